# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""How well a cell's motion fits what the paper tells of the cell of its Figure 2.

It moves with a high |O_x2| in free flow, detours around S8 and flips over after t = 50 ms,
about the positive x1 axis as cells do soon after the edge of a sieve; at 55 ms its velocity along x2 rises while O_x1 and O_x2 turn steeply; at 56 ms it lies
across the flow, |O_x1| and |O_x3| high; |O_x2| has recovered when it leaves the chamber.
"""

from collections import namedtuple
from functools import lru_cache

import numpy as np

from . import walls
from .case import MILLI, NotApplicable

SIEVE = "S8"
SIDE = 0.5        # |O_x2| beyond which the long axis is on one side
NEAR = 3.0        # micrometres between the cell's centre and a sieve that it detours
AFTER = 20e-3     # s between the passing of the sieve and the flip
AROUND = 1e-3     # s before and after the flip for the change of u2
PAPER_FLIP = 55.0   # ms
SPREAD = 20.0       # ms about it
TURN = 0.1e-3     # s before and after the flip for its axis
RISE, STEEP = 0.2, 0.5   # mm/s and 1/ms from which on a flip fits in full


def flips(track):
    """Times at which O_x2 passes zero between one side and the other."""
    along = track.axis[:, 1]
    firm = np.flatnonzero(np.abs(along) > SIDE)
    changes = np.flatnonzero(np.diff(np.sign(along[firm])))
    times = []
    for before, after in zip(firm[changes], firm[changes + 1]):
        k = before + np.flatnonzero(np.diff(np.sign(along[before:after + 1])))[0]
        share = along[k] / (along[k] - along[k + 1])
        times.append(track.t[k] + share * (track.t[k + 1] - track.t[k]))
    return np.array(times)


def sense(track, t):
    """Part of the long axis' rate of turning at a time that is about +x1, from -1 to 1."""
    before, after = track.at([t - TURN, t + TURN]).axis
    about = np.cross(before, after)
    return float(about[0] / max(np.linalg.norm(about), 1e-30))


class Account(namedtuple(
    "Account", "cell sieve passing gap free flip sense rise steep across exit time"
)):
    """What a cell does of the paper's account; passing and flip are times of the run [s], sense
    as of sense(), rise [mm/s], steep [1/ms], time of the flip since the injection [ms]."""

    __slots__ = ()

    @property
    def score(self):
        """From 0, nothing fits, to 1, all fits: the mean of its parts."""
        return np.mean([
            self.free,
            max(0, self.sense),
            np.clip((2 * NEAR - self.gap) / NEAR, 0, 1),
            np.clip(self.rise / RISE, 0, 1),
            np.clip(self.steep / STEEP, 0, 1),
            self.across,
            self.exit,
            np.exp(-((self.time - PAPER_FLIP) / SPREAD) ** 2),
        ])

    @property
    def explained(self):
        """What the score is, and what it is not, for a caption."""
        return f"""Its fit to the paper's account is {self.score:.2f} of 1, the mean of eight parts of
            0 to 1: the median |O_x2| until it passes {self.sieve}; the part of its turning
            at the flip that is about +x1; its gap at {self.sieve}, 1 up to
            {NEAR:g} µm and 0 from {2 * NEAR:g} µm; the rise of u2 within {MILLI * AROUND:g} ms of
            the flip over {RISE:g} mm/s; |dO_x2/dt| over {STEEP:g} per ms; the higher of |O_x1| and
            |O_x3| within that of it; |O_x2| at the chamber's end; and exp(-(t - {PAPER_FLIP:g} ms)² /
            ({SPREAD:g} ms)²) of the time of the flip."""

    def table(self):
        """Beside the paper's words."""
        return [
            ["the paper's account", f"cell {self.cell}"],
            ["high |O_x2| in free flow", f"median |O_x2| = {self.free:.2f} until there"],
            [f"detours around {self.sieve}", f"its centre passes {self.gap:.1f} µm from it, "
             f"{1e3 * (self.flip - self.passing):+.1f} ms before it flips"],
            ["flips over after t = 50 ms", f"at {self.time:.1f} ms"],
            ["flips about +x1", f"{self.sense:+.2f} of its turning is about +x1"],
            ["at 55 ms the velocity along x2 rises",
             f"by {self.rise:+.2f} mm/s within 1 ms either way of the flip"],
            ["and O_x1 and O_x2 turn steeply", f"|dO_x2/dt| = {self.steep:.2f} per ms"],
            ["at 56 ms |O_x1| and |O_x3| near 1", f"the higher of both is {self.across:.2f} within 1 ms of it"],
            ["|O_x2| high again at the exit", f"|O_x2| = {self.exit:.2f} at the chamber's end"],
            ["fit, of 1", f"{self.score:.2f}"],
        ]


@lru_cache(maxsize=1)
def finer_track(case, cell):
    """The cell's track between its rows: of one cell all sieves are asked in turn."""
    return case.tracks[cell].finer(10)


def detour(case, cell, sieve=SIEVE):
    """(track, row at which it is nearest, gap there) of an escaped cell that comes near a sieve;
    None of the others."""
    if not case.chamber or sieve not in case.sieves or case.fates[cell].name != "escaped":
        return None
    rows = case.tracks[cell]
    # Most never come near: find that out from their rows
    low, high = case.box(sieve)
    reach = 2 * NEAR + np.abs(np.diff(rows.x[:, :2], axis=0)).max(initial=0)
    x = rows.x[:, :2]
    if not ((x > low - reach) & (x < high + reach)).all(1).any():
        return None
    track = finer_track(case, cell)
    gaps = walls.distance(case, [sieve], track.x, within=2 * NEAR)
    nearest = int(np.argmin(gaps))
    return (track, nearest, gaps[nearest]) if np.isfinite(gaps[nearest]) else None


def of_cell(case, cell, sieve=SIEVE, near=None):
    """The account of an escaped cell; None if it does not flip after passing the sieve. near
    is its detour() where that is known."""
    near = near or detour(case, cell, sieve)
    if not near:
        return None
    track, nearest, gap = near
    passing = track.t[nearest]
    exits = np.flatnonzero(track.x[:, 1] > case.chamber[1])
    if not len(exits):
        return None
    later = flips(track)
    later = later[(later > passing) & (later < min(passing + AFTER, track.t[exits[0]]))]
    if not len(later):
        return None

    flip = later[0]
    before, after = (track.at([flip + dt]) for dt in (-AROUND, AROUND))
    about = np.abs(track.t - flip) < AROUND
    inside = (track.x[:, 1] > -case.chamber[1]) & (track.t < passing)
    steep = np.abs(np.gradient(track.axis[:, 1], track.t))[about]
    return Account(
        cell, sieve, passing, gap,
        float(np.median(np.abs(track.axis[inside, 1]))) if inside.any() else 0.0,
        flip, sense(track, flip), float(after.u[0, 1] - before.u[0, 1]),
        steep.max(initial=0) / MILLI,
        float(np.abs(track.axis[about][:, [0, 2]]).max(initial=0)), float(abs(track.axis[exits[0], 1])),
        (flip - track.t[0]) * MILLI,
    )


def all_of(case, sieve=SIEVE):
    """The accounts of all cells that pass the sieve and flip, those that fit best first."""
    if not case.chamber:
        raise NotApplicable("the paper's account is of a circular trap, which this case is not "
                            "(no constant/generated/chamber): give the id of a cell")
    told = [one for one in (of_cell(case, cell, sieve) for cell in case.tracks) if one]
    if not told:
        raise NotApplicable(f"no escaped cell flips after it has passed {sieve}")
    return sorted(told, key=lambda one: -one.score)

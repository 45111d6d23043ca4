# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Speed of the flow at half depth, with the tracks of all cells by their fate."""

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.patches import Patch

from . import style

SHOWN = 100   # tracks of escaped cells at most: more would hide the flow
FEW = 20      # tracks of each other fate that are shown in any case
FAINT = 0.45  # how much of those that escaped is seen
PARTS = 6     # of a way between two rows
MICRO_PER_MILLI = 1000


def thinned(cells, most):
    """So many of the cells at most, in even steps; they entered in no order."""
    most = min(most, len(cells))
    return [cells[i * len(cells) // most] for i in range(most)]


def shown(cells):
    """The cells of every fate whose tracks are drawn: where not all that escaped are, the others
    are so many that the picture does not seem to hold more of them than the device."""
    escaped = max(len(cells.get("escaped", ())), 1)
    share = min(SHOWN / escaped, 1)
    return {
        fate: thinned(some, SHOWN if fate == "escaped" else max(FEW, round(share * len(some))))
        for fate, some in cells.items()
    }


def jumps(track):
    """Between which rows a cell left at one side and came in at another, as at a cyclic patch: much
    farther apart than it moved."""
    apart = np.linalg.norm(np.diff(track.x[:, :2], axis=0), axis=1)
    speed = np.linalg.norm(track.u, axis=1)
    return apart > 1 + 5 * MICRO_PER_MILLI * np.maximum(speed[:-1], speed[1:]) * np.diff(track.t)


def pieces(track):
    """The path in as many parts as it has without its jumps."""
    ends = PARTS * np.flatnonzero(jumps(track))
    path, begin = track.finer(PARTS).x[:, :2], 0
    for end in ends:
        yield path[begin:end + 1]
        begin = end + PARTS
    yield path[begin:]


def beyond_walls(plane, tracks):
    """How many tracks lead between two of their rows through what is not fluid at half depth,
    though both rows are in fluid."""
    many = 0
    for track in tracks:
        rows = plane.has_fluid(track.x[:, :2])
        between = plane.has_fluid(track.finer(PARTS).x[:-1, :2]).reshape(-1, PARTS)
        many += bool((rows[:-1] & rows[1:] & ~jumps(track) & ~between.all(axis=1)).any())
    return many


def rows_of(plane, tracks):
    """The flow in the mesh cells cut, and the paths drawn, in rows."""
    middles = np.array([polygon.mean(axis=0) for polygon in plane.polygons])
    speed = np.linalg.norm(plane.velocity, axis=1)
    rows = [("flow", "", "", x, y, value) for (x, y), value in zip(middles.tolist(), speed.tolist())]
    for cell, fate, track in tracks:
        rows += [
            (fate, cell, float(t), *x[:2].tolist(), float(np.linalg.norm(u)))
            for t, x, u in zip(track.t, track.x, track.u)
        ]
    return ("what", "cell", "t [s]", "x [um]", "y [um]", "speed [mm/s]"), rows


def draw(case):
    """The figure."""
    plane = case.plane
    bounds = np.array(plane.bounds)
    margin = 0.04 * np.ptp(bounds, axis=1).max()
    figure, ax = style.plan_figure(*(bounds + [-margin, margin]))
    image = style.draw_speed(ax, plane)
    style.draw_outlines(ax, case)
    style.name_openings(ax, case)
    figure.colorbar(image, ax=ax, label="speed |u| at\nhalf depth [mm/s]", aspect=35, pad=0.02)

    keys, drawn = [], []
    of_fate = {
        fate: [cell for cell, one in case.fates.items() if one.name == fate and cell in case.tracks]
        for fate in style.FATE_LINES
    }
    chosen = shown({fate: cells for fate, cells in of_fate.items() if cells})
    for fate, cells in chosen.items():
        line = style.FATE_LINES[fate]
        key = style.fate_key(fate, len(of_fate[fate]))
        if len(cells) < len(of_fate[fate]):
            key.set_label(f"{fate} ({len(of_fate[fate])}; {len(cells)} shown)")
        keys.append(key)
        drawn += [(cell, fate, case.tracks[cell]) for cell in cells]
        tracks = [piece for cell in cells for piece in pieces(case.tracks[cell])]
        effects = [] if fate == "escaped" else style.framed("white", line["linewidth"] + 0.6)
        ax.add_collection(LineCollection(
            tracks, colors=line["color"], linewidths=line["linewidth"],
            linestyles=[line["linestyle"]], path_effects=effects,
            alpha=FAINT if fate == "escaped" else 1,
        ))
        if fate != "escaped":
            ends = np.array([case.tracks[cell].x[-1, :2] for cell in cells])
            ax.plot(
                *ends.T, linestyle="none", markerfacecolor=line["color"], **style.LAST_POINT
            )

    # The names of more would hide the flow
    many = len(case.sieves) > style.MOST_SIEVES
    for name in case.sieves:
        if many and not case.count("caught", name):
            continue
        (left, _), (right, top) = case.box(name)
        ax.annotate(
            f"{name}: {case.count('caught', name)}", ((left + right) / 2, top),
            xytext=(0, 3), textcoords="offset points", ha="center", va="bottom",
            fontsize=4 if many else 8, fontweight="bold", path_effects=style.framed("white", 1 if many else 2),
        )
    keys.append(Patch(facecolor=style.SOLID, edgecolor="black", label="no fluid"))
    # Wider than the plan it would part that from its colour bar
    style.legend_below(ax, keys, most=3 if len(keys) == 3 else 2)
    sparse = beyond_walls(plane, [track for *_, track in drawn])
    warning = f"""{sparse} of the {len(drawn)} paths drawn lead through walls: the rows of the tracks
        are too far apart for this flow (tracks/interval).""" if sparse else ""
    if sparse:
        print(f"speedAndTracks: {' '.join(warning.split())}")
    style.describe(figure, f"""Speed of the flow at half depth, and the paths of the cells' centres
        by fate, of those that escaped {SHOWN} at most, and of others no larger a share, but {FEW};
        points mark where cells are that have not left. Numbers beside the sieves are the cells that
        they hold{", where they hold any" * many}. {warning}""", rows_of(plane, drawn))
    return figure

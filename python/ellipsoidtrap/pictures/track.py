# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""The rows of one cell, and its motion between them."""

from collections import namedtuple

import numpy as np

from . import poses

MICRO = 1e6   # m to micrometres
MILLI = 1e3   # m/s to mm/s, s to ms

STEEPEST = 3   # tangents of a cubic in chords: above, it turns back (Fritsch & Carlson 1980)


def cubic(start, end, tangents, s):
    """Place and d/ds at 0 <= s <= 1 on cubics, and whether the rates are those of a smooth
    motion: rows of a cell at rest may lie far apart, and their tangents are then shortened."""
    limited = [poses.at_most(one, end - start, STEEPEST) for one in tangents]
    smooth = np.all([one == kept for one, kept in zip(limited, tangents)], axis=(0, 2))[:, None]
    return (
        poses.hermite(start, end, *limited, s), poses.hermite_rate(start, end, *limited, s), smooth
    )


def between(values, first, s):
    """On the straight line between two rows."""
    return values[first] + s * (values[first + 1] - values[first])


class Track(namedtuple("Track", "t x u q omega axis")):
    """The rows of one cell by time, in arrays."""

    __slots__ = ()

    def at(self, times):
        """The track at other times: x and q on cubics that have the velocity and spin of its
        rows, and u and omega as the rates of these."""
        if len(self.t) < 2:
            return Track(*(np.repeat(part[:1], len(times), axis=0) for part in self))
        first = np.searchsorted(self.t, times, side="right") - 1
        first = np.clip(first, 0, len(self.t) - 2)
        last = first + 1
        dt = np.maximum(self.t[last] - self.t[first], 1e-30)[:, None]
        s = np.clip((np.asarray(times)[:, None] - self.t[first][:, None]) / dt, 0, 1)
        # A row is written as a cell enters and one as it leaves: not yet, or no more, at its ease
        inner = ((first > 0) & (last < len(self.t) - 1))[:, None]

        tangents = [self.u[row] * dt * MICRO / MILLI for row in (first, last)]
        x, rate, smooth = cubic(self.x[first], self.x[last], tangents, s)
        u = np.where(smooth & inner, rate / dt * MILLI / MICRO, between(self.u, first, s))
        # q and -q are the same pose
        start, end = self.q[first], self.q[last]
        near = np.where((start * end).sum(axis=1, keepdims=True) < 0, -1, 1)
        tangents = [
            poses.quaternion_rate(start, self.omega[first]) * dt,
            near * poses.quaternion_rate(end, self.omega[last]) * dt,
        ]
        q, rate, smooth = cubic(start, near * end, tangents, s)
        omega = np.where(smooth & inner, poses.spin(q, rate / dt), between(self.omega, first, s))
        q /= np.linalg.norm(q, axis=1, keepdims=True)
        return Track(np.asarray(times), x, u, q, omega, poses.long_axis(q))

    def spin_at(self, times):
        """omega at other times without the corners that at() leaves at the rows: quartics with
        the mean of at() over every interval, and at a row the mean of its slopes on both sides."""
        if len(self.t) < 3:
            return self.at(times).omega
        dt = np.diff(self.t)[:, None]
        start, end = self.omega[:-1], self.omega[1:]
        middle = self.at((self.t[1:] + self.t[:-1]) / 2).omega
        # The parabolas through these three
        first = (4 * middle - 3 * start - end) / dt
        last = (3 * end + start - 4 * middle) / dt
        slopes = np.concatenate((
            first[:1], (last[:-1] * dt[1:] + first[1:] * dt[:-1]) / (dt[1:] + dt[:-1]), last[-1:]
        ))
        lacking = (start + 4 * middle + end) / 6 - (start + end) / 2
        lacking -= (slopes[:-1] - slopes[1:]) * dt / 12
        row = np.clip(np.searchsorted(self.t, times, side="right") - 1, 0, len(dt) - 1)
        dt = dt[row]
        s = np.clip((np.asarray(times) - self.t[row])[:, None] / dt, 0, 1)
        a, b = slopes[row] * dt, slopes[row + 1] * dt
        # s^2 (1 - s)^2 has the mean 1/30
        return poses.hermite(start[row], end[row], a, b, s) + 30 * lacking[row] * (s - s * s) ** 2

    def finer(self, parts=6):
        """The track with every interval between rows divided."""
        steps = np.diff(self.t)[:, None] * np.arange(parts) / parts
        return self.at(np.append((self.t[:-1, None] + steps).ravel(), self.t[-1]))

    @property
    def travelled(self):
        """Length of the path up to every row."""
        return np.append(0, np.linalg.norm(np.diff(self.x, axis=0), axis=1).cumsum())

    @property
    def turned(self):
        """Angle turned through, back and forth, up to every row."""
        half = np.abs((self.q[1:] * self.q[:-1]).sum(axis=1))
        return np.append(0, 2 * np.arccos(np.minimum(half, 1)).cumsum())

    def until(self, t):
        """The rows up to a time."""
        return Track(*(part[self.t <= t] for part in self))

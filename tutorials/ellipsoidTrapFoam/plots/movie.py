# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""An animation of cells that tumble past a sieve, and of one that it catches, as in movies 2
to 5 of the paper: true ellipsoids over the flow's speed at half depth.

Few cells of a run are near one sieve at one time: the film puts cells together that came
one after the other, each from when it enters the window. They do not see one another.
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib import font_manager
from matplotlib.patches import Patch
from PIL import Image, ImageDraw, ImageFont

import bodies
import style
import walls
from case import MILLI, NotApplicable
from files import CaseError

MARGIN = 9.0        # shown about the sieve, in micrometres
SCALE = 15          # pixels a micrometre
STEP = 0.5e-3       # s between frames
FRAME = 50          # ms that a frame is seen
LONGEST = 0.1       # s that are shown at most, and
SHORTEST = 0.06     # at least, so that a caught cell comes to rest
BEFORE = 0.018      # s from the first entry to the first frame, which shows some cells
PASSING = 7         # cells that pass
APART = 9e-3        # s between their entries
QUALITY = 55

PASSES, STAYS = (style.ORANGE, style.YELLOW), (style.BLUE, style.SKY)

OPTIONS = {"sieve": {"help": "to look at [the one that holds most cells]"}}


class Film:
    """Frames that are saved like a figure."""

    suffix = ".webp"

    def __init__(self, frames):
        self.frames = frames

    def savefig(self, file):
        """Write them as an animation that goes round."""
        first, *others = (Image.fromarray(frame) for frame in self.frames)
        first.save(
            file, save_all=True, append_images=others, duration=FRAME, loop=0,
            quality=QUALITY, method=1,
        )


def visit(track, window):
    """The part of a track in a window, from when it enters it, or None."""
    (x0, x1), (y0, y1) = window
    x, y, _ = track.x.T
    inside = np.flatnonzero((x > x0) & (x < x1) & (y > y0) & (y < y1))
    if len(inside) < 2:
        return None
    return track.t[inside[0]], track.t[inside[-1]]


def cast(case, sieve, window):
    """(cell, when its visit begins and ends) of the cells to show: one caught, and those that pass
    nearest to the sieve."""
    passing, staying = [], []
    reach = 0.7 * MARGIN
    tracks = {
        cell: track.until(track.t[0] + 1) for cell, track in case.tracks.items()
        if visit(track, window)
    }
    for cell, track in tracks.items():
        fate = case.fates[cell]
        begin, end = visit(track, window)
        if fate.name == "escaped":
            near = walls.distance(case, [sieve], track.finer(3).x, within=reach).min()
            if np.isfinite(near) and end - begin < LONGEST / 2:
                passing.append((near, cell, begin, end))
        elif fate.name == "caught" and fate.patch == sieve:
            staying.append((fate.t, cell, begin, begin))
    chosen = [one[1:] for one in sorted(passing)[:PASSING]]
    # In the order of their ids, which is none, so that not the nearest come first
    chosen.sort()
    if staying:
        chosen.insert(min(1, len(chosen)), min(staying)[1:])
    return chosen


def busiest(case):
    """The sieve that holds most cells."""
    return max(case.sieves, key=lambda name: case.count("caught", name))


def draw_stage(case, sieve, window):
    """What does not move, as an image, and where its axes lie: left, top in pixels."""
    (x0, x1), (y0, y1) = window
    width, height = (int(round(SCALE * (high - low))) for low, high in window)
    left, right, below, above = 58, 78, 78, 34
    size = np.array((left + width + right, below + height + above))
    figure = plt.figure(figsize=size / 100, dpi=100)
    ax = figure.add_axes((
        left / size[0], below / size[1], width / size[0], height / size[1]
    ))
    style.plan_axes(ax, (x0, x1), (y0, y1))
    image = style.draw_speed(ax, case.plane, vmin=0)
    style.draw_outlines(ax, case, linewidth=1.5)
    bar = figure.add_axes((
        (left + width + 10) / size[0], below / size[1], 12 / size[0], height / size[1]
    ))
    figure.colorbar(image, cax=bar, label="|u| at half depth [mm/s]")
    keys = [
        Patch(facecolor=PASSES[0], edgecolor="black", label="passes"),
        Patch(facecolor=STAYS[0], edgecolor="black", label=f"is caught by {sieve}"),
        Patch(facecolor=style.SOLID, edgecolor="black", label="no fluid"),
    ]
    figure.legend(handles=keys, loc="lower center", ncol=3, bbox_to_anchor=(0.48, 0))
    figure.canvas.draw()
    stage = np.asarray(figure.canvas.buffer_rgba())[..., :3].copy()
    plt.close(figure)
    return stage, left, above


def draw(case, sieve=None):
    """The film."""
    if not case.sieves:
        raise NotApplicable("the case has no sieves")
    if sieve is not None and sieve not in case.sieves:
        file = case.path("constant", "ellipsoidCloudProperties")
        raise CaseError(f"{file}: no sieve {sieve}")
    sieve = sieve or busiest(case)
    corners = case.plane.outlines[sieve].reshape(-1, 2)
    window = tuple(zip(corners.min(axis=0) - MARGIN, corners.max(axis=0) + MARGIN))
    shown = cast(case, sieve, window)
    if not shown:
        raise NotApplicable(f"no cell comes near {sieve}")

    stage, left, top = draw_stage(case, sieve, window)
    font = ImageFont.truetype(font_manager.findfont("DejaVu Sans"), 15)
    last = max(end - begin + k * APART - BEFORE for k, (_, begin, end) in enumerate(shown))
    times = np.arange(0, np.clip(last, SHORTEST, LONGEST), STEP)
    poses = []
    for k, (cell, begin, _) in enumerate(shown):
        track = case.tracks[cell]
        clock = begin + BEFORE + times - k * APART
        there = (clock >= track.t[0]) & (clock <= track.t[-1])
        colours = STAYS if case.fates[cell].name == "caught" else PASSES
        poses.append((there, track.at(clock), case.semi_axes_of(cell), colours))

    frames = []
    for i, t in enumerate(times):
        cells = [
            bodies.Body(track.x[i], track.q[i], semi_axes, *colours)
            for there, track, semi_axes, colours in poses if there[i]
        ]
        over = bodies.picture(cells, bodies.FROM_ABOVE, *window, SCALE)
        frame = stage.copy()
        part = frame[top:top + over.shape[0], left:left + over.shape[1]]
        alpha = over[..., 3:]
        part[:] = (255 * over[..., :3] * alpha + part * (1 - alpha)).astype(np.uint8)
        image = Image.fromarray(frame)
        ImageDraw.Draw(image).text((left, 9), f"{MILLI * t:5.1f} ms", "black", font)
        frames.append(np.asarray(image))

    film = Film(frames)
    caught = sum(case.fates[cell].name == "caught" for cell, *_ in shown)
    style.describe(film, f"""{len(shown) - caught} cells that pass {sieve} and {caught} that it
        catches, true ellipsoids seen from above, {FRAME / (MILLI * STEP):.0f} times slowed
        down. Light and dark halves tell the ends of a cell apart. The cells came at different
        times of the run and are put together; they do not see one another. Cells:
        {", ".join(str(cell) for cell, *_ in shown)}.""")
    return film

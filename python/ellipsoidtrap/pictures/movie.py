# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""An animation of cells that tumble past a sieve, and of one that it catches, as in movies 2
to 5 of the paper: true ellipsoids over the flow's speed at half depth. Or of all cells in the
whole device, as they were at one time.

Few cells of a run are near one sieve at one time: the film puts cells together that came
one after the other, each from when it enters the window. There they do not see one another.
"""

import shutil
import subprocess
import textwrap

import matplotlib.pyplot as plt
import numpy as np
from matplotlib import font_manager
from matplotlib.patches import Patch
from PIL import Image, ImageDraw, ImageFont

from . import bodies
from . import style
from . import walls
from .case import MILLI, NotApplicable
from .files import CaseError

# Lengths and times of a film at a sieve are those of the default cell: size_of() times as much for others
MARGIN = 9.0        # shown about the sieve, in micrometres
LONG = 60.0         # of a sieve at most
WIDEST = 8000       # pixels
NARROWEST = 760     # of them, so that the keys have room
LINES = 1080        # of the MP4 at least; the WebP beside it has half as many, one alone two thirds
LEFT, RIGHT, BELOW, ABOVE = 117, 156, 231, 63   # pixels about the window, multiples of three
STEP = 0.5e-3       # s between frames
FRAME = 50          # ms that a frame is seen
LONGEST = 0.1       # s that are shown at most, and
SHORTEST = 0.06     # at least, so that a caught cell comes to rest
BEFORE = 0.018      # s from the first entry to the first frame, which shows some cells
PASSING = 7         # cells that pass
APART = 9e-3        # s between their entries
WHOLE = 400         # frames of the whole device
QUALITY = 55

PASSES, STAYS = (style.ORANGE, style.YELLOW), (style.BLUE, style.SKY)

OPTIONS = {
    "sieve": {"help": "to look at [the one that holds most cells]"},
    "device": {"action": "store_true", "help": "all of it, from the first cell to the end"},
    "begin": {"type": float, "metavar": "T", "help": "of the film of the device [0 s]"},
    "end": {"type": float, "metavar": "T", "help": "of the film of the device [that of the run]"},
    "frames": {"type": int, "metavar": "N", "help": f"of the film of the device [{WHOLE}]"},
}

# Frames from the standard input; even sides, as the format asks for
ENCODE = "ffmpeg -y -loglevel error -f rawvideo -pix_fmt rgb24 -s {}x{} -r {:g} -i - -c:v libx264 " \
    "-crf 18 -pix_fmt yuv420p -movflags +faststart -bitexact"


def is_encoded():
    """Whether there is an MP4, too."""
    return shutil.which("ffmpeg") is not None


class Reel(Image.Image):
    """Frames as one image, each made when it is written: all of a long device take a gigabyte."""

    def __init__(self, frames, number):
        super().__init__()
        self.frames = iter(frames)
        self.n_frames = number
        self.show_next()

    def show_next(self):
        """Become the next frame."""
        self.__dict__.update(next(self.frames).__dict__)

    def seek(self, frame):
        """Pillow asks for one after the other, and at the end for the first again, of which it takes nothing."""
        if frame > 0:
            self.show_next()


class Film:
    """Frames that are saved like a figure."""

    def __init__(self, frames, number):
        self.frames = frames   # a function that yields so many, as images
        self.number = number
        self.halves = None
        self.suffixes = ("mp4", "webp") if is_encoded() else ("webp",)
        if len(self.suffixes) == 1:
            print("movie: no MP4, as ffmpeg is not installed")

    def savefig(self, file, **_):
        """Write them as the file's name says."""
        if file.endswith(".mp4"):
            self.encode(file)
            return
        reel = Reel(self.halves or self.frames(), self.number)
        reel.save(file, save_all=True, duration=FRAME, loop=0, quality=QUALITY, method=1)

    def encode(self, file):
        """The MP4; keeps the frames of the WebP, which have half as many lines."""
        self.halves = []
        encoder = None
        for frame in self.frames():
            self.halves.append(frame.reduce(2))
            if encoder is None:
                words = ENCODE.format(*frame.size, MILLI / FRAME).split()
                encoder = subprocess.Popen(
                    [*words, file], stdin=subprocess.PIPE, stderr=subprocess.PIPE
                )
            try:
                encoder.stdin.write(frame.tobytes())
            except BrokenPipeError:
                break
        _, said = encoder.communicate()
        if encoder.returncode != 0:
            raise CaseError(f"{file}: ffmpeg: {said.decode(errors='replace').strip()}")


def visit(track, window):
    """The part of a track in a window, from when it enters it, or None."""
    (x0, x1), (y0, y1) = window
    x, y, _ = track.x.T
    inside = np.flatnonzero((x > x0) & (x < x1) & (y > y0) & (y < y1))
    if len(inside) < 2:
        return None
    return track.t[inside[0]], track.t[inside[-1]]


def size_of(case):
    """Length of a cell by the default cell's, 1 for shorter ones."""
    return max(1.0, case.semi_axes.max() / 2)


def cast(case, sieve, window):
    """(cell, when its visit begins and ends) of the cells to show: one caught, and those that pass
    nearest to the sieve."""
    passing, staying = [], []
    size = size_of(case)
    reach = 0.7 * size * MARGIN
    tracks = {
        cell: track for cell, track in
        ((cell, track.until(track.t[0] + size)) for cell, track in case.tracks.items())
        if visit(track, window)
    }
    for cell, track in tracks.items():
        fate = case.fates[cell]
        begin, end = visit(track, window)
        if fate.name == "escaped":
            near = walls.distance(case, [sieve], track.finer(3).x, within=reach).min()
            if np.isfinite(near) and end - begin < size * LONGEST / 2:
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


def in_view(case, sieve):
    """(low, high) corners of a sieve, of a long one about the first cell that it caught."""
    low, high = case.box(sieve)
    held = [(one.t, cell) for cell, one in case.fates.items()
            if one.name == "caught" and one.patch == sieve and cell in case.tracks]
    at = case.tracks[min(held)[1]].x[-1, :2] if held else (low + high) / 2
    half = np.minimum(size_of(case) * LONG, high - low) / 2
    middle = np.clip(at, low + half, high - half)
    return middle - half, middle + half


def draw_stage(case, sieve, window, scale, share, caption):
    """What does not move, as an image of that share of its pixels each way; scale in pixels of the image."""
    (x0, x1), (y0, y1) = window
    width, height = (int(round(scale * (high - low))) / share for low, high in window)
    size = np.array((LEFT + width + RIGHT, BELOW + height + ABOVE))
    # A little more, as what is cut off must not be a whole pixel
    figure = plt.figure(figsize=(size + 1e-3) / 200, dpi=200 * share)
    ax = figure.add_axes((
        LEFT / size[0], BELOW / size[1], width / size[0], height / size[1]
    ))
    style.plan_axes(ax, (x0, x1), (y0, y1))
    image = style.draw_speed(ax, case.plane)
    style.draw_outlines(ax, case, linewidth=1.5)
    bar = figure.add_axes((
        (LEFT + width + 20) / size[0], BELOW / size[1], 24 / size[0], height / size[1]
    ))
    figure.colorbar(image, cax=bar, label="|u| at half depth [mm/s]")
    keys = [
        Patch(facecolor=PASSES[0], edgecolor="black", label="passes"),
        Patch(facecolor=STAYS[0], edgecolor="black", label=f"is caught by {sieve or 'a sieve'}"),
        Patch(facecolor=style.SOLID, edgecolor="black", label="no fluid"),
    ]
    figure.legend(handles=keys, loc="lower center", ncol=3, bbox_to_anchor=(0.48, 82 / size[1]))
    figure.text(
        0.5, 8 / size[1], textwrap.fill(caption, int(size[0] / 11.5)), ha="center", va="bottom",
        fontsize=7.5,
    )
    figure.canvas.draw()
    stage = np.asarray(figure.canvas.buffer_rgba())[..., :3].copy()
    plt.close(figure)
    return stage[:stage.shape[0] // 2 * 2, :stage.shape[1] // 2 * 2]


def follow(case, shown):
    """The times of the frames, and of every cell to show: at which it is there, its track at
    them, its semi-axes and colours."""
    size = size_of(case)
    # The last one enters in view, however fast all of them pass
    before = min(BEFORE, (len(shown) - 1) * APART)
    last = max((end - begin) / size + k * APART - before for k, (_, begin, end) in enumerate(shown))
    times = size * np.arange(0, np.clip(last, SHORTEST, LONGEST), STEP)
    actors = []
    for k, (cell, begin, _) in enumerate(shown):
        track = case.tracks[cell]
        clock = begin + size * before + times - k * size * APART
        there = (clock >= track.t[0]) & (clock <= track.t[-1])
        colours = STAYS if case.fates[cell].name == "caught" else PASSES
        actors.append((cell, there, track.at(clock), case.semi_axes_of(cell), colours))
    return times, actors


def follow_all(case, times):
    """The same of all cells at the run's own times."""
    actors = []
    for cell, track in case.tracks.items():
        fate = case.fates[cell]
        stays = fate.name != "escaped"
        there = (times >= track.t[0]) & (stays | (times <= track.t[-1]))
        at = track.at(np.clip(times, track.t[0], track.t[-1]))
        colours = STAYS if fate.name == "caught" else PASSES
        actors.append((cell, there, at, case.semi_axes_of(cell), colours))
    return actors


def rows_of(times, actors):
    """What is seen when, in rows."""
    names = ("t [ms]", "cell", "x1 [um]", "x2 [um]", "x3 [um]", "eps1", "eps2", "eps3", "eta")
    return names, [
        (MILLI * float(t), cell, *track.x[i].tolist(), *track.q[i].tolist())
        for i, t in enumerate(times) for cell, there, track, *_ in actors if there[i]
    ]


def crossing(case):
    """How long it takes a cell to pass the device, the median of those that did; infinite if none."""
    spent = [track.t[-1] - track.t[0] for cell, track in case.tracks.items()
             if case.fates[cell].name == "escaped"]
    return np.median(spent) if spent else np.inf


def draw_device(case, begin, end, frames):
    """The film of all cells from one time to another."""
    begin = 0.0 if begin is None else begin
    end = case.end_time if end is None else end
    frames = WHOLE if frames is None else frames
    if not 0 <= begin < end <= case.end_time:
        raise CaseError(f"--begin {begin:g} and --end {end:g}: allowed: 0 to {case.end_time:g}, in order")
    if frames < 2:
        raise CaseError(f"--frames {frames}: allowed: 2 or more")
    window = tuple((low - 1, high + 1) for low, high in case.plane.bounds)
    times = np.linspace(begin, end, frames)
    actors = follow_all(case, times)
    step, passing = times[1] - times[0], crossing(case)
    if step > passing / 4:
        print(f"movie: from frame to frame {step:.3g} s pass, and a cell crosses the device in "
              f"{passing:.3g} s: give --begin and --end, or more --frames")
    factor = FRAME / (MILLI * step)
    caption = f"""All cells of the run, true ellipsoids seen from above,
        {factor if factor > 1 else 1 / factor:.3g} times {"slowed down" if factor > 1 else "as fast"}.
        The speed is that of the flow as it was at the start."""
    film = film_of(case, None, window, times, actors, " ".join(caption.split()))
    film.name = "movieOfDevice"   # beside that of the sieve
    return film


def draw(case, sieve=None, device=False, begin=None, end=None, frames=None):
    """The film; the times and frames are those of the device's."""
    of_device = [f"--{name}" for name, value in (("begin", begin), ("end", end), ("frames", frames)) if value is not None]
    if of_device and not device:
        raise CaseError(f"{' '.join(of_device)}: only of the film of the device: give --device, too")
    if device and sieve is not None:
        raise CaseError("--sieve and --device: the film is of one or of the other")
    if not case.sieves:
        raise NotApplicable("the case has no sieves")
    if sieve is not None and sieve not in case.sieves:
        file = case.path("constant", "ellipsoidCloudProperties")
        raise CaseError(f"{file}: no sieve {sieve}")
    if device:
        return draw_device(case, begin, end, frames)
    sieve = sieve or busiest(case)
    low, high = in_view(case, sieve)
    size = size_of(case)
    window = tuple(zip(low - size * MARGIN, high + size * MARGIN))
    shown = cast(case, sieve, window)
    if not shown:
        raise NotApplicable(f"no cell comes near {sieve}")

    caught = sum(case.fates[cell].name == "caught" for cell, *_ in shown)
    caption = f"""{len(shown) - caught} cells that pass {sieve} and {caught} that it catches, true
        ellipsoids seen from above, {FRAME / (MILLI * size * STEP):.3g} times slowed down. Light and dark
        halves tell the ends of a cell apart. The cells came at different times of the run and are
        put together; they do not see one another."""
    caption = " ".join(caption.split())
    return film_of(case, sieve, window, *follow(case, shown), caption)


def film_of(case, sieve, window, times, actors, caption):
    """The frames of actors in a window, and their data."""
    scale = min(-(-(LINES - BELOW - ABOVE + 1) // np.ptp(window[1])), WIDEST / np.ptp(window[0]))
    beside = max(0, NARROWEST / scale - np.ptp(window[0])) / 2
    window = ((window[0][0] - beside, window[0][1] + beside), window[1])
    share = 1 if is_encoded() else 2/3
    scale *= share
    left, above, begin, size = (round(share * pixels) for pixels in (LEFT, ABOVE, 15, 30))
    stage = draw_stage(case, sieve, window, scale, share, caption)
    font = ImageFont.truetype(font_manager.findfont("DejaVu Sans"), size)

    def frames():
        for i, t in enumerate(times):
            cells = [
                bodies.Body(track.x[i], track.q[i], semi_axes, *colours)
                for _, there, track, semi_axes, colours in actors if there[i]
            ]
            frame = stage.copy()
            for rows, columns, over in bodies.parts(cells, bodies.FROM_ABOVE, *window, scale):
                rows = slice(above + rows.start, above + rows.stop)
                columns = slice(left + columns.start, left + columns.stop)
                colour, alpha = over[..., :3], over[..., 3:]
                frame[rows, columns] = 255 * colour * alpha + stage[rows, columns] * (1 - alpha)
            image = Image.fromarray(frame)
            ImageDraw.Draw(image).text((left, begin), f"{MILLI * t:5.1f} ms", "black", font)
            yield image

    film = Film(frames, len(times))
    style.describe(
        film, caption + (f" Cells: {', '.join(str(cell) for cell, *_ in actors)}." if sieve else ""),
        rows_of(times, actors)
    )
    return film

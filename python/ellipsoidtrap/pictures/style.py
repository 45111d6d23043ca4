# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""The look that the pictures share, and the frame of their commands."""

import argparse
import json
import os
import sys
import time
import traceback

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib import patheffects
from matplotlib.collections import LineCollection, TriMesh
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D
from matplotlib.tri import Triangulation

from ..colours import BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILLION, YELLOW
from .case import NotApplicable
from .files import CaseError, write_csv

FORMATS = ("png", "pdf", "svg")
# So that the same data leave the same bytes
UNDATED = {"png": {}, "pdf": {"CreationDate": None}, "svg": {"Date": None}}
# A side of a picture: matplotlib draws up to 65 536
MOST_DOTS = 30000
# For so many sieves a picture has room
MOST_SIEVES = 20
# What may lie beside one another under the name of a picture
SUFFIXES = (*FORMATS, "webp", "mp4", "json", "csv")

# Viridis, paled so that tracks stand out on all of it
PALE = 0.3
SPEED_MAP = ListedColormap(
    plt.get_cmap("viridis")(np.linspace(0, 1, 256)) * (1 - PALE) + PALE, "paleViridis"
)
POTENTIAL_MAP = ListedColormap(
    plt.get_cmap("RdBu_r")(np.linspace(0, 1, 256)) * (1 - PALE) + PALE, "paleRdBu"
)
SOLID = "0.82"

# Colour, width and dashes tell the fates apart, also in grey
FATE_LINES = {
    "escaped": {"color": "black", "linewidth": 0.3, "linestyle": "-"},
    "in flight": {"color": YELLOW, "linewidth": 1.0, "linestyle": (0, (1, 1))},
    "caught": {"color": VERMILLION, "linewidth": 1.2, "linestyle": "-"},
    "stalled": {"color": SKY, "linewidth": 1.2, "linestyle": (0, (4, 1.5))},
    "lost": {"color": PURPLE, "linewidth": 1.2, "linestyle": (0, (4, 1, 1, 1))},
}

# Where a cell is that has not left
LAST_POINT = {
    "marker": "o", "markersize": 3, "markeredgecolor": "black", "markeredgewidth": 0.5
}

# Colour and dashes of the components along x1, x2, x3
COMPONENTS = (
    {"color": VERMILLION, "linestyle": (0, (5, 1.5))},
    {"color": "black", "linestyle": "-"},
    {"color": SKY, "linestyle": (0, (1, 0.8)), "linewidth": 1.6},
)

# What an experiment showed, over what was computed
MEASURED = {
    "marker": "D", "markersize": 5, "markeredgecolor": "black", "markeredgewidth": 0.8
}

# Without what a matplotlibrc of the user or of the case says
plt.rcdefaults()
plt.rcParams.update({
    "savefig.dpi": 200,
    "pdf.fonttype": 42,        # letters stay letters, as journals ask for
    "svg.hashsalt": "ellipsoidTrapFoam",
    "savefig.bbox": "tight",   # nothing is cut off, whatever stands beside the axes
    "font.size": 9,
    "axes.titlesize": 9,
    "axes.linewidth": 0.7,
    "axes.formatter.offset_threshold": 3,     # labels of six digits would meet
    "axes.axisbelow": True,
    "xtick.major.width": 0.7,
    "ytick.major.width": 0.7,
    "legend.fontsize": 8,
    "legend.framealpha": 0.9,
    "lines.linewidth": 1.2,
    "grid.color": "0.88",
    "grid.linewidth": 0.5,
})


def with_room(ranks):
    """Of a rank of every sieve, the names of those that a picture shows, and words on the others."""
    highest = sorted(ranks, key=ranks.get, reverse=True)[:MOST_SIEVES]
    told = f"Of {len(ranks)} sieves, the {MOST_SIEVES} that held most." if len(ranks) > MOST_SIEVES else ""
    return [name for name in ranks if name in highest], told


def plan_axes(ax, xlim, ylim):
    """Axes in the plan of the device, in micrometres, what is solid in grey."""
    ax.set_aspect("equal")
    ax.set_xlim(xlim)
    ax.set_ylim(ylim)
    ax.set_facecolor(SOLID)
    ax.set_xlabel("x [µm]")
    ax.set_ylabel("y [µm]")


def plan_figure(xlim, ylim, beside=1.4, below=0.9):
    """Figure and axes for a plan, with inches to spare for a colour bar and a legend."""
    width, height = xlim[1] - xlim[0], ylim[1] - ylim[0]
    scale = min(5 / width, 7 / height)
    figure, ax = plt.subplots(
        figsize=(max(width * scale, 1) + beside, max(height * scale, 1) + below), layout="compressed"
    )
    plan_axes(ax, xlim, ylim)
    return figure, ax


def name_openings(ax, case):
    """The names of the patches by which the flow comes and goes, outside the plan."""
    (x0, x1), (y0, y1) = case.plane.bounds
    near = 1e-3 * max(x1 - x0, y1 - y0)
    for name, segments in case.plane.outlines.items():
        if case.patches[name] != "patch":
            continue
        x, y = segments.reshape(-1, 2).mean(axis=0)
        sides = ((x - x0, -1, 0), (x1 - x, 1, 0), (y - y0, 0, -1), (y1 - y, 0, 1))
        for distance, right, up in sides:
            if distance < near:
                ax.annotate(
                    name, (x, y), xytext=(8 * right, 8 * up), textcoords="offset points",
                    ha="center", va="center", rotation=90 * right, fontsize=8,
                )


def draw_speed(ax, plane, norm=None, cmap=SPEED_MAP):
    """The flow's speed in the limits of the axes, from 0 if no norm says otherwise; an image for
    a colour bar."""
    x, y, triangles, speed = plane.speed_in(ax.get_xlim(), ax.get_ylim())
    image = TriMesh(Triangulation(x, y, triangles), norm=norm, cmap=cmap, rasterized=True)
    image.set_array(speed)
    if norm is None:
        image.set_clim(0, speed.max())
    ax.grid(False)
    # tripcolor() would make a path of every triangle to find limits that the axes have
    return ax.add_collection(image, autolim=False)


def draw_outlines(ax, case, linewidth=0.6, sieve_color="black"):
    """The walls that the plane cuts."""
    for name, segments in case.plane.outlines.items():
        if case.patches[name] == "wall":
            color = sieve_color if name in case.sieves else "black"
            ax.add_collection(LineCollection(
                segments, colors=color, linewidths=linewidth, capstyle="round"
            ))


def legend_below(ax, keys, most=9):
    """A legend below the axis' label, in one row or of so many columns at most."""
    ax.legend(
        handles=keys, loc="upper center", bbox_to_anchor=(0.5, 0), borderaxespad=5,
        ncol=min(len(keys), most), columnspacing=1.2, handlelength=1.8,
    )


def framed(color, width):
    """A rim about a line or text that sets it off from what lies below."""
    return [patheffects.withStroke(linewidth=width, foreground=color)]


def fate_key(fate, number):
    """Legend entry of a fate."""
    line = dict(FATE_LINES[fate])
    line["linewidth"] = max(line["linewidth"], 0.8)
    if fate != "escaped":
        line.update(LAST_POINT, markerfacecolor=line["color"])
    return Line2D([], [], label=f"{fate} ({number})", **line)


def describe(figure, caption, data, table=()):
    """What goes beside the picture: a caption, the data drawn as (names of columns, rows), and
    a table with its headings first."""
    figure.data = data
    figure.note = {"caption": " ".join(caption.split()), "table": list(table)}


def print_table(table):
    """Rows of words in columns, the first to the left."""
    words = [[str(word) for word in row] for row in table]
    widths = [max(map(len, column)) for column in zip(*words)]
    for row in words:
        print("    " + "  ".join(
            [row[0].ljust(widths[0])] + [w.rjust(n) for w, n in zip(row[1:], widths[1:])]
        ).rstrip())


def save(figure, case, name, formats):
    """Write a picture and what describe() said of it to the case's pictures; the paths."""
    name = getattr(figure, "name", name)
    suffixes = getattr(figure, "suffixes", formats)
    *made, note, data = (case.target("pictures", f"{name}.{one}") for one in (*suffixes, "json", "csv"))
    file = case.path("pictures")
    try:
        os.makedirs(file, exist_ok=True)
        for file, suffix in zip(made, suffixes):
            # What is drawn as pixels within a page of lines is to stand print
            dots = resolution(figure, 200 if suffix == "png" else 400)
            figure.savefig(file, dpi=dots, metadata=UNDATED.get(suffix))
        file = note
        with open(file, "w", encoding="utf-8") as f:
            json.dump(figure.note, f, ensure_ascii=False, indent=1)
        file = data
        write_csv(file, *figure.data)
    except OSError as error:
        raise CaseError(f"{file}: {error.strerror or error}") from None
    finally:
        plt.close("all")
    return made


def resolution(figure, wanted):
    """Dots an inch: fewer of a page that would be larger than can be drawn."""
    if not isinstance(figure, plt.Figure):
        return wanted
    width, height = figure.get_size_inches()
    return min(wanted, MOST_DOTS / max(width, height))


def remove(case, name):
    """Take away a picture made before."""
    for suffix in SUFFIXES:
        file = case.target("pictures", f"{name}.{suffix}")
        if os.path.isfile(file):
            os.remove(file)


def read_formats(words):
    """Formats by name, with commas between; the report shows PNG, which is always among them."""
    formats = words.split(",")
    for one in formats:
        if one not in FORMATS:
            raise argparse.ArgumentTypeError(f"no format '{one}'; there are {','.join(FORMATS)}")
    return tuple(one for one in FORMATS if one in (*formats, "png"))


def add_format(parser):
    """The option that all commands have."""
    parser.add_argument(
        "--format", type=read_formats, metavar="LIST", default=("png",),
        help=f"of {','.join(FORMATS)}; png is always written [png]",
    )


def make(draw, name, case, formats=("png",), tables=True, **options):
    """Draw one picture of a case and say what came of it; whether it went well."""
    start = time.monotonic()
    try:
        figure = draw(case, **options)
        files = save(figure, case, name, formats)
    except NotApplicable as reason:
        print(f"{name}: left out: {reason}")
        return True
    except CaseError as error:
        print(f"{name}: {error}", file=sys.stderr)
        return False
    except Exception:
        print(f"{name}: failed by a fault of the program:", file=sys.stderr)
        traceback.print_exc()
        return False
    print(f"{name}: {' '.join(files)} ({time.monotonic() - start:.1f} s)")
    if tables and figure.note["table"]:
        print_table(figure.note["table"])
    return True


def command(picture, case, words):
    """Make one picture, a module, with the options given as words; whether it went well."""
    name = picture.__name__.rpartition(".")[2]
    parser = argparse.ArgumentParser(
        prog=f"makePictures CASE {name}", description=picture.__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    for option, settings in getattr(picture, "OPTIONS", {}).items():
        parser.add_argument("--" + option, **settings)
    add_format(parser)
    given = vars(parser.parse_args(words))
    return make(picture.draw, name, case, given.pop("format"), **given)

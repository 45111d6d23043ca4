# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Make the pictures of a case, in its folder pictures, and the report of them, report.html.

usage: makePictures CASE [--format LIST]          the report and all pictures but captureMap,
                                                  figure4 and probability
       makePictures [CASE] PICTURE... [OPTION...] these; --help tells the options of one
       makePictures CASE report                   the report of the pictures that are there

Without CASE, that of the present folder.

PICTURE is one of
    captureMap      where a cell must enter to be caught, by ellipsoidCaptureMap
    deflection      an electric potential, tracks of all cells
    figure1         cells held by every sieve against time
    figure2         orientation, velocity and spin of one cell
    figure3         the model drawn, and a cell at discrete times
    figure4         trapping performance of every sieve, of several designs
    figure5         the mesh, with close-ups of the apertures
    fluxShares      share of the flow of every sieve, where held cells block it
    movie           cells that tumble past a sieve, an animation
    nearWall        spin rate against the distance from the sieves
    probability     that a sieve catches a cell, and holds exactly one of N
    speedAndTracks  speed of the flow, tracks of all cells
    trappedCells    the cells at rest in the sieves

LIST is of png, pdf and svg, with commas between them; png is always written. Beside each
picture lies NAME.csv with the data drawn, and NAME.json with its caption and table. The
movie is a WebP, and an MP4 of 1080 lines or more where ffmpeg is installed.

A picture that cannot be made leaves the others; the exit status is then 1.
"""

import argparse
import importlib
import os
import sys
from concurrent.futures import ProcessPoolExecutor
from functools import lru_cache

from . import report
from . import style
from .case import Case
from .files import CaseError

# The longest first, so that none of them comes last alone
PICTURES = (
    "movie", "figure3", "speedAndTracks", "figure2", "trappedCells", "figure5", "nearWall",
    "figure1", "fluxShares", "deflection",
)
# What takes runs of its own
BY_ITSELF = ("figure4", "captureMap", "probability")
MOST_AT_ONCE = 4   # each reads the case for itself, mesh and tracks


@lru_cache(maxsize=1)
def case_of(folder):
    """The case as this process has read it."""
    return Case(folder)


def make(name, folder, formats):
    """One picture; whether it went well."""
    draw = importlib.import_module("." + name, __package__).draw
    return style.make(draw, name, case_of(folder), formats, tables=False)


def make_all(folder, formats):
    """All that every run leaves; whether they went well."""
    # What a picture of an earlier run showed must not get into the report
    for name in PICTURES:
        style.remove(case_of(folder), name)
    workers = min(len(os.sched_getaffinity(0)), MOST_AT_ONCE)
    with ProcessPoolExecutor(workers) as pool:
        many = len(PICTURES)
        well = list(pool.map(make, PICTURES, [folder] * many, [formats] * many))
    return all(well) & report.make(case_of(folder))


def main(words):
    """The command; whether it went well."""
    if not words or words[0].startswith("-"):
        sys.exit(__doc__.strip())
    names = (*PICTURES, *BY_ITSELF, "report")
    if words[0] in names and not os.path.isdir(words[0]):
        words = [".", *words]
    folder, *rest = words
    many = next((i for i, word in enumerate(rest) if word.startswith("-")), len(rest))
    pictures, options = rest[:many], rest[many:]
    for name in pictures:
        if name not in names:
            sys.exit(f"makePictures: no picture {name}; there are "
                     f"{' '.join(sorted((*PICTURES, *BY_ITSELF)))}")
    try:
        case = case_of(folder)
        if not pictures:
            parser = argparse.ArgumentParser(prog="makePictures CASE")
            style.add_format(parser)
            return make_all(folder, parser.parse_args(options).format)
    except CaseError as error:
        sys.exit(f"{pictures[0] if pictures else 'makePictures'}: {error}")
    return all([
        report.make(case) if name == "report"
        else style.command(importlib.import_module("." + name, __package__), case, options)
        for name in pictures
    ])


def command(words):
    """The command's exit status."""
    return 0 if main(words) else 1

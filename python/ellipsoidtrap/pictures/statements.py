# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""What the paper's supplement says, beside what a run of the circular trap gives: Markdown.

Verdicts. 'agrees': a number within a fifth of the paper's; what it says of cells in general holds for four fifths of
them; what it saw is more likely than not. 'near': a number within a factor of two; more than half of the cells, and by
more than chance; a probability of a twentieth at least; or what holds in part. 'differs': what is farther off.
'fitted': a dimension of the device was chosen by it.

Members are cases with other seeds: the probability of what the paper tells is then of all their cells.
With --into FILE the table is written into a file, between the lines '<!-- statements -->' and
'<!-- end of statements -->', and else to standard output. Figure 1 is of design C.
"""

import argparse
import itertools
import re
from math import exp, factorial, log, sqrt

import numpy as np

from . import account
from . import figure1
from .case import MILLI, Case, NotApplicable
from .files import CaseError, read_csv
from .nearWall import APART, CLOSE, moving_rows, unit
from .report import logged
from .shares import mcnemar, wilson

AGREES, NEAR, DIFFERS, CHOSEN = "agrees", "near", "differs", "fitted"
WORDS = ("the paper says", "we get", "verdict")
NAMED = ("S1", "S2", "S3", "S7")   # sieves that Figure 1's caption names
BEGIN, END = "<!-- statements -->\n", "<!-- end of statements -->"
SWIMMING = 0.01   # mm/s, the supplement's speed of a swimming cell
FIFTH, TWOFOLD, CHANCE = 0.2, 2.0, 0.05
HIGH = 0.8        # of the component of an axis


def verdict(agrees, near=False):
    """Of a statement that holds, or at least nearly or in part, or does not."""
    return AGREES if agrees else NEAR if near else DIFFERS


def of_number(ours, papers):
    """Of a number that the paper tells."""
    ratio = ours / papers
    return verdict(abs(ratio - 1) <= FIFTH, 1 / TWOFOLD <= ratio <= TWOFOLD)


def of_cells(holds):
    """Of what it says of cells in general: one truth a cell."""
    n = np.count_nonzero(holds)
    most = n > len(holds) / 2 and mcnemar(n, len(holds) - n) < CHANCE
    return verdict(n >= (1 - FIFTH) * len(holds) > 0, most)


def of_chance(probability):
    """Of what it saw, which here has a probability."""
    return verdict(probability > 0.5, probability >= CHANCE)


def of_best(best, usual):
    """Of what the best cell does, and perhaps the one in the middle, too."""
    return verdict(best and usual, best)


def middle(values, form="{:.0f}"):
    """A median with the first and the last tenth cut off, in words."""
    low, median, high = np.percentile(values, (10, 50, 90))
    return f"{form} ({form} to {form})".format(median, low, high)


# -- the model and the flow ------------------------------------------------------

def of_flow(case):
    """Speed, Reynolds' number, the flux that the load asks for."""
    speed = MILLI * float(logged(case, r"flow: mean inlet speed (\S+) m/s"))
    flux = float(logged(case, r"flow: inlet: (\S+) m3/s in"))
    length = 2 * case.semi_axes.max()
    number = len(case.fates)
    wanted = number / case.loading / 2e7 * 1e-6
    reynolds = [speed * one * 1e-3 for one in (length, case.depth[1] - case.depth[0])]
    return [
        ("cells come at about 4 mm/s", f"the flow enters at {speed:.2f} mm/s on average", CHOSEN),
        ("Reynolds' number is about 1e-2",
         f"{reynolds[0]:.2g} of a cell's length, {reynolds[1]:.2g} of the depth",
         of_number(reynolds[0], 1e-2)),
        (f"{number} cells in {case.loading:g} s, of 2e7 per ml: {wanted:.3g} m³/s",
         f"{flux:.3g} m³/s", CHOSEN if abs(flux / wanted - 1) < 0.05 else of_number(flux, wanted)),
    ]


def of_model(case):
    """What the model of the paper neglects or claims."""
    cells = read_csv(case.path(case.results, "cells.csv"), [("id", int), ("deepestCell", float), ("deepest", float)])
    free = np.array([case.fates[int(one)].name == "escaped" for one in cells["id"]])
    met = (cells["deepestCell"] > 0)[free]
    steps, rejected = map(int, logged(case, r"tracking: \S+ s, (\d+) steps, (\d+) rejected"))
    radius = logged(case, r"deepest overlap of a bead with a wall: \S+ nm, (\S+) % of its radius")
    lost = case.count("lost")
    starts = [case.tracks[cell].x[0, 0] for cell, fate in case.fates.items()
              if fate.name == "caught" and fate.patch == "S2"]
    times = [fate.t - case.tracks[cell].t[0] for cell, fate in case.fates.items() if fate.name == "escaped"]
    swum = SWIMMING * MILLI * np.median(times)
    strip = f"those that S2 caught entered within {np.ptp(starts):.2f} µm" if len(starts) > 1 else \
        "S2 caught too few to tell from how wide a strip"
    e = sqrt(1 - 1 / np.square(case.semi_axes.max() / case.semi_axes.min()))
    L = log((1 + e) / (1 - e))
    # Kim & Karrila, Table 3.4
    ratio = 2 * ((1 + e * e) * L - 2 * e) / (2 * e + (3 * e * e - 1) * L)
    return [
        ("moving cells do not meet: the suspension is dilute",
         f"{np.count_nonzero(met)} of {len(met)} cells that pass touch another one",
         verdict(np.mean(met) < 0.01, np.mean(met) < 0.05)),
        ("walls keep cells from penetrating",
         f"a bead overlaps a wall by at most {float(radius):.2g} % of its radius, {lost} cells lost",
         verdict(lost == 0 and float(radius) < 1, lost == 0 and float(radius) < 5)),
        ("Rosenbrock's method does not diverge",
         f"{steps} steps, {rejected} more tried in vain; " * bool(steps) + f"{lost} cells lost", verdict(lost == 0)),
        ("swimming at 10 µm/s is negligible beside the flow",
         f"for the way through, of which it is {swum:.2g} µm, but not for which cells are caught: {strip}",
         verdict(len(starts) > 1 and swum < np.ptp(starts) / 10, True)),
        ("a cell across the flow has the higher resistance",
         f"{ratio:.2f} times that along its axis (Stokes)", verdict(ratio > 1)),
    ]


# -- tumbling ---------------------------------------------------------------------

def of_tumbling(case):
    """Spin at walls and flips after a sieve's edge."""
    rows = moving_rows(case)
    close, apart = CLOSE * unit(case), APART * unit(case)
    spin = [np.median(rows.spin[rows.passing & rows.middle & there])
            for there in (rows.distance < close, rows.distance > apart)]
    passed, turns = 0, []
    for cell, sieve in itertools.product(case.tracks, case.sieves):
        near = account.detour(case, cell, sieve)
        if near:
            passed += near[2] < account.NEAR
            turns.append(account.of_cell(case, cell, sieve, near))
    turns = [one for one in turns if one and one.gap < account.NEAR]
    upper = np.array([case.tracks[one.cell].at([one.flip]).x[0, 2] > sum(case.depth) / 2 for one in turns])
    positive = np.array([one.sense > 0 for one in turns])
    exits = []
    for track in case.tracks.values():
        out = np.flatnonzero(track.x[:, 1] > case.chamber[1])
        exits += [abs(track.axis[out[0], 1])] if len(out) else []
    return [
        ("cells near an obstacle's wall rotate fast",
         f"within {close:g} µm {spin[0]:.0f} rad/s, farther than {apart:g} µm {spin[1]:.0f} (medians of those that pass "
         "in the middle third of the depth)", verdict(spin[0] > TWOFOLD * spin[1], spin[0] > (1 + FIFTH) * spin[1])),
        ("cells flip soon after a sieve's edge",
         f"{len(turns)} of {passed} that pass within {account.NEAR:g} µm, within {MILLI * account.AFTER:g} ms",
         of_cells(np.arange(passed) < len(turns))),
        ("and about +x1",
         f"{positive.mean():.0%} of the flips; {positive[upper].mean():.0%} in the upper half of the depth, "
         f"{positive[~upper].mean():.0%} in the lower: floor and ceiling shear in opposite senses", of_cells(positive)),
        ("high abs(O_x2) again as a cell leaves the chamber",
         f"{middle(exits, '{:.2f}')}, median and tenths; above {HIGH:g} {np.mean(np.array(exits) > HIGH):.0%}",
         of_cells(np.array(exits) > HIGH)),
    ] + of_figure2(case)


def of_figure2(case):
    """The one cell of Figure 2."""
    try:
        told = account.all_of(case)
    except NotApplicable as reason:
        return [("a cell flips after it has detoured S8 (Figure 2)", str(reason), DIFFERS)]
    best, usual = told[0], told[len(told) // 2]
    good = sum(one.score > 0.8 for one in told)
    late = np.mean([one.time > 50 for one in told])
    return [
        ("a cell detours S8, then flips, after t = 50 ms (Figure 2)",
         f"cell {best.cell} at {best.time:.0f} ms, the best of {len(told)}: fit {best.score:.2f}, "
         f"{good} above 0.8; the one in the middle at {usual.time:.0f} ms, {usual.score:.2f}; {late:.0%} flip after 50 ms",
         of_best(best.time > 50, usual.time > 50)),
        ("at 55 ms u_x2 rises", f"by {best.rise:+.2f} mm/s about the flip; {usual.rise:+.2f} for the one in the middle",
         of_best(best.rise > 0, usual.rise > 0)),
        ("at 56 ms abs(O_x1), abs(O_x3) near 1",
         f"the higher is {best.across:.2f} within 1 ms of the flip; {usual.across:.2f} for the one in the middle",
         of_best(best.across > 0.9, usual.across > 0.9)),
    ]


# -- Figure 1 ----------------------------------------------------------------------

def caught_shares(cases):
    """Sieve to the probability that a cell is caught by it: half a cell more than there were, as
    none is known to be zero (Jeffreys)."""
    injected = sum(len(one.fates) for one in cases)
    return {name: (sum(one.count("caught", name) for one in cases) + 0.5) / injected for name in cases[0].sieves}


def poisson(n, mean):
    """Probability of so many."""
    return exp(-mean) * mean**n / factorial(n)


def at_least(n, mean):
    """Probability of so many or more."""
    return 1 - sum(poisson(k, mean) for k in range(n))


def as_likely(counts, means):
    """Probability of numbers as unlikely as these, or more, all of them independent and Poisson: the
    exact test of goodness of fit."""
    likely = [np.array([poisson(k, mean) for k in range(30)]) for mean in means]
    seen = np.prod([one[n] for one, n in zip(likely, counts)])
    # The sieves one by one; what is too unlikely to matter is left out as it comes
    together = np.ones(1)
    for one in likely:
        together = np.outer(together, one).ravel()
        together = together[together > 1e-12]
    return 1 - together[together > seen * (1 + 1e-9)].sum()


def in_sieves(numbers):
    """Numbers of sieves in words."""
    return ", ".join(f"{name} {n}" for name, n in numbers.items() if n) or "none"


def of_figure1(case, members):
    """Who is caught when."""
    held = figure1.holdings(case)
    thirds = [case.loading * k / 3 for k in (1, 2, 3)]
    at = [{name: figure1.number_at(one, t) for name, one in held.items()} for t in thirds]
    cases = members or [case]
    shares = caught_shares(cases)
    load = sum(len(one.fates) for one in cases) / len(cases)
    means = [{name: share * load * k / 3 for name, share in shares.items()} for k in (1, 2, 3)]
    count = len(case.fates) / 3
    entered = int(np.count_nonzero((case.events["event"] == "injected") & (case.events["t"] <= thirds[0])))
    paper = [int(name in NAMED) for name in case.sieves]
    fit = as_likely(paper, list(means[0].values()))
    just = np.prod([poisson(n, mean) for n, mean in zip(paper, means[0].values())])
    in_all = load / 3 * sum(one.count("caught", name) for one in cases for name in shares) / sum(
        len(one.fates) for one in cases)
    others = [name for name in case.sieves if name not in NAMED]
    s1, s2 = (at_least(2, means[k][name]) for k, name in ((1, "S1"), (2, "S2")))
    few = sum(poisson(n, means[2]["S1"]) for n in (1, 2, 3))
    mean10 = ", ".join(f"{name} {means[0][name]:.2g}" for name in NAMED)
    total = sum(case.count("caught", name) for name in case.sieves)
    low, high = (100 * bound for bound in wilson(sum(at[0].values()), entered, dispersion=case.dispersion))
    said = f"probability {{:.2f}} by {len(cases) * round(load)} cells"
    return [
        (f"{count:.0f} cells have come in {thirds[0]:.3g} s", str(entered),
         verdict(abs(entered - count) < 2 * sqrt(2 / 3 * count), of_number(entered, count) == AGREES)),
        (f"within {thirds[0]:.3g} s single cells at S1, S2, S3 and S7", in_sieves(at[0]) + f"; expected {mean10}; numbers as "
         "unlikely as the paper's: " + said.format(fit) + f", a test of little power; these alone: {just:.1%}, of 1.8% at most",
         verdict(False, fit >= CHANCE)),
        ("it names no other sieve", f"{sum(at[2][name] for name in others)} of {total} in the others at {thirds[2]:.3g} s",
         verdict(sum(at[2][name] for name in others) == 0)),
        ("in all 4 of 333, 1.2 %", f"{sum(at[0].values())} of {entered} ({low:.1f} to {high:.1f} %); expected {in_all:.2g}",
         of_number(in_all, 4)),
        (f"several at S1 in {thirds[1]:.3g} s", f"{at[1]['S1']}; two or more: " + said.format(s1), of_chance(s1)),
        (f"several at S2 in {thirds[2]:.3g} s", f"{at[2]['S2']}; two or more: " + said.format(s2), of_chance(s2)),
        (f"1 to 3 at S1 in {thirds[2]:.3g} s", f"{at[2]['S1']}; 1 to 3: " + said.format(few), of_chance(few)),
    ]


def table(case, members):
    """The table in Markdown."""
    rows = [WORDS, ["---"] * len(WORDS)]
    rows += of_flow(case) + of_model(case) + of_tumbling(case)
    if case.design.endswith("C"):
        rows += of_figure1(case, members)
    return "".join("| " + " | ".join(row) + " |\n" for row in rows)


def marked(file):
    """The text of a file with the marks."""
    with open(file, encoding="utf-8") as source:
        text = source.read()
    if text.count(BEGIN) != 1 or text.count(END) != 1:
        raise CaseError(f"{file}: not one '{BEGIN.strip()}' and one '{END}'")
    return text


def put_into(file, old, text):
    """In place of what stands between the marks."""
    new = re.sub(f"({BEGIN}).*({END})", lambda found: found[1] + text + found[2], old, flags=re.S)
    with open(file, "w", encoding="utf-8") as target:
        target.write(new)


def command(words):
    """The command."""
    parser = argparse.ArgumentParser(prog="statements", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("case")
    parser.add_argument("--members", nargs="+", default=(), metavar="CASE")
    parser.add_argument("--into", metavar="FILE")
    given = parser.parse_args(words)
    case = Case(given.case)
    if not (case.chamber and set(NAMED) <= set(case.sieves)):
        raise CaseError(f"{given.case}: the supplement is of a circular trap with the sieves S1 to S8")
    page = marked(given.into) if given.into else ""
    text = table(case, [Case(one) for one in given.members])
    if given.into:
        put_into(given.into, page, text)
    else:
        print(text, end="")

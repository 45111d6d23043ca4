# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Shares of trials, with intervals, and what follows from them."""

from math import comb
from statistics import NormalDist

import numpy as np

# Cells that push one another need not be caught independently. The variance of the number caught
# between runs of different seeds, by that of independent cells, where a case does not tell its own
# (constant/modelBand): chi2 of eight runs of the design narrowC, with 14 cells caught of 200 on the
# mean, over its degrees of freedom, 14.9/7 (docs/uncertainty.md)
PUSHING_DISPERSION = 14.9 / 7


def quantile(confidence):
    """Two-sided quantile of the normal distribution."""
    return NormalDist().inv_cdf(0.5 + confidence / 2)


def wilson(successes, trials, confidence=0.95, dispersion=1.0):
    """(low, high) of a share, Wilson's score interval (Wilson 1927).

    dispersion: variance of the successes by that of independent trials; so many trials tell
    as much as one that is independent.
    """
    if trials == 0:
        return 0.0, 1.0
    z = quantile(confidence)
    z2 = z**2
    share = successes / trials
    trials = trials / dispersion
    middle = (share + z2 / (2 * trials)) / (1 + z2 / trials)
    half = z / (1 + z2 / trials) * np.sqrt(
        share * (1 - share) / trials + z2 / (4 * trials**2)
    )
    # At the ends rounding must not leave [0, 1], nor the share
    return max(0.0, min(share, middle - half)), min(1.0, max(share, middle + half))


def dispersion_of(counts, trials):
    """Variance of counts between runs by that of independent trials, 1 at least: chi2 of
    their being alike over its degrees of freedom (McCullagh & Nelder 1989, section 4.5)."""
    counts, trials = np.asarray(counts, float), np.asarray(trials, float)
    share = counts.sum() / trials.sum() if trials.sum() else 0
    if len(counts) < 2 or not 0 < share < 1:
        return 1.0
    chi2 = np.sum((counts - trials * share) ** 2 / (trials * share * (1 - share)))
    return max(1.0, float(chi2 / (len(counts) - 1)))


def mcnemar(only_first, only_second):
    """p of paired yes-or-no outcomes, two-sided: how likely it is that so many pairs that
    differ do so as unevenly by chance (McNemar 1947, exact by the binomial)."""
    pairs = only_first + only_second
    tail = sum(comb(pairs, k) for k in range(min(only_first, only_second) + 1))
    return min(1.0, 2 * tail / 2**pairs)


def in_words(held, trials, confidence=0.95, dispersion=1.0):
    """A share with its interval."""
    low, high = wilson(held, trials, confidence, dispersion)
    share = f"{held / trials:.1%}" if trials else "-"
    return f"{held}/{trials} = {share} ({100 * low:.1f}-{100 * high:.1f})"


def trials_for(share, half_width, confidence=0.95):
    """Fewest trials with which Wilson's interval about a share is that narrow."""
    def wide(trials):
        low, high = wilson(share * trials, trials, confidence)
        return high - low > 2 * half_width

    # It narrows with every trial: doubled until narrow enough, then bisected
    most = 1
    while wide(most):
        most *= 2
    fewest = most // 2
    while most - fewest > 1:
        middle = (fewest + most) // 2
        fewest, most = (middle, most) if wide(middle) else (fewest, middle)
    return most


def exactly_one(p, n):
    """Probability of one success in n independent trials of probability p."""
    return n * p * (1 - p) ** (n - 1)


def exactly_one_within(low, high, n):
    """(least, most) of exactly_one() for p from low to high; it has its only maximum at 1/n."""
    ends = [exactly_one(low, n), exactly_one(high, n)]
    most = exactly_one(min(max(1 / n, low), high), n)
    return min(ends), most

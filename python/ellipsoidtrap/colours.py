# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""Okabe and Ito's colours, which the colour-blind can tell apart."""

ORANGE, SKY, YELLOW, GREEN = "#E69F00", "#56B4E9", "#F0E442", "#009E73"
BLUE, VERMILLION, PURPLE = "#0072B2", "#D55E00", "#CC79A7"

# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam.
#
# ellipsoidTrapFoam is free software: you can redistribute it and/or modify it
# under the terms of the GNU General Public License as published by the Free
# Software Foundation, either version 3 of the License, or (at your option) any
# later version. It comes with ABSOLUTELY NO WARRANTY; see the file COPYING.
"""Parameter files of the makeGeometry scripts: OpenFOAM's dictionaries of words, numbers and
nested lists, with checked look-up. What is wrong ends the script with one line."""

import math
import re
import sys
from itertools import zip_longest

from . import foamDictionary
from .foamDictionary import spelled


def chosen(arguments, usage, names):
    """Options '-name VALUE' of a command line; None where not given."""
    options = dict.fromkeys(names)
    for option, value in zip_longest(arguments[::2], arguments[1::2]):
        if option not in options or value is None:
            sys.exit(f"{usage}makeGeometry: {option}: allowed: -quick, -fine, {' NAME, '.join(names)} NAME")
    options.update(zip(arguments[::2], arguments[1::2]))
    return options


def read(file):
    """The entries of a parameter file. What it says by #eval and the like OpenFOAM works out."""
    twice, entries = [], None
    try:
        text = foamDictionary.text_of(file)
        try:
            entries = foamDictionary.parse(text, twice)
        except ValueError:
            if "#" not in text:
                raise
        if "#" in text:
            entries = foamDictionary.parse(foamDictionary.expanded(file))
    except ValueError as error:
        fail(file, error)
    if twice:
        fail(file, f"'{twice[0]}' is given twice")
    _check(entries, file)
    return Entries(entries, "", file, set(re.findall(r"\$\{?[:.]*(\w+)", text)))


def fail(file, message):
    """End the script."""
    sys.exit(f"makeGeometry: {file}: {message}")


def _check(entries, file):
    """Refuse brackets that are not of lists."""
    for key, value in entries.items():
        if isinstance(value, dict):
            _check(value, file)
        elif set("{}") & set(spelled(value)) or isinstance(value, str) and set("()") & set(value):
            fail(file, f"cannot read entry '{key}'")


def shown(value):
    """A value as it stands in the file, a long one cut."""
    text = spelled(value)
    return text if len(text) < 60 else text[:56] + " ..."


class Entries:
    """A (sub-)dictionary with checked look-up; names in variables are used by other entries of the file."""

    def __init__(self, entries, name, file, variables):
        self.entries, self.name, self.file, self.variables = entries, name, file, variables
        self.sketch = None      # draws what a message is about, with places marked; returns where that is

    def __contains__(self, key):
        return key in self.entries

    def fail(self, message, places=()):
        """End the script with what is wrong in this file, and where in the plan."""
        fail(self.file, message + (self.sketch(list(places)) if self.sketch else ""))

    def _within(self, value, key):
        entries = Entries(value, f"{self.name}{key}.", self.file, self.variables)
        entries.sketch = self.sketch
        return entries

    def get(self, key):
        """The value of an entry that must be there."""
        if key not in self.entries:
            self.fail(f"entry '{self.name}{key}' is missing")
        return self.entries[key]

    def sub(self, key):
        """A sub-dictionary that must be there."""
        value = self.get(key)
        if not isinstance(value, dict):
            have = [k for k, v in self.entries.items() if isinstance(v, dict)]
            self.fail(f"'{self.name}{key}' is no dictionary (there are: {' '.join(have)})")
        return self._within(value, key)

    def sub_if(self, key):
        """A sub-dictionary that may be left out."""
        return self.sub(key) if key in self else self._within({}, key)

    def choose(self, key):
        """The sub-dictionary that an option names."""
        if key not in self.entries:
            self.fail(f"no '{key}' among {self.name[:-1]}: {' '.join(self.entries)}")
        return self.sub(key)

    def only(self, *known):
        """Refuse entries that nobody reads."""
        for key in self.entries:
            if key not in known and key not in self.variables:
                self.fail(f"unknown entry '{self.name}{key}'; there are: {' '.join(known)}")

    def path(self, key):
        """The name of a file, with or without quotes; foamDictionary puts blanks about a slash."""
        value = self.get(key)
        if not isinstance(value, str):
            self.fail(f"'{self.name}{key}' must be the name of a file: {shown(value)}")
        return value.strip('"').replace(" / ", "/")

    def number(self, key, low=0.0, strict=True):
        """A number above low, or not below it."""
        value = self.get(key)
        try:
            number = float(value)
        except (TypeError, ValueError):
            self.fail(f"'{self.name}{key}' is no number: {value}")
        if not (math.isfinite(number) and (number > low or (not strict and number == low))):
            self.fail(f"'{self.name}{key}' must be {'above' if strict else 'at least'} {low:g}: {value}")
        return number

    def integer(self, key, low=1):
        """A whole number not below low."""
        number = self.number(key, low, strict=False)
        if number != int(number):
            self.fail(f"'{self.name}{key}' must be whole: {number:g}")
        return int(number)

    def point(self, key):
        """A point (x y)."""
        return self.numbers(self.get(key), 2, key, "a point (x y)")

    def items(self, key):
        """A list, with what each of its members is called in messages."""
        value = self.get(key)
        if not isinstance(value, list) or not value:
            self.fail(f"'{self.name}{key}' must be a list ( ... ) that is not empty: {shown(value)}")
        return [(item, f"{key}[{i}]") for i, item in enumerate(value)]

    def points(self, value, key, fewest):
        """So many points (x y) or more."""
        if not isinstance(value, list) or len(value) < fewest:
            self.fail(f"'{self.name}{key}' must be a list of at least {fewest} points (x y): {shown(value)}")
        return [self.numbers(one, 2, f"{key}[{i}]", "a point (x y)") for i, one in enumerate(value)]

    def corners(self):
        """The corners min and max of a box."""
        self.only("min", "max")
        low, high = self.point("min"), self.point("max")
        if not (low[0] < high[0] and low[1] < high[1]):
            self.fail(f"'{self.name}min' ({low[0]:g} {low[1]:g}) must lie below and left of max "
                      f"({high[0]:g} {high[1]:g})")
        return low, high

    def numbers(self, value, count, key, what):
        """So many finite numbers in brackets."""
        try:
            found = tuple(float(word) for word in value)
        except (TypeError, ValueError):
            found = ()
        if len(found) != count or isinstance(value, str) or not all(map(math.isfinite, found)):
            self.fail(f"'{self.name}{key}' must be {what}: {shown(value)}")
        return found

# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""The options of a cell, as the core lists them (src/ellipsoid/options.def): Python repeats none."""

import difflib
from collections import namedtuple
from ctypes import Structure, byref, c_char_p, c_double, c_int

from .library import core, vector

REAL, VECTOR, WHOLE, SWITCH, CHOICE = range(5)
TYPES = {REAL: c_double, VECTOR: vector, WHOLE: c_int, SWITCH: c_int, CHOICE: c_int}

OptionInfo = namedtuple("OptionInfo", "default range unit meaning")


def listed():
    """The core's list."""
    count = c_int()
    first = core.ellipsoid_option_list(byref(count))
    return [first[n] for n in range(count.value)]


LIST = {option.member.decode(): option for option in listed()}


class Options(Structure):
    """ellipsoid_options: its members in the order of the list."""
    _fields_ = [(name, TYPES[option.type]) for name, option in LIST.items()]


core.ellipsoid_options_default.restype = Options


def words(option):
    """Of one that is one of several."""
    found = []
    while option.words[len(found)]:
        found.append(option.words[len(found)].decode())
    return found


def value(option, member):
    """A member of the struct as Python has it."""
    if option.type == CHOICE:
        return words(option)[member]
    if option.type == SWITCH:
        return bool(member)
    return tuple(member) if option.type == VECTOR else member


def options():
    """Name to default, range, unit and meaning, of all options."""
    defaults = core.ellipsoid_options_default()
    return {name: OptionInfo(value(option, getattr(defaults, name)), option.range.decode(), option.unit.decode(),
                             option.meaning.decode())
            for name, option in LIST.items()}


def wrong(name, given):
    """The one text of what is not allowed."""
    return ValueError(f"{name} = {given!r}: allowed is {LIST[name].range.decode()}")


def converted(name, given):
    """What the struct takes."""
    option = LIST[name]
    try:
        if option.type == CHOICE:
            return words(option).index(given)
        if option.type == VECTOR:
            first, second, third = given
            return vector(first, second, third)
        number = TYPES[option.type](given).value
    except (TypeError, ValueError):
        raise wrong(name, given) from None
    if number != given:     # of a whole number that C would cut off
        raise wrong(name, given)
    return number


def make(given):
    """The struct with what is given by name, checked; other options have their defaults."""
    made = core.ellipsoid_options_default()
    for name, what in given.items():
        if name not in LIST:
            near = difflib.get_close_matches(name, LIST, 1)
            raise TypeError(f"no option {name}" + (f"; {near[0]}?" if near else "; ellipsoidtrap.core.options() has all"))
        setattr(made, name, converted(name, what))
    field, allowed = c_char_p(), c_char_p()
    if core.ellipsoid_options_check(byref(made), byref(field), byref(allowed)) != 0:
        name = field.value.decode()
        raise ValueError(f"{name} = {value(LIST[name], getattr(made, name))!r}: allowed is {allowed.value.decode()}")
    return made


for _name, _option in LIST.items():
    if getattr(Options, _name).offset != _option.offset:
        raise ImportError(f"{_name} is not where the core has it")

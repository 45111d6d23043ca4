# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""OpenFOAM's dictionaries as nested dicts, for the scripts that make geometries and pictures."""

import re


def without_comments(text):
    """Text of an OpenFOAM file without its comments."""
    return re.sub(r"/\*.*?\*/|//[^\n]*", " ", text, flags=re.S)


def parse(text):
    """The entries of a dictionary without comments and directives; lists as nested lists of words,
    other values as strings. What cannot be read is a ValueError."""
    entries, at = _entries(re.findall(r'"[^"]*"|[{}();]|[^\s{}();"]+', text), 0, nested=False)
    return entries


def spelled(value):
    """A value as it stands in a file."""
    return value if isinstance(value, str) else "(" + " ".join(map(spelled, value)) + ")"


def _entries(tokens, at, nested):
    """The entries from a token on, and the token behind them."""
    entries = {}
    while at < len(tokens) and tokens[at] != "}":
        key = tokens[at]
        if tokens[at + 1:at + 2] == ["{"]:
            entries[key], at = _entries(tokens, at + 2, nested=True)
        else:
            end = _end(tokens, at + 1, key)
            entries[key] = _value(tokens[at + 1:end], key)
            at = end + 1
    if nested != (at < len(tokens)):
        raise ValueError("'{' and '}' do not match")
    return entries, at + 1


def _end(tokens, at, key):
    """Where the ';' of an entry is."""
    depth = 0
    for end in range(at, len(tokens)):
        if tokens[end] == ";" and depth == 0:
            return end
        depth += (tokens[end] in "({") - (tokens[end] in ")}")
        if depth < 0:
            break
    raise ValueError(f"entry '{key}' has no ';'")


def _value(words, key):
    """Nested lists if the words are in brackets, else one string."""
    if words[:1] != ["("] or words[-1] != ")":
        return " ".join(words)
    stack = [[]]
    for word in words:
        if word == "(":
            stack.append([])
        elif word == ")":
            inner = stack.pop()
            if not stack:
                raise ValueError(f"cannot read entry '{key}'")
            stack[-1].append(inner)
        else:
            stack[-1].append(word)
    if len(stack) > 1 or len(stack[0]) > 1:
        raise ValueError(f"cannot read entry '{key}'")
    return stack[0][0]

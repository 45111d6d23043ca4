# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""OpenFOAM's dictionaries as nested dicts, for the scripts that make geometries and pictures.

#include and $ are resolved. No code is run, as a case may be another's: what #calc, #codeStream and
the like would give stays as it is written. Only expanded(), for a user's own geometry, has OpenFOAM do so.
"""

import os
import re
import subprocess

# A word, not a number, may have brackets in it that are closed
WORD = r"""(?![\d.+-])[^\s{}();"]+(?:\([^\s{}();"]*\)[^\s{}();"]*)*|[^\s{}();"]+"""
TOKENS = re.compile(r'"[^"]*"|#\{.*?#\}|[{}();]|\[[^\]]*\]|\$\{[^}]*\}|' + WORD, re.S)
HEADER = re.compile(r"\bFoamFile\s*\{[^}]*\}")
# Directives without which a dictionary has the same entries of our programs
PASSED_OVER = ("#includeFunc", "#includeEtc", "#inputMode", "#message")
FOLDERS = {
    "<case>": "", "$FOAM_CASE": "", "${FOAM_CASE}": "", "<constant>": "constant", "<system>": "system",
}


def text_of(file, above=()):
    """Text of a file without header and comments, what it includes put in. A ValueError says what
    is wrong."""
    if os.path.realpath(file) in above:
        raise ValueError(f"{file} includes itself")
    try:
        with open(file, encoding="utf-8-sig", errors="replace") as source:
            text = HEADER.sub(" ", without_comments(source.read()))
    except OSError as error:
        raise ValueError(f"cannot read {file}: {error.strerror}") from None

    def included(match):
        optional, name = match[1] or match[2], match[3]
        for tag, folder in FOLDERS.items():
            if name.startswith(tag):
                name = os.path.join(_case_of(file), folder, name[len(tag):].lstrip("/"))
        name = os.path.join(os.path.dirname(file), name)
        if optional and not os.path.exists(name):
            return ""
        return text_of(name, (*above, os.path.realpath(file)))

    return re.sub(r'#(s)?include(IfPresent)?\s+"([^"]*)"', included, text)


def read(file):
    """The entries of a file, as of parse(). A ValueError says what is wrong."""
    return parse(text_of(file))


def without_comments(text):
    """Text of an OpenFOAM file without its comments."""
    return re.sub(r'("[^"]*")|/\*.*?\*/|//[^\n]*', lambda found: found[1] or " ", text, flags=re.S)


def parse(text, twice=None):
    """The entries of a dictionary without comments and #include; lists as nested lists of words,
    other values as strings. What cannot be read is a ValueError. Names that stand twice in one
    dictionary are added to a list, if one is given."""
    entries = {}
    _entries(TOKENS.findall(text), 0, [entries], "", [] if twice is None else twice)
    return entries


def expanded(file):
    """Text of a file as OpenFOAM's own foamDictionary expands it, #eval and #calc among it: code that a
    case has is run, if OpenFOAM is set to do so. A ValueError says what is wrong."""
    command = ["foamDictionary", "-expand", "-precision", "15", file]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError:
        raise ValueError("has #, which OpenFOAM's foamDictionary resolves: it must be on the PATH") from None
    if done.returncode:
        said = [line.strip() for line in done.stderr.splitlines() if line.strip() and "FOAM FATAL" not in line]
        raise ValueError(" ".join(said[:2]))
    return HEADER.sub(" ", without_comments(done.stdout))


def spelled(value):
    """A value as it stands in a file."""
    return value if isinstance(value, str) else "(" + " ".join(map(spelled, value)) + ")"


def _case_of(file):
    """The case that a file belongs to: the folder that has a system, or the file's own."""
    folder = os.path.dirname(os.path.abspath(file))
    while not os.path.isdir(os.path.join(folder, "system")):
        if folder == os.path.dirname(folder):
            return os.path.dirname(os.path.abspath(file))
        folder = os.path.dirname(folder)
    return folder


def _entries(tokens, at, scopes, name, twice):
    """Read entries of a dictionary from a token on into the last of the scopes; the token behind them."""
    entries, seen = scopes[-1], set()
    while at < len(tokens) and tokens[at] != "}":
        key = tokens[at]
        if key in seen and key[0] not in "#$":
            twice.append(name + key)
        seen.add(key)
        following = tokens[at + 1:at + 2]
        if key in PASSED_OVER:
            at += 2
        elif key.startswith("#"):
            raise ValueError(f"'{key}' is not resolved here: write what it stands for")
        elif key.startswith("$") and following == [";"]:
            _merge(entries, _found(key, scopes) or {})
            at += 2
        elif following == ["{"]:
            before = entries.get(key)
            # A dictionary that is there already is added to
            entries[key] = before if isinstance(before, dict) else {}
            at = _entries(tokens, at + 2, [*scopes, entries[key]], f"{name}{key}.", twice)
        else:
            end = _end(tokens, at + 1, key)
            words = [part for word in tokens[at + 1:end] for part in _resolved(word, scopes)]
            entries[key] = _value(words, key)
            at = end + 1
    if (len(scopes) > 1) != (at < len(tokens)):
        raise ValueError("'{' and '}' do not match")
    return at + 1


def _merge(entries, others):
    """Add the entries of another dictionary."""
    for key, value in others.items():
        if isinstance(value, dict):
            before = entries.get(key)
            entries[key] = before if isinstance(before, dict) else {}
            _merge(entries[key], value)
        else:
            entries[key] = value


def _found(word, scopes):
    """What a macro stands for, by OpenFOAM's rules of scopes; None if it is not there."""
    name = word.lstrip("$").strip("{}")
    chain = scopes[:1] if name.startswith(":") else scopes
    up = len(name) - len(name.lstrip("."))
    if up:
        chain = scopes[:len(scopes) + 1 - up][-1:]
    for value in reversed(chain):
        for part in name.strip(":.").split("."):
            value = value.get(part) if isinstance(value, dict) else None
        if value is not None:
            return value
    return None


def _resolved(word, scopes):
    """The words that a word of a value stands for."""
    value = _found(word, scopes) if word.startswith("$") else None
    return [word] if value is None or isinstance(value, dict) else TOKENS.findall(spelled(value))


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
    # Dimensions, the type of a list and its size are OpenFOAM's
    if re.fullmatch(r"\[[^\]]*\]", words[0] if words[1:] else ""):
        words = words[1:]
    at = words.index("(") if "(" in words[:3] else 0
    if re.fullmatch(r"(List<\w+> ?)?(\d+ ?)?", " ".join(words[:at])):
        words = words[at:]
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

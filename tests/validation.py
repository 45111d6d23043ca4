#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""The validation table, from the rows that tests add to the file ELLIPSOID_TEST_ROWS.

Usage: tests/validation.py [--full] [--write] [ROWS]

ROWS is a folder with a file a test, of the test's name. The rows of those tests must be those of docs/validation.csv:
those of every day, with --full all; what differs is shown, with exit status 1. --write writes docs/validation.csv anew,
and from it the table in docs/validation.md, the line in README.md and the pictures. Without ROWS the last three must be
what docs/validation.csv says.
"""

import csv
import re
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parent.parent
TABLE, PAGE, README = TOP/"docs/validation.csv", TOP/"docs/validation.md", TOP/"README.md"
PICTURES = "gallery/validation"

GROUPS = ("resistance", "free motion", "integration", "Brownian motion", "contact", "walls", "flow between mesh points",
          "flow solver", "occupied flow", "tracking on meshes", "devices", "parallel and restart")
KINDS = {"A": "exact", "P": "published computation", "E": "experiment, or a fit to experiments",
         "S": "another code, run side by side", "I": "the program itself, run otherwise"}
COLUMNS = ("group", "quantity", "conditions", "source", "kind", "why", "value", "reference", "bound", "often",
           "disagrees", "test", "errorOverBound")
KEY = ("group", "quantity", "conditions", "test")
# What is not measured: it must be that of the committed table
SAID = ("group", "quantity", "conditions", "source", "kind", "why", "bound", "often", "disagrees", "test")
# A value that moved by less of its bound keeps its digits, so that noise changes no file
NOISE = 0.1


def place(test):
    """The file of a test, from the top folder: a script, or the source of a program of the core."""
    found = [f for name in (test, test + ".c") for f in sorted((TOP/"tests").glob(f"*/{name}"))]
    return str(found[0].relative_to(TOP)) if found else test


def read_rows(folder):
    """Rows by their key, the worst of each; and the files of the tests that were run."""
    rows, tests = {}, set()
    for file in sorted(Path(folder).iterdir()):
        test = place(file.name)
        tests.add(test)
        for line in file.read_text(encoding="utf-8").splitlines():
            fields = line.split("\t")
            if len(fields) != 11 or fields[0] not in GROUPS or fields[4] not in KINDS or fields[9] not in ("everyday", "full"):
                sys.exit(f"{file}: not a row: {line}")
            row = dict(zip(COLUMNS, [*fields, test]))
            value, reference, bound = (float(row[c]) for c in ("value", "reference", "bound"))
            for c in ("value", "reference", "bound", "disagrees"):
                row[c] = f"{float(row[c]):.6g}"
            row["errorOverBound"] = f"{(value - reference)/bound:.2g}"
            key = tuple(row[c] for c in KEY)
            if key not in rows or error(row) > error(rows[key]):
                rows[key] = row
    return rows, tests


def error(row):
    """Over its bound; that of a NaN is above any."""
    e = abs(float(row["errorOverBound"]))
    return e if e == e else float("inf")


def read_table():
    """The committed rows by their key."""
    if not TABLE.exists():
        return {}
    with open(TABLE, encoding="utf-8", newline="") as file:
        return {tuple(row[c] for c in KEY): row for row in csv.DictReader(file)}


def differences(rows, table, tests, full):
    """Of the rows of these tests, line by line."""
    def said(those):
        return {tuple(row[c] for c in SAID) for row in those}
    now = said(rows.values())
    then = said(row for row in table.values() if row["test"] in tests and (full or row["often"] == "everyday"))
    return [f"- {' | '.join(row)}" for row in sorted(then - now)] + [f"+ {' | '.join(row)}" for row in sorted(now - then)]


def merged(rows, table, tests, full):
    """The rows to write: those of tests that were not run stay, and those that have not moved."""
    result = [row for key, row in table.items()
              if row["test"] not in tests or not full and row["often"] == "full" and key not in rows]
    for key, row in rows.items():
        old = table.get(key)
        same = old and all(old[c] == row[c] for c in SAID)
        result.append(old if same and abs(float(old["errorOverBound"]) - float(row["errorOverBound"])) < NOISE else row)
    return sorted(result, key=lambda row: (GROUPS.index(row["group"]), *(row[c] for c in KEY)))


def put(file, text, mark):
    """A document with a text between its marks."""
    head, tail = f"<!-- {mark}: written by tests/validation.py -->\n", f"<!-- end of {mark} -->"
    return re.sub(f"(?s){re.escape(head)}.*{tail}", lambda _: head + text + tail, file.read_text(encoding="utf-8"))


def picture(group):
    return f"{PICTURES}/{group.replace(' ', '_')}.png"


def page(rows):
    """The table, a section a group."""
    text = []
    for group in GROUPS:
        those = [row for row in rows if row["group"] == group]
        if not those:
            continue
        text += [f"\n### Table: {group}\n", f"![{group}: every value less its reference, over its bound]({picture(group)})\n",
                 "| Quantity | Conditions | Reference | Kind | Value | Expected | Bound | Why | Error/bound | Test |",
                 "|---|---|---|---|---|---|---|---|---|---|"]
        for row in those:
            over = f"{error(row):.2g}"
            text.append("| " + " | ".join((
                *(row[c].replace("|", "\\|") for c in ("quantity", "conditions", "source", "kind", "value", "reference", "bound", "why")),
                f"**{over}: disagrees**" if error(row) > 1 else over,
                f"[{Path(row['test']).name}](../{row['test']})" + (", `--full`" if row["often"] == "full" else ""))) + " |")
    return "\n".join(text) + "\n"


def summary(rows):
    """The line of the README."""
    kinds = ", ".join(f"{sum(row['kind'] == k for row in rows)} {k} ({name})" for k, name in KINDS.items())
    agree = [row for row in rows if error(row) <= 1]
    return (f"The [validation table](docs/validation.md#the-table) has {len(rows)} rows: {kinds}. "
            f"{len(agree)} agree, with errors of at most {max(map(error, agree)):.2g} of their bounds; {len(rows) - len(agree)} do not, with "
            "the reason.\n")


def draw(rows, group):
    """Every value of a group about its reference, in units of its bound, between the bounds."""
    sys.path.insert(0, str(TOP/"python"))
    from ellipsoidtrap.pictures import style
    those = [row for row in rows if row["group"] == group][::-1]
    most = max(1.0, *(error(row) for row in those))
    figure, axes = style.plt.subplots(figsize=(4.5, 0.7 + 0.4*len(those)))
    axes.axvspan(-1, 1, color="0.9", zorder=0)
    for bound in (-1, 1):
        axes.axvline(bound, color="black", linewidth=0.8)
    axes.axvline(0, color="0.6", linewidth=0.5)
    for y, row in enumerate(those):
        axes.plot(float(row["errorOverBound"]), y, "o", color=style.VERMILLION if error(row) > 1 else style.BLUE, markersize=5)
        axes.text(1.02, y, f"{float(row['value']):.4g}, expected\n{float(row['reference']):.4g} ± {float(row['bound']):.2g}", va="center",
                  fontsize=7, transform=axes.get_yaxis_transform())
    axes.set_yticks(range(len(those)), [f"{row['quantity']}\n{row['conditions']}" for row in those], fontsize=7)
    axes.set_ylim(-0.6, len(those) - 0.4)
    axes.set_xlim(-1.1*most, 1.1*most)
    axes.set_xlabel("(value − reference)/bound")
    axes.locator_params(axis="x", nbins=6)
    axes.set_title(group, fontsize=9)
    (TOP/"docs"/PICTURES).mkdir(exist_ok=True)
    figure.savefig(TOP/"docs"/picture(group), dpi=100, metadata={"Software": None})
    style.plt.close(figure)


def write(rows, table):
    """Table, documents and those pictures whose rows have changed."""
    with open(TABLE, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    for group in {row["group"] for row in rows}:
        old, new = ([row for row in those if row["group"] == group] for those in (table.values(), rows))
        if old != new or not (TOP/"docs"/picture(group)).exists():
            draw(rows, group)
    for file, text, mark in documents(rows):
        file.write_text(put(file, text, mark), encoding="utf-8")


def documents(rows):
    return (PAGE, page(rows), "table"), (README, summary(rows), "validation")


def main(words):
    options, folders = {w for w in words if w.startswith("--")}, [w for w in words if not w.startswith("--")]
    if options - {"--full", "--write"} or len(folders) > 1 or "--write" in options and not folders:
        sys.exit(__doc__)
    table = read_table()
    if not folders:
        rows = list(table.values())
        wrong = [file.name for file, text, mark in documents(rows) if put(file, text, mark) != file.read_text(encoding="utf-8")]
        wrong += [picture(g) for g in {row["group"] for row in rows} if not (TOP/"docs"/picture(g)).exists()]
        sys.exit(f"not as docs/validation.csv says: {', '.join(wrong)}" if wrong else 0)
    rows, tests = read_rows(folders[0])
    wrong = differences(rows, table, tests, "--full" in options)
    print(*wrong, sep="\n", end="\n" if wrong else "")
    if "--write" in options:
        write(merged(rows, table, tests, "--full" in options), table)
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main(sys.argv[1:])

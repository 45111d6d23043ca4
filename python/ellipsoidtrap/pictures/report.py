# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""One page of HTML about a run, report.html in its case: device, flow, catches, the pictures
that are there, parameters, versions and times. All that it needs is inside it; pictures link to
the files of their full size and of their data."""

import base64
import html
import json
import os
import platform
import re
import sys
import time

import matplotlib
import numpy as np
from PIL import Image
from vtkmodules.vtkCommonCore import vtkVersion

from .case import MILLI
from .files import CaseError, number, read_dictionary, read_text, spelled
from .shares import wilson
from .style import SUFFIXES

# Chapter to (picture, title)
CHAPTERS = {
    "Flow": (
        ("speedAndTracks", "Flow and tracks"),
        ("deflection", "Electric potential and tracks"),
    ),
    "Catches": (
        ("figure1", "Cells caught against time (Figure 1 of the paper)"),
        ("fluxShares", "The flow through the sieves as they fill"),
        ("trappedCells", "The cells at rest"),
        ("captureMap", "Where a cell must enter to be caught"),
        ("probability", "How probable it is that a sieve holds exactly one"),
    ),
    "Motion": (
        ("figure2", "One cell on its way (Figure 2 of the paper)"),
        ("movie", "Cells that tumble (movies 2 to 5 of the paper)"),
        ("nearWall", "Spin near the sieves"),
        ("figure3", "The model (Figure 3 of the paper)"),
    ),
    "Designs": (("figure4", "Every sieve by itself (Figure 4 of the paper)"),),
    "Mesh": (
        ("figure5", "The mesh (Figure 5 of the paper)"),
        ("figure5Designs", "The apertures of the designs"),
    ),
}

STYLE = """
:root { --ink: #1a1a1a; --soft: #5a5f66; --line: #d9dce0; --accent: #0072b2; }
* { box-sizing: border-box; }
html { scroll-behavior: smooth; }
body { margin: 0 auto; padding: 2.5rem 1.25rem 4rem; max-width: 52rem; color: var(--ink);
  font: 16px/1.55 "Source Sans 3", "Segoe UI", "Helvetica Neue", Arial, sans-serif; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0 0 .3rem; }
h2 { font-size: 1.35rem; margin: 2.6rem 0 .8rem; padding-top: .8rem;
  border-top: 2px solid var(--ink); }
h3 { font-size: 1.05rem; margin: 1.8rem 0 .4rem; }
p.lead { color: var(--soft); margin: 0 0 1.4rem; }
nav { border: 1px solid var(--line); padding: .7rem 1.1rem; margin: 1.4rem 0; }
nav ol { margin: 0; padding-left: 1.2rem; columns: 2; }
nav a { color: var(--accent); text-decoration: none; }
nav a:hover { text-decoration: underline; }
.facts { display: grid; grid-template-columns: repeat(auto-fit, minmax(8rem, 1fr));
  gap: .8rem; margin: 1.2rem 0; }
.facts div { border-left: 3px solid var(--accent); padding: .1rem .7rem; }
.facts b { display: block; font-size: 1.5rem; line-height: 1.2;
  font-variant-numeric: tabular-nums; }
.facts span { color: var(--soft); font-size: .85rem; }
figure { margin: .4rem 0 1.6rem; }
figure img { display: block; max-width: 100%; height: auto; margin: 0 auto; }
figcaption a { color: var(--accent); }
figcaption { color: var(--soft); font-size: .9rem; margin-top: .5rem; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; margin: .6rem 0 1.4rem; font-size: .9rem;
  font-variant-numeric: tabular-nums; }
caption { text-align: left; color: var(--soft); padding-bottom: .3rem; }
th, td { padding: .22rem .8rem .22rem 0; text-align: right; vertical-align: top;
  border-bottom: 1px solid var(--line); }
th:first-child, td:first-child, table.words td, table.words th { text-align: left; }
thead th { border-bottom: 1.5px solid var(--ink); }
table.words td:first-child { white-space: nowrap; }
code { font: .85em ui-monospace, "DejaVu Sans Mono", Consolas, monospace; }
@media print {
  body { max-width: none; padding: 0; font-size: 10.5pt; }
  nav ol { columns: 3; }
  h2, h3 { break-after: avoid; }
  figure, table.short { break-inside: avoid; }
  figure img { max-height: 20cm; width: auto; }
  .wide { overflow: visible; }
}
"""


def text_of(words):
    """Text for HTML."""
    return html.escape(str(words))


def table_of(rows, caption="", kind="", head=True):
    """An HTML table; rows of words, the first the headings unless there are none."""
    parts = ['<div class="wide">', f'<table class="{kind}{" short" if len(rows) < 30 else ""}">']
    if caption:
        parts.append(f"<caption>{text_of(caption)}</caption>")

    def line(row, tag):
        return "<tr>" + "".join(f"<{tag}>{text_of(word)}</{tag}>" for word in row) + "</tr>"

    if head:
        parts.append(f"<thead>{line(rows[0], 'th')}</thead>")
        rows = rows[1:]
    parts += ["<tbody>", *(line(row, "td") for row in rows), "</tbody>", "</table>", "</div>"]
    return "\n".join(parts)


def words_table(rows, caption=""):
    """A table of names and what they are."""
    return table_of(rows, caption, "words", head=False)


def picture_of(case, name, title, number):
    """A picture with its caption and table, or "" if it has not been made."""
    stem = case.path("pictures", name)
    file = next((stem + end for end in (".png", ".webp") if os.path.isfile(stem + end)), None)
    if file is None:
        return ""
    try:
        with open(stem + ".json", encoding="utf-8") as f:
            note = json.load(f)
        caption, table = note["caption"], note["table"]
        with open(file, "rb") as f:
            data = base64.b64encode(f.read()).decode("ascii")
        with Image.open(file) as image:
            width, height = image.size
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise CaseError(f"{file}: {error}") from None
    beside = [
        (suffix, f"pictures/{name}.{suffix}") for suffix in SUFFIXES
        if suffix != "json" and os.path.isfile(f"{stem}.{suffix}")
    ]
    links = ", ".join(f'<a href="{path}">{suffix.upper()}</a>' for suffix, path in beside)
    largest = dict(beside).get("mp4") or "pictures/" + os.path.basename(file)
    # The pictures have 200 dots an inch, the film those of the screen
    shown = width if file.endswith(".webp") else round(width / 2)
    parts = [
        f'<h3 id="{name}">{text_of(title)}</h3>',
        "<figure>",
        f'<a href="{largest}"><img width="{shown}" height="{round(shown * height / width)}" '
        f'alt="{text_of(title)}" src="data:image/{file[-4:].strip(".")};base64,{data}"></a>',
        f"<figcaption><b>{number}.</b> {text_of(caption)} "
        f"In full: {links}.</figcaption>",
        "</figure>",
    ]
    if table:
        parts.append(table_of(table, kind="words" if len(table[0]) == 2 else ""))
    return "\n".join(parts)


# -- what the chapters tell beside the pictures --------------------------------

def title_of(case):
    """First line of the case's README, or the name of its folder."""
    file = case.path("README.md")
    if os.path.isfile(file):
        first = read_text(file).split("\n", 1)[0]
        if first.startswith("# "):
            return first[2:]
    return os.path.basename(case.folder)


def all_logged(case, pattern, name="ellipsoidTrapFoam"):
    """All that a log says of a kind."""
    file = case.path("log." + name)
    return re.findall(pattern, read_text(file)) if os.path.isfile(file) else []


def logged(case, pattern, name="ellipsoidTrapFoam"):
    """What a log says last, or None."""
    return next(reversed(all_logged(case, pattern, name)), None)


# Entry of constant/generated/plan to what it is
PLAN = {
    "obstacles": "obstacles", "area": "area of the fluid in the plan [µm²]",
    "narrowestGap": "narrowest gap [µm]", "finestCell": "finest mesh cells in the plan [µm]",
}


def device(case):
    """The geometry."""
    low, high = case.depth
    (x0, x1), (y0, y1) = case.plane.bounds
    along = case.plane.flow_axis
    direction = "" if along is None else f", flow along {'xy'[along]}"
    rows = [("Size", f"{x1 - x0:.4g} x {y1 - y0:.4g} x {high - low:.4g} µm{direction}")]
    if case.chamber:
        given = read_dictionary(case.path("constant", "generated", "chamber"))
        rows += [("chamber: " + key, f"{value} µm") for key, value in given.items()]
        design = read_dictionary(case.path("constant", "trapGeometry"))["designs"].get(case.design, {})
        rows.append(("design of the sieves", case.design))
        rows += [(f"design: {key}", value) for key, value in design.items() if isinstance(value, str)]
    file = case.path("constant", "generated", "plan")
    if os.path.isfile(file):
        given = read_dictionary(file)
        rows += [(told, f"{number(file, given, 0, key):.4g}") for key, told in PLAN.items() if key in given]
    if case.sieves:
        rows.append(("sieves, middle (x y) [µm]", "; ".join(
            "{} ({:.3g} {:.3g})".format(name, *np.mean(case.box(name), axis=0)) for name in case.sieves
        )))
    return words_table(rows, "Lengths of a design are in µm, its inlet pressure is kinematic "
                       "[m²/s²]." if case.design else "")


def flow(case):
    """What the solver logged of the flow."""
    said = (
        ("mean inlet speed", r"flow: mean inlet speed (\S+) m/s", MILLI, "mm/s"),
        ("pressure drop", r"flow: pressure drop \S+ m2/s2 \((\S+) Pa\)", 1, "Pa"),
    )
    rows = []
    for name, pattern, scale, unit in said:
        value = logged(case, pattern)
        if value is not None:
            rows.append((name, f"{scale * float(value):.4g} {unit}"))
    # A chip may have several inlets
    for patch, value in dict(all_logged(case, r"flow: (\S+): (\S+) m3/s in,")).items():
        rows.append((f"flux through the patch {patch}", f"{1e12 * float(value):.4g} 10⁻¹² m³/s"))
    found = logged(case, r"flow: (converged in \d+ iterations|already converged[^\n]*)")
    if found:
        rows.append(("steady state", found))
    rows.append(("mesh", f"{case.mesh_size:,} mesh cells"))
    parts = [words_table(rows)]
    if case.fluxes:
        names, fluxes, shares = zip(*case.fluxes)
        parts.append(table_of([
            ["through", *names], ["flux [10⁻¹² m³/s]", *(f"{1e12 * abs(one):.4g}" for one in fluxes)],
            ["share of what enters", *(f"{abs(one):.2%}" for one in shares)],
        ]))
    return "\n".join(parts)


def within(case):
    """How many were caught, and how many it might have been."""
    held, n = case.count("caught"), len(case.fates)
    ends = np.multiply(wilson(held, n, dispersion=case.dispersion), n)
    least, most = np.multiply(ends, case.band or (1, 1))
    return f"{held} ({np.floor(least):.0f}-{min(np.ceil(most), n):.0f})"


def catches(case):
    """How many of each fate."""
    names = ("caught", "escaped", "stalled", "in flight", "lost")
    counts = table_of([["injected", *names], [len(case.fates)] + [case.count(n) for n in names]])
    told = case.share_in_words(case.count("caught"), len(case.fates))
    return counts + (
        f"<p>Caught: {text_of(told)}; in brackets the interval in per cent that chance leaves, 95 %"
        + ("" if case.independent else ", for cells that push one another")
        + ("; with the model's choices: docs/uncertainty.md" if case.band else "") + ".</p>"
    )


def designs(case):
    """How to get the chapter where it is empty."""
    if os.path.isfile(case.path("pictures", "figure4.png")) or not case.design:
        return ""
    return ("<p><code>./compareDesigns</code> in the case's folder runs the designs A, B and C "
            "and adds their comparison here.</p>")


def flattened(entries, above=""):
    """(path, value) of a dictionary."""
    rows = []
    for key, value in entries.items():
        if isinstance(value, dict):
            rows += flattened(value, f"{above}{key}/")
        else:
            words = spelled(value)
            # Thousands of positions are no parameter to read
            rows.append((above + key, words if len(words) < 200 else words[:200] + " ..."))
    return rows


def parameters(case):
    """The dictionaries of the run."""
    parts = [words_table(
        flattened(case.properties), "constant/ellipsoidCloudProperties, in SI units. Entries left "
        "out have the defaults of the user guide."
    )]
    rows = []
    for folder, name, wanted in (
        ("constant", "transportProperties", ("nu",)),
        ("system", "controlDict", ("endTime", "deltaT", "writeInterval")),
    ):
        try:
            given = read_dictionary(case.path(folder, name))
        except CaseError as error:
            rows.append((f"{folder}/{name}", f"not read: {error}"))
            continue
        rows += [(f"{folder}/{name}: {key}", spelled(given[key])) for key in wanted if key in given]
    parts.append(words_table(rows))
    return "\n".join(parts)


def versions(case):
    """Programs and times."""
    rows = [
        ("ellipsoidTrapFoam", logged(case, r"\nellipsoidTrapFoam (\d.*)") or "unknown"),
        ("OpenFOAM", logged(case, r"Build\s*: (.*)") or "unknown"),
        ("Python, NumPy", f"{platform.python_version()}, {np.__version__}"),
        ("matplotlib, VTK", f"{matplotlib.__version__}, {vtkVersion().GetVTKVersion()}"),
        ("processors of the run", logged(case, r"nProcs : (\d+)") or "unknown"),
        ("run on", logged(case, r"Date   : (.*)") or "unknown"),
    ]
    for stage, name, pattern in (
        ("meshing (snappyHexMesh)", "snappyHexMesh", r"Finished meshing in = (\S+) s"),
        ("flow", "ellipsoidTrapFoam", r"flow: converged in .* (\S+) s"),
        ("tracking", "ellipsoidTrapFoam", r"tracking: (\S+) s"),
    ):
        value = logged(case, pattern, name)
        if value is not None:
            rows.append((f"time: {stage}", f"{float(value):.1f} s"))
    steps = logged(case, r"tracking: \S+ s, (\d+) steps")
    if steps:
        rows.append(("steps of the cells", f"{int(steps):,}"))
    return words_table(rows)


def page(case):
    """The HTML."""
    own = {
        "Device": device, "Flow": flow, "Catches": catches, "Motion": None, "Designs": designs,
        "Mesh": None, "Parameters": parameters, "Versions and times": versions,
    }
    body, contents, number = [], [], 0
    for chapter, tell in own.items():
        parts = [tell(case)] if tell else []
        for name, title in CHAPTERS.get(chapter, ()):
            made = picture_of(case, name, title, f"Picture {number + 1}")
            if made:
                number += 1
                parts.append(made)
        parts = [part for part in parts if part]
        if parts:
            anchor = chapter.split()[0].lower()
            contents.append(f'<li><a href="#{anchor}">{text_of(chapter)}</a></li>')
            body += [f'<h2 id="{anchor}">{text_of(chapter)}</h2>', *parts]

    title = title_of(case) + (f", design {case.design}" if case.design else "")
    facts = [
        (f"{len(case.fates)}", "cells injected"),
        (within(case), "cells caught"),
        (f"{len(case.sieves)}", "sieves"),
        (f"{case.end_time:g} s", "simulated"),
    ]
    boxes = "".join(f"<div><b>{text_of(a)}</b><span>{text_of(b)}</span></div>" for a, b in facts)
    return "\n".join([
        "<!DOCTYPE html>", '<html lang="en">', "<head>", '<meta charset="utf-8">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        '<link rel="icon" href="data:,">',
        f"<title>{text_of(title)}</title>", f"<style>{STYLE}</style>", "</head>", "<body>",
        f"<h1>{text_of(title)}</h1>",
        '<p class="lead">Report of ellipsoidTrapFoam, written '
        f"{time.strftime('%d %B %Y, %H:%M')}</p>",
        f'<div class="facts">{boxes}</div>',
        "<nav><ol>", *contents, "</ol></nav>", *body, "</body>", "</html>", "",
    ])


def make(case):
    """Write the report and say what came of it; whether it went well."""
    try:
        file = case.target("report.html")
        text = page(case)
        with open(file, "w", encoding="utf-8") as f:
            f.write(text)
    except CaseError as error:
        print(f"report: {error}", file=sys.stderr)
        return False
    except OSError as error:
        print(f"report: {file}: {error.strerror or error}", file=sys.stderr)
        return False
    print(f"report: {file} ({len(text) / 1e6:.1f} MB)")
    return True

# SPDX-License-Identifier: GPL-3.0-or-later
#
# This file is part of ellipsoidTrapFoam; see COPYING at the top of the source tree.
"""The report of the circular trap in the present folder is a page that needs nothing from outside, for figures.test."""

import base64
import io
import os
import re
from html.parser import HTMLParser

from PIL import Image

from checks import expect, finish

with open("report.html", encoding="utf-8") as file:
    text = file.read()


class Reader(HTMLParser):
    """What a page holds, and whether each of its elements is closed."""
    VOID = ("meta", "link", "img", "br")

    def __init__(self):
        super().__init__()
        self.open, self.ids, self.links, self.images, self.rows, self.words = [], [], [], [], [], []
        self.captions = 0

    def handle_starttag(self, tag, given):
        given = dict(given)
        if tag not in self.VOID:
            self.open.append(tag)
        if "id" in given:
            self.ids.append(given["id"])
        if tag == "a":
            self.links.append(given["href"])
        if tag == "img":
            self.images.append(given)
        if tag == "tr":
            self.rows.append([])
        self.captions += tag == "figcaption"
        expect(given["href"].startswith(("#", "data:", "pictures/")), f"{tag} {given['href'][:50]}") if "href" in given else None
        expect(given["src"].startswith("data:"), f"{tag} has its data inside") if "src" in given else None

    def handle_endtag(self, tag):
        expect(self.open and self.open.pop() == tag, f"</{tag}> closes what is open") if tag not in self.VOID else None

    def handle_data(self, data):
        if self.open and self.open[-1] in ("td", "th"):
            self.rows[-1].append(data)


reader = Reader()
reader.feed(text)
expect(not reader.open, f"all is closed: {reader.open}")
expect(len(set(reader.ids)) == len(reader.ids), "ids are unique")
contents = [link[1:] for link in reader.links if link.startswith("#")]
files = [link for link in reader.links if link.startswith("pictures/")]
expect(all(link in reader.ids for link in contents) and len(contents) >= 7, f"contents {contents}")
expect(all(os.path.isfile(link) for link in files), f"files {files}")
expect(sum(link.endswith(".csv") for link in files) == reader.captions, "each picture has its data")
expect(len(files) >= 3*reader.captions, "and is linked to its full size")
expect(not re.search(r"https?://|<script|@import", text), "nothing from outside")
expect(len(reader.images) == reader.captions >= 10, f"{len(reader.images)} pictures, {reader.captions} captions")
for image in reader.images:
    kind, data = image["src"].split(";base64,")
    with Image.open(io.BytesIO(base64.b64decode(data, validate=True))) as picture:
        picture.verify()
        expect(kind == "data:image/" + picture.format.lower() and image["alt"], image["alt"])
with open("log.ellipsoidTrapFoam", encoding="ascii") as file:
    last = re.findall(r"cells: (\d+) injected, (\d+) caught, (\d+) escaped, (\d+) stalled, (\d+) in flight, (\d+) lost", file.read())[-1]
expect(list(last) in reader.rows, f"the fates {last} are in a table")
expect(["cell/semiAxes", "(0.5e-6 2e-6 0.5e-6)"] in reader.rows, "and the parameters")
finish()

"""The page round a picture: its title, and a legend that says in plain words what the colours mean."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from PIL import Image, ImageDraw

from sim.pictures.floor import path_colours
from sim.pictures.lettering import Style, shortened, width, write
from sim.pictures.palette import BLUE, FAIL, GREEN, GREY, INK, PAPER, SKY, mix
from sim.pictures.record import RunRecord

MARGIN = 28
HEAD = 84
"""Height in pixels of the title's part of a page."""
FOOT = 62
"""Height in pixels of the legend's part of a page."""

TITLE = Style(25, INK, weight=1.0, tracking=0.006)
SUBTITLE = Style(15.5, GREY)
ENTRY = Style(15, INK)
_FINE = 4
_WIDTHS = {"line": 34.0, "area": 28.0, "ring": 19.0, "target": 19.0}


@dataclass(frozen=True)
class Entry:
    """A line of the legend: a kind of swatch ("line", "ring", "target" or "area"), its colour, and what it means."""

    kind: str
    colour: str
    text: str


def entries(run: RunRecord, seen: bool) -> list[Entry]:
    """Return the legend of a run; `seen` says whether the picture shows a camera's view area."""
    found = [Entry("line", colour, f"pose from {source}") for source, colour in path_colours(run).items()]
    if not run.sources and run.length() > 0.0:
        found.append(Entry("line", GREY, "path"))
    if run.failures:
        reasons = {failure.reason for failure in run.failures}
        found.insert(
            min(1, len(found)),
            Entry("target", FAIL, "FAIL" if len(reasons) > 1 else f"FAIL: {reasons.pop()}".rstrip(": ")),
        )
    if seen:
        found.append(Entry("area", SKY, "view of the camera"))
    if run.goal is not None:
        found.append(Entry("ring", GREEN, "goal"))
    return found


def compose(picture: Image.Image, run: RunRecord, legend: Sequence[Entry]) -> Image.Image:
    """Return a picture with the run's title above and the legend below, written on its own white margins."""
    page = faded(picture, HEAD, FOOT, 40)
    room = page.width - 2 * MARGIN
    write(page, MARGIN, 42, shortened(run.title, TITLE, room), TITLE)
    if run.subtitle:
        write(page, MARGIN, 67, shortened(run.subtitle, SUBTITLE, room), SUBTITLE)
    x, y = float(MARGIN), page.height - 27.0
    swatches = sum(_WIDTHS[entry.kind] + 10.0 for entry in legend)
    words = sum(width(entry.text, ENTRY) + 30.0 for entry in legend) - 30.0
    # Long names make the letters of the legend smaller, down to where they could no longer be read.
    scale = max(0.6, min(1.0, (room - swatches) / max(words, 1.0)))
    style = replace(ENTRY, size=ENTRY.size * scale)
    for entry in legend:
        swatch(page, x, y - 5.0, entry)
        x += _WIDTHS[entry.kind] + 10.0
        x += write(page, x, y, shortened(entry.text, style, max(40.0, page.width - x - 10.0)), style) + 30.0 * scale
    return page


def faded(picture: Image.Image, head: int, foot: int, side: int) -> Image.Image:
    """Return a picture that fades into paper at its sides, and above and below, where words will stand.

    It is whole from `head` pixels below its upper end to `foot` pixels above its lower end, and `side` pixels
    from its left and right end.
    """
    height, width = picture.height, picture.width
    row, column = np.arange(height, dtype=np.float32)[:, None], np.arange(width, dtype=np.float32)[None, :]
    ends = np.minimum((row - head + 34) / 34, (height - foot + 26 - row) / 26)
    sides = np.minimum(column, width - 1 - column) / side
    kept = np.clip(np.minimum(ends, sides), 0.0, 1.0)
    mask = Image.fromarray((kept * kept * (3.0 - 2.0 * kept) * 255.0).astype(np.uint8))
    return Image.composite(picture, Image.new("RGB", picture.size, PAPER), mask)


def swatch(page: Image.Image, x: float, y: float, entry: Entry) -> None:
    """Draw a swatch with its left end at x and its middle at y."""
    left, top = int(x), int(y) - 14
    tile = page.crop((left, top, left + 38, top + 28)).resize((38 * _FINE, 28 * _FINE))
    draw = ImageDraw.Draw(tile)

    def at(*numbers: float) -> list[float]:
        return [(number + (x - left if k % 2 == 0 else y - top)) * _FINE for k, number in enumerate(numbers)]

    if entry.kind == "line":
        draw.rounded_rectangle(at(0, -3.2, 34, 3.2), 3.2 * _FINE, fill=entry.colour)
    elif entry.kind == "area":
        fill, line = mix(entry.colour, PAPER, 0.7), mix(BLUE, PAPER, 0.2)
        draw.rounded_rectangle(at(0, -9, 28, 9), 3 * _FINE, fill=fill, outline=line, width=int(1.6 * _FINE))
    else:
        for radius, colour in (
            (9.5, entry.colour),
            (5.6, PAPER),
            (2.8 if entry.kind == "target" else 0, entry.colour),
        ):
            if radius:
                draw.ellipse(at(9.5 - radius, -radius, 9.5 + radius, radius), fill=colour)
    page.paste(tile.resize((38, 28), Image.Resampling.LANCZOS), (left, top))

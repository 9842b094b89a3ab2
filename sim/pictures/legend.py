"""What stands round a picture: its title, a legend that says in plain words what colours mean, and white margins."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from xml.etree.ElementTree import Element

from PIL import Image

from sim.pictures.colours import BLUE, FAIL, GREEN, GREY, PAPER, SKY, mix
from sim.pictures.record import RunRecord
from sim.pictures.svg import Style, add, document, image, shortened, width, write

MARGIN, HEAD, FOOT = 28, 84, 62
"""Height in pixels of the title's and the legend's part of a picture, and the space beside them."""

TITLE, SUBTITLE, ENTRY = Style(25, bold=True), Style(15.5, GREY), Style(15)
SMALLEST = 0.6
"""The scale below which the letters of the legend can no longer be read."""
_WIDTHS = {"line": 34.0, "area": 28.0, "ring": 19.0, "target": 19.0}


@dataclass(frozen=True)
class Entry:
    """A line of the legend: a kind of swatch ("line", "ring", "target" or "area"), its colour, and what it means."""

    kind: str
    colour: str
    text: str


def entries(run: RunRecord, seen: bool) -> list[Entry]:
    """Return the legend of a run; `seen` says whether the picture shows a camera's view area."""
    found = [Entry("line", colour, f"pose from {source}") for source, colour in run.colours().items()]
    if not run.sources and run.length() > 0.0:
        found.append(Entry("line", GREY, "path"))
    if run.failures:
        reasons = {failure.reason for failure in run.failures}
        words = "FAIL" if len(reasons) > 1 else f"FAIL: {reasons.pop()}".rstrip(": ")
        found.insert(min(1, len(found)), Entry("target", FAIL, words))
    if seen:
        found.append(Entry("area", SKY, "view of the camera"))
    if run.goal is not None:
        found.append(Entry("ring", GREEN, "goal"))
    return found


def compose(picture: Image.Image, run: RunRecord, legend: Sequence[Entry]) -> Image.Image:
    """Return a picture with the run's title above and the legend below, on white margins that it fades into."""
    root = document(*picture.size)
    fade(root, HEAD, FOOT, 40)
    room = picture.width - 2 * MARGIN
    write(root, MARGIN, 42, shortened(run.title, TITLE, room), TITLE)
    write(root, MARGIN, 67, shortened(run.subtitle, SUBTITLE, room), SUBTITLE)
    lines = rows(legend, room)
    style = replace(ENTRY, size=ENTRY.size * max(SMALLEST, min(1.0, *(_scale(line, room) for line in lines))))
    for number, line in enumerate(lines):
        x, y = float(MARGIN), picture.height - (27.0 if len(lines) == 1 else 32.0 - 22.0 * number)
        for entry in line:
            swatch(root, x, y - 5.0, entry)
            x += _WIDTHS[entry.kind] + 10.0
            text = shortened(entry.text, style, max(40.0, picture.width - x - 10.0))
            write(root, x, y, text, style)
            x += width(text, style) + 30.0 * style.size / ENTRY.size
    return over(picture, root)


def rows(legend: Sequence[Entry], room: float) -> list[Sequence[Entry]]:
    """Return the legend in one row, or in two where one would need letters too small to be read."""
    if _scale(legend, room) >= SMALLEST or len(legend) < 2:
        return [legend]
    halves = ([legend[:first], legend[first:]] for first in range(1, len(legend)))
    return max(halves, key=lambda pair: min(_scale(row, room) for row in pair))


def _scale(row: Sequence[Entry], room: float) -> float:
    """Return by how much the letters of a row have to be scaled to fill a room, given in pixels."""
    swatches = sum(_WIDTHS[entry.kind] + 10.0 for entry in row)
    words = sum(width(entry.text, ENTRY) + 30.0 for entry in row) - 30.0
    return (room - swatches) / max(words, 1.0)


def over(picture: Image.Image, root: Element) -> Image.Image:
    """Return a picture with an SVG document of its size drawn over it."""
    return Image.alpha_composite(picture.convert("RGBA"), image(root)).convert("RGB")


def fade(root: Element, head: float, foot: float, side: float) -> None:
    """Cover what lies above `head` and below `foot` pixels with white, and let the rest fade into white there."""
    wide, high = float(root.get("width", 0)), float(root.get("height", 0))
    defs = add(root, "defs")
    ends = {"n": (0, 0, 0, 1), "s": (0, 1, 0, 0), "w": (0, 0, 1, 0), "e": (1, 0, 0, 0)}
    for name, (x1, y1, x2, y2) in ends.items():
        gradient = add(defs, "linearGradient", id=name, x1=x1, y1=y1, x2=x2, y2=y2)
        for offset, opacity in ((0.0, 1.0), (0.25, 0.84), (0.5, 0.5), (0.75, 0.16), (1.0, 0.0)):
            add(gradient, "stop", offset=offset, stop_color=PAPER, stop_opacity=opacity)
    add(root, "rect", width=wide, height=max(head - 34, 0.0), fill=PAPER)
    add(root, "rect", y=high - foot + 26, width=wide, height=foot, fill=PAPER)
    add(root, "rect", y=head - 34, width=wide, height=34, fill="url(#n)")
    add(root, "rect", y=high - foot, width=wide, height=26, fill="url(#s)")
    add(root, "rect", width=side, height=high, fill="url(#w)")
    add(root, "rect", x=wide - side, width=side, height=high, fill="url(#e)")


def swatch(root: Element, x: float, y: float, entry: Entry) -> None:
    """Draw a swatch with its left end at x and its middle at y."""
    if entry.kind == "line":
        add(root, "rect", x=x, y=y - 3.2, width=34, height=6.4, rx=3.2, fill=entry.colour)
    elif entry.kind == "area":
        fill, line = mix(entry.colour, PAPER, 0.7), mix(BLUE, PAPER, 0.2)
        add(root, "rect", x=x, y=y - 9, width=28, height=18, rx=3, fill=fill, stroke=line, stroke_width=1.6)
    else:
        add(root, "circle", cx=x + 9.5, cy=y, r=7.5, fill=PAPER, stroke=entry.colour, stroke_width=3.9)
        if entry.kind == "target":
            add(root, "circle", cx=x + 9.5, cy=y, r=2.8, fill=entry.colour)

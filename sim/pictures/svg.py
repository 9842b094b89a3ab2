"""SVG: the few elements that titles, legends, diagrams and floors are drawn with, and their rendering by resvg.

Text is set in Aileron, the typeface that comes with Pillow, so every machine draws the same picture; letters that
Aileron lacks come from the system's fonts. Aileron has one weight: headings are made bolder by a fine outline.
"""

from __future__ import annotations

import io
import re
import tempfile
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from xml.etree.ElementTree import Element, SubElement, indent, tostring

import resvg_py
from PIL import Image, ImageFont

from sim.pictures.colours import INK

Point = tuple[float, float]
Attributes = dict[str, float | str]

FAMILY = "Aileron, 'Helvetica Neue', Helvetica, Arial, sans-serif"
_TRACKING, _WORD, _OUTLINE = 0.006, 0.045, 0.04
"""Extra space between letters and words, and the width of a bold letter's outline, in font sizes."""


@dataclass(frozen=True)
class Style:
    """How text looks: size in pixels, colour, and whether it is bold."""

    size: float
    colour: str = INK
    bold: bool = False


def printable(text: str) -> str:
    """Return text on one line, with a replacement character for each that XML does not allow."""
    known = re.sub("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]", "\N{REPLACEMENT CHARACTER}", text)
    return re.sub(r"\s", " ", known)


def width(text: str, style: Style) -> float:
    """Return the width in pixels of a line of text."""
    text = printable(text)
    # Measured at a hundred pixels, where rounding to whole pixels does not matter.
    return style.size * (_font().getlength(text) / 100.0 + _TRACKING * len(text) + _WORD * text.count(" "))


def shortened(text: str, style: Style, room: float) -> str:
    """Return the text, cut with an ellipsis if it is wider than there is room for."""
    if width(text, style) <= room:
        return text
    kept = bisect_right(range(1, len(text)), room, key=lambda end: width(text[:end].rstrip() + "…", style))
    return text[:kept].rstrip() + "…"


def document(wide: float, high: float, title: str = "") -> Element:
    """Return an empty SVG document; its title is its name for people that cannot see it."""
    size: Attributes = {"width": wide, "height": high, "viewBox": f"0 0 {number(wide)} {number(high)}", "role": "img"}
    root = Element("svg", {"xmlns": "http://www.w3.org/2000/svg"} | {key: number(size[key]) for key in size})
    if title:
        SubElement(root, "title").text = printable(title)
    return root


def add(parent: Element, tag: str, **attributes: float | str) -> Element:
    """Append an element; underscores in the names of its attributes stand for hyphens."""
    return SubElement(parent, tag, {name.replace("_", "-"): number(value) for name, value in attributes.items()})


def write(parent: Element, x: float, y: float, text: str, style: Style, anchor: str = "start") -> None:
    """Append a line of text with its baseline at y; x is its "start", "middle" or "end"."""
    outline: Attributes = {"stroke": style.colour, "stroke_width": _OUTLINE * style.size} if style.bold else {}
    line = add(parent, "text", x=x, y=y, fill=style.colour, font_size=style.size, text_anchor=anchor, **outline)
    line.set("font-family", FAMILY)
    line.set("letter-spacing", number(_TRACKING * style.size))
    line.set("word-spacing", number(_WORD * style.size))
    line.text = printable(text)


def badge(parent: Element, x: float, y: float, text: str, fill: str, style: Style, middle: bool = False) -> float:
    """Append text with its baseline at y on a pill of colour that begins at x, or ends there; return its width."""
    wide, high = width(text, style) + 1.5 * style.size, 1.7 * style.size
    left = x - wide if middle else x
    add(parent, "rect", x=left, y=y - 1.2 * style.size, width=wide, height=high, rx=high / 2, fill=fill)
    write(parent, left + wide / 2, y, text, style, "middle")
    return wide


def points(places: Sequence[Point]) -> str:
    """Return points as the attributes `points` and `d` want them."""
    return " ".join(f"{number(x)},{number(y)}" for x, y in places)


def number(value: float | str) -> str:
    """Return a number with four decimals at most; a string is left as it is."""
    return value if isinstance(value, str) else f"{value:.4f}".rstrip("0").rstrip(".")


def source(root: Element) -> str:
    """Return a document's text; what was written in it is escaped, whatever it holds."""
    indent(root)
    return tostring(root, encoding="unicode") + "\n"


def image(root: Element, zoom: float = 1.0) -> Image.Image:
    """Return a document as an RGBA image with `zoom` pixels for each of its units, transparent where it is empty."""
    with tempfile.TemporaryDirectory() as folder:
        face = Path(folder) / "Aileron.ttf"
        face.write_bytes(_font().font_bytes)
        drawn = resvg_py.svg_to_bytes(svg_string=tostring(root, encoding="unicode"), zoom=zoom, font_files=[str(face)])
    return Image.open(io.BytesIO(drawn)).convert("RGBA")


@lru_cache(maxsize=1)
def _font() -> ImageFont.FreeTypeFont:
    font = ImageFont.load_default(100.0)
    assert isinstance(font, ImageFont.FreeTypeFont)
    return font

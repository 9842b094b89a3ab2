"""Lettering: text in pictures, set with the typeface that comes with Pillow, so every machine draws the same.

Aileron has one weight and the letters of English. Headings are made bolder by a fine outline; text with a letter
that Aileron lacks is set in DejaVu Sans if the machine has it. Text is drawn four times too large and shrunk, which
keeps the shapes of small letters and lets them stand at fractions of a pixel.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from dataclasses import dataclass
from functools import lru_cache

from PIL import Image, ImageDraw, ImageFont

from sim.pictures.palette import INK, rgb

_FINE = 4
_STAND_IN = "DejaVuSans.ttf"


@dataclass(frozen=True)
class Style:
    """How text looks: size in pixels, colour, weight (0 regular, 1 bold) and extra space between letters (in sizes)."""

    size: float
    colour: str = INK
    weight: float = 0.0
    tracking: float = 0.004


def printable(text: str) -> str:
    """Return text on one line, with a replacement character for each that neither XML nor a typeface knows."""
    known = re.sub("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]", "\N{REPLACEMENT CHARACTER}", text)
    return re.sub(r"\s", " ", known)


def width(text: str, style: Style) -> float:
    """Return the width in pixels of a line of text."""
    text = printable(text)
    font = _font(text, style.size * _FINE)
    return (font.getlength(text) / _FINE) + style.size * (style.tracking * len(text) + _WORD * text.count(" "))


def write(image: Image.Image, x: float, y: float, text: str, style: Style, anchor: str = "left") -> float:
    """Write a line of text with its baseline at y; x is its left end, middle or right end. Return its width."""
    text, wide = printable(text), width(text, style)
    x -= {"left": 0.0, "middle": wide / 2.0, "right": wide}[anchor]
    left, top = int(x) - 2, int(y - 1.1 * style.size)
    mask = Image.new("L", (int(wide + 6) * _FINE, int(1.6 * style.size + 2) * _FINE))
    draw, font = ImageDraw.Draw(mask), _font(text, style.size * _FINE)
    at, base = (x - left) * _FINE, (y - top) * _FINE
    for k, letter in enumerate(text):
        kerned = font.getlength(text[: k + 1]) - font.getlength(letter)
        extra = style.size * (style.tracking * k + _WORD * text.count(" ", 0, k)) * _FINE
        outline = 0.020 * style.weight * style.size * _FINE
        draw.text((at + kerned + extra, base), letter, fill=255, font=font, anchor="ls", stroke_width=outline)
    small = mask.resize((mask.width // _FINE, mask.height // _FINE), Image.Resampling.BOX)
    image.paste(Image.new("RGB", small.size, rgb(style.colour)), (left, top), small)
    return wide


def shortened(text: str, style: Style, room: float) -> str:
    """Return the text, cut with an ellipsis if it is wider than there is room for."""
    if width(text, style) <= room:
        return text
    kept = bisect_right(range(1, len(text)), room, key=lambda end: width(text[:end].rstrip() + "…", style))
    return text[:kept].rstrip() + "…"


_WORD = 0.045
"""Aileron's word space is narrow for small sizes: this much is added, in sizes."""


@lru_cache(maxsize=64)
def _face(name: str, size: float) -> ImageFont.FreeTypeFont | ImageFont.ImageFont:
    if name:
        try:
            return ImageFont.truetype(name, size)
        except OSError:
            pass
    return ImageFont.load_default(size)


@lru_cache(maxsize=4096)
def _lacks(letter: str) -> bool:
    """Say whether the default typeface shows its box for missing letters in place of this one."""
    font = _face("", 20.0)
    return not letter.isspace() and bytes(font.getmask(letter)) == bytes(font.getmask("\uffff"))


def _font(text: str, size: float) -> ImageFont.FreeTypeFont | ImageFont.ImageFont:
    return _face(_STAND_IN if any(_lacks(letter) for letter in set(text)) else "", size)

"""The tracker's view as a strip of its images: tracking, the last sight of Astrid, and lost."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from PIL import Image, ImageDraw

from sim.pictures.arrays import Bytes, Mask, Point
from sim.pictures.lettering import Style, shortened, width, write
from sim.pictures.palette import BLUE, FAIL, GREY, INK, ORANGE, PAPER, rgb
from sim.pictures.record import Sight

TITLE = Style(22, INK, weight=1.0, tracking=0.006)
BADGE = Style(13.5, PAPER, weight=0.9, tracking=0.012)
TEXT = Style(14.5, INK)
CLOCK = Style(14.5, GREY)
MARK = "#ffe100"
"""The yellow of what is drawn on camera images: it is in none of the furniture."""

FRAME = 380
"""Width of an image in the strip, in pixels."""
_FINE = 4
_FEWEST = 6
_NUMBERS = 3


def strip(sights: Sequence[Sight], title: str = "What the camera sees") -> Image.Image:
    """Return a strip of at most three images, with Astrid's plate outlined where the tracker found it.

    ValueError if there is no image.
    """
    shown = chosen(sights)
    if not shown:
        raise ValueError("a strip has at least one image")
    high = max(round(FRAME * s.image.shape[0] / s.image.shape[1]) for s, _ in shown)
    gap, margin, head = 22, 28, 66
    page = Image.new("RGB", (2 * margin + FRAME * len(shown) + gap * (len(shown) - 1), head + high + 74), PAPER)
    write(page, margin, 42, shortened(title, TITLE, page.width - 2 * margin), TITLE)
    for k, (sight, stage) in enumerate(shown):
        _panel(page, margin + k * (FRAME + gap), head, sight, stage)
    return page


def chosen(sights: Sequence[Sight]) -> list[tuple[Sight, str]]:
    """Return up to three images that tell the story, and what each shows: tracking, last sight, lost."""
    tracked = [sight for sight in sights if not sight.lost]
    lost = [sight for sight in sights if sight.lost and (not tracked or sight.time >= tracked[-1].time)]
    if not lost:
        picks = [tracked[k * (len(tracked) - 1) // 2] for k in range(_NUMBERS)] if len(tracked) > _NUMBERS else tracked
        return [(sight, "tracking") for sight in picks]
    found = [(tracked[(len(tracked) - 1) // 2], "tracking")] if len(tracked) > 1 else []
    found += [(tracked[-1], "last sight")] if tracked else []
    return [*found, (lost[-1], "lost")]


def plate(image: Bytes) -> tuple[list[Point], Point, Point] | None:
    """Return the outline of Astrid's plate in pixels, and the middles of its back and front; None if it is not seen."""
    red, green, blue = (image[:, :, k].astype(np.int32) for k in range(3))
    magenta = (red > 100) & (blue > 100) & (red > 3 * green) & (blue > 3 * green)
    cyan = (green > 100) & (blue > 100) & (green > 3 * red) & (blue > 3 * red)
    if magenta.sum() < _FEWEST or cyan.sum() < _FEWEST:
        return None
    rows, columns = np.nonzero(magenta | cyan)
    # The corners of the pixels, not their middles: the outline goes round them.
    corners = {
        (float(x + dx), float(y + dy)) for x, y in zip(columns, rows, strict=True) for dx in (0, 1) for dy in (0, 1)
    }
    return _hull(sorted(corners)), _middle(cyan), _middle(magenta)


def _middle(mask: Mask) -> Point:
    rows, columns = np.nonzero(mask)
    return float(columns.mean()) + 0.5, float(rows.mean()) + 0.5


def _hull(points: Sequence[Point]) -> list[Point]:
    """Return the convex hull of sorted points (Andrew's monotone chain)."""

    def chain(ordered: Sequence[Point]) -> list[Point]:
        kept: list[Point] = []
        for x, y in ordered:
            while len(kept) > 1:
                (x0, y0), (x1, y1) = kept[-2:]
                if (x1 - x0) * (y - y0) > (y1 - y0) * (x - x0):
                    break
                kept.pop()
            kept.append((x, y))
        return kept[:-1]

    return chain(points) + chain(points[::-1])


def _panel(page: Image.Image, left: int, top: int, sight: Sight, stage: str) -> None:
    """Draw one image with its outline, its frame and its words."""
    colour = {"tracking": BLUE, "last sight": ORANGE, "lost": FAIL}[stage]
    picture = Image.fromarray(np.ascontiguousarray(sight.image[:, :, :3]))
    zoom = FRAME / picture.width
    picture = picture.resize((FRAME, round(picture.height * zoom)), Image.Resampling.LANCZOS)
    if not sight.lost:
        picture = _outlined(picture, sight.image, zoom)
    page.paste(_framed(picture, colour), (left, top))
    base = top + picture.height + 29
    ink = INK if stage == "last sight" else PAPER
    badge = Style(BADGE.size, ink, BADGE.weight, BADGE.tracking)
    wide = width(stage, badge) + 22
    _pill(page, left, base - 16, wide, 23, colour)
    write(page, left + wide / 2, base, stage, badge, "middle")
    write(page, left + FRAME, base, f"{sight.time:.1f} s", CLOCK, "right")
    write(page, left, base + 27, shortened(sight.caption, TEXT, FRAME), TEXT)


def _outlined(picture: Image.Image, image: Bytes, zoom: float) -> Image.Image:
    """Return the picture with an outline round the plate, and an arrow from its back to its front."""
    found = plate(image)
    if found is None:
        return picture
    hull, back, front = found
    veil = Image.new("L", (picture.width * _FINE, picture.height * _FINE))
    draw = ImageDraw.Draw(veil)
    x, y = ((back[k] + front[k]) / 2.0 for k in range(2))
    grown = []
    for a, b in hull:
        away = math.hypot(a - x, b - y)
        grown.append(((x + (a - x) * (1 + 2.5 / away)) * zoom * _FINE, (y + (b - y) * (1 + 2.5 / away)) * zoom * _FINE))
    draw.line([*grown, *grown[:2]], fill=255, width=2 * _FINE, joint="curve")
    ahead = math.hypot(front[0] - back[0], front[1] - back[1])
    if ahead > 1.0:
        dx, dy = (front[0] - back[0]) / ahead, (front[1] - back[1]) / ahead
        reach = max(math.hypot(a - x, b - y) for a, b in hull) + 14.0
        tip = ((x + dx * reach) * zoom * _FINE, (y + dy * reach) * zoom * _FINE)
        foot = ((x + dx * (reach - 9)) * zoom * _FINE, (y + dy * (reach - 9)) * zoom * _FINE)
        side = 5.0 * zoom * _FINE
        draw.polygon(
            [tip, (foot[0] - dy * side, foot[1] + dx * side), (foot[0] + dy * side, foot[1] - dx * side)],
            fill=255,
        )
    mask = veil.resize(picture.size, Image.Resampling.BOX)
    return Image.composite(Image.new("RGB", picture.size, rgb(MARK)), picture, mask)


def _framed(picture: Image.Image, colour: str) -> Image.Image:
    """Return the picture with round corners and a border."""
    fine = (picture.width * _FINE, picture.height * _FINE)
    shape, border = Image.new("L", fine), Image.new("L", fine)
    outline = (0, 0, fine[0] - 1, fine[1] - 1)
    ImageDraw.Draw(shape).rounded_rectangle(outline, 8 * _FINE, fill=255)
    ImageDraw.Draw(border).rounded_rectangle(outline, 8 * _FINE, outline=255, width=3 * _FINE)
    small = [mask.resize(picture.size, Image.Resampling.BOX) for mask in (shape, border)]
    bordered = Image.composite(Image.new("RGB", picture.size, rgb(colour)), picture, small[1])
    return Image.composite(bordered, Image.new("RGB", picture.size, PAPER), small[0])


def _pill(page: Image.Image, x: float, y: float, wide: float, high: float, colour: str) -> None:
    size = (math.ceil(wide), math.ceil(high))
    mask = Image.new("L", (size[0] * _FINE, size[1] * _FINE))
    ImageDraw.Draw(mask).rounded_rectangle((0, 0, wide * _FINE - 1, high * _FINE - 1), high / 2 * _FINE, fill=255)
    page.paste(Image.new("RGB", size, rgb(colour)), (round(x), round(y)), mask.resize(size, Image.Resampling.BOX))

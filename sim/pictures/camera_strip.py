"""The tracker's view as a strip of camera images: tracking, the last sight of Astrid, and lost."""

from __future__ import annotations

import base64
import io
import math
from collections.abc import Sequence
from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from shapely import MultiPoint

from sim.pictures.colours import BLUE, FAIL, GREY, INK, ORANGE, PAPER
from sim.pictures.record import CameraImage
from sim.pictures.svg import Point, Style, add, badge, document, image, points, shortened, write
from sim.robot.tracker import plate_colours

TITLE, TEXT, CLOCK = Style(22, bold=True), Style(14.5), Style(14.5, GREY)
MARK = "#ffe100"
"""The yellow of what is drawn on camera images: it is in none of the furniture."""

FRAME, GAP, MARGIN, HEAD = 380, 22, 28, 66
"""Width of an image in the strip, the spaces between and beside images, and the height of the title, in pixels."""
_FEWEST = 6
"""A colour of the plate is seen from this many pixels on."""
_NUMBERS = 3


def strip(sights: Sequence[CameraImage], title: str = "What the camera sees") -> Image.Image:
    """Return a strip of at most three images, with Astrid's plate outlined where the tracker found it.

    ValueError if there is no image.
    """
    shown = chosen(sights)
    if not shown:
        raise ValueError("a strip has at least one image")
    high = max(round(FRAME * s.image.shape[0] / s.image.shape[1]) for s, _ in shown)
    wide = 2 * MARGIN + FRAME * len(shown) + GAP * (len(shown) - 1)
    root = document(wide, HEAD + high + 74, title)
    add(root, "rect", width="100%", height="100%", fill=PAPER)
    rounded = add(add(root, "defs"), "clipPath", id="rounded")
    add(rounded, "rect", width=FRAME, height=high, rx=8)
    write(root, MARGIN, 42, shortened(title, TITLE, wide - 2 * MARGIN), TITLE)
    for k, (sight, stage) in enumerate(shown):
        left = MARGIN + k * (FRAME + GAP)
        _panel(add(root, "g", transform=f"translate({left} {HEAD})"), sight, stage, high)
    return image(root).convert("RGB")


def chosen(sights: Sequence[CameraImage]) -> list[tuple[CameraImage, str]]:
    """Return up to three images that tell the story, and what each shows: tracking, last sight, lost."""
    tracked = [sight for sight in sights if not sight.lost]
    lost = [sight for sight in sights if sight.lost and (not tracked or sight.time >= tracked[-1].time)]
    if not lost:
        picks = [tracked[k * (len(tracked) - 1) // 2] for k in range(_NUMBERS)] if len(tracked) > _NUMBERS else tracked
        return [(sight, "tracking") for sight in picks]
    found = [(tracked[(len(tracked) - 1) // 2], "tracking")] if len(tracked) > 1 else []
    found += [(tracked[-1], "last sight")] if tracked else []
    return [*found, (lost[-1], "lost")]


def plate(picture: NDArray[np.uint8]) -> tuple[list[Point], Point, Point] | None:
    """Return the outline of Astrid's plate in pixels, and the middles of its back and front; None if it is not seen."""
    magenta, cyan = plate_colours(picture)
    if magenta.sum() < _FEWEST or cyan.sum() < _FEWEST:
        return None
    # The corners of the pixels, not their middles: the outline goes round them.
    rows, columns = np.nonzero(magenta | cyan)
    corners = [np.stack([columns + dx, rows + dy], axis=1) for dx in (0, 1) for dy in (0, 1)]
    hull = MultiPoint(np.concatenate(corners)).convex_hull
    return list(hull.exterior.coords)[:-1], _middle(cyan), _middle(magenta)


def _middle(mask: NDArray[np.bool_]) -> Point:
    rows, columns = np.nonzero(mask)
    return float(columns.mean()) + 0.5, float(rows.mean()) + 0.5


def _panel(panel: Element, sight: CameraImage, stage: str, high: int) -> None:
    """Draw one image with its outline, its frame and its words."""
    colour = {"tracking": BLUE, "last sight": ORANGE, "lost": FAIL}[stage]
    packed = io.BytesIO()
    picture = Image.fromarray(np.ascontiguousarray(sight.image[:, :, :3]))
    picture.resize((2 * FRAME, 2 * high), Image.Resampling.LANCZOS).save(packed, "PNG", compress_level=1)
    href = f"data:image/png;base64,{base64.b64encode(packed.getvalue()).decode()}"
    inside = add(panel, "g", clip_path="url(#rounded)")
    add(inside, "image", width=FRAME, height=high, href=href)
    if not sight.lost:
        _outline(inside, sight.image)
    add(
        panel,
        "rect",
        x=1.5,
        y=1.5,
        width=FRAME - 3,
        height=high - 3,
        rx=6.5,
        fill="none",
        stroke=colour,
        stroke_width=3,
    )
    base = high + 29
    badge(panel, 0, base, stage, colour, Style(13.5, INK if stage == "last sight" else PAPER, bold=True))
    write(panel, FRAME, base, f"{sight.time:.1f} s", CLOCK, "end")
    write(panel, 0, base + 27, shortened(sight.caption, TEXT, FRAME), TEXT)


def _outline(parent: Element, picture: NDArray[np.uint8]) -> None:
    """Draw an outline round the plate, and an arrow from its back to its front."""
    found = plate(picture)
    if found is None:
        return
    hull, back, front = found
    zoom = FRAME / picture.shape[1]
    layer = add(parent, "g", transform=f"scale({zoom})")
    add(layer, "polygon", points=points(hull), fill="none", stroke=MARK, stroke_width=3 / zoom, stroke_linejoin="round")
    x, y = (back[0] + front[0]) / 2, (back[1] + front[1]) / 2
    if math.dist(back, front) > 1.0:
        reach = max(math.hypot(a - x, b - y) for a, b in hull) + 14.0
        turn = math.degrees(math.atan2(front[1] - back[1], front[0] - back[0]))
        arrow = add(layer, "polygon", points=points([(reach, 0), (reach - 9, -5), (reach - 9, 5)]), fill=MARK)
        arrow.set("transform", f"translate({x} {y}) rotate({turn})")

"""The floor as a picture: planks, carpets and rugs, and on them what the run left behind.

The path lies in the floor's texture, so it runs in perspective, under the table and through shadows, like paint. It is
drawn as SVG in metres. There are two floors, without the run's paint and with it; where paint was laid until a time
says `trail`, in the texture as in a picture of it, so that a film need not draw a floor for every frame.
"""

from __future__ import annotations

import colorsys
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from sim.home.floor_plan import Furniture, Room
from sim.pictures.colours import BLUE, FAIL, GREEN, GREY, SKY, mix, to_linear, written
from sim.pictures.mesh import Array
from sim.pictures.record import RunRecord, Sample
from sim.pictures.scene import tile
from sim.pictures.svg import Attributes, Point, add, document, image, points

Extent = tuple[float, float, float, float]

PATH_WIDTH, CASING = 0.062, 0.011
FAIL_RING, GOAL_RING = 0.115, 0.32
"""Outer radius, in metres, of the rings where something failed and at the goal; the robot fits into the second."""
WHITE = "#f7f7f7"
PLANK = (1.15, 0.125)


@dataclass(frozen=True, eq=False)
class Floor:
    """Linear colours (h, w, 3) of a floor without and with a run's paint, `density` pixels a metre, north first."""

    extent: Extent
    density: float
    bare: Array
    painted: Array

    def place(self, x: float, y: float) -> Point:
        """Return the column and row of a point."""
        return (x - self.extent[0]) * self.density, (self.extent[3] - y) * self.density

    def until(self, run: RunRecord, time: float) -> Array:
        """Return the floor with the paint that was laid until a time."""
        height, width = self.bare.shape[:2]
        laid = trail(run, time, (width, height), self.place, self.density)
        return np.where(laid[..., None], self.painted, self.bare)


def lay(
    extent: Extent,
    rooms: Iterable[Room],
    coverings: Iterable[Furniture],
    areas: Iterable[Sequence[Point]],
    run: RunRecord,
    density: float,
) -> Floor:
    """Return the floor of the rooms with coverings, the cameras' view areas, the goal and the run's path.

    `extent` is (west, south, east, north) in metres.
    """
    rooms = list(rooms)
    west, south, east, north = extent
    root = document(round((east - west) * density), round((north - south) * density))
    metres = add(root, "g", transform=f"matrix({density} 0 0 {-density} {-west * density} {north * density})")
    add(metres, "rect", x=west, y=south, width=east - west, height=north - south, fill="#b09a7c")
    for room in rooms:
        _room(metres, room)
    for covering in coverings:
        _rug(metres, covering)
    for number, area in enumerate(areas):
        _view_area(metres, area, f"area{number}")
    if run.goal is not None:
        _ring(metres, *run.goal, GOAL_RING, 0.042, GREEN)
    grain = _grain(extent, rooms, density)
    bare = _pixels(root) * grain
    _path(metres, run)
    for failure in run.failures:
        _target(metres, failure.x, failure.y)
    return Floor(extent, density, bare, _pixels(root) * grain)


def trail(
    run: RunRecord, time: float, size: tuple[int, int], place: Callable[[float, float], Point], scale: float
) -> NDArray[np.bool_]:
    """Say for the pixels (h, w) of a picture of the floor in which of them paint may have been laid until a time.

    `place` finds the pixel of a point of the floor; a metre is `scale` pixels there.
    """
    mask = Image.new("1", size)
    draw = ImageDraw.Draw(mask)
    samples = [*(sample for sample in run.samples if sample.time <= time), run.at(time)]
    way = [place(sample.x, sample.y) for sample in samples]
    wide = math.ceil(scale * (PATH_WIDTH + 2 * CASING)) + 3
    draw.line(way, fill=1, width=wide, joint="curve")
    spots = [(*place(x, y), wide / 2) for x, y in ((sample.x, sample.y) for sample in (samples[0], samples[-1]))]
    far = scale * (FAIL_RING + 0.02) + 1
    spots += [(*place(failure.x, failure.y), far) for failure in run.failures if failure.time <= time]
    for x, y, radius in spots if time >= run.start else ():
        draw.ellipse((x - radius, y - radius, x + radius, y + radius), fill=1)
    return np.asarray(mask)


def _pixels(root: Element) -> Array:
    drawn = image(root).convert("RGB")
    return to_linear(np.asarray(drawn, np.float32) / 255.0)


def _wooden(room: Room) -> bool:
    hue, _, saturation = colorsys.rgb_to_hls(*room.colour)
    return saturation > 0.25 and 0.04 < hue < 0.17


def _room(parent: Element, room: Room) -> None:
    """Lay a room's floor, to the middle of its walls: planks if its colour is a wooden one, carpet otherwise."""
    colour, wide, deep = written(room.colour), room.width + 0.1, room.depth + 0.1
    west, south = room.x - wide / 2, room.y - deep / 2
    board = add(parent, "svg", x=west, y=south, width=wide, height=deep)
    add(board, "rect", width=wide, height=deep, fill=colour)
    for row in range(math.ceil(deep / PLANK[1]) if _wooden(room) else 0):
        for column in range(-1, math.ceil(wide / PLANK[0])):
            # A fraction that looks random, and is the same in each picture.
            tone = (row * 131 + column * 57) * 0.6180339887 % 1.0
            plank = mix(colour, "#ffffff" if tone > 0.5 else "#5a3a1c", abs(tone - 0.5) * 0.24)
            x = (column + row * 0.381966 % 1.0) * PLANK[0]
            size: Attributes = {
                "width": PLANK[0],
                "height": PLANK[1],
                "stroke": mix(colour, "#3a2814", 0.35),
                "stroke_width": 0.004,
            }
            add(board, "rect", x=x, y=row * PLANK[1], fill=plank, **size)


def _grain(extent: Extent, rooms: Iterable[Room], density: float) -> Array:
    """Return the fine tones (h, w, 1) of planks, which run along x, and of carpets."""
    x = np.arange(extent[0], extent[2], 1.0 / density)[: round((extent[2] - extent[0]) * density)]
    y = np.arange(extent[3], extent[1], -1.0 / density)[: round((extent[3] - extent[1]) * density)]
    noise, tones = tile(), np.ones((len(y), len(x), 1), np.float32)
    side = len(noise)
    for room in rooms:
        rows = np.flatnonzero(np.abs(y - room.y) < room.depth / 2 + 0.05)
        columns = np.flatnonzero(np.abs(x - room.x) < room.width / 2 + 0.05)
        along, across, strength = (70.0, 1400.0, 0.035) if _wooden(room) else (300.0, 300.0, 0.04)
        fine = noise[np.ix_((y[rows] * across).astype(int) % side, (x[columns] * along).astype(int) % side)]
        coarse = noise[np.ix_((y[rows] * across / 6).astype(int) % side, (x[columns] * along / 4).astype(int) % side)]
        tones[np.ix_(rows, columns)] = (1.0 + strength * (fine + 0.7 * coarse))[..., None]
    return tones


def _rug(parent: Element, rug: Furniture) -> None:
    """Lay a rug with a woven border and rounded corners."""
    turned = add(parent, "g", transform=f"translate({rug.x} {rug.y}) rotate({math.degrees(rug.theta)})")
    for inset, line in ((0.0, 0.0), (0.010, 0.020), (0.046, 0.012)):
        wide, deep = rug.width - 2 * inset, rug.depth - 2 * inset
        edge = {"stroke": "#f1e4d3", "stroke_width": line, "fill": "none"} if line else {"fill": written(rug.colour)}
        add(turned, "rect", x=-wide / 2, y=-deep / 2, width=wide, height=deep, rx=0.1 - inset, **edge)


def _view_area(parent: Element, area: Sequence[Point], name: str) -> None:
    """Tint the view area, most along its rim, and draw its outline."""
    defs, outline = add(parent, "defs"), points(area)
    add(add(defs, "clipPath", id=name), "polygon", points=outline)
    add(add(defs, "filter", id=f"{name}-blur"), "feGaussianBlur", stdDeviation=0.07)
    add(parent, "polygon", points=outline, fill=SKY, fill_opacity=0.08)
    clipped = add(parent, "g", clip_path=f"url(#{name})")
    rim: Attributes = {"fill": "none", "stroke": SKY, "stroke_width": 0.18, "stroke_opacity": 0.4}
    add(clipped, "polygon", points=outline, filter=f"url(#{name}-blur)", **rim)
    add(parent, "polygon", points=outline, fill="none", stroke=BLUE, stroke_width=0.018, stroke_opacity=0.75)


def _ring(parent: Element, x: float, y: float, radius: float, width: float, colour: str) -> None:
    """Draw a ring, given by its outer radius and its width, with white edges."""
    for extra, tone in ((0.024, WHITE), (0.0, colour)):
        add(parent, "circle", cx=x, cy=y, r=radius - width / 2, fill="none", stroke=tone, stroke_width=width + extra)


def _target(parent: Element, x: float, y: float) -> None:
    """Draw the target that marks a failure."""
    for radius, tone in ((1.0, WHITE), (0.9, FAIL), (0.57, WHITE), (0.27, FAIL)):
        add(parent, "circle", cx=x, cy=y, r=radius * (FAIL_RING + 0.012), fill=tone)


def _path(parent: Element, run: RunRecord) -> None:
    """Paint the path, cut where another component takes over."""
    line: Attributes = {"fill": "none", "stroke_linecap": "round", "stroke_linejoin": "round"}
    pieces = _pieces(run)
    casing: Attributes = {"stroke": WHITE, "stroke_width": PATH_WIDTH + 2 * CASING, "stroke_opacity": 0.8, **line}
    add(parent, "polyline", points=points([(s.x, s.y) for piece, _ in pieces for s in piece]), **casing)
    for piece, colour in pieces:
        way = points([(sample.x, sample.y) for sample in piece])
        add(parent, "polyline", points=way, stroke=colour, stroke_width=PATH_WIDTH, **line)


def _pieces(run: RunRecord) -> list[tuple[list[Sample], str]]:
    """Return the path as pieces of one colour each."""
    cuts = {time for supply in run.supplies for time in (supply.start, supply.end)}
    times = sorted({run.start, run.end, *(time for time in cuts if run.start < time < run.end)})
    colours, found = run.colours(), []
    for start, end in pairwise(times):
        source = run.source((start + end) / 2.0)
        between = [sample for sample in run.samples if start < sample.time < end]
        found.append(([run.at(start), *between, run.at(end)], GREY if source is None else colours[source]))
    return found

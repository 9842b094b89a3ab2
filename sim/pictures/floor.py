"""The floor as a picture: planks, carpets and rugs, and on them what the run left behind.

The path lies in the texture, so it runs in perspective, under the table and through shadows, like paint. Paint has
a moment at which it is laid: with it a film can show the floor as it was at any time, and draw it only once.
"""

from __future__ import annotations

import colorsys
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from PIL import Image, ImageDraw, ImageFilter

from sim.floor_plan import Furniture, Room
from sim.geometry import Pose
from sim.pictures.arrays import Array, Indices, Point
from sim.pictures.matter import noise
from sim.pictures.palette import BLUE, FAIL, GREEN, GREY, SKY, SOURCES, linear, written
from sim.pictures.record import RunRecord, Sample

Extent = tuple[float, float, float, float]

PATH_WIDTH = 0.062
FAIL_RING, GOAL_RING = 0.115, 0.32
"""Outer radius, in metres, of the rings where something failed and at the goal; the robot fits into the second."""
WHITE = np.full(3, 0.93, np.float32)


@dataclass(frozen=True, eq=False)
class Floor:
    """A floor of `density` pixels a metre: bare and painted colours (h, w, 3), and when the paint was laid (h, w).

    `corner` is the south-west one. Colours are linear; the moment is infinity where nothing is ever painted.
    """

    corner: Point
    density: float
    bare: Array
    painted: Array
    moment: Array

    def pixels(self, points: Array) -> Indices:
        """Return, for points (2 or 3, n) of the world, their places in the flattened texture."""
        height, width = self.moment.shape
        column = np.clip((points[0] - self.corner[0]) * self.density, 0, width - 1).astype(np.int32)
        row = np.clip(height - (points[1] - self.corner[1]) * self.density, 0, height - 1).astype(np.int32)
        return np.asarray(row * width + column, np.int32)


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
    ground = _Ground(extent, density)
    for room in rooms:
        ground.board(room)
    for covering in coverings:
        ground.cover(covering)
    for area in areas:
        ground.outline(area)
    if run.goal is not None:
        ground.ring(*run.goal, GOAL_RING, 0.042, GREEN)
    bare = ground.colours.copy()
    moment = _paint(ground, run)
    return Floor((extent[0], extent[1]), density, bare, ground.colours, moment)


def path_colours(run: RunRecord) -> dict[str, str]:
    """Return the colour of each component that supplied the pose."""
    return {source: SOURCES[k % len(SOURCES)] for k, source in enumerate(run.sources)}


class _Ground:
    """Colours of a stretch of ground, and the ways to draw on them in metres."""

    def __init__(self, extent: Extent, density: float) -> None:
        self.corner, self.density = (extent[0], extent[1]), density
        self.width, self.height = (
            round((extent[2] - extent[0]) * density),
            round((extent[3] - extent[1]) * density),
        )
        self.x = (extent[0] + (np.arange(self.width, dtype=np.float32) + 0.5) / density)[None, :]
        self.y = (extent[3] - (np.arange(self.height, dtype=np.float32) + 0.5) / density)[:, None]
        self.colours = np.empty((self.height, self.width, 3), np.float32)
        self.colours[:] = linear("#b09a7c")

    def near(self, x: float, y: float, reach: float) -> tuple[slice, slice]:
        """Return the window of the texture that holds everything within reach of a point."""
        column, row = self.at(x, y)
        far = reach * self.density + 2
        return (
            slice(max(0, int(row - far)), max(0, int(row + far))),
            slice(max(0, int(column - far)), max(0, int(column + far))),
        )

    def at(self, x: float, y: float) -> Point:
        """Return the column and row of a point."""
        return (x - self.corner[0]) * self.density, self.height - (y - self.corner[1]) * self.density

    def blend(self, window: tuple[slice, slice], colour: Array, share: Array) -> None:
        """Lay a colour over a window, as opaque as `share` (rows, columns) says."""
        self.colours[window] += (colour - self.colours[window]) * share[..., None]

    def within(self, distance: Array) -> Array:
        """Return how far inside (distance below 0) each pixel lies, from 0 to 1 over the width of a pixel."""
        return np.asarray(np.clip(0.5 - distance * np.float32(self.density), 0.0, 1.0))

    def board(self, room: Room) -> None:
        """Lay a room's floor, to the middle of its walls: planks if its colour is a wooden one, carpet otherwise."""
        reach = math.hypot(room.width, room.depth) / 2 + 0.1
        window = self.near(room.x, room.y, reach)
        x, y = self.x[:, window[1]], self.y[window[0]]
        inside = self.within(
            np.maximum(np.abs(x - room.x) - room.width / 2, np.abs(y - room.y) - room.depth / 2) - 0.051
        )
        hue, _, saturation = colorsys.rgb_to_hls(*room.colour)
        tone = _planks(x, y) if saturation > 0.25 and 0.04 < hue < 0.17 else _pile(x, y)
        self.blend(window, linear(written(room.colour)) * tone, inside)

    def cover(self, covering: Furniture) -> None:
        """Lay a rug with a woven border and rounded corners."""
        window = self.near(covering.x, covering.y, math.hypot(covering.width, covering.depth) / 2)
        frame = Pose(covering.x, covering.y, covering.theta)
        cosine, sine = math.cos(frame.theta), math.sin(frame.theta)
        dx, dy = self.x[:, window[1]] - frame.x, self.y[window[0]] - frame.y
        along, across = np.abs(cosine * dx + sine * dy), np.abs(cosine * dy - sine * dx)
        radius = min(0.10, covering.width / 2, covering.depth / 2)
        outside = np.hypot(
            np.maximum(along - covering.width / 2 + radius, 0.0),
            np.maximum(across - covering.depth / 2 + radius, 0.0),
        )
        inside = np.maximum(along - covering.width / 2, across - covering.depth / 2)
        edge = np.where(outside > 0.0, outside - radius, np.maximum(inside, -radius))
        weave = (1.0 + 0.05 * noise(dx * 380.0 + 0 * dy, dy * 380.0 + 0 * dx))[..., None]
        colour, light = written(covering.colour), linear("#f1e4d3")
        self.blend(window, linear(colour) * weave, self.within(edge))
        for inner, outer in ((0.020, 0.0), (0.052, 0.040)):
            self.blend(window, light * weave, self.within(np.abs(edge + (inner + outer) / 2) - (inner - outer) / 2))

    def outline(self, area: Sequence[Point]) -> None:
        """Tint the view area, most along its rim, and draw its outline."""
        place = [self.at(*point) for point in area]
        window = (slice(0, self.height), slice(0, self.width))
        fill, line = (Image.new("L", (self.width, self.height)) for _ in range(2))
        ImageDraw.Draw(fill).polygon(place, fill=255)
        ImageDraw.Draw(line).line(
            [*place, *place[:2]], fill=255, width=max(2, round(0.018 * self.density)), joint="curve"
        )
        inside = np.asarray(fill, np.float32) / 255.0
        rim = 1.0 - np.asarray(fill.filter(ImageFilter.GaussianBlur(0.09 * self.density)), np.float32) / 255.0
        self.blend(window, linear(SKY), inside * (0.07 + 0.75 * rim))
        self.blend(window, linear(BLUE), np.asarray(line, np.float32) * np.float32(0.75 / 255.0))

    def ring(self, x: float, y: float, radius: float, width: float, colour: str) -> None:
        """Draw a ring, given by its outer radius and its width, with white edges."""
        window = self.near(x, y, radius + 0.03)
        away = np.abs(np.hypot(self.x[:, window[1]] - x, self.y[window[0]] - y) - radius + width / 2)
        self.blend(window, WHITE, self.within(away - width / 2 - 0.012) * np.float32(0.9))
        self.blend(window, linear(colour), self.within(away - width / 2))

    def target(self, x: float, y: float, moment: Array, time: float) -> None:
        """Draw the target that marks a failure, and note the time at which it was painted."""
        window = self.near(x, y, FAIL_RING + 0.03)
        away = np.hypot(self.x[:, window[1]] - x, self.y[window[0]] - y)
        self.blend(window, WHITE, self.within(away - FAIL_RING - 0.012))
        self.blend(window, linear(FAIL), self.within(np.abs(away - FAIL_RING * 0.82) - FAIL_RING * 0.18))
        self.blend(window, linear(FAIL), self.within(away - FAIL_RING * 0.30))
        moment[window] = np.where(away < FAIL_RING + 0.016, np.float32(time), moment[window])


def _planks(x: Array, y: Array) -> Array:
    """Return the tones (h, w, 3) of planks that run along x, each a little different, with fine gaps."""
    wide, long = 0.125, 1.15
    row = np.floor(y / wide)
    along = x / long + np.mod(row * 0.381966, 1.0)
    number = (np.floor(along) * 57.0 + row * 131.0).astype(np.int64)
    tone = ((number * 2654435761 >> 7) & 1023).astype(np.float32) / 1023.0 - 0.5
    grain = noise(x * 70.0 + number * 37, y * 1400.0 + number * 61) + 0.8 * noise(
        x * 22.0 + number * 17, y * 260.0 + number
    )
    gap = np.minimum(np.abs(np.mod(y / wide + 0.5, 1.0) - 0.5) * wide, np.abs(np.mod(along + 0.5, 1.0) - 0.5) * long)
    level = (1.0 + 0.20 * tone + 0.030 * grain) * (1.0 - 0.32 * np.exp(-np.square(gap / 0.0022)))
    warmth = np.stack([1.0 + 0.02 * tone, np.ones_like(tone), 1.0 - 0.08 * tone], axis=-1)
    return np.asarray(level[..., None] * warmth, np.float32)


def _pile(x: Array, y: Array) -> Array:
    """Return the tones (h, w, 3) of a short carpet."""
    column, row = x + 0.0 * y, y + 0.0 * x
    fibre = noise(column * 300.0, row * 300.0) + 0.6 * noise(column * 41.0, row * 41.0)
    return np.asarray((1.0 + 0.035 * fibre)[..., None], np.float32)


def _paint(ground: _Ground, run: RunRecord) -> Array:
    """Paint the path and what failed; return when each pixel was painted, infinity where none was."""
    shape = (ground.height, ground.width)
    away, moment = np.full(shape, np.inf, np.float32), np.full(shape, np.inf, np.float32)
    colours = np.zeros((*shape, 3), np.float32)
    half, casing = np.float32(PATH_WIDTH / 2), np.float32(PATH_WIDTH / 2 + 0.011)
    for first, second, colour in _strokes(run):
        reach = math.dist((first.x, first.y), (second.x, second.y)) / 2 + float(casing) + 0.01
        window = ground.near((first.x + second.x) / 2, (first.y + second.y) / 2, reach)
        distance = _distance(ground.x[:, window[1]], ground.y[window[0]], first, second)
        colours[window][distance <= half + 0.01] = linear(colour)
        away[window] = np.minimum(away[window], distance)
        moment[window] = np.where(distance < casing + 0.004, np.minimum(moment[window], second.time), moment[window])
    everything = (slice(0, ground.height), slice(0, ground.width))
    ground.blend(everything, WHITE, ground.within(away - casing) * np.float32(0.8))
    ground.blend(everything, colours, ground.within(away - half))
    for failure in run.failures:
        ground.target(failure.x, failure.y, moment, failure.time)
    return moment


def _distance(x: Array, y: Array, first: Sample, second: Sample) -> Array:
    """Return how far points are from the straight piece between two samples."""
    dx, dy = second.x - first.x, second.y - first.y
    share = np.clip(((x - first.x) * dx + (y - first.y) * dy) / max(dx * dx + dy * dy, 1e-12), 0.0, 1.0)
    return np.asarray(np.hypot(x - first.x - share * dx, y - first.y - share * dy), np.float32)


def _strokes(run: RunRecord) -> list[tuple[Sample, Sample, str]]:
    """Return the path as straight pieces with their colours, cut where another component takes over."""
    cuts = {time for supply in run.supplies for time in (supply.start, supply.end) if run.start < time < run.end}
    samples = sorted([*run.samples, *(run.at(time) for time in cuts)], key=lambda sample: sample.time)
    colours = path_colours(run)
    found: list[tuple[Sample, Sample, str]] = []
    last = samples[0]
    for sample in samples[1:]:
        if math.hypot(sample.x - last.x, sample.y - last.y) > 0.008 or sample.time in cuts:
            source = run.source((last.time + sample.time) / 2.0)
            found.append((last, sample, GREY if source is None else colours[source]))
            last = sample
    return found

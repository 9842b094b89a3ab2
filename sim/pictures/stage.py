"""The stage: how solids, light and floor become a picture.

The set (walls and furniture) stands still and is lit once: its lamps keep their shadow maps. The robot is an actor:
her shadow is found by sending rays at her few solids, exactly, and only where it can fall. A picture is the mean
of several exposures, each moved by a part of a pixel and lit by its own few lamps, so that edges, soft shadows and
fine grain are all smoothed by one and the same sum. The ground outside is paper that only shows shadows.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sim.pictures.arrays import Array, Indices, Mask
from sim.pictures.floor import Floor
from sim.pictures.light import BOUNCE, SKY, SUN, Lamp, sky, sun
from sim.pictures.solids import Solid, look
from sim.pictures.view import View

SLAB = 0.12
"""How far the floor lies above the ground outside, in metres."""
END = math.inf
"""The time at which all paint has been laid."""
_GOLDEN = (math.sqrt(5.0) - 1.0) / 2.0
_LIFT = np.float32(0.012)
"""How far points are lifted off their surfaces, in metres, before lamps look for them: more than a map is coarse."""
_NEAR = 0.6
"""How far from an actor, in metres, she is seen to keep the light of the sky away."""


@dataclass(frozen=True, eq=False)
class Actor:
    """What moves on the stage: the solids to be drawn, and a few rough ones that darken what is near them."""

    solids: Sequence[Solid] = ()
    rough: Sequence[Solid] = ()


NOBODY = Actor()


@dataclass(frozen=True, eq=False)
class Stage:
    """A lit set: its solids, of which the first is the floor, the floor's picture, and each exposure's lamps."""

    solids: Sequence[Solid]
    floor: Floor
    suns: Sequence[Lamp]
    skies: Sequence[Sequence[Lamp]]

    @classmethod
    def lit(cls, solids: Sequence[Solid], floor: Floor, exposures: int, skies: int, step: float) -> Stage:
        """Return the set with a sun and `skies` sky lamps for each exposure; sun maps have `step` metres a pixel."""
        dome = sky(solids, exposures * skies, 2.0 * step)
        return cls(solids, floor, sun(solids, exposures, step), [dome[k::exposures] for k in range(exposures)])

    def quicker(self, exposures: int) -> Stage:
        """Return the same lit set with fewer exposures, spread evenly over those that it has."""
        chosen = [k * len(self.suns) // exposures for k in range(min(exposures, len(self.suns)))]
        return Stage(self.solids, self.floor, [self.suns[k] for k in chosen], [self.skies[k] for k in chosen])

    def picture(self, view: View, actor: Actor = NOBODY, time: float = END) -> Array:
        """Return the linear intensities (h, w, 3) of a view, with the paint that was laid until a time."""
        count = len(self.suns) if view.width and view.height else 0
        total = np.zeros((view.height, view.width, 3), np.float32)
        for k in range(count):
            # A lattice: however many exposures there are, no two share a row or a column of the pixel.
            moved = view.shifted((k + 0.5) / count - 0.5, (k * _GOLDEN) % 1.0 - 0.5)
            total += _Exposure(self, moved, actor, k).develop(time)
        return total / np.float32(max(count, 1))

    def moments(self, view: View) -> Array:
        """Return when paint first shows in each pixel (h, w) of a view; infinity where none ever does."""
        found = np.full((view.height, view.width), np.inf, np.float32)
        for across, down in ((0.0, 0.0), (-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5)):
            moved = view.shifted(across, down)
            seen = look(self.solids, moved)
            start, way = moved.rays(moved.everything())
            on_floor = seen.which == 0
            depth = np.where(on_floor, seen.depth, 0.0)
            points = np.stack([o + depth * d for o, d in zip(start[:2], way[:2], strict=True)])
            moment = self.floor.moment.ravel()[self.floor.pixels(points[:, on_floor])]
            found[on_floor] = np.minimum(found[on_floor], moment)
        return found


class _Exposure:
    """One look at the set and the actor, under one sun and a few lamps of the sky; all arrays are (.., pixels)."""

    def __init__(self, stage: Stage, view: View, actor: Actor, number: int) -> None:
        self.stage, self.view, self.actor = stage, view, actor
        self.sun, self.skies = stage.suns[number], stage.skies[number]
        self.solids = [*stage.solids, *actor.solids]
        seen = look(self.solids, view)
        start, way = view.rays(view.everything())
        shape = seen.depth.shape
        self.way = np.stack([np.broadcast_to(part, shape).ravel() for part in way])
        origin = np.stack([np.broadcast_to(part, shape).ravel() for part in start])
        self.which = seen.which.ravel()
        outside = (-np.float32(SLAB) - origin[2]) / self.way[2]
        self.points = origin + np.where(self.which >= 0, seen.depth.ravel(), outside) * self.way

    def develop(self, time: float) -> Array:
        """Return the picture (h, w, 3) with the paint that was laid until a time."""
        count = self.which.size
        normals, colours = np.zeros((3, count), np.float32), np.ones((3, count), np.float32)
        normals[2] = 1.0
        gloss, glow = np.zeros(count, np.float32), np.zeros(count, np.float32)
        order = np.argsort(self.which, kind="stable")
        numbers, starts = np.unique(self.which[order], return_index=True)
        for number, mine in zip(numbers.tolist(), np.split(order, starts[1:]), strict=True):
            if number < 0:
                continue
            solid = self.solids[number]
            local = solid.local(self.points[:, mine])
            normals[:, mine] = solid.normal(local)
            colours[:, mine] = solid.matter.colours(local, solid.half)
            gloss[mine], glow[mine] = solid.matter.gloss, solid.matter.glow
        paint = self._floor(colours, normals, time)
        light, shine = self._light(normals, gloss)
        # Paint is there to be read: shadows darken it half as much as what it lies on.
        own = np.maximum(glow, np.float32(0.5) * paint)
        picture = shoulder(colours * (light + (1.0 - light) * own) + shine)
        outside = self.which < 0
        # The faintest shade is left out, so that the paper is white where words stand on it.
        shade = 1.0 - light[:, outside] / self._open_air()[:, None]
        picture[:, outside] = 1.0 - np.maximum(shade - 0.07, 0.0) * 0.92
        return np.ascontiguousarray(picture.T).reshape(self.view.height, self.view.width, 3)

    def _open_air(self) -> Array:
        """Return the light that falls on level ground in the open: what `_light` finds where nothing stands."""
        up = np.array([[0.0], [0.0], [1.0]], np.float32)
        direct = self.sun.towards @ up
        dome = sum(lamp.towards @ up for lamp in self.skies) * np.float32(2.0 / len(self.skies))
        return np.asarray(SUN * direct + SKY * dome + BOUNCE * np.float32(0.35), np.float32)

    def _floor(self, colours: Array, normals: Array, time: float) -> Array:
        """Put the floor's picture on its top; return where (1 or 0) there is paint."""
        painted = np.zeros(self.which.size, np.float32)
        mine = np.flatnonzero((self.which == 0) & (normals[2] > 0.5))
        floor = self.stage.floor
        pixel = floor.pixels(self.points[:, mine])
        laid = floor.moment.ravel()[pixel] <= time
        bare, full = (layer.reshape(-1, 3)[pixel] for layer in (floor.bare, floor.painted))
        colours[:, mine] = np.where(laid[:, None], full, bare).T
        painted[mine] = laid
        return painted

    def _light(self, normals: Array, gloss: Array) -> tuple[Array, Array]:
        """Return the light that falls on each pixel, and the light that a gloss mirrors towards the eye."""
        lifted = self.points + normals * _LIFT
        sunny = self.sun.reaches(lifted) & ~shadowed(self.actor.solids, lifted, self.sun.towards)
        direct = np.where(sunny, np.maximum(self.sun.towards @ normals, 0.0), np.float32(0.0))
        dome: Array = np.zeros(direct.size, np.float32)
        openness: Array = np.zeros(direct.size, np.float32)
        near = around(self.actor.rough, lifted, _NEAR)
        close = lifted[:, near]
        for lamp in self.skies:
            reached = lamp.reaches(lifted)
            reached[near] &= ~shadowed(self.actor.rough, close, lamp.towards)
            openness += reached
            dome += reached * np.maximum(lamp.towards @ normals, 0.0)
        dome, openness = dome * 2.0 / len(self.skies), openness / len(self.skies)
        light = SUN[:, None] * direct + SKY[:, None] * dome
        light += BOUNCE[:, None] * ((0.85 - 0.5 * normals[2]) * (0.3 + 0.7 * openness))
        return light, self._shine(normals, gloss, sunny, openness)

    def _shine(self, normals: Array, gloss: Array, sunny: Mask, openness: Array) -> Array:
        """Return what glossy surfaces mirror: the sun as a highlight, the sky more the flatter they are seen."""
        shine = np.zeros_like(normals)
        mine = np.flatnonzero(gloss > 0.0)
        if mine.size:
            way = self.way[:, mine] / np.sqrt((self.way[:, mine] ** 2).sum(axis=0))
            normal = normals[:, mine]
            facing = np.maximum(-(way * normal).sum(axis=0), 0.0)
            mirrored = way + 2.0 * facing * normal
            highlight = np.maximum(self.sun.towards @ mirrored, 0.0) ** 40 * sunny[mine]
            above = np.clip(mirrored[2] * 1.5 + 0.3, 0.0, 1.0) * openness[mine]
            flat = 0.05 + 0.6 * (1.0 - facing) ** 4
            shine[:, mine] = gloss[mine] * (SUN[:, None] * 0.9 * highlight + SKY[:, None] * (2.0 * flat * above))
        return shine


def shoulder(intensity: Array) -> Array:
    """Return intensities of which the brightest are pressed together below 1, as film does, instead of cut off."""
    knee = np.float32(0.72)
    above = np.maximum(intensity - knee, 0.0) / (1.0 - knee)
    return np.where(intensity > knee, knee + (1.0 - knee) * (1.0 - np.exp(-above)), intensity)


def shadowed(solids: Sequence[Solid], points: Array, towards: Array) -> Mask:
    """Say for points (3, n) whether one of the solids lies between them and a far light."""
    dark = np.zeros(points.shape[1], np.bool_)
    if not solids or points.shape[1] == 0:
        return dark
    centre, reach = _ball(solids)
    offset = centre[:, None] - points
    along = towards @ offset
    near = np.flatnonzero(((offset * offset).sum(axis=0) - along * along < reach * reach) & (along > -reach))
    for solid in solids:
        if near.size == 0:
            break
        start = solid.local(points[:, near])
        way = (solid.turn @ towards).astype(np.float32)
        depth = solid.hit((start[0], start[1], start[2]), (way[0:1], way[1:2], way[2:3]))
        hit = np.isfinite(depth) & (depth > 0.0)
        dark[near[hit]] = True
        near = near[~hit]
    return dark


def around(solids: Sequence[Solid], points: Array, distance: float) -> Indices:
    """Return which of the points (3, n) lie no further than a distance from the ball about all solids."""
    if not solids:
        return np.zeros(0, np.intp)
    centre, reach = _ball(solids)
    offset = points - centre[:, None]
    return np.flatnonzero((offset * offset).sum(axis=0) < (reach + distance) ** 2)


def _ball(solids: Sequence[Solid]) -> tuple[Array, float]:
    """Return centre and radius of a ball that holds all solids."""
    corners = np.concatenate([solid.corners for solid in solids], axis=1)
    centre = ((corners.max(axis=1) + corners.min(axis=1)) / 2.0).astype(np.float32)
    return centre, float(np.sqrt(((corners - centre[:, None]) ** 2).sum(axis=0).max()))

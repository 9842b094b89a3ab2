"""A ring of sonars: each hears the nearest echo out of a cone, and not every echo comes back.

A wall hit at a slant reflects the sound away (specular reflection), so that the sonar hears something
farther off or nothing. What it hears is noisy, comes in centimetres, and lies between a nearest and a
farthest range.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from sim.physics.camera import Array
from sim.signals import RangeScan


@dataclass(frozen=True, eq=False)
class Beams:
    """Rays in the robot's frame: starts and directions, both (n, 3), and how far they reach."""

    starts: Array
    directions: Array
    reach: float


@dataclass(frozen=True, eq=False)
class Echoes:
    """What rays met: distance (n,) in metres, infinite for nothing; angle of incidence (n,)."""

    distance: Array
    incidence: Array


class Sonar:
    """A ring of sonars at `angles` from the heading, on a circle of radius `ring`, at some height."""

    nearest, farthest = 0.12, 4.0
    cone = math.radians(25.0)
    rays_per_cone = 5
    slant = math.radians(65.0)
    drop_out = 0.01
    quantum = 0.01

    def __init__(self, angles: tuple[float, ...], ring: float, height: float, chance: np.random.Generator) -> None:
        self.angles, self.ring, self._chance = angles, ring, chance
        fan = np.linspace(-self.cone / 2, self.cone / 2, self.rays_per_cone)
        axes = np.repeat(np.asarray(angles), self.rays_per_cone)
        rays = axes + np.tile(fan, len(angles))
        starts = np.stack([ring * np.cos(axes), ring * np.sin(axes), np.full(len(axes), height)], axis=1)
        directions = np.stack([np.cos(rays), np.sin(rays), np.zeros(len(rays))], axis=1)
        self.beams = Beams(starts, directions, self.farthest)

    def hear(self, echoes: Echoes) -> RangeScan:
        """Return what the sonars make of the echoes along `beams`; ranges count from the robot's axis."""
        heard = np.where(echoes.incidence > self.slant, np.inf, echoes.distance)
        nearest = heard.reshape(len(self.angles), self.rays_per_cone).min(axis=1)
        # Every cone draws its numbers, heard or not: the stream does not depend on what stands about.
        noise = self._chance.normal(0.0, 1.0, len(nearest))
        dropped = self._chance.random(len(nearest)) < self.drop_out
        finite = np.minimum(nearest, self.farthest)
        noisy = finite + noise * (0.01 + 0.01 * finite)
        ranges = np.clip(np.round(noisy / self.quantum) * self.quantum, self.nearest, self.farthest)
        ranges[dropped | (nearest >= self.farthest)] = self.farthest
        return {
            "angles": list(self.angles),
            "ranges": (ranges + self.ring).tolist(),
            "max_range": self.farthest + self.ring,
        }

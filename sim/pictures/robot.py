"""Astrid as she is drawn: the measures are those of the simulated robot, the looks those of a PeopleBot."""

from __future__ import annotations

import math

import numpy as np

from sim.pictures.mesh import Material, Solid, ball, box, cone, upright
from sim.robot.astrid import PLATE_HEIGHT, SONAR_ANGLES, SONAR_HEIGHT, SONAR_RING, TRACK, WHEEL_RADIUS

RED = Material("#c8262b", gloss=0.5)
BLACK = Material("#1d1f24", gloss=0.35)
RUBBER = Material("#26282d")
METAL = Material("#aab0ba", gloss=0.6)
GOLD = Material("#c9a24a", gloss=0.5)
MAGENTA = Material("#ff00ff")
CYAN = Material("#00ffff")

SIDEWAYS = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""Axes of a round solid that lies on its side, along y."""


def robot() -> list[Solid]:
    """Return Astrid's solids, where she stands at the origin and faces along x."""
    solids: list[Solid] = [
        cone(BLACK, (0, 0, 0.045), 0.035, 0.150, 0.172),
        cone(RED, (0, 0, 0.080), 0.155, 0.186, 0.200),
        cone(BLACK, (0, 0, 0.235), 0.075, 0.198, 0.198),
        cone(RED, (0, 0, 0.310), 0.022, 0.200, 0.186),
        cone(RED, (0, 0, 0.332), 0.020, 0.186, 0.110),
        cone(BLACK, (0, 0, 0.345), 0.040, 0.095, 0.066),
        cone(BLACK, (0, 0, 0.380), 0.545, 0.058, 0.052),
        cone(METAL, (0, 0, 0.600), 0.012, 0.060, 0.060),
        cone(BLACK, (0, 0, 0.920), 0.020, 0.070, 0.120),
        cone(RED, (0, 0, 0.940), 0.030, 0.120, 0.142),
        cone(RED, (0, 0, 0.970), 0.085, 0.142, 0.138),
        cone(RED, (0, 0, 1.055), 0.022, 0.138, 0.105),
        cone(METAL, (0, 0, 1.075), PLATE_HEIGHT - 0.02 - 1.075, 0.030, 0.030),
        box(MAGENTA, (0.085, 0, PLATE_HEIGHT - 0.01), (0.17, 0.30, 0.02), 0.002),
        box(CYAN, (-0.085, 0, PLATE_HEIGHT - 0.01), (0.17, 0.30, 0.02), 0.002),
        box(BLACK, (0.125, 0, 1.008), (0.05, 0.15, 0.058), 0.012),
    ]
    for side in (-1, 1):
        foot = (0.0, side * TRACK / 2 - 0.024, WHEEL_RADIUS)
        solids.append(cone(RUBBER, foot, 0.048, WHEEL_RADIUS, WHEEL_RADIUS, SIDEWAYS))
        hub = (0.0, side * TRACK / 2 - 0.027, WHEEL_RADIUS)
        solids.append(cone(METAL, hub, 0.054, 0.055, 0.055, SIDEWAYS))
        solids.append(ball(METAL, (0.148, side * 0.036, 1.008), (0.012, 0.022, 0.022)))
        solids.append(ball(RUBBER, (side * 0.16, 0, 0.036), (0.035, 0.035, 0.035)))
    for angle in SONAR_ANGLES:
        ring = SONAR_RING - 0.013
        centre = (ring * math.cos(angle), ring * math.sin(angle), SONAR_HEIGHT - 0.008)
        solids.append(ball(GOLD, centre, (0.007, 0.021, 0.021), upright(angle)))
    return solids

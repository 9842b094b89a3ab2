"""Astrid's measures in metres and radians, as far as programs need them; the whole robot is `astrid.urdf`."""

from __future__ import annotations

import math
from pathlib import Path

URDF = Path(__file__).parent / "astrid.urdf"

WHEEL_RADIUS = 0.0975
TRACK = 0.33
"""Distance between the points where the wheels touch the floor."""
WHEEL_TORQUE = 6.0
"""What a motor can do, in newton metres."""

RADIUS = 0.265
"""Of the smallest upright cylinder about her; the wheels stick out of the hull."""

SONAR_ANGLES = tuple(math.radians(22.5 * k) for k in range(-7, 9))
"""Sixteen sonars all round, from -157.5 to 180 degrees."""
SONAR_RING = 0.21
"""Radius of the ring of sonars, a centimetre outside the hull."""
SONAR_HEIGHT = 0.28

PLATE_HEIGHT = 1.12
"""Height of the plate of two colours, magenta in front, cyan behind."""

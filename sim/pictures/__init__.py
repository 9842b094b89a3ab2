"""Pictures of a finished run: stills, a film, configuration diagrams and the tracker's view.

They need numpy and Pillow, and no PyBullet: the apartment's solids are looked at by closed formulas (`solids`),
lit by shadow maps (`light`) and summed over several exposures (`stage`). So pictures can be drawn wherever
Python runs, edges and normals are exact, and parallel views, which TinyRenderer cannot draw, cost nothing.
"""

from sim.pictures.album import QUALITIES, Progress, Quality, draw
from sim.pictures.record import Failure, RunRecord, Sample, Sight, Supply
from sim.pictures.wiring import Link, Part, Port, Wiring

__all__ = [
    "QUALITIES",
    "Failure",
    "Link",
    "Part",
    "Port",
    "Progress",
    "Quality",
    "RunRecord",
    "Sample",
    "Sight",
    "Supply",
    "Wiring",
    "draw",
]

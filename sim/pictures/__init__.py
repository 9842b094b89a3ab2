"""Pictures of a finished run: stills, a film, configuration diagrams and the tracker's view.

Solids are rendered by Mitsuba and denoised by Open Image Denoise, diagrams are laid out by Graphviz, everything flat
is drawn as SVG and rendered by resvg; `docs/decisions/0003-pictures.md` says what else was tried.
"""

from sim.pictures.record import CameraImage, Failure, RunRecord, Sample, Supply
from sim.pictures.run_pictures import QUALITIES, Progress, Quality, draw
from sim.pictures.wiring import Link, Part, Wiring

__all__ = [
    "QUALITIES",
    "CameraImage",
    "Failure",
    "Link",
    "Part",
    "Progress",
    "Quality",
    "RunRecord",
    "Sample",
    "Supply",
    "Wiring",
    "draw",
]

"""All pictures of a run, drawn in one go and written to a directory."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product
from pathlib import Path

from PIL import Image

from sim.home.apartment import Apartment
from sim.pictures import film, legend
from sim.pictures.camera_strip import strip
from sim.pictures.colours import to_screen
from sim.pictures.diagram import draw_wiring
from sim.pictures.floor import lay
from sim.pictures.house import extent, house
from sim.pictures.record import RunRecord
from sim.pictures.robot import robot
from sim.pictures.scene import Scene
from sim.pictures.svg import image, source
from sim.pictures.view_area import view_area
from sim.pictures.viewpoint import perspective, plan
from sim.robot.astrid import PLATE_HEIGHT

Progress = Callable[[str, float], None]
"""Hears what is being drawn, and the share (0..1) of all pictures that is done."""

STILL_LIMIT, FILM_LIMIT = 600_000, 900_000
"""Pictures are no larger than these numbers of bytes, if need be at the cost of fine shades."""


@dataclass(frozen=True)
class Quality:
    """How much care is taken: sizes in pixels, light paths a pixel, the floor's pixels a metre, the film's frames."""

    size: tuple[int, int] = (1200, 760)
    samples: int = 9
    density: float = 256.0
    film_size: tuple[int, int] = (760, 440)
    film_samples: int = 4
    film_density: float = 120.0
    frames: int = 54


QUALITIES = {
    "draft": Quality((600, 380), 1, 80.0, film_size=(300, 174), film_samples=1, film_density=50.0, frames=6),
    "fine": Quality(),
}


def draw(
    record: RunRecord,
    apartment: Apartment,
    out_dir: Path,
    quality: str | Quality = "fine",
    progress: Progress = lambda what, share: None,
) -> list[Path]:
    """Draw all pictures of a run into a directory, which is made if need be; return the paths of the files.

    These are `run-perspective.png`, `run-plan.png` and `run.webp`; `configuration-1.svg` and `.png` and so on for each
    wiring of the record; `tracker-view.png` if it has camera images. `quality` is a name in QUALITIES (KeyError) or a
    Quality. "fine" takes somewhat over a minute of one core, "draft" a tenth of that; both use all cores.
    """
    care = QUALITIES[quality] if isinstance(quality, str) else quality
    out_dir.mkdir(parents=True, exist_ok=True)
    progress("building the scene", 0.0)
    areas = [view_area(camera, apartment.walls, apartment.rooms, PLATE_HEIGHT) for camera in apartment.cameras]
    areas = [area for area in areas if area]
    coverings = [piece for piece in apartment.furniture if not piece.solid]
    ground, solids = extent(apartment), house(apartment)
    floor = lay(ground, apartment.rooms, coverings, areas, record, care.density)
    scene = Scene(solids, robot(), ground, floor.painted)
    scene.change(record.samples[-1])
    paths = []
    entries = legend.entries(record, seen=bool(areas))
    width, height = care.size
    # Room for a title above and a legend below.
    frame = (0.035 * width, legend.HEAD + 6.0, 0.965 * width, height - legend.FOOT - 14.0)
    for k, (name, viewpoint) in enumerate((("perspective", perspective), ("plan", plan))):
        progress(f"drawing the {name}", 0.1 + 0.25 * k)
        shown = to_screen(scene.picture(viewpoint(solids, care.size, frame), care.samples))
        page = legend.compose(Image.fromarray(shown), record, entries)
        paths.append(_save(page, out_dir / f"run-{name}.png"))
    progress("filming", 0.6)
    width, height = care.film_size
    view = perspective(solids, care.film_size, (14.0, 10.0, width - 14.0, height - 10.0))
    floor = lay(ground, apartment.rooms, coverings, areas, record, care.film_density)
    scene = Scene(solids, robot(), ground, floor.bare)

    def filming(share: float) -> None:
        progress("filming", 0.6 + 0.35 * share)

    frames = film.shoot(scene, floor, view, record, care.frames, care.film_samples, filming)
    paths.append(out_dir / "run.webp")
    film.save(frames, paths[-1], FILM_LIMIT)
    progress("drawing the diagrams", 0.96)
    for number, wiring in enumerate(record.wirings, 1):
        diagram = draw_wiring(wiring)
        paths.append(out_dir / f"configuration-{number}.svg")
        paths[-1].write_text(source(diagram), encoding="utf-8")
        paths.append(_save(image(diagram, 2.0).convert("RGB"), paths[-1].with_suffix(".png")))
    if record.sights:
        paths.append(_save(strip(record.sights), out_dir / "tracker-view.png"))
    progress("done", 1.0)
    return paths


def _save(picture: Image.Image, path: Path) -> Path:
    """Write a PNG below the limit: the finest shades go first, as they are hardly seen and noise packs badly."""
    for step, optimize in product((1, 2, 3, 4, 6, 8), (False, True)):  # to optimize takes ten times as long
        levels = [min(round(level / step) * step, 255) for level in range(255)] + [255]
        picture.point(levels * 3).save(path, optimize=optimize)
        if path.stat().st_size < STILL_LIMIT:
            break
    return path

"""The album of a run: every picture of it, drawn in one go and written to a directory."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from PIL import Image

from sim.apartment import Apartment
from sim.astrid import PLATE_HEIGHT
from sim.pictures import film, page, still
from sim.pictures.diagram import draw_wiring
from sim.pictures.floor import lay
from sim.pictures.house import extent, house
from sim.pictures.ink import image, svg
from sim.pictures.palette import to_screen
from sim.pictures.record import RunRecord
from sim.pictures.robot import robot, shade
from sim.pictures.sight import view_area
from sim.pictures.stage import Actor, Stage
from sim.pictures.strip import strip
from sim.pictures.wiring import Wiring

Progress = Callable[[str, float], None]
"""Hears what is being drawn, and the share (0..1) of the album that is done."""

STILL_LIMIT = 600_000
FILM_LIMIT = 900_000
"""Pictures are no larger than these numbers of bytes, if need be at the cost of fine shades."""


@dataclass(frozen=True)
class Quality:
    """How much care is taken: sizes in pixels, exposures and sky lamps per exposure, the floor's pixels a metre.

    `map_step` is the size in metres of a pixel of the shadow maps; `film_exposures` is at most `exposures`.
    """

    size: tuple[int, int] = (1200, 760)
    exposures: int = 16
    skies: int = 5
    density: float = 320.0
    map_step: float = 0.008
    film_size: tuple[int, int] = (760, 440)
    film_exposures: int = 6
    frames: int = 54


QUALITIES = {
    "draft": Quality(
        exposures=2, skies=6, density=200.0, map_step=0.012, film_exposures=1, film_size=(640, 370), frames=16
    ),
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
    Quality. "fine" takes about a minute of one core, "draft" some seconds.
    """
    care = QUALITIES[quality] if isinstance(quality, str) else quality
    out_dir.mkdir(parents=True, exist_ok=True)
    progress("lighting the apartment", 0.0)
    areas = [view_area(camera, apartment.walls, apartment.rooms, PLATE_HEIGHT) for camera in apartment.cameras]
    areas = [area for area in areas if area]
    coverings = [piece for piece in apartment.furniture if not piece.solid]
    floor = lay(extent(apartment), apartment.rooms, coverings, areas, record, care.density)
    stage = Stage.lit(house(apartment), floor, care.exposures, care.skies, care.map_step)
    paths = []
    legend = page.entries(record, seen=bool(areas))
    for k, (name, viewpoint) in enumerate((("perspective", still.perspective), ("plan", still.plan))):
        progress(f"drawing the {name}", 0.08 + 0.25 * k)
        picture = _still(stage, record, viewpoint, care.size)
        paths.append(_save(page.compose(picture, record, legend), out_dir / f"run-{name}.png"))
    paths.append(out_dir / "run.webp")
    _film(stage, record, care, paths[-1], lambda share: progress("filming", 0.6 + 0.35 * share))
    progress("drawing the diagrams", 0.96)
    for number, wiring in enumerate(record.wirings, 1):
        paths += _diagram(wiring, out_dir / f"configuration-{number}.svg")
    if record.sights:
        paths.append(_save(strip(record.sights), out_dir / "tracker-view.png"))
    progress("done", 1.0)
    return paths


def _still(stage: Stage, record: RunRecord, viewpoint: still.Viewpoint, size: tuple[int, int]) -> Image.Image:
    """Return what the run looks like at its end, with room for a title above and a legend below."""
    width, height = size
    frame = (0.035 * width, page.HEAD + 6.0, 0.965 * width, height - page.FOOT - 14.0)
    last = record.samples[-1]
    view = viewpoint(stage.solids, size, frame)
    return Image.fromarray(to_screen(stage.picture(view, Actor(robot(last), shade(last)))))


def _film(stage: Stage, record: RunRecord, care: Quality, path: Path, progress: Callable[[float], None]) -> None:
    width, height = care.film_size
    view = still.perspective(stage.solids, care.film_size, (14.0, 10.0, width - 14.0, height - 10.0))
    frames = film.shoot(stage.quicker(care.film_exposures), view, record, care.frames, progress)
    film.save(frames, path, FILM_LIMIT)


def _diagram(wiring: Wiring, path: Path) -> list[Path]:
    drawing = draw_wiring(wiring)
    path.write_text(svg(drawing), encoding="utf-8")
    return [path, _save(image(drawing), path.with_suffix(".png"))]


def _save(picture: Image.Image, path: Path) -> Path:
    """Write a PNG below the limit: the finest shades go first, as nobody sees them and noise packs badly."""
    for step in (1, 2, 3, 4, 6, 8):
        levels = [min(round(level / step) * step, 255) for level in range(255)] + [255]
        picture.point(levels * 3).save(path, optimize=True)
        if path.stat().st_size < STILL_LIMIT:
            break
    return path

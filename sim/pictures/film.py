"""The film of a run: Astrid drives, her path grows behind her, and a FAIL flashes.

The empty scene is rendered twice, without the run's paint and with all of it, and each frame takes every pixel from one
of the two. Only a window round Astrid, as far as she and her shadow reach, is rendered anew.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
from PIL import Image

from sim.pictures.colours import FAIL, GREY, PAPER, to_screen
from sim.pictures.floor import Floor, trail
from sim.pictures.legend import ENTRY, Entry, fade, over, swatch
from sim.pictures.mesh import Array
from sim.pictures.record import Failure, RunRecord, Sample
from sim.pictures.scene import SUN_FROM, Scene
from sim.pictures.svg import Style, add, badge, document, points, shortened, write
from sim.pictures.viewpoint import Viewpoint, Window
from sim.robot.astrid import PLATE_HEIGHT, RADIUS

FRAME_TIME, LAST_TIME = 0.11, 1.8
"""How long a frame shows, and how long the last, in seconds."""
FLASH = 7
"""Frames that a FAIL is held for."""
CAPTION = 44
"""Height in pixels of the caption below the scene."""


@dataclass(frozen=True)
class Moment:
    """A frame of the film: a time of the run, and how far (0..1) the flash of a failure has spread, if one does."""

    time: float
    failure: Failure | None = None
    spread: float = 0.0


def moments(run: RunRecord, count: int) -> list[Moment]:
    """Return the frames of the film: `count` of them evenly through the run, and a few more for each failure."""
    step = (run.end - run.start) / max(count - 1, 1)
    times = [run.start + k * step for k in range(max(count, 2))]
    found = [Moment(time) for time in times]
    for failure in run.failures:
        found += [Moment(failure.time, failure, (k + 0.5) / FLASH) for k in range(FLASH)]
    return sorted(found, key=lambda moment: (moment.time, moment.spread))


def shoot(
    scene: Scene,
    floor: Floor,
    view: Viewpoint,
    run: RunRecord,
    count: int,
    samples: int,
    progress: Callable[[float], None],
) -> list[Image.Image]:
    """Return the frames of a run's film, with captions; `progress` hears the share that is done."""
    scene.change(None, floor.painted)
    painted = scene.picture(view, 2 * samples)
    scene.change(None, floor.bare)
    empty = scene.picture(view, 2 * samples)
    # The largest scale of the floor anywhere in the picture: what lies nearest to the eye.
    scale = view.zoom / float(np.linalg.norm(view.eye) * 0.6)

    def place(x: float, y: float) -> tuple[float, float]:
        column, row = view.project(np.array([[x, y, 0.0]]))[0]
        return float(column), float(row)

    @lru_cache(maxsize=1)  # time stands still while a FAIL flashes
    def shown(time: float) -> Image.Image:
        at = run.at(time)
        whole = np.where(trail(run, time, view.size, place, scale)[..., None], painted, empty)
        left, top, right, bottom = window = _reach(view, at)
        if right > left and bottom > top:
            scene.change(at, floor.until(run, time))
            drawn, part = scene.picture(view, samples, window), whole[top:bottom, left:right]
            part += (drawn - part) * _feather(drawn.shape[:2])
        return Image.fromarray(to_screen(whole))

    shots = moments(run, count)
    frames: list[Image.Image] = []
    for k, moment in enumerate(shots):
        frames.append(_captioned(shown(moment.time), view, run, moment))
        progress((k + 1) / len(shots))
    return frames


def save(frames: list[Image.Image], path: Path, limit: int) -> None:
    """Write an animated WebP that loops, in the best quality that stays below a limit in bytes."""
    times = [round(FRAME_TIME * 1000)] * (len(frames) - 1) + [round(LAST_TIME * 1000)]
    for quality in (80, 66, 50, 35, 20):
        frames[0].save(path, save_all=True, append_images=frames[1:], duration=times, loop=0, quality=quality, method=4)
        if path.stat().st_size < limit:
            return


def _reach(view: Viewpoint, at: Sample) -> Window:
    """Return the window that holds Astrid, her shadow, and what she darkens."""
    fall = PLATE_HEIGHT / SUN_FROM[2]
    reached = []
    for x, y in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
        reached.append((at.x + x * 0.6, at.y + y * 0.6, 0.0))
        reached.append((at.x + x * RADIUS, at.y + y * RADIUS, PLATE_HEIGHT + 0.02))
        reached.append((at.x + x * RADIUS - fall * SUN_FROM[0], at.y + y * RADIUS - fall * SUN_FROM[1], 0.0))
    return view.window(np.array(reached), margin=8)


def _feather(shape: tuple[int, int]) -> Array:
    """Return weights (h, w, 1) that rise from 0 at the border to 1 within a few pixels."""
    rows, columns = (np.minimum(np.arange(n), np.arange(n)[::-1]) / 8.0 for n in shape)
    return np.clip(np.minimum(rows[:, None], columns[None, :]), 0.0, 1.0).astype(np.float32)[..., None]


def words(run: RunRecord, time: float) -> str:
    """What supplies the pose at a time, or what is done while nothing does."""
    source = run.source(time)
    if source:
        return f"pose from {source}"
    if any(failure.time <= time for failure in run.failures):
        return "reconfiguring"
    return "configuring" if any(supply.start > time for supply in run.supplies) else "on the way"


def _captioned(scene: Image.Image, view: Viewpoint, run: RunRecord, moment: Moment) -> Image.Image:
    """Return the frame with a caption below: what supplies the pose, or what failed, and the time."""
    frame = Image.new("RGB", (scene.width, scene.height + CAPTION), PAPER)
    frame.paste(scene, (0, 0))
    root = document(*frame.size)
    fade(root, 38, CAPTION + 26, 12)
    base, room = frame.height - 17.0, frame.width - 160.0
    if moment.failure is not None:
        for share in (moment.spread, moment.spread - 0.35):
            if share > 0.0:
                turn, radius = np.linspace(0.0, math.tau, 97), 0.15 + 0.75 * share
                x, y = moment.failure.x + radius * np.cos(turn), moment.failure.y + radius * np.sin(turn)
                ring = view.project(np.stack([x, y, 0.0 * turn], axis=1)).tolist()
                line = {"stroke": FAIL, "stroke_width": 4, "stroke_opacity": (1.0 - share) ** 0.7}
                add(root, "polygon", points=points(ring), fill="none", **line)
        loud = Style(15, PAPER, bold=True)
        badge(root, 16, base, shortened(f"FAIL: {moment.failure.reason}".rstrip(": "), loud, room), FAIL, loud)
    else:
        source = run.source(moment.time)
        swatch(root, 18, base - 5, Entry("line", run.colours()[source] if source else GREY, ""))
        write(root, 62, base, shortened(words(run, moment.time), ENTRY, room), ENTRY)
    write(root, frame.width - 18, base, f"{moment.time - run.start:.1f} s", Style(15), "end")
    return over(frame, root)

"""The film of a run: Astrid drives, her path grows behind her, and a FAIL flashes.

The empty set is drawn twice, without any paint and with all of it; where paint shows at which moment is known, so
each frame takes every pixel from one of the two. Only a window round Astrid, as far as she and her shadow reach, is
drawn anew, by the same exposures: outside the window nothing changes, so no seam can be seen.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from sim.astrid import PLATE_HEIGHT, RADIUS
from sim.pictures.arrays import Array, Window
from sim.pictures.floor import path_colours
from sim.pictures.lettering import Style, shortened, width, write
from sim.pictures.light import SUN_FROM
from sim.pictures.page import ENTRY, Entry, faded, swatch
from sim.pictures.palette import FAIL, GREY, INK, PAPER, rgb, to_screen
from sim.pictures.record import Failure, RunRecord, Sample
from sim.pictures.robot import robot, shade
from sim.pictures.stage import Actor, Stage
from sim.pictures.view import View

FRAME_TIME = 0.11
"""How long a frame shows, in seconds."""
LAST_TIME = 1.8
FLASH = 7
"""Frames that a FAIL is held for."""
CAPTION = 44
"""Height in pixels of the caption below the scene."""
_FINE = 3


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


def shoot(stage: Stage, view: View, run: RunRecord, count: int, progress: Callable[[float], None]) -> list[Image.Image]:
    """Return the frames of a run's film, with captions; `progress` hears the share that is done."""
    empty, painted, laid = stage.picture(view, time=-math.inf), stage.picture(view), stage.moments(view)
    shots = moments(run, count)
    frames: list[Image.Image] = []
    for k, moment in enumerate(shots):
        at = run.at(moment.time)
        scene = np.where((laid <= moment.time)[..., None], painted, empty)
        window = _reach(view, at)
        drawn = stage.picture(view.cropped(window), Actor(robot(at), shade(at)), moment.time)
        scene[window] += (drawn - scene[window]) * _feather(drawn.shape[:2])
        frame = Image.fromarray(to_screen(scene))
        if moment.failure is not None:
            frame = _flash(frame, view, moment.failure, moment.spread)
        frames.append(_captioned(frame, run, moment))
        progress((k + 1) / len(shots))
    return frames


def save(frames: list[Image.Image], path: Path, limit: int) -> None:
    """Write an animated WebP that loops, in the best quality that stays below a limit in bytes."""
    times = [round(FRAME_TIME * 1000)] * (len(frames) - 1) + [round(LAST_TIME * 1000)]
    for quality in (80, 66, 50, 35, 20):
        frames[0].save(path, save_all=True, append_images=frames[1:], duration=times, loop=0, quality=quality, method=4)
        if path.stat().st_size < limit:
            return


def _reach(view: View, at: Sample) -> Window:
    """Return the window that holds Astrid, her shadow, and what she darkens."""
    fall = PLATE_HEIGHT / SUN_FROM[2]
    points = []
    for x, y in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
        points.append((at.x + x * 0.6, at.y + y * 0.6, 0.0))
        points.append((at.x + x * RADIUS, at.y + y * RADIUS, PLATE_HEIGHT + 0.02))
        points.append((at.x + x * RADIUS - fall * SUN_FROM[0], at.y + y * RADIUS - fall * SUN_FROM[1], 0.0))
    return view.window(np.array(points).T, margin=6)


def _feather(shape: tuple[int, int]) -> Array:
    """Return weights (h, w, 1) that rise from 0 at the border to 1 within a few pixels."""
    rows, columns = (np.minimum(np.arange(n), np.arange(n)[::-1]) / 6.0 for n in shape)
    return np.clip(np.minimum(rows[:, None], columns[None, :]), 0.0, 1.0).astype(np.float32)[..., None]


def _flash(frame: Image.Image, view: View, failure: Failure, spread: float) -> Image.Image:
    """Return the frame with rings that spread over the floor from where something failed."""
    veil = Image.new("L", (frame.width * _FINE, frame.height * _FINE))
    draw = ImageDraw.Draw(veil)
    for lag in (0.0, 0.35):
        share = spread - lag
        if share > 0.0:
            turn = np.linspace(0.0, math.tau, 97)
            radius = 0.15 + 0.75 * share
            circle = np.stack([failure.x + radius * np.cos(turn), failure.y + radius * np.sin(turn), 0.0 * turn])
            columns, rows, _ = view.project(circle)
            line = [(float(x) * _FINE, float(y) * _FINE) for x, y in zip(columns, rows, strict=True)]
            draw.line(line, fill=round(255 * (1.0 - share) ** 0.7), width=4 * _FINE, joint="curve")
    mask = veil.resize(frame.size, Image.Resampling.BOX)
    return Image.composite(Image.new("RGB", frame.size, rgb(FAIL)), frame, mask)


def _captioned(scene: Image.Image, run: RunRecord, moment: Moment) -> Image.Image:
    """Return the frame with a caption below: who supplies the pose, or what failed, and the time."""
    frame = Image.new("RGB", (scene.width, scene.height + CAPTION), PAPER)
    frame.paste(faded(scene, 4, 20, 12), (0, 0))
    base = frame.height - 17.0
    room = frame.width - 160.0
    if moment.failure is not None:
        text = shortened(f"FAIL: {moment.failure.reason}".rstrip(": "), _LOUD, room)
        draw = ImageDraw.Draw(frame)
        draw.rounded_rectangle((16, base - 20, 16 + width(text, _LOUD) + 24, base + 9), 14, fill=rgb(FAIL))
        write(frame, 28, base, text, _LOUD)
    else:
        source = run.source(moment.time)
        failed = any(failure.time <= moment.time for failure in run.failures)
        colour = GREY if source is None else path_colours(run)[source]
        swatch(frame, 18, base - 5, Entry("line", colour, ""))
        words = f"pose from {source}" if source else "reconfiguring" if failed else "on the way"
        write(frame, 62, base, shortened(words, ENTRY, room), ENTRY)
    write(frame, frame.width - 18, base, f"{moment.time - run.start:.1f} s", Style(15, INK), "right")
    return frame


_LOUD = Style(15, PAPER, weight=1.0, tracking=0.01)

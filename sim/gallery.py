"""From a finished demo to its pictures. It loads what draws them, which is an extra."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from selfconf.model.term import IRI
from sim.account import Account, short
from sim.home.apartment import Apartment, read_apartment
from sim.outcome import GOAL
from sim.peis_home import standing_point
from sim.pictures import CameraImage, Failure, Link, Part, RunRecord, Sample, Supply, Wiring, draw

SPOKEN = {"tracker": "the person tracker", "odometry": "odometry"}
COMPOSITE = "the position service"
"""What a tracker is called that is in a composite."""


def draw_run(account: Account, record: Path, out: Path, quality: str, progress: Callable[[str], None]) -> list[Path]:
    """Draw every picture of the run; the paths written."""
    apartment = read_apartment()
    with np.load(record) as logbook:
        run = run_record(account, apartment, dict(logbook))
    last = ""

    def tell(*step: Any) -> None:
        nonlocal last
        word = str(step[0]) if step else ""
        if word not in (last, "done"):
            last = word
            progress(f"pictures: {word}")

    return draw(run, apartment, out, quality=quality, progress=tell)


def run_record(account: Account, apartment: Apartment, logbook: dict[str, NDArray[Any]]) -> RunRecord:
    """What pictures are drawn from: the lines of the processes of a demo, and what its world has recorded."""
    times, poses = logbook["times"], logbook["poses"]
    samples = tuple(Sample(float(t), float(x), float(y), float(a)) for t, (x, y, a) in zip(times, poses, strict=True))
    spoken = {**SPOKEN, "tracker": COMPOSITE} if account.eyes else SPOKEN
    supplies = tuple(_supplies(times, logbook["sources"], spoken))
    failures: tuple[Failure, ...] = ()
    tracked = [supply for supply in supplies if supply.component == spoken["tracker"]]
    if account.loss and tracked:
        at = samples[int(np.searchsorted(times, tracked[-1].end))]
        failures = (Failure(at.time, at.x, at.y, spoken["tracker"], account.loss["detail"]),)
    stand = standing_point(apartment, GOAL)
    return RunRecord(
        samples,
        supplies,
        failures,
        (stand.x, stand.y),
        tuple(_sights(logbook)),
        tuple(_wirings(account)),
        "Astrid goes to the bedroom",
        "The tracker loses her at the edge of its view; odometry takes over.",
    )


def _supplies(times: NDArray[np.float64], sources: NDArray[np.str_], spoken: Mapping[str, str]) -> Iterator[Supply]:
    start = 0
    for index in range(1, len(times) + 1):
        if index == len(times) or sources[index] != sources[start]:
            if sources[start]:
                yield Supply(spoken[str(sources[start])], float(times[start]), float(times[min(index, len(times) - 1)]))
            start = index


def _sights(logbook: dict[str, NDArray[Any]]) -> Iterator[CameraImage]:
    for time, image, pose in zip(logbook["sight_times"], logbook["sight_images"], logbook["sight_poses"], strict=True):
        lost = bool(np.isnan(pose[0]))
        x, y, theta = (float(value) for value in pose)
        words = "lost" if lost else f"x {x:.2f} m, y {y:.2f} m, {math.degrees(theta):.0f}°"
        yield CameraImage(image, float(time), words, lost)


def _wirings(account: Account) -> Iterator[Wiring]:
    lost = account.loss["component"] if account.loss else None
    before: set[str] = set()
    for title, configuration in zip(("before the failure", "after the failure"), account.around_loss(), strict=False):
        components = {c: role["role"] for role in configuration["roles"] for c in role["components"]}
        links = [
            Link(short(c["from"]["component"]), c["from"]["output"], short(c["to"]["component"]), c["to"]["input"])
            for c in configuration["connections"]
        ]
        parts = tuple(
            Part(
                short(component),
                IRI(role).short,
                tuple(dict.fromkeys(link.input for link in links if link.sink == short(component))),
                tuple(dict.fromkeys(link.output for link in links if link.source == short(component))),
                failed=component == lost,
                fresh=bool(before) and component not in before,
            )
            for component, role in components.items()
        )
        before = set(components)
        yield Wiring(title, parts, tuple(links))

"""Families of stations, relays and sensors that have to cover what there is."""

from __future__ import annotations

import math
import random

from benchmarks.search.families.wiring import counted, iri, made, profile
from selfconf.model.partition import Candidate
from selfconf.search.problem import Problem


def cover(signals: int, stations: int, most: int, share: float, seed: int) -> Problem:
    """So many stations of a role that together issue all the signals that one sink wants."""
    rng = random.Random(seed)
    some = [[s for s in range(signals) if rng.random() < share] for _ in range(stations)]
    parts = [Candidate(profile(f"station{k:03}", (), issued)) for k, issued in enumerate(some)]
    return counted([parts, [Candidate(profile("sink", range(signals)))]], [most, 1], [(0, 1)])


def relay_chain(hops: int, relays: int, reach: float, seed: int) -> Problem:
    """A chain of relays of one pool, scattered on a square, from one corner to the opposite one; none is used twice."""
    rng = random.Random(seed)
    places = [(rng.random(), rng.random()) for _ in range(relays)]
    heard = [[k for k in range(relays) if k != n and math.dist(places[k], places[n]) < reach] for n in range(relays)]
    pool = [Candidate(profile(f"relay{k:03}", [f"to{k}"], [f"to{n}" for n in heard[k]])) for k in range(relays)]
    near = [k for k in range(relays) if math.dist(places[k], (0, 0)) < 1.3 * reach]
    far = [k for k in range(relays) if math.dist(places[k], (1, 1)) < 1.3 * reach]
    last = [Candidate(profile(f"relay{k:03}", [f"to{k}"], ["goal"])) for k in far]
    base = Candidate(profile("base", (), [f"to{k}" for k in near]))
    parts = [[base], *[pool] * hops, last, [Candidate(profile("goal", ["goal"]))]]
    return made(parts, [(role, role + 1) for role in range(len(parts) - 1)])


def fields(places: int, sensors: int, cameras: int, lidars: int, seed: int) -> Problem:
    """So many cameras and lidars, of some scattered on a square, that see all places on it that any of them sees."""
    rng = random.Random(seed)
    there = [(rng.random(), rng.random()) for _ in range(places)]

    def scattered(sort: str, reach: float) -> list[Candidate]:
        found = []
        for k in range(sensors):
            here = (rng.random(), rng.random())
            seen = [f"{sort}{t}" for t in range(places) if math.dist(here, there[t]) < reach]
            found.append(Candidate(profile(f"{sort}{k:03}", (), seen)))
        return found

    sorts = {"camera": scattered("camera", 0.3), "lidar": scattered("lidar", 0.35)}
    issued = {port.signals[0] for some in sorts.values() for one in some for port in one.profile.outputs}
    wanted = [f"{sort}{t}" for sort in sorts for t in range(places) if iri(f"{sort}{t}") in issued]
    return counted([*sorts.values(), [Candidate(profile("sink", wanted))]], [cameras, lidars, 1], [(0, 2), (1, 2)])

"""Families of stations, relays, sensors, dominoes and triples that have to cover what there is."""

from __future__ import annotations

import math
import random
from itertools import combinations

from benchmarks.search.families.wiring import counted, iri, made, profile
from selfconf.model.partition import ANY_VALUE, Candidate, Variable
from selfconf.search.problem import Problem


def cover(signals: int, stations: int, most: int, share: float, seed: int) -> Problem:
    """So many stations of a role that together issue all the signals that one sink wants."""
    rng = random.Random(seed)
    some = [[s for s in range(signals) if rng.random() < share] for _ in range(stations)]
    parts = [Candidate(profile(f"station{k:03}", (), issued)) for k, issued in enumerate(some)]
    return counted([parts, [Candidate(profile("sink", range(signals)))]], [most, 1], [(0, 1)])


def tiling(side: int, holes: int, seed: int, fair: bool = True) -> Problem:
    """Dominoes that cover a board of which fields are missing, as many of both colours, or else of one alone.

    A field is a free parameter: its value says in which direction the other half of its domino lies.
    """
    rng = random.Random(seed)
    board = [(row, column) for row in range(side) for column in range(side)]
    black, white = ([one for one in board if sum(one) % 2 == colour] for colour in (0, 1))
    missing = {*rng.sample(black, holes), *(rng.sample(white, holes) if fair else ())}
    place = {field: number for number, field in enumerate(one for one in board if one not in missing)}
    some = []
    for (row, column), number in place.items():
        for direction, other in enumerate(((row, column + 1), (row + 1, column))):
            if other in place:
                masks = [ANY_VALUE] * len(place)
                masks[number], masks[place[other]] = 1 << direction, 1 << direction + 2
                some.append(Candidate(profile(f"domino{number:03}.{direction}"), tuple(masks)))
    rng.shuffle(some)
    return counted([some], [len(place) // 2], (), _variables("field", len(place), 4))


def triples(points: int, number: int, seed: int) -> Problem:
    """So many triples of some points, of which no two have two points in common.

    A pair of points is a free parameter: its value is the third point of its triple.
    """
    rng = random.Random(seed)
    name = rng.sample(range(points), points)
    pairs = {pair: k for k, pair in enumerate(combinations(range(points), 2))}
    some = []
    for triple in combinations(range(points), 3):
        masks = [ANY_VALUE] * len(pairs)
        for third in triple:
            a, b = (point for point in triple if point != third)
            masks[pairs[a, b]] = 1 << third
        some.append(Candidate(profile("triple" + ".".join(f"{name[point]:02}" for point in triple)), tuple(masks)))
    rng.shuffle(some)
    return counted([some], [number], (), _variables("pair", len(pairs), points))


def _variables(name: str, number: int, values: int) -> tuple[Variable, ...]:
    return tuple(
        Variable(iri(f"{name}{k}"), tuple(iri(f"{name}{k}.{value}") for value in range(values))) for k in range(number)
    )


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

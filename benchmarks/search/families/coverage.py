"""Families of stations, relays, sensors, and pieces of one role that have to cover what there is."""

from __future__ import annotations

import math
import random
from collections.abc import Sequence
from itertools import combinations

from benchmarks.search.families.wiring import counted, iri, made, profile
from selfconf.model.partition import ANY_VALUE, Candidate, Variable
from selfconf.search.problem import Problem

NEAR = 0.25
"""From how near a sensor watches a place, where the square has sides of 1."""


def cover(signals: int, stations: int, most: int, share: float, seed: int) -> Problem:
    """So many stations of a role that together issue all the signals that one sink wants."""
    rng = random.Random(seed)
    some = [[s for s in range(signals) if rng.random() < share] for _ in range(stations)]
    parts = [Candidate(profile(f"station{k:03}", (), issued)) for k, issued in enumerate(some)]
    return counted([parts, [Candidate(profile("sink", range(signals)))]], [most, 1], [(0, 1)])


def watched(places: int, sensors: int, most: int, times: int, seed: int) -> Problem:
    """So many of some sensors in a square that each of some places is near to several of them."""
    rng = random.Random(seed)
    stand = [(rng.random(), rng.random()) for _ in range(sensors)]
    parts = [[Candidate(profile(f"sensor{k:02}", (), [f"on{k}"])) for k in rng.sample(range(sensors), sensors)]]
    for place in range(places):
        here = rng.random(), rng.random()
        by_distance = sorted(range(sensors), key=lambda sensor: math.dist(here, stand[sensor]))
        near = [sensor for sensor in by_distance if math.dist(here, stand[sensor]) < NEAR]
        parts.append(
            [
                Candidate(profile(f"place{place:02}.{sensor:02}", [f"on{sensor}"]))
                for sensor in sorted(near if len(near) > times else by_distance[: times + 1])
            ]
        )
    return counted(parts, [most] + [times] * places, [(0, 1 + place) for place in range(places)])


def tiling(side: int, holes: int, seed: int, fair: bool = True) -> Problem:
    """Dominoes that cover a board of which fields are missing, as many of both colours, or else of one alone.

    A field is a free parameter, of which each domino that could lie on it has a value of its own.
    """
    rng = random.Random(seed)
    board = [(row, column) for row in range(side) for column in range(side)]
    black, white = ([one for one in board if sum(one) % 2 == colour] for colour in (0, 1))
    missing = {*rng.sample(black, holes), *(rng.sample(white, holes) if fair else ())}
    place = {field: number for number, field in enumerate(one for one in board if one not in missing)}
    beside = [(number, ((row, column + 1), (row + 1, column))) for (row, column), number in place.items()]
    dominoes = [(number, place[other]) for number, others in beside for other in others if other in place]
    return _covering(len(place), dominoes, len(place) // 2, rng)


def triples(points: int, number: int, seed: int) -> Problem:
    """So many triples of some points, of which no two have two points in common.

    A pair of points is a free parameter, of which each triple with these points has a value of its own.
    """
    pairs = {pair: k for k, pair in enumerate(combinations(range(points), 2))}
    some = [[pairs[pair] for pair in combinations(triple, 2)] for triple in combinations(range(points), 3)]
    return _covering(len(pairs), some, number, random.Random(seed))


def trominoes(side: int, holes: int, seed: int) -> Problem:
    """Straight and bent trominoes that cover a board of which some fields are missing."""
    rng = random.Random(seed)
    board = [(row, column) for row in range(side) for column in range(side)]
    missing = set(rng.sample(board, holes))
    place = {field: number for number, field in enumerate(one for one in board if one not in missing)}
    pieces = []
    for row, column in board:
        square = [(row, column), (row, column + 1), (row + 1, column), (row + 1, column + 1)]
        bent = [[field for field in square if field != corner] for corner in square]
        pieces += [*bent, [(row, column + k) for k in range(3)], [(row + k, column) for k in range(3)]]
    on_board = [[place[field] for field in piece] for piece in pieces if all(field in place for field in piece)]
    return _covering(len(place), on_board, len(place) // 3, rng)


def couples(people: int, acquaintances: int, seed: int) -> Problem:
    """Pairs of people who know each other, of some each on average, in which all people take part."""
    rng = random.Random(seed)
    known: set[tuple[int, ...]] = set()
    while len(known) < people * acquaintances // 2:
        known.add(tuple(sorted(rng.sample(range(people), 2))))
    return _covering(people, sorted(known), people // 2, rng)


def trios(people: int, number: int, seed: int) -> Problem:
    """Groups of three people, of some that are known to go together, in which all people take part once."""
    rng = random.Random(seed)
    order = rng.sample(range(people), people)
    known = {tuple(sorted(order[k : k + 3])) for k in range(0, people, 3)}
    while len(known) < number:
        known.add(tuple(sorted(rng.sample(range(people), 3))))
    return _covering(people, sorted(known), people // 3, rng)


def _covering(places: int, pieces: Sequence[Sequence[int]], slots: int, rng: random.Random) -> Problem:
    """So many of some pieces, no two of which have a place in common: each has a value of its own of each place."""
    own = [0] * places
    some = []
    for number, piece in enumerate(pieces):
        masks = [ANY_VALUE] * places
        for place in piece:
            masks[place] = 1 << own[place]
            own[place] += 1
        some.append(Candidate(profile(f"piece{number:04}"), tuple(masks)))
    rng.shuffle(some)
    values = tuple(tuple(iri(f"place{k}.{value}") for value in range(max(own))) for k in range(places))
    return counted([some], [slots], (), tuple(Variable(iri(f"place{k}"), values[k]) for k in range(places)))


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

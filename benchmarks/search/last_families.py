"""Families that were made after `later_families`: what a template and its components ask of each other in other ways.

`LAST_CHOOSING` are those on which the search was changed once more, and `LAST_REPORTING` those on which that was only
measured.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Mapping, Sequence
from itertools import combinations, product

from benchmarks.search.families import iri, made, profile
from benchmarks.search.further_families import Family, counted, in_pairs
from selfconf.model.partition import ANY_VALUE, Candidate, Variable
from selfconf.search.problem import Problem


def knights(side: int, most: int, seed: int) -> Problem:
    """So many guards on a square with gaps that see every cell: their own one, and those a knight's move away."""
    rng = random.Random(seed)
    cells = [cell for cell in product(range(side), repeat=2) if rng.random() > 0.1]
    moves = [(0, 0), *[(a, b) for a, b in product((-2, -1, 1, 2), repeat=2) if abs(a) != abs(b)]]
    guards = [
        Candidate(profile(f"guard{k:03}", (), [f"{x + a}.{y + b}" for a, b in moves if (x + a, y + b) in cells]))
        for k, (x, y) in enumerate(rng.sample(cells, len(cells)))
    ]
    sink = [Candidate(profile("sink", [f"{x}.{y}" for x, y in cells]))]
    return counted([guards, sink], [most, 1], [(0, 1)])


def teams(count: int, size: int, people: int, skills: int, asked: int, seed: int) -> Problem:
    """Teams of one pool, nobody in two of them; each team has all the skills that its task asks for."""
    rng = random.Random(seed)
    pool = [
        Candidate(profile(f"person{k:03}", (), [f"skill{s}" for s in rng.sample(range(skills), 3)]))
        for k in range(people)
    ]
    free = [[person for person in pool if rng.random() < 0.6] for _ in range(count)]
    tasks = [
        [Candidate(profile(f"task{t:02}", [f"skill{s}" for s in rng.sample(range(skills), asked)]))]
        for t in range(count)
    ]
    return counted([*free, *tasks], [size] * count + [1] * count, [(team, count + team) for team in range(count)])


class Circuit:
    """Wires and gates as roles: what plays a wire says its bit, what plays a gate which bits it makes of which."""

    def __init__(self) -> None:
        self.parts: list[list[Candidate]] = []
        self.edges: list[tuple[int, int]] = []

    def wire(self) -> int:
        """Add a wire that may be either, and return its number."""
        return self.gate(lambda bit: bit, (), ways=((0,), (1,)))

    def gate(
        self,
        makes: Callable[..., int],
        wires: Sequence[int],
        wanted: int | None = None,
        ways: Sequence[tuple[int, ...]] | None = None,
    ) -> int:
        """Add a gate on some wires, of which a bit may be wanted, and return the number of the wire that it makes."""
        number = len(self.parts)
        ways = list(product((0, 1), repeat=len(wires))) if ways is None else ways
        self.parts.append(
            [
                Candidate(
                    profile(
                        f"gate{number:03}.{''.join(map(str, way))}",
                        [f"wire{wire}.{bit}" for wire, bit in zip(wires, way, strict=False)],
                        [f"wire{number}.{makes(*way)}"],
                    )
                )
                for way in ways
                if wanted in (None, makes(*way))
            ]
        )
        self.edges += [(wire, number) for wire in wires]
        return number

    def problem(self) -> Problem:
        """The problem of finding bits for all wires."""
        return made(self.parts, self.edges)


GATES: tuple[Callable[[int, int], int], ...] = (
    lambda x, y: x & y,
    lambda x, y: x | y,
    lambda x, y: x ^ y,
    lambda x, y: 1 - (x & y),
)


def circuit(inputs: int, gates: int, wanted: int, seed: int) -> Problem:
    """A random circuit whose last gates have to make what they make of hidden bits, so that it has a solution."""
    rng = random.Random(seed)
    built = Circuit()
    bits = [rng.randrange(2) for _ in range(inputs)]
    for _ in bits:
        built.wire()
    for number in range(inputs, inputs + gates):
        one, other = rng.sample(range(max(0, number - 12), number), 2)
        makes = rng.choice(GATES)
        bits.append(makes(bits[one], bits[other]))
        built.gate(makes, (one, other), bits[number] if number >= inputs + gates - wanted else None)
    return built.problem()


def quorum(roles: int, candidates: int, signals: int, sources: int, seed: int) -> Problem:
    """Roles that each hear some others at random, of which any may issue the two signals that a candidate wants."""
    rng = random.Random(seed)
    parts, edges = [], []
    for role in range(roles):
        heard = rng.sample([other for other in range(roles) if other != role], sources)
        edges += [(source, role) for source in sorted(heard)]
        parts.append(
            [
                Candidate(profile(f"c{role:03}.{k:02}", rng.sample(range(signals), 2), rng.sample(range(signals), 1)))
                for k in range(candidates)
            ]
        )
    return made(parts, edges)


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


def packing(side: int, pieces: int, seed: int) -> Problem:
    """Random pieces of four cells to be placed on a square, a role for each, so that no two overlap."""
    rng = random.Random(seed)
    places = []
    for _ in range(pieces):
        shape = {(0, 0)}
        while len(shape) < 4:
            x, y = rng.choice(sorted(shape))
            a, b = rng.choice([(0, 1), (1, 0), (0, -1), (-1, 0)])
            shape.add((x + a, y + b))
        moved = [frozenset((x + a, y + b) for x, y in shape) for a, b in product(range(-4, side + 4), repeat=2)]
        fitting = sorted((cells for cells in moved if all(0 <= k < side for cell in cells for k in cell)), key=sorted)
        places.append(rng.sample(fitting, len(fitting)))

    def apart(one: int, other: int) -> Callable[[int, int], bool]:
        return lambda a, b: not places[one][a] & places[other][b]

    pairs = {(one, other): apart(one, other) for one, other in combinations(range(pieces), 2)}
    return in_pairs([range(len(some)) for some in places], pairs)


def multiplied(bits: int, known: int) -> Problem:
    """A circuit that multiplies two numbers of so many bits, whose product is known: its first wires are their bits."""
    built = Circuit()
    one, other = ([built.wire() for _ in range(bits)] for _ in range(2))
    columns: list[list[int]] = [[] for _ in range(2 * bits + 1)]
    for (i, x), (j, y) in product(enumerate(one), enumerate(other)):
        columns[i + j].append(built.gate(lambda a, b: a & b, (x, y)))
    for place, column in enumerate(columns):
        bit = known >> place & 1
        while len(column) > 1:
            # Up to three bits of one column are added: one stays in it, and one is carried.
            wires, last = column[:3], len(column) <= 3
            column[:3] = [built.gate(lambda *some: sum(some) & 1, wires, bit if last else None)]
            columns[place + 1].append(built.gate(lambda *some: sum(some) >> 1, wires))
            if last:
                break
        else:
            for wire in column:
                built.gate(lambda a: a, (wire,), bit)
    return built.problem()


def factors(bits: int, seed: int) -> Problem:
    """Two numbers to be found for their product, by the bits of a circuit; in three of ten, that is off by two."""
    rng = random.Random(seed)
    one, other = (rng.randrange(1 << (bits - 1), 1 << bits) for _ in range(2))
    return multiplied(bits, one * other + (2 if rng.random() < 0.3 else 0))


def timetable(lectures: int, times: int, rooms: int, teachers: int, seed: int) -> Problem:
    """Lectures that each need a time and a room; free parameters say who has a room, or a teacher, at a time."""
    rng = random.Random(seed)
    busy = [*product(["room"], range(rooms), range(times)), *product(["teacher"], range(teachers), range(times))]
    place = {name: number for number, name in enumerate(busy)}
    names = [f"{sort}{who}.{time}" for sort, who, time in busy]
    variables = tuple(
        Variable(iri(name), tuple(iri(f"{name}.{lecture}") for lecture in range(lectures))) for name in names
    )
    parts = []
    for lecture in range(lectures):
        teacher = rng.randrange(teachers)
        some = [one for one in product(range(times), range(rooms)) if rng.random() < 0.5] or [(0, 0)]
        candidates = []
        for k, (time, room) in enumerate(rng.sample(some, len(some))):
            admits = [ANY_VALUE] * len(busy)
            admits[place["room", room, time]] = admits[place["teacher", teacher, time]] = 1 << lecture
            candidates.append(Candidate(profile(f"lecture{lecture:03}.{k:02}"), tuple(admits)))
        parts.append(candidates)
    return counted(parts, [1] * lectures, (), variables)


LAST_CHOOSING: Mapping[str, Family] = {
    "knights": (
        ("10 on 7 x 7", lambda seed: knights(7, 10, seed)),
        ("12 on 8 x 8", lambda seed: knights(8, 12, seed)),
    ),
    "teams": (
        ("6 of 4", lambda seed: teams(6, 4, 32, 12, 9, seed)),
        ("10 of 4", lambda seed: teams(10, 4, 48, 14, 9, seed)),
    ),
    "circuit": (
        ("120 gates", lambda seed: circuit(20, 120, 12, seed)),
        ("300 gates", lambda seed: circuit(30, 300, 24, seed)),
    ),
    "quorum": (
        ("30 roles", lambda seed: quorum(30, 6, 14, 4, seed)),
        ("60 roles", lambda seed: quorum(60, 8, 18, 4, seed)),
    ),
}
"""What the search was changed on."""

LAST_REPORTING: Mapping[str, Family] = {
    "fields": (
        ("7 and 6 of 40", lambda seed: fields(40, 40, 7, 6, seed)),
        ("8 and 7 of 60", lambda seed: fields(60, 60, 8, 7, seed)),
    ),
    "packing": (
        ("8 pieces on 6 x 6", lambda seed: packing(6, 8, seed)),
        ("11 pieces on 7 x 7", lambda seed: packing(7, 11, seed)),
    ),
    "factors": (("5 bits", lambda seed: factors(5, seed)), ("8 bits", lambda seed: factors(8, seed))),
    "timetable": (
        ("30 lectures", lambda seed: timetable(30, 8, 4, 8, seed)),
        ("60 lectures", lambda seed: timetable(60, 10, 7, 12, seed)),
    ),
}
"""What was only measured."""

LAST_SMALL: Mapping[str, Family] = {
    "knights": (("4 on 3 x 3", lambda seed: knights(3, 4, seed)),),
    "teams": (("2 of 2", lambda seed: teams(2, 2, 8, 5, 3, seed)),),
    "circuit": (("10 gates", lambda seed: circuit(4, 10, 2, seed)),),
    "quorum": (("5 roles", lambda seed: quorum(5, 3, 4, 3, seed)),),
    "fields": (("2 and 2 of 6", lambda seed: fields(5, 6, 2, 2, seed)),),
    "packing": (("3 pieces on 4 x 4", lambda seed: packing(4, 3, seed)),),
    "factors": (("2 bits", lambda seed: factors(2, seed)),),
    "timetable": (("4 lectures", lambda seed: timetable(4, 3, 2, 2, seed)),),
}
"""One small size of each, to see that everything runs."""

"""Families that were made after `last_families`: kinds of problems that one would think of who wants to judge a search.

`NEWEST_CHOOSING` are those on which the search was changed once more, and `NEWEST_REPORTING` those on which that was
only measured.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations, permutations, product

from benchmarks.search.families import iri, profile
from benchmarks.search.further_families import Family, Goes, counted, in_pairs
from selfconf.model.partition import ANY_VALUE, Candidate, Partition, Variable
from selfconf.model.profile import Input, Output, Profile, shared_ports
from selfconf.model.template import Interaction, Role, Task, Template
from selfconf.search.problem import Problem


def hearing(name: str, heard: Mapping[int, object], issued: Iterable[object]) -> Candidate:
    """A component that hears some roles, each by an input of its own, with the signals that it wants of them."""
    wanted = tuple(Input(f"from{role}", (iri(signal),)) for role, signal in heard.items())
    return Candidate(Profile(iri(name), ports=shared_ports(wanted, tuple(Output(f"{s}", (iri(s),)) for s in issued))))


def heard_by_name(roles: Sequence[Sequence[Candidate]], edges: Iterable[tuple[int, int]]) -> Problem:
    """A problem with one component per role, in which each role feeds the inputs that are named after it."""
    template = Template(
        iri("template"),
        tuple(Role(iri(f"role{k}")) for k in range(len(roles))),
        tuple(Interaction(iri(f"role{a}"), iri(f"role{b}"), None, f"from{a}") for a, b in edges),
    )
    return Problem(Task(template), Partition(tuple(map(tuple, roles))))


def squads(roles: int, people: int, signals: int, share: float, seed: int) -> Problem:
    """Squads of two or three from one pool, nobody in two of them, in a random graph of what they tell each other."""
    rng = random.Random(seed)
    pool = [
        Candidate(profile(f"p{k:03}", rng.sample(range(signals), 2), rng.sample(range(signals), 2)))
        for k in range(people)
    ]
    parts = [[one for one in pool if rng.random() < share] for _ in range(roles)]
    edges = sorted({(a, b) for b in range(roles) for a in rng.sample(range(roles), 2) if a != b})
    return counted(parts, [rng.choice((2, 3)) for _ in range(roles)], edges)


def workshop(jobs: int, machines: int, end: int, seed: int) -> Problem:
    """Jobs that visit all machines, each in an order of its own: an operation starts at some time, and ends in time."""
    rng = random.Random(seed)
    visits = [
        (job, machine, rng.randint(1, 3)) for job in range(jobs) for machine in rng.sample(range(machines), machines)
    ]
    domains = []
    for number, (job, _, _) in enumerate(visits):
        lasting = [duration for other, _, duration in visits if other == job]
        place = number % machines
        domains.append(range(sum(lasting[:place]), end - sum(lasting[place:]) + 1))

    def in_turn(one: int, other: int, ordered: bool) -> Goes:
        first, second = visits[one][2], visits[other][2]
        return lambda a, b: a + first <= b or (not ordered and b + second <= a)

    pairs = {
        (one, other): in_turn(one, other, visits[one][0] == visits[other][0])
        for one, other in combinations(range(len(visits)), 2)
        if visits[one][1] == visits[other][1] or (visits[one][0] == visits[other][0] and other == one + 1)
    }
    return in_pairs(domains, pairs)


def tree(nodes: int, sockets: int, more: int, depth: int, seed: int) -> Problem:
    """A tree that spans a random graph: each node but the first hangs at a socket of a neighbour, a level below it."""
    rng = random.Random(seed)
    near: list[set[int]] = [set() for _ in range(nodes)]
    links = [(rng.randrange(max(0, node - 6), node), node) for node in range(1, nodes)]
    for a, b in [*links, *rng.sample(list(combinations(range(nodes), 2)), more)]:
        near[a].add(b)
        near[b].add(a)
    parts = [[hearing("first", {}, ["level0"])]]
    for node in range(1, nodes):
        places = [
            (other, socket, level)
            for other in sorted(near[node])
            for socket in range(sockets)
            for level in ((1,) if other == 0 else range(2, depth + 1))
        ]
        parts.append(
            [
                hearing(f"socket{other:03}.{socket}.{level:02}", {other: f"level{level - 1}"}, [f"level{level}"])
                for other, socket, level in rng.sample(places, len(places))
            ]
        )
    return heard_by_name(parts, [(other, node) for node in range(1, nodes) for other in sorted(near[node])])


def cycles(nodes: int, more: int, seed: int) -> Problem:
    """Cycles of three nodes or more through all of a random graph, which has some.

    A role says who follows a node, and one whom it follows.
    """
    rng = random.Random(seed)
    order = rng.sample(range(nodes), nodes)
    links = [*zip(order, order[1:] + order[:1], strict=True), *rng.sample(list(combinations(range(nodes), 2)), more)]
    near: list[set[int]] = [set() for _ in range(nodes)]
    for a, b in links:
        near[a].add(b)
        near[b].add(a)

    def both(one: int, other: int) -> Goes:
        return lambda after, before: (after == other) == (before == one)

    def not_both(one: int, other: int) -> Goes:
        return lambda a, b: a != other or b != one

    domains = [rng.sample(sorted(some), len(some)) for some in near] * 2
    pairs = {(one, nodes + other): both(one, other) for one in range(nodes) for other in sorted(near[one])}
    pairs |= {(one, other): not_both(one, other) for one in range(nodes) for other in sorted(near[one]) if one < other}
    return in_pairs(domains, pairs)


def ladder(length: int, rails: int, candidates: int, states: int, seed: int) -> Problem:
    """Rails side by side, each fed by its last step and by its neighbour; in half of them the last wish is off."""
    rng = random.Random(seed)
    hidden = [[rng.randrange(states) for _ in range(rails)] for _ in range(length)]
    parts: list[list[Candidate]] = []
    edges: list[tuple[int, int]] = []
    for step, rail in product(range(length), range(rails)):
        role = len(parts)
        heard = ([role - rails] if step else []) + ([role - 1] if rail else [])
        edges += [(source, role) for source in heard]
        sure = rng.randrange(candidates)
        some = []
        for k in range(candidates):
            states_of = {source: rng.randrange(states) for source in heard}
            issued = rng.randrange(states)
            if k == sure:
                states_of = {source: hidden[source // rails][source % rails] for source in heard}
                issued = hidden[step][rail]
            some.append(hearing(f"c{role:04}.{k:02}", states_of, [issued]))
        parts.append(some)
    wanted = dict(enumerate(hidden[-1], len(parts) - rails))
    if rng.random() < 0.5:
        wanted[len(parts) - 1] = (wanted[len(parts) - 1] + 1) % states
    edges += [(source, len(parts)) for source in wanted]
    return heard_by_name([*parts, [hearing("end", wanted, ())]], edges)


def planted(roles: int, values: int, pairs: int, tightness: float, seed: int) -> Problem:
    """Random relations between random pairs of roles that one solution, which is hidden, is sure to satisfy."""
    rng = random.Random(seed)
    hidden = [rng.randrange(values) for _ in range(roles)]

    def without(forbidden: frozenset[tuple[int, int]]) -> Goes:
        return lambda a, b: (a, b) not in forbidden

    found: dict[tuple[int, int], Goes] = {}
    for one, other in rng.sample(list(combinations(range(roles), 2)), pairs):
        every = [pair for pair in product(range(values), range(values)) if pair != (hidden[one], hidden[other])]
        found[one, other] = without(frozenset(rng.sample(every, round(tightness * values * values))))
    return in_pairs([range(values)] * roles, found)


def regular(roles: int, heard: int, candidates: int, signals: int, seed: int) -> Problem:
    """Each role hears as many others as hear it; a candidate wants a signal of each that it hears, and issues two."""
    rng = random.Random(seed)
    order = rng.sample(range(roles), roles)
    steps = rng.sample(range(1, roles), heard)
    parts: list[list[Candidate]] = [[] for _ in range(roles)]
    edges = []
    for place, role in enumerate(order):
        sources = [order[(place + step) % roles] for step in steps]
        edges += [(source, role) for source in sources]
        parts[role] = [
            hearing(
                f"c{role:03}.{k:03}",
                {source: rng.randrange(signals) for source in sources},
                rng.sample(range(signals), 2),
            )
            for k in range(candidates)
        ]
    return heard_by_name(parts, edges)


SQUARE = ((16, 3, 2, 13), (5, 10, 11, 8), (9, 6, 7, 12), (4, 15, 14, 1))
"""Dürer's."""


def magic(given: int, seed: int) -> Problem:
    """A magic square of sixteen numbers, some of which are given: free parameters say what is in a cell, and where.

    A role for each cell names its number, one for each line and diagonal numbers that have the sum.
    """
    rng = random.Random(seed)
    side = len(SQUARE)
    cells = list(product(range(side), range(side)))
    known = set(rng.sample(cells, given))
    numbers = range(1, side * side + 1)
    names = [*cells, *numbers]
    place = {name: number for number, name in enumerate(names)}
    variables = (
        *(Variable(iri(f"cell{x}.{y}"), tuple(iri(f"cell{x}.{y}.{number}") for number in numbers)) for x, y in cells),
        *(
            Variable(iri(f"number{number}"), tuple(iri(f"number{number}.{x}.{y}") for x, y in cells))
            for number in numbers
        ),
    )

    def admitting(name: str, values: Mapping[object, int]) -> Candidate:
        admits = [ANY_VALUE] * len(names)
        for variable, value in values.items():
            admits[place[variable]] = 1 << value
        return Candidate(profile(name), tuple(admits))

    parts = [
        [
            admitting(f"cell{x}.{y}.{number:02}", {(x, y): number - 1, number: place[x, y]})
            for number in ((SQUARE[x][y],) if (x, y) in known else rng.sample(numbers, len(numbers)))
        ]
        for x, y in cells
    ]
    lines = [[cell for cell in cells if cell[axis] == k] for axis in (0, 1) for k in range(side)]
    lines += [[(k, k) for k in range(side)], [(k, side - 1 - k) for k in range(side)]]
    left = [number for number in numbers if number not in {SQUARE[x][y] for x, y in known}]
    for line, of_line in enumerate(lines):
        free = [cell for cell in of_line if cell not in known]
        wanted = sum(SQUARE[0]) - sum(SQUARE[x][y] for x, y in of_line if (x, y) in known)
        some = [chosen for chosen in permutations(left, len(free)) if sum(chosen) == wanted]
        parts.append(
            [
                admitting(f"line{line}.{k:04}", {cell: number - 1 for cell, number in zip(free, chosen, strict=True)})
                for k, chosen in enumerate(rng.sample(some, len(some)))
            ]
        )
    return counted(parts, [1] * len(parts), (), variables)


def building(floors: int, rooms: int, each: int, protocols: int, seed: int) -> Problem:
    """A building with a backbone, a gateway for each floor, and a sensor, a controller and a lamp for each room.

    For each of these there are so many candidates, and each speaks one or two protocols; a sensor of a floor's hall may
    serve any room of the floor, but one alone.
    """
    rng = random.Random(seed)

    def spoken(kind: str, number: int) -> list[str]:
        return [f"{kind}{protocol}" for protocol in rng.sample(range(protocols), number)]

    def some(name: str, heard: Mapping[int, str], issued: str, number: int) -> list[Candidate]:
        return [
            hearing(
                f"{name}.{k:02}",
                {role: signal for role, kind in heard.items() for signal in spoken(kind, 1)},
                spoken(issued, number),
            )
            for k in range(each)
        ]

    parts = [some("backbone", {}, "net", 2)]
    edges: list[tuple[int, int]] = []
    for floor in range(floors):
        gateway = len(parts)
        parts.append(some(f"gateway{floor:02}", {0: "net"}, "bus", 2))
        edges.append((0, gateway))
        hall = some(f"hall{floor:02}", {}, "lux", 2)
        for room in range(rooms):
            place, sensor = f"{floor:02}.{room:02}", len(parts)
            parts += [
                some(f"sensor{place}", {}, "lux", 1) + hall,
                some(f"controller{place}", {sensor: "lux", gateway: "bus"}, "dim", 1),
                some(f"lamp{place}", {sensor + 1: "dim"}, "light", 1),
            ]
            edges += [(sensor, sensor + 1), (gateway, sensor + 1), (sensor + 1, sensor + 2)]
    return heard_by_name(parts, edges)


def bins(items: int, number: int, each: int, slack: int, seed: int) -> Problem:
    """Items of 2 to 9 units that each fit some of the bins; a bin knows the loads that it can take, all nearly full."""
    rng = random.Random(seed)
    size = [rng.randint(2, 9) for _ in range(items)]
    fits = [rng.sample(range(number), each) for _ in range(items)]
    room = [slack] * number
    for item, some in enumerate(fits):
        room[rng.choice(some)] += size[item]
    parts = [
        [
            hearing(f"item{item:02}.{one}", {}, [f"{'in' if one == other else 'out'}{other}" for other in some])
            for one in some
        ]
        for item, some in enumerate(fits)
    ]
    edges: list[tuple[int, int]] = []
    for one in range(number):
        mine = [item for item, some in enumerate(fits) if one in some]
        loads = [
            load
            for load in product((0, 1), repeat=len(mine))
            if room[one] - 5 <= sum(size[item] for item, taken in zip(mine, load, strict=True) if taken) <= room[one]
        ]
        parts.append(
            [
                hearing(
                    f"load{one}.{''.join(map(str, load))}",
                    {item: f"{'in' if taken else 'out'}{one}" for item, taken in zip(mine, load, strict=True)},
                    (),
                )
                for load in rng.sample(loads, len(loads))
            ]
        )
        edges += [(item, items + one) for item in mine]
    return heard_by_name(parts, edges)


def hours(jobs: int, workers: int, projects: int, length: int, seed: int) -> Problem:
    """Workers of one pool for jobs, each with time for three projects: all have to have an hour of each in common."""
    rng = random.Random(seed)
    variables = tuple(
        Variable(iri(f"project{p:02}"), tuple(iri(f"hour{p:02}.{k:02}") for k in range(length)))
        for p in range(projects)
    )
    pool = []
    for k in range(workers):
        admits = [ANY_VALUE] * projects
        for project in rng.sample(range(projects), 3):
            begin, last = rng.randrange(length), rng.randint(length // 6 + 1, length // 3)
            admits[project] = sum(1 << (begin + hour) % length for hour in range(last))
        pool.append(Candidate(profile(f"worker{k:03}"), tuple(admits)))
    return counted([[one for one in pool if rng.random() < 0.35] for _ in range(jobs)], [1] * jobs, (), variables)


NEWEST_CHOOSING: Mapping[str, Family] = {
    "squads": (
        ("20 of 60 people", lambda seed: squads(20, 60, 10, 0.4, seed)),
        ("28 of 76 people", lambda seed: squads(28, 76, 11, 0.38, seed)),
    ),
    "building": (
        ("4 floors of 5 rooms", lambda seed: building(4, 5, 6, 5, seed)),
        ("10 floors of 8 rooms", lambda seed: building(10, 8, 10, 6, seed)),
    ),
    "bins": (
        ("18 items, 6 bins", lambda seed: bins(18, 6, 3, 1, seed)),
        ("24 items, 8 bins", lambda seed: bins(24, 8, 3, 1, seed)),
    ),
    "hours": (
        ("7 jobs, 8 projects", lambda seed: hours(7, 36, 8, 12, seed)),
        ("9 jobs, 14 projects", lambda seed: hours(9, 40, 14, 16, seed)),
    ),
}
"""What the search was changed on."""

NEWEST_REPORTING: Mapping[str, Family] = {
    "workshop": (
        ("8 jobs, 6 machines", lambda seed: workshop(8, 6, 30, seed)),
        ("12 jobs, 8 machines", lambda seed: workshop(12, 8, 44, seed)),
    ),
    "tree": (
        ("50 nodes", lambda seed: tree(50, 2, 30, 12, seed)),
        ("70 nodes", lambda seed: tree(70, 2, 40, 14, seed)),
    ),
    "cycles": (
        ("60 nodes", lambda seed: cycles(60, 60, seed)),
        ("120 nodes", lambda seed: cycles(120, 120, seed)),
    ),
    "ladder": (
        ("60 steps of 4", lambda seed: ladder(60, 4, 10, 4, seed)),
        ("60 steps of 6", lambda seed: ladder(60, 6, 14, 5, seed)),
    ),
    "planted": (
        ("50 roles of 8", lambda seed: planted(50, 8, 250, 0.32, seed)),
        ("65 roles of 8", lambda seed: planted(65, 8, 350, 0.3, seed)),
    ),
    "regular": (
        ("50 roles of 24", lambda seed: regular(50, 3, 24, 8, seed)),
        ("60 roles of 30", lambda seed: regular(60, 3, 30, 8, seed)),
    ),
    "magic square": (
        ("5 given", lambda seed: magic(5, seed)),
        ("4 given", lambda seed: magic(4, seed)),
    ),
}
"""What was only measured."""

NEWEST_SMALL: Mapping[str, Family] = {
    "squads": (("3 of 10 people", lambda seed: squads(3, 10, 4, 0.8, seed)),),
    "building": (("1 floor of 2 rooms", lambda seed: building(1, 2, 3, 2, seed)),),
    "bins": (("5 items, 3 bins", lambda seed: bins(5, 3, 2, 1, seed)),),
    "hours": (("2 jobs, 4 projects", lambda seed: hours(2, 12, 4, 6, seed)),),
    "workshop": (("2 jobs, 2 machines", lambda seed: workshop(2, 2, 9, seed)),),
    "tree": (("6 nodes", lambda seed: tree(6, 2, 4, 3, seed)),),
    "cycles": (("6 nodes", lambda seed: cycles(6, 4, seed)),),
    "ladder": (("3 steps of 2", lambda seed: ladder(3, 2, 3, 3, seed)),),
    "planted": (("5 roles of 3", lambda seed: planted(5, 3, 6, 0.3, seed)),),
    "regular": (("5 roles of 4", lambda seed: regular(5, 2, 4, 3, seed)),),
    "magic square": (("11 given", lambda seed: magic(11, seed)),),
}
"""One small size of each, to see that everything runs."""

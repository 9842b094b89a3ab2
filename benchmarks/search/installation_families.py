"""Families after real installations, which were measured before the search was changed once more.

`INSTALLATION_CHOOSING` is what it was changed on, and on `INSTALLATION_REPORTING` that was only measured.
"""

from __future__ import annotations

import random
from collections.abc import Mapping
from itertools import combinations, product

from benchmarks.search.families import iri, profile
from benchmarks.search.further_families import Family, Goes, counted, in_pairs
from benchmarks.search.newest_families import heard_by_name, hearing
from selfconf.model.partition import ANY_VALUE, Candidate, Partition, Variable
from selfconf.model.template import Interaction, Parameter, Role, Task, Template
from selfconf.search.problem import Problem


def capacity(holes: int, room: int, guests: int, each: int, seed: int) -> Problem:
    """Guests that each fit some holes; a hole takes so many of them at most, whichever they are."""
    rng = random.Random(seed)
    fits = [rng.sample(range(holes), each) for _ in range(guests)]
    parts = [
        [
            hearing(f"guest{guest:02}.{hole}", {}, [f"{'in' if hole == other else 'out'}{other}" for other in some])
            for hole in some
        ]
        for guest, some in enumerate(fits)
    ]
    edges: list[tuple[int, int]] = []
    for hole in range(holes):
        mine = [guest for guest, some in enumerate(fits) if hole in some]
        loads = [load for number in range(room + 1) for load in combinations(mine, number)]
        parts.append(
            [
                hearing(
                    f"load{hole}.{'.'.join(map(str, load))}",
                    {guest: f"{'in' if guest in load else 'out'}{hole}" for guest in mine},
                    (),
                )
                for load in rng.sample(loads, len(loads))
            ]
        )
        edges += [(guest, guests + hole) for guest in mine]
    return heard_by_name(parts, edges)


def beds(holes: int, room: int, guests: int, each: int, seed: int) -> Problem:
    """The same, wired the other way: each guest wants a bed, and a hole issues one for each guest that it takes."""
    rng = random.Random(seed)
    fits = [rng.sample(range(holes), each) for _ in range(guests)]
    taken = [[guest for guest, some in enumerate(fits) if hole in some] for hole in range(holes)]
    parts = []
    for hole, mine in enumerate(taken):
        loads = [load for number in range(room + 1) for load in combinations(mine, number)]
        parts.append(
            [
                Candidate(profile(f"load{hole}.{'.'.join(map(str, load))}", (), [f"bed{guest}" for guest in load]))
                for load in rng.sample(loads, len(loads))
            ]
        )
    parts += [[Candidate(profile(f"guest{guest:02}", [f"bed{guest}"]))] for guest in range(guests)]
    edges = [(hole, holes + guest) for hole, mine in enumerate(taken) for guest in mine]
    return counted(parts, [1] * len(parts), edges)


def shifts(days: int, workers: int, share: float, seed: int) -> Problem:
    """Two workers for each of three shifts a day: none within two shifts of another of theirs, and not every pair."""
    rng = random.Random(seed)
    places = list(product(range(3 * days), range(2)))
    foes = {frozenset(pair) for pair in rng.sample(list(combinations(range(workers), 2)), 2 * workers)}
    able = [[worker for worker in range(workers) if rng.random() < share] or [0] for _ in places]

    def goes(together: bool) -> Goes:
        return lambda one, other: one != other and not (together and frozenset((one, other)) in foes)

    pairs = {
        (a, b): goes(places[a][0] == places[b][0])
        for a, b in combinations(range(len(places)), 2)
        if places[b][0] - places[a][0] <= 2
    }
    return in_pairs([rng.sample(some, len(some)) for some in able], pairs)


def magazine(tools: int, room: int, jobs: int, operations: int, seed: int) -> Problem:
    """A magazine for so many tools, three operations each; a job has three plans, of three operations each."""
    rng = random.Random(seed)
    some = [
        Candidate(profile(f"tool{k:03}", (), [f"op{one}" for one in rng.sample(range(operations), 3)]))
        for k in range(tools)
    ]
    plans = [
        [
            Candidate(profile(f"job{job:02}.{k}", [f"op{one}" for one in rng.sample(range(operations), 3)]))
            for k in range(3)
        ]
        for job in range(jobs)
    ]
    return counted([some, *plans], [room] + [1] * jobs, [(0, job + 1) for job in range(jobs)])


def redundant(areas: int, relays: int, each: int, share: float, seed: int) -> Problem:
    """Two sets of relays from one pool, each of which hears all areas, and two backhauls that feed the relays."""
    rng = random.Random(seed)
    pool = []
    for k in range(relays):
        heard = [f"area{area}" for area in range(areas) if rng.random() < share]
        pool.append(Candidate(profile(f"relay{k:03}", [f"back{rng.randrange(6)}"], heard)))
    backhauls = [
        Candidate(profile(f"back{k:02}", (), [f"back{b}" for b in rng.sample(range(6), 2)])) for k in range(10)
    ]
    sinks = [[Candidate(profile(f"sink{k}", [f"area{area}" for area in range(areas)]))] for k in range(2)]
    return counted([pool, pool, backhauls, *sinks], [each, each, 2, 1, 1], [(2, 0), (2, 1), (0, 3), (1, 4)])


def charging(robots: int, chargers: int, times: int, seed: int) -> Problem:
    """Robots that charge for two or three periods; a free parameter says who has a charger in a period."""
    rng = random.Random(seed)
    cells = list(product(range(chargers), range(times)))
    variables = tuple(
        Variable(iri(f"charger{c}.{t}"), tuple(iri(f"charger{c}.{t}.{robot}") for robot in range(robots)))
        for c, t in cells
    )
    parts = []
    for robot in range(robots):
        length, early = rng.randint(2, 3), rng.randrange(times - 5)
        some = []
        for charger in rng.sample(range(chargers), max(1, chargers // 2)):
            for start in range(early, min(early + 6, times - length + 1)):
                taken = {(charger, start + k) for k in range(length)}
                admits = tuple(1 << robot if cell in taken else ANY_VALUE for cell in cells)
                some.append(Candidate(profile(f"robot{robot:02}.{charger}.{start:02}"), admits))
        parts.append(rng.sample(some, len(some)))
    return counted(parts, [1] * robots, (), variables)


def zones(rooms: int, number: int, values: int, seed: int) -> Problem:
    """Rooms that join zones whose temperatures are free parameters, and hear how neighbours before them are heated."""
    rng = random.Random(seed)
    variables = tuple(
        Variable(iri(f"zone{zone}"), tuple(iri(f"zone{zone}.{value}") for value in range(values)))
        for zone in range(number)
    )
    near = {(max(0, room - rng.randint(1, 4)), room) for room in range(1, rooms)}
    near |= {(max(0, room - rng.randint(2, 7)), room) for room in range(3, rooms)}
    parts = []
    for room in range(rooms):
        some = []
        for zone, device in product(range(number), range(3)):
            lowest = rng.randrange(values)
            mask = sum(1 << value for value in range(lowest, min(values, lowest + 3)))
            heard = {a: rng.choice("hcd") for a, b in sorted(near) if b == room}
            heating = hearing(f"room{room:02}.{zone}.{device}", heard, dict.fromkeys(rng.choices("hcd", k=2)))
            admits = tuple(mask if one == zone else ANY_VALUE for one in range(number))
            some.append(Candidate(heating.profile, admits))
        parts.append(tuple(rng.sample(some, len(some))))
    template = Template(
        iri("template"),
        tuple(Role(iri(f"role{room}")) for room in range(rooms)),
        tuple(Interaction(iri(f"role{a}"), iri(f"role{b}"), None, f"from{a}") for a, b in sorted(near)),
        tuple(Parameter(one.parameter, one.parameter.short, in_shape=True) for one in variables),
    )
    return Problem(Task(template), Partition(tuple(parts), variables))


def licences(stations: int, staff: int, features: int, servers: int, room: int, seed: int) -> Problem:
    """Stations staffed from one pool, where each wants two licences; so many servers issue them, fed by two hosts."""
    rng = random.Random(seed)
    pool = [Candidate(profile(f"p{k:03}", [f"f{one}" for one in rng.sample(range(features), 2)])) for k in range(staff)]
    parts = [[one for one in pool if rng.random() < 0.25] or pool for _ in range(stations)]
    some = [
        Candidate(profile(f"s{k:02}", [f"h{rng.randrange(5)}"], [f"f{one}" for one in rng.sample(range(features), 3)]))
        for k in range(servers)
    ]
    hosts = [Candidate(profile(f"host{k}", (), [f"h{one}" for one in rng.sample(range(5), 2)])) for k in range(8)]
    edges = [(0, 1), *((1, 2 + station) for station in range(stations))]
    return counted([hosts, some, *parts], [2, room] + [1] * stations, edges)


def cabling(width: int, height: int, nets: int, seed: int) -> Problem:
    """Cables from the left to the right of a grid of ducts; a duct holds one, and each has up to 14 ways."""
    rng = random.Random(seed)
    ways = []
    for _ in range(nets):
        start, end = rng.randrange(height), rng.randrange(height)
        some = {_way(rng, width, height, start, end) for _ in range(14)}
        ways.append(sorted(some, key=sorted))

    def apart(one: int, other: int) -> Goes:
        return lambda a, b: ways[one][a].isdisjoint(ways[other][b])

    pairs = {
        (a, b): apart(a, b)
        for a, b in combinations(range(nets), 2)
        if any(not one.isdisjoint(other) for one in ways[a] for other in ways[b])
    }
    return in_pairs([rng.sample(range(len(some)), len(some)) for some in ways], pairs)


def _way(rng: random.Random, width: int, height: int, start: int, end: int) -> frozenset[tuple[int, int, str]]:
    x, y, ducts = 0, start, set()
    while x < width - 1:
        step = 0
        if rng.random() < 0.45 and y != end:
            step = 1 if end > y else -1
        elif rng.random() < 0.25:
            step = rng.choice((-1, 1))
        if step and 0 <= y + step < height:
            ducts.add((x, min(y, y + step), "up"))
            y += step
        else:
            ducts.add((x, y, "along"))
            x += 1
    return frozenset(ducts)


def voters(groups: int, makes: int, signals: int, seed: int) -> Problem:
    """Groups of two sensors, three channels and a voter, which wants channels of two makes and two qualities."""
    rng = random.Random(seed)

    def some(kind: str, number: int) -> list[str]:
        return [f"{kind}{one}" for one in rng.sample(range(signals if kind == "s" else makes), number)]

    pool = [
        Candidate(profile(f"channel{k:03}", some("s", 2), [f"v{rng.randrange(makes)}", f"q{rng.randrange(4)}"]))
        for k in range(8 * groups)
    ]
    sensors = [Candidate(profile(f"sensor{k:03}", (), some("s", 2))) for k in range(5 * groups)]
    parts: list[list[Candidate]] = []
    edges: list[tuple[int, int]] = []
    for group in range(groups):
        edges += [(len(parts), len(parts) + 1), (len(parts) + 1, len(parts) + 2)]
        parts.append([one for one in sensors if rng.random() < 0.3])
        parts.append([one for one in pool if rng.random() < 0.3])
        wanted = [some("v", 2) + [f"q{one}" for one in rng.sample(range(4), 2)] for _ in range(6)]
        parts.append([Candidate(profile(f"voter{group:02}.{k}", one)) for k, one in enumerate(wanted)])
    return counted(parts, [2, 3, 1] * groups, edges)


INSTALLATION_CHOOSING: Mapping[str, Family] = {
    "capacity": (
        ("8 holes for 2, 16 guests", lambda seed: capacity(8, 2, 16, 4, seed)),
        ("8 holes for 2, 17 guests", lambda seed: capacity(8, 2, 17, 5, seed)),
    ),
    "beds": (
        ("8 holes for 2, 16 guests", lambda seed: beds(8, 2, 16, 4, seed)),
        ("8 holes for 2, 17 guests", lambda seed: beds(8, 2, 17, 5, seed)),
    ),
}
"""What the search was changed on."""

INSTALLATION_REPORTING: Mapping[str, Family] = {
    "shifts": (
        ("5 days", lambda seed: shifts(5, 12, 0.5, seed)),
        ("14 days", lambda seed: shifts(14, 9, 0.6, seed)),
    ),
    "magazine": (
        ("6 of 30 tools", lambda seed: magazine(30, 6, 12, 12, seed)),
        ("9 of 60 tools", lambda seed: magazine(60, 9, 20, 18, seed)),
    ),
    "redundant": (
        ("twice 6 of 40 relays", lambda seed: redundant(20, 40, 6, 0.25, seed)),
        ("twice 8 of 60 relays", lambda seed: redundant(28, 60, 8, 0.2, seed)),
    ),
    "charging": (
        ("12 robots, 3 chargers", lambda seed: charging(12, 3, 16, seed)),
        ("24 robots, 5 chargers", lambda seed: charging(24, 5, 20, seed)),
    ),
    "zones": (
        ("30 rooms, 3 zones", lambda seed: zones(30, 3, 8, seed)),
        ("60 rooms, 4 zones", lambda seed: zones(60, 4, 10, seed)),
    ),
    "licences": (
        ("12 stations, 4 of 20 servers", lambda seed: licences(12, 40, 14, 20, 4, seed)),
        ("20 stations, 5 of 30 servers", lambda seed: licences(20, 60, 20, 30, 5, seed)),
    ),
    "cabling": (
        ("8 cables, 8 x 8", lambda seed: cabling(8, 8, 8, seed)),
        ("14 cables, 12 x 14", lambda seed: cabling(12, 14, 14, seed)),
    ),
    "voters": (
        ("6 groups", lambda seed: voters(6, 6, 8, seed)),
        ("12 groups", lambda seed: voters(12, 6, 8, seed)),
    ),
}
"""What was only measured."""

INSTALLATION_SMALL: Mapping[str, Family] = {
    "capacity": (("2 holes for 2, 3 guests", lambda seed: capacity(2, 2, 3, 2, seed)),),
    "beds": (("2 holes for 2, 3 guests", lambda seed: beds(2, 2, 3, 2, seed)),),
    "shifts": (("1 day", lambda seed: shifts(1, 5, 0.8, seed)),),
    "magazine": (("2 of 5 tools", lambda seed: magazine(5, 2, 3, 4, seed)),),
    "redundant": (("twice 2 of 8 relays", lambda seed: redundant(3, 8, 2, 0.6, seed)),),
    "charging": (("3 robots, 1 charger", lambda seed: charging(3, 1, 8, seed)),),
    "zones": (("4 rooms, 2 zones", lambda seed: zones(4, 2, 3, seed)),),
    "licences": (("2 stations, 2 of 5 servers", lambda seed: licences(2, 8, 4, 5, 2, seed)),),
    "cabling": (("2 cables, 4 x 4", lambda seed: cabling(4, 4, 2, seed)),),
    "voters": (("1 group", lambda seed: voters(1, 3, 4, seed)),),
}
"""One small size of each, to see that everything runs."""

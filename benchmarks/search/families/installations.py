"""Families after real installations."""

from __future__ import annotations

import random
from collections.abc import Mapping
from itertools import combinations, product

from benchmarks.search.families.wiring import Goes, counted, heard_by_name, hearing, in_pairs, iri, profile
from selfconf.model.partition import ANY_VALUE, Candidate, Partition, Variable
from selfconf.model.template import Interaction, Parameter, Role, Task, Template
from selfconf.search.problem import Problem


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


def machines(services: int, number: int, cores: int, modules: int, seed: int) -> Problem:
    """Services that each take one to three cores in a row, and as many modules of memory, of one of three machines.

    A free parameter for each core and module of the `number` of machines says which service has it.
    """
    rng = random.Random(seed)
    kinds = {"core": cores, "module": modules}
    units = [*((kind, machine, k) for kind, most in kinds.items() for machine in range(number) for k in range(most))]
    place = {unit: n for n, unit in enumerate(units)}
    left = {(kind, machine): most for kind, most in kinds.items() for machine in range(number)}
    parts = []
    for service in range(services):
        free = [m for m in range(number) if all(left[kind, m] for kind in kinds)] or list(range(number))
        home = rng.choice(free)
        taken = {kind: max(1, min(left[kind, home], rng.randint(1, 3))) for kind in kinds}
        for kind, count in taken.items():
            left[kind, home] -= count
        some = []
        for machine in sorted({home, *rng.sample(range(number), min(number, 3))}):
            for starts in product(*(range(most - taken[kind] + 1) for kind, most in kinds.items())):
                admits = [ANY_VALUE] * len(units)
                for (kind, count), start in zip(taken.items(), starts, strict=True):
                    for unit in range(start, start + count):
                        admits[place[kind, machine, unit]] = 1 << service
                name = f"service{service:02}.{machine}.{'.'.join(map(str, starts))}"
                some.append(Candidate(profile(name), tuple(admits)))
        parts.append(rng.sample(some, len(some)))
    names = ["{}{}.{}".format(*unit) for unit in units]
    variables = [Variable(iri(name), tuple(iri(f"{name}.{service}") for service in range(services))) for name in names]
    return counted(parts, [1] * services, (), tuple(variables))

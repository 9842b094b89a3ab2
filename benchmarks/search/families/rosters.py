"""Families of rosters and timetables: which worker, robot or machine does which job, and when."""

from __future__ import annotations

import math
import random
from collections.abc import Sequence
from itertools import combinations, pairwise, product

from benchmarks.search.families.wiring import Goes, counted, in_pairs, iri, made, profile
from selfconf.model.partition import ANY_VALUE, Candidate, Variable
from selfconf.search.problem import Problem


def crew(roles: int, people: int, signals: int, share: float, seed: int) -> Problem:
    """Roles in a random graph that draw on one pool: each person can do some of them, wants signals and issues some."""
    rng = random.Random(seed)
    pool = [
        Candidate(profile(f"p{k:03}", rng.sample(range(signals), 2), rng.sample(range(signals), 3)))
        for k in range(people)
    ]
    parts = [[one for one in pool if rng.random() < share] for _ in range(roles)]
    edges = sorted({(a, b) for b in range(roles) for a in rng.sample(range(roles), 3) if a != b})
    return made(parts, edges)


def missions(robots: int, most: int, chargers: int, sockets: int, tasks: int, seed: int) -> Problem:
    """So many robots that together do all tasks of a mission, each at a plug that one of so many chargers has."""
    rng = random.Random(seed)
    plugs = range(2 * sockets)
    able = [
        Candidate(
            profile(f"robot{k:03}", [f"plug{rng.choice(plugs)}"], [f"task{t}" for t in rng.sample(range(tasks), 4)])
        )
        for k in range(robots)
    ]
    charging = [
        Candidate(profile(f"charger{k:03}", (), [f"plug{p}" for p in rng.sample(plugs, 2)])) for k in range(chargers)
    ]
    mission = [Candidate(profile("mission", [f"task{t}" for t in range(tasks)]))]
    return counted([charging, able, mission], [sockets, most, 1], [(0, 1), (1, 2)])


def relief(shifts: int, asked: int, robots: int, nets: int, seed: int) -> Problem:
    """A fleet with few sorts of robots, of which each shift takes some, each fed by what the shift before issues."""
    rng = random.Random(seed)
    fleet = [Candidate(profile(f"robot{k:03}", [f"net{k % nets}"], [f"net{(k + 1) % nets}"])) for k in range(robots)]
    parts = [fleet[rng.randrange(nets + 1) :] for _ in range(shifts)]
    return counted(parts, [asked] * shifts, [(shift, (shift + 1) % shifts) for shift in range(shifts)])


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


def nurses(number: int, days: int, patterns: int, seed: int) -> Problem:
    """Nurses who each have one pattern of shifts, of so many; a shift asks for as many of them as one roster gives it.

    Nobody is early after a late shift, or by day after a night, and all work about as much.
    """
    rng = random.Random(seed)
    suited = ["".join(shifts) for shifts in product("eln-", repeat=days) if _is_fair(shifts)]
    own = [rng.sample(suited, patterns) for _ in range(number)]
    roster = [rng.choice(some) for some in own]
    parts = [
        [
            Candidate(
                profile(f"nurse{n:02}.{pattern}", (), [f"{n}.{d}.{s}" for d, s in enumerate(pattern) if s != "-"])
            )
            for pattern in some
        ]
        for n, some in enumerate(own)
    ]
    asked, edges = [1] * number, []
    for day, shift in product(range(days), "eln"):
        able = [n for n, some in enumerate(own) if any(pattern[day] == shift for pattern in some)]
        needed = sum(pattern[day] == shift for pattern in roster)
        if needed:
            edges += [(n, len(parts)) for n in able]
            parts.append([Candidate(profile(f"{shift}{day}.{n:02}", [f"{n}.{day}.{shift}"])) for n in able])
            asked.append(needed)
    return counted(parts, asked, edges)


def _is_fair(shifts: Sequence[str]) -> bool:
    """Whether a pattern of shifts leaves time to sleep, and is of four to five shifts a week."""
    rested = all(pair not in {("n", "e"), ("n", "l"), ("l", "e")} for pair in pairwise(shifts))
    return rested and 4.0 <= 7 * sum(shift != "-" for shift in shifts) / len(shifts) <= 5.3


def duties(trips: int, each: int, bases: int, seed: int) -> Problem:
    """Duties of so many trips each that between them make all trips: of each base so many, of up to ten times that."""
    rng = random.Random(seed)
    order = rng.sample(range(trips), trips)
    planned: list[set[tuple[int, ...]]] = [set() for _ in range(bases)]
    for first in range(0, trips, each):
        rng.choice(planned).add(tuple(sorted(order[first : first + each])))
    asked = [len(some) for some in planned]
    for some, count in zip(planned, asked, strict=True):
        while len(some) < min(10 * count, math.comb(trips, each)):
            some.add(tuple(sorted(rng.sample(range(trips), each))))
    parts = [
        [Candidate(profile(f"base{base}.{k:03}", (), [f"trip{trip}" for trip in made])) for k, made in enumerate(some)]
        for base, some in enumerate([rng.sample(sorted(some), len(some)) for some in planned])
    ]
    timetable = [Candidate(profile("timetable", [f"trip{trip}" for trip in range(trips)]))]
    return counted([*parts, timetable], [*asked, 1], [(base, bases) for base in range(bases)])

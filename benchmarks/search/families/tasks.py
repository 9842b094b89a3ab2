"""Families after tasks of robots, sensors and homes: port names, free parameters, and roles with several players."""

from __future__ import annotations

import random
from collections.abc import Iterable, Sequence
from itertools import combinations, product

from benchmarks.search.families.wiring import counted, iri, profile
from selfconf.model.partition import ANY_VALUE, Candidate, Partition, Variable
from selfconf.model.profile import Input, Output, Profile, shared_ports
from selfconf.model.template import Interaction, Parameter, Role, Task, Template
from selfconf.search.problem import Problem

Named = Iterable[tuple[str, str]]
"""Ports by their names, each with its signal."""


Link = tuple[int, int, str | None, str | None]
"""An interaction: the role that feeds, the role that is fed, and the names of both ports where they matter."""


def _component(name: str, wanted: Named = (), issued: Named = ()) -> Profile:
    return Profile(
        iri(name),
        ports=shared_ports(
            tuple(Input(port, (iri(signal),)) for port, signal in wanted),
            tuple(Output(port, (iri(signal),)) for port, signal in issued),
        ),
    )


def _task(
    parts: Sequence[Sequence[Candidate]],
    asked: Sequence[int],
    links: Iterable[Link],
    variables: Sequence[Variable] = (),
) -> Problem:
    template = Template(
        iri("template"),
        tuple(Role(iri(f"role{k}"), number, number) for k, number in enumerate(asked)),
        tuple(Interaction(iri(f"role{a}"), iri(f"role{b}"), output, port) for a, b, output, port in links),
        tuple(Parameter(v.parameter, v.parameter.short, in_shape=True) for v in variables),
    )
    return Problem(Task(template), Partition(tuple(map(tuple, parts)), tuple(variables)))


def _variable(name: str, values: int) -> Variable:
    return Variable(iri(name), tuple(iri(f"{name}.{value}") for value in range(values)))


def _mask(values: Iterable[int]) -> int:
    return sum(1 << value for value in set(values))


def rooms(number: int, hubs: int, protocols: int, seed: int, share: float = 0.5) -> Problem:
    """Rooms with a thermometer, a presence sensor, a hub from one pool and a valve that the hub also hears.

    The devices of a floor agree on one of five radio channels.
    """
    rng = random.Random(seed)
    floors = max(1, number // 6)
    variables = [_variable(f"channel{floor}", 5) for floor in range(floors)]
    pool = []
    for k in range(hubs):
        spoken = rng.sample(range(protocols), 2)
        ports = [("temp", f"t{rng.choice(spoken)}"), ("presence", f"p{rng.choice(spoken)}"), ("state", f"v{k % 3}")]
        hub = _component(f"hub{k:03}", ports, [(f"cmd{one}", f"c{one}") for one in spoken])
        pool.append((hub, _mask(rng.sample(range(5), 2))))
    parts: list[list[Candidate]] = []
    links: list[Link] = []
    for room in range(number):
        floor, base = room * floors // number, len(parts)

        def of_floor(one: Profile, mask: int, floor: int = floor) -> Candidate:
            return Candidate(one, tuple(mask if other == floor else ANY_VALUE for other in range(floors)))

        def sensors(kind: str, free: float, room: int = room) -> list[Candidate]:
            return [
                of_floor(
                    _component(f"{kind}{room:02}.{k}", (), [(kind, f"{kind}{rng.randrange(protocols)}")]),
                    ANY_VALUE if rng.random() < free else _mask(rng.sample(range(5), 3)),
                )
                for k in range(4)
            ]

        parts += [sensors("t", 0), sensors("p", 0.5), [of_floor(*one) for one in pool if rng.random() < share]]
        parts.append(
            [
                of_floor(
                    _component(
                        f"valve{room:02}.{k}",
                        [("cmd", f"c{rng.randrange(protocols)}")],
                        [(f"state{s}", f"v{s}") for s in rng.sample(range(3), 2)],
                    ),
                    ANY_VALUE,
                )
                for k in range(4)
            ]
        )
        links += [
            (base, base + 2, "t", "temp"),
            (base + 1, base + 2, None, "presence"),
            (base + 2, base + 3, None, None),
        ]
        links.append((base + 3, base + 2, None, "state"))
        if room:
            links.append((base - 4, base + 2, "t", "temp"))
    return _task(parts, [1] * len(parts), links, variables)


def convoy(robots: int, modes: int, channels: int, seed: int) -> Problem:
    """Robots in a line: each hears the one before, acknowledges, and leaves the channel of the last but one alone."""
    rng = random.Random(seed)
    parts: list[list[Candidate]] = []
    links: list[Link] = []
    for robot in range(robots):
        some = []
        ways = list(product(range(modes), range(channels)))
        for k, (mode, channel) in enumerate(rng.sample(ways, 3 * len(ways) // 4)):
            wanted = [
                *([("prev", f"pos{robot - 1}.{rng.randrange(modes)}")] if robot else []),
                *([("clear", f"not{robot - 2}.{channel}")] if robot >= 2 else []),
                *([("ack", f"ack{robot + 1}.{rng.randrange(modes)}")] if robot + 1 < robots else []),
            ]
            issued = [("pos", f"pos{robot}.{mode}")]
            issued += [(f"ack{turn}", f"ack{robot}.{(mode + turn) % modes}") for turn in range(2)]
            issued += [(f"not{one}", f"not{robot}.{one}") for one in range(channels) if one != channel]
            component = _component(f"robot{robot:02}.{k:02}", wanted, issued)
            some.append(Candidate(component, (_mask(rng.sample(range(6), 4)),)))
        parts.append(some)
        if robot:
            links += [(robot - 1, robot, "pos", "prev"), (robot, robot - 1, None, "ack")]
        if robot >= 2:
            links.append((robot - 2, robot, None, "clear"))
    return _task(parts, [1] * robots, links, [_variable("formation", 6)])


def orchard(plots: int, drones: int, each: int, docks: int, seed: int, share: float = 0.12) -> Problem:
    """So many drones see all plots; each charges at a dock of its kind, and two gateways hear three radios each."""
    rng = random.Random(seed)
    pool = []
    for k in range(drones):
        seen = [f"plot{plot}" for plot in range(plots) if rng.random() < share]
        pool.append(
            Candidate(profile(f"drone{k:03}", [f"dock{rng.randrange(8)}"], [*seen, f"radio{rng.randrange(5)}"]))
        )
    stations = [Candidate(profile(f"dock{k:02}", (), [f"dock{d}" for d in rng.sample(range(8), 2)])) for k in range(14)]
    gates = [Candidate(profile(f"gate{k:02}", [f"radio{r}" for r in rng.sample(range(5), 3)])) for k in range(6)]
    sink = [Candidate(profile("map", [f"plot{plot}" for plot in range(plots)]))]
    return counted([stations, pool, gates, sink], [docks, each, 2, 1], [(0, 1), (1, 2), (1, 3)])


def theatres(number: int, staff: int, kits: int, seed: int, hours: int = 4) -> Problem:
    """Operating theatres with a surgeon, two nurses and an anaesthetist of one staff, who agree on an hour and habits.

    A free parameter for each kit and hour says which theatre has it.
    """
    rng = random.Random(seed)
    variables = [_variable(f"hour{t}", hours) for t in range(number)]
    variables += [_variable(f"kit{k}.{h}", number) for k in range(kits) for h in range(hours)]
    people = []
    for k in range(staff):
        habits = [(f"habit{x}", f"h{x}") for x in rng.sample(range(6), 2)]
        person = _component(f"staff{k:03}", [("habit", f"h{rng.randrange(6)}")], habits)
        people.append((person, _mask(rng.sample(range(hours), 2)), rng.sample(range(3), 2)))
    parts: list[list[Candidate]] = []
    links: list[Link] = []
    for theatre in range(number):
        base = len(parts)

        def at(mask: int, theatre: int = theatre) -> list[int]:
            return [mask if k == theatre else ANY_VALUE for k in range(len(variables))]

        for job in range(3):
            parts.append([Candidate(p, tuple(at(m))) for p, m, jobs in people if job in jobs and rng.random() < 0.5])
        links += [(base + a, base + b, None, None) for a, b in ((0, 1), (1, 2), (2, 0), (1, 0))]
        some = []
        for kit, hour in product(rng.sample(range(kits), 2), range(hours)):
            admits = at(1 << hour)
            admits[number + kit * hours + hour] = 1 << theatre
            some.append(Candidate(_component(f"kit{theatre:02}.{kit}.{hour}"), tuple(admits)))
        parts.append(some)
    return _task(parts, [1, 2, 1, 1] * number, links, variables)


def fusion(platforms: int, makes: int, width: int, seed: int) -> Problem:
    """Platforms with camera, detector, tracker and a fusion node, which hears a neighbour's tracker and calibrates.

    A clock for all and a frame for each platform are free.
    """
    rng = random.Random(seed)
    variables = [_variable("clock", 4), *(_variable(f"frame{p}", 4) for p in range(platforms))]
    parts: list[list[Candidate]] = []
    edges: list[tuple[int, int]] = []

    def some(kind: str, number: int) -> list[str]:
        return [f"{kind}{rng.randrange(makes)}" for _ in range(number)]

    for platform in range(platforms):
        base = len(parts)
        for name, wanted, issued in (
            ("camera", {}, {"image": 2}),
            ("detector", {"image": 1, "calibration": 1}, {"box": 1}),
            ("tracker", {"box": 1}, {"object": 2}),
            ("fusion", {"object": 2}, {"calibration": 2}),
        ):
            of_role = []
            for k in range(width):
                admits = [ANY_VALUE] * len(variables)
                if rng.random() < 0.4:
                    admits[0] = _mask(rng.sample(range(4), 3))
                if rng.random() < 0.6:
                    admits[platform + 1] = _mask(rng.sample(range(4), 2))
                ports = [[one for kind, n in of.items() for one in some(kind, n)] for of in (wanted, issued)]
                of_role.append(Candidate(profile(f"{name}{platform:02}.{k:02}", *ports), tuple(admits)))
            parts.append(of_role)
        edges += [(base, base + 1), (base + 1, base + 2), (base + 2, base + 3), (base + 3, base + 1)]
        if platform:
            edges += [(base - 2, base + 3), (base + 2, base - 1)]
    return counted(parts, [1] * len(parts), edges, tuple(variables))


def museum(groups: int, guides: int, halls: int, times: int, seed: int) -> Problem:
    """Groups with a guide who knows their language and first hall, and a route; no two are in a hall at a time."""
    rng = random.Random(seed)
    pool = []
    for k in range(guides):
        known = [f"lang{x}" for x in rng.sample(range(6), 2)] + [
            f"hall{x}" for x in rng.sample(range(halls), halls // 2)
        ]
        pool.append(Candidate(_component(f"guide{k:02}", (), [(one, one) for one in known])))
    routes: list[list[list[tuple[int, int]]]] = []
    for _ in range(groups):
        starts = [(rng.randrange(times - 3), rng.sample(range(halls), 3)) for _ in range(8)]
        routes.append([[(hall, start + k) for k, hall in enumerate(path)] for start, path in starts])
    wanted: dict[tuple[int, int], list[tuple[str, str]]] = {}
    issued: dict[tuple[int, int], list[tuple[str, str]]] = {}
    links: list[Link] = []
    for a, b in combinations(range(groups), 2):
        links.append((2 * a + 1, 2 * b + 1, None, f"group{a}"))
        for j, theirs in enumerate(routes[b]):
            wanted.setdefault((b, j), []).append((f"group{a}", f"free{a}.{b}.{j}"))
            for k, ours in enumerate(routes[a]):
                if not set(ours) & set(theirs):
                    issued.setdefault((a, k), []).append((f"free{b}.{j}", f"free{a}.{b}.{j}"))
    parts: list[list[Candidate]] = []
    for group in range(groups):
        language = rng.randrange(6)
        parts.append([one for one in pool if rng.random() < 0.6])
        some = []
        for k, route in enumerate(routes[group]):
            guided = [("guide", f"lang{language}"), ("guide", f"hall{route[0][0]}")]
            ports = [*wanted.get((group, k), ()), *((f"{port}{n}", one) for n, (port, one) in enumerate(guided))]
            some.append(Candidate(_component(f"route{group:02}.{k}", ports, issued.get((group, k), ()))))
        parts.append(some)
        links += [(2 * group, 2 * group + 1, None, f"guide{n}") for n in range(2)]
    return _task(parts, [1] * len(parts), links)


def depot(lifts: int, zones: int, pickers: int, each: int, seed: int) -> Problem:
    """Zones with so many pickers of one pool, who agree on a shift, want loads and badges, and report to aisles."""
    rng = random.Random(seed)
    variables = [_variable(f"shift{zone}", 3) for zone in range(zones)]
    anywhere = (ANY_VALUE,) * zones
    pool = []
    for k in range(pickers):
        ports = [("load", f"load{rng.randrange(10)}"), ("badge", f"badge{rng.randrange(4)}")]
        picker = _component(f"picker{k:03}", ports, [("done", f"done{rng.randrange(4)}")])
        pool.append((picker, _mask(rng.sample(range(3), rng.choice((1, 2))))))
    some = [
        _component(
            f"lift{k:02}",
            [("aisle", f"a{rng.randrange(6)}")],
            [(f"l{x}", f"load{x}") for x in rng.sample(range(10), 3)],
        )
        for k in range(3 * lifts)
    ]
    aisles = []
    for k in range(10):
        issued = [(f"a{x}", f"a{x}") for x in rng.sample(range(6), 2)] + [("badge", f"badge{rng.randrange(4)}")]
        aisles.append(_component(f"aisle{k:02}", [("done", f"done{rng.randrange(4)}")], issued))
    parts = [[Candidate(one, anywhere) for one in of_role] for of_role in (some, aisles)]
    links: list[Link] = [(1, 0, None, None)]
    for zone in range(zones):
        admits = [[mask if other == zone else ANY_VALUE for other in range(zones)] for _, mask in pool]
        parts.append([Candidate(p, tuple(a)) for (p, _), a in zip(pool, admits, strict=True) if rng.random() < 0.5])
        links += [(0, 2 + zone, None, "load"), (1, 2 + zone, "badge", "badge"), (2 + zone, 1, None, None)]
    return _task(parts, [lifts, 3, *[each] * zones], links, variables)


def patrol(legs: int, robots: int, seed: int) -> Problem:
    """Legs of a patrol, each by a robot that had neither of the two before; a tool and a charge are handed on."""
    rng = random.Random(seed)
    charges, tools = 4, 3
    has = [rng.sample(range(tools), 2) for _ in range(robots)]
    parts: list[list[Candidate]] = []
    links: list[Link] = []
    for leg in range(legs):
        ways = [(r, c, t) for r in range(robots) for c in range(charges) for t in has[r] if rng.random() < 0.35]
        some = []
        for k, (robot, charge, tool) in enumerate(rng.sample(ways, len(ways))):
            wanted = [(f"duty{back}", f"free{leg - back}.{robot}") for back in (1, 2) if leg >= back]
            if leg:
                wanted += [("tool", f"tool{leg - 1}.{tool}"), ("charge", f"charge{leg - 1}.{charge}")]
            left = [charge, charge - 1 if charge else charges - 1]
            issued = [f"free{leg}.{other}" for other in range(robots) if other != robot]
            issued += [f"tool{leg}.{tool}", *(f"charge{leg}.{one}" for one in left)]
            some.append(Candidate(_component(f"leg{leg:02}.{k:02}", wanted, [(one, one) for one in issued])))
        parts.append(some)
        links += [(leg - back, leg, None, f"duty{back}") for back in (1, 2) if leg >= back]
        if leg:
            links += [(leg - 1, leg, None, "tool"), (leg - 1, leg, None, "charge")]
    return _task(parts, [1] * legs, links)

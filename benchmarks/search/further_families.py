"""Further families, on which the search was not tuned at first: constraint problems as their users would wire them.

`CHOOSING` are for choosing how to search, `REPORTING` for reporting how that does, and `UNSEEN` were made after the
search had been changed, to see whether it is any different on these. Two roles that must not be played
by certain pairs are wired through a named input: a candidate of the one issues a signal for each candidate of the other
that it goes with, which is all that a template can say of pairs.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from itertools import combinations

from benchmarks.search.families import Instance, iri, made, profile
from selfconf.model.partition import ANY_VALUE, Candidate, Partition, Variable
from selfconf.model.profile import Input, Output, Profile, shared_ports
from selfconf.model.template import Interaction, Parameter, Role, Task, Template
from selfconf.search.problem import Problem

Goes = Callable[[int, int], bool]
"""Whether a value of one role goes with a value of another."""


def in_pairs(domains: Sequence[Sequence[int]], pairs: Mapping[tuple[int, int], Goes]) -> Problem:
    """A role for each domain, a component for each value; the values of a pair of roles have to go together."""
    inputs: list[list[list[Input]]] = [[[] for _ in domain] for domain in domains]
    outputs: list[list[list[Output]]] = [[[] for _ in domain] for domain in domains]
    for (sink, source), goes in pairs.items():
        for k, value in enumerate(domains[sink]):
            signal = iri(f"{source}.{sink}.{value}")
            inputs[sink][k].append(Input(f"from{source}", (signal,)))
            for n, other in enumerate(domains[source]):
                if goes(value, other):
                    outputs[source][n].append(Output(f"to{sink}.{value}", (signal,)))
    candidates = tuple(
        tuple(
            Candidate(Profile(iri(f"c{role:03}.{value:04}"), ports=shared_ports(tuple(wanted), tuple(issued))))
            for value, wanted, issued in zip(domain, inputs[role], outputs[role], strict=True)
        )
        for role, domain in enumerate(domains)
    )
    template = Template(
        iri("template"),
        tuple(Role(iri(f"role{role}")) for role in range(len(domains))),
        tuple(Interaction(iri(f"role{a}"), iri(f"role{b}"), None, f"from{a}") for b, a in pairs),
    )
    return Problem(Task(template), Partition(candidates))


def counted(
    roles: Sequence[Sequence[Candidate]],
    asked: Sequence[int],
    edges: Iterable[tuple[int, int]],
    variables: tuple[Variable, ...] = (),
) -> Problem:
    """A problem whose roles ask for so many components each."""
    template = Template(
        iri("template"),
        tuple(Role(iri(f"role{k}"), count, count) for k, count in enumerate(asked)),
        tuple(Interaction(iri(f"role{a}"), iri(f"role{b}")) for a, b in edges),
        tuple(Parameter(v.parameter, v.parameter.short, in_shape=True) for v in variables),
    )
    return Problem(Task(template), Partition(tuple(map(tuple, roles)), variables))


def grid(side: int, candidates: int, signals: int, seed: int, wanted: int = 2, issued: int = 2) -> Problem:
    """Roles on a square that feed their four neighbours; each candidate wants some signals and issues some."""
    rng = random.Random(seed)
    place = {(x, y): x * side + y for x in range(side) for y in range(side)}
    edges = [
        (role, place[x + dx, y + dy])
        for (x, y), role in place.items()
        for dx, dy in ((0, 1), (1, 0), (0, -1), (-1, 0))
        if (x + dx, y + dy) in place
    ]
    roles = [
        [
            Candidate(profile(f"c{role:03}.{k:04}", *(rng.sample(range(signals), n) for n in (wanted, issued))))
            for k in range(candidates)
        ]
        for role in place.values()
    ]
    return made(roles, edges)


def tiles(side: int, candidates: int, signals: int, seed: int) -> Problem:
    """Roles on a square that feed the ones to the right and below, a signal each way; one tiling is sure to fit."""
    rng = random.Random(seed)
    right = [[rng.randrange(signals) for _ in range(side)] for _ in range(side)]
    down = [[rng.randrange(signals) for _ in range(side)] for _ in range(side)]
    roles = []
    for x in range(side):
        for y in range(side):
            sure = rng.randrange(candidates)
            some = []
            for k in range(candidates):
                w, n, e, s = (rng.randrange(signals) for _ in range(4))
                if k == sure:
                    w, n, e, s = right[x][y - 1], down[x - 1][y], right[x][y], down[x][y]
                wanted = ([f"r{w}"] if y else []) + ([f"d{n}"] if x else [])
                some.append(Candidate(profile(f"c{x:02}.{y:02}.{k:03}", wanted, [f"r{e}", f"d{s}"])))
            roles.append(some)
    edges = [(x * side + y - 1, x * side + y) for x in range(side) for y in range(1, side)]
    edges += [((x - 1) * side + y, x * side + y) for x in range(1, side) for y in range(side)]
    return made(roles, edges)


def pigeonholes(pigeons: int, holes: int, seed: int = 0, share: float = 1.0) -> Problem:
    """A role for each pigeon, a candidate for each hole that it takes to; no two of a hole go together."""
    rng = random.Random(seed)
    domains = [[h for h in rng.sample(range(holes), holes) if rng.random() < share] or [0] for _ in range(pigeons)]
    return in_pairs(domains, dict.fromkeys(combinations(range(pigeons), 2), _differ))


def _differ(one: int, other: int) -> bool:
    return one != other


def latin(side: int, holes: float, seed: int) -> Problem:
    """A Latin square, shuffled, with a share of its cells left open."""
    rng = random.Random(seed)
    rows, columns, symbols = (rng.sample(range(side), side) for _ in range(3))
    square = [[symbols[(a + b) % side] for b in columns] for a in rows]
    domains = [list(range(side)) if rng.random() < holes else [square[x][y]] for x in range(side) for y in range(side)]
    pairs = {
        (a, b): _differ
        for a, b in combinations(range(side * side), 2)
        if a // side == b // side or a % side == b % side
    }
    return in_pairs(domains, pairs)


def queens(side: int, seed: int = 0, given: int = 0) -> Problem:
    """So many queens, a role for each column; with some of their places taken away at random."""
    rng = random.Random(seed)
    domains = [sorted(rng.sample(range(side), side - given)) for _ in range(side)]
    return in_pairs(domains, {(a, b): partial(_no_attack, b - a) for a, b in combinations(range(side), 2)})


def _no_attack(apart: int, one: int, other: int) -> bool:
    return one != other and abs(one - other) != apart


def colouring(nodes: int, colours: int, degree: float, seed: int) -> Problem:
    """A random graph to be coloured."""
    rng = random.Random(seed)
    every = list(combinations(range(nodes), 2))
    pairs = sorted(rng.sample(every, min(len(every), round(nodes * degree / 2))))
    return in_pairs([list(range(colours))] * nodes, dict.fromkeys(pairs, _differ))


def binary(roles: int, values: int, pairs: int, tightness: float, seed: int) -> Problem:
    """Random relations between random pairs of roles (model B of the literature)."""
    rng = random.Random(seed)
    found: dict[tuple[int, int], Goes] = {}
    for pair in rng.sample(list(combinations(range(roles), 2)), pairs):
        every = [(a, b) for a in range(values) for b in range(values)]
        forbidden = frozenset(rng.sample(every, round(tightness * len(every))))
        found[pair] = partial(_permitted, forbidden)
    return in_pairs([list(range(values))] * roles, found)


def _permitted(forbidden: frozenset[tuple[int, int]], one: int, other: int) -> bool:
    return (one, other) not in forbidden


def ring(roles: int, asked: int, candidates: int, signals: int, seed: int) -> Problem:
    """Roles in a ring that ask for several components each; each wants a signal and issues one."""
    rng = random.Random(seed)
    parts = [
        [
            Candidate(profile(f"c{role:03}.{k:03}", [rng.randrange(signals)], [rng.randrange(signals)]))
            for k in range(candidates)
        ]
        for role in range(roles)
    ]
    return counted(parts, [asked] * roles, [(k, (k + 1) % roles) for k in range(roles)])


def dumbbell(roles: int, candidates: int, signals: int, values: int, seed: int) -> Problem:
    """Two dense ecologies that share nothing but the value of a free parameter."""
    rng = random.Random(seed)
    variable = Variable(iri("site"), tuple(iri(f"value{k:02}") for k in range(values)))
    parts, edges = [], []
    for half in range(2):
        start = half * roles
        for role in range(roles):
            sources = sorted(rng.sample(range(role), min(role, 3)))
            edges += [(start + source, start + role) for source in sources]
            parts.append(
                [
                    Candidate(
                        profile(
                            f"c{start + role:03}.{k:03}",
                            [f"{start + source}.{rng.randrange(signals)}" for source in sources],
                            [f"{start + role}.{rng.randrange(signals)}"],
                        ),
                        (ANY_VALUE if rng.random() < 0.3 else sum(1 << v for v in rng.sample(range(values), 2)),),
                    )
                    for k in range(candidates)
                ]
            )
    return counted(parts, [1] * len(parts), edges, (variable,))


def tour(places: int, degree: float, seed: int) -> Problem:
    """A walk through all places: a role for each stop, each place hands over to its neighbours, none twice."""
    rng = random.Random(seed)
    near: dict[int, set[int]] = {k: set() for k in range(places)}
    for a, b in rng.sample(list(combinations(range(places), 2)), round(places * degree / 2)):
        near[a].add(b)
        near[b].add(a)
    start = Candidate(profile("start", (), [f"to{k}" for k in sorted(near[0])]))
    others = [
        Candidate(profile(f"place{k:03}", [f"to{k}"], [f"to{n}" for n in sorted(near[k])])) for k in range(1, places)
    ]
    return made([[start], *([others] * (places - 1))], [(k - 1, k) for k in range(1, places)])


def cover(signals: int, stations: int, most: int, share: float, seed: int) -> Problem:
    """So many stations of a role that together issue all the signals that one sink wants."""
    rng = random.Random(seed)
    some = [[s for s in range(signals) if rng.random() < share] for _ in range(stations)]
    parts = [Candidate(profile(f"station{k:03}", (), issued)) for k, issued in enumerate(some)]
    return counted([parts, [Candidate(profile("sink", range(signals)))]], [most, 1], [(0, 1)])


def parity(checks: int, degree: int, seed: int) -> Problem:
    """Checks on a random regular graph whose edges are bits: each check wants an odd or an even number of ones."""
    rng = random.Random(seed)
    ends = [k for k in range(checks) for _ in range(degree)]
    rng.shuffle(ends)
    bits = [(a, b) for a, b in zip(ends[::2], ends[1::2], strict=True) if a != b]
    parts = [[Candidate(profile(f"bit{k:03}.{v}", (), [f"bit{k}.{v}"])) for v in (0, 1)] for k in range(len(bits))]
    edges = []
    odd = [rng.randrange(2) for _ in range(checks)]
    hidden = [rng.randrange(2) for _ in bits]
    for check in range(checks):
        mine = [k for k, pair in enumerate(bits) if check in pair]
        odd[check] = sum(hidden[k] for k in mine) % 2
        ways = [way for way in range(1 << len(mine)) if way.bit_count() % 2 == odd[check]]
        parts.append(
            [
                Candidate(profile(f"check{check:03}.{way:02}", [f"bit{k}.{way >> n & 1}" for n, k in enumerate(mine)]))
                for way in ways
            ]
        )
        edges += [(k, len(bits) + check) for k in mine]
    return made(parts, edges)


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


def langford(pairs: int, seed: int) -> Problem:
    """Langford's problem: the two of number k stand k apart; a role for each number, a candidate for each place."""
    rng = random.Random(seed)
    domains = [rng.sample(range(places), places) for places in (2 * pairs - k - 1 for k in range(1, pairs + 1))]

    def apart(first: int, second: int) -> Goes:
        def goes(a: int, b: int) -> bool:
            return len({a, a + first + 1, b, b + second + 1}) == 4

        return goes

    return in_pairs(domains, {(a, b): apart(a + 1, b + 1) for a, b in combinations(range(pairs), 2)})


def frequencies(radios: int, channels: int, reach: float, seed: int) -> Problem:
    """Radios on a square: two near each other use channels apart, and further apart the nearer they are."""
    rng = random.Random(seed)
    places = [(rng.random(), rng.random()) for _ in range(radios)]
    pairs: dict[tuple[int, int], Goes] = {}
    for a, b in combinations(range(radios), 2):
        distance = math.dist(places[a], places[b])
        if distance < reach:
            pairs[a, b] = partial(_apart, 1 + (distance < 0.7 * reach) + (distance < 0.4 * reach))
    return in_pairs([rng.sample(range(channels), channels - 2) for _ in range(radios)], pairs)


def _apart(least: int, one: int, other: int) -> bool:
    return abs(one - other) >= least


def plant(layers: int, width: int, asked: int, candidates: int, signals: int, seed: int) -> Problem:
    """Layers of roles for several machines each; a machine wants two products of the layer above, and makes two."""
    rng = random.Random(seed)
    parts, edges = [], []
    for layer in range(layers):
        for place in range(width):
            role = layer * width + place
            edges += [(role - width - place + above, role) for above in rng.sample(range(width), 2) if layer]
            parts.append(
                [
                    Candidate(
                        profile(
                            f"m{role:03}.{k:03}",
                            [f"p{layer}.{s}" for s in rng.sample(range(signals), 2)] if layer else [],
                            [f"p{layer + 1}.{s}" for s in rng.sample(range(signals), 2)],
                        )
                    )
                    for k in range(candidates)
                ]
            )
    return counted(parts, [asked] * len(parts), edges)


def agreements(roles: int, candidates: int, parameters: int, values: int, share: float, seed: int) -> Problem:
    """Roles whose candidates admit some values of a few of many free parameters, which all have to agree on."""
    rng = random.Random(seed)
    variables = tuple(
        Variable(iri(f"parameter{p}"), tuple(iri(f"value{p}.{v:02}") for v in range(values))) for p in range(parameters)
    )
    parts = []
    for role in range(roles):
        about = rng.sample(range(parameters), 3)
        parts.append(
            [
                Candidate(
                    profile(f"c{role:03}.{k:03}"),
                    tuple(
                        sum(1 << v for v in range(values) if rng.random() < share) if p in about else ANY_VALUE
                        for p in range(parameters)
                    ),
                )
                for k in range(candidates)
            ]
        )
    return counted(parts, [1] * roles, (), variables)


Family = tuple[tuple[str, Callable[[int], Problem]], ...]
"""What each size is called, and how an instance is made from a seed."""

CHOOSING: dict[str, Family] = {
    "grid": (
        ("8 x 8, 20 candidates, 12 signals", lambda seed: grid(8, 20, 12, seed)),
        ("8 x 8, 50 candidates, 12 signals", lambda seed: grid(8, 50, 12, seed, 3)),
        ("8 x 8, 100 candidates, 12 signals", lambda seed: grid(8, 100, 12, seed, 3)),
    ),
    "pigeonholes": (
        ("10 in 9", lambda seed: pigeonholes(10, 9, seed)),
        ("11 in 10", lambda seed: pigeonholes(11, 10, seed)),
        ("20 in 20", lambda seed: pigeonholes(20, 20, seed)),
        ("16 in 16, each takes to half", lambda seed: pigeonholes(16, 16, seed, 0.4)),
    ),
    "ring": (
        ("20 roles of 2", lambda seed: ring(20, 2, 12, 6, seed)),
        ("40 roles of 2", lambda seed: ring(40, 2, 12, 6, seed)),
        ("100 roles of 3", lambda seed: ring(100, 3, 12, 8, seed)),
    ),
    "Latin square": (
        ("8, 42 % open", lambda seed: latin(8, 0.42, seed)),
        ("12, 42 % open", lambda seed: latin(12, 0.42, seed)),
        ("15, 42 % open", lambda seed: latin(15, 0.42, seed)),
    ),
    "colouring": (("60 nodes, 4 colours", lambda seed: colouring(60, 4, 8.4, seed)),),
    "tour": (("16 places", lambda seed: tour(16, 4.0, seed)), ("24 places", lambda seed: tour(24, 4.0, seed))),
}
"""What ideas and thresholds are chosen on."""

REPORTING: dict[str, Family] = {
    "tiles": (
        ("10 x 10, 12 candidates, 3 signals", lambda seed: tiles(10, 12, 3, seed)),
        ("18 x 18, 14 candidates, 4 signals", lambda seed: tiles(18, 14, 4, seed)),
    ),
    "queens": (("16", lambda seed: queens(16, seed, 4)), ("24", lambda seed: queens(24, seed, 6))),
    "dumbbell": (
        ("30 roles twice", lambda seed: dumbbell(30, 10, 4, 6, seed)),
        ("40 roles twice", lambda seed: dumbbell(40, 14, 3, 10, seed)),
    ),
    "pairs": (
        ("25 roles of 8", lambda seed: binary(25, 8, 100, 0.35, seed)),
        ("40 roles of 8", lambda seed: binary(40, 8, 200, 0.32, seed)),
    ),
    "cover": (
        ("9 of 40 stations", lambda seed: cover(60, 40, 9, 0.2, seed)),
        ("12 of 60 stations", lambda seed: cover(100, 60, 12, 0.2, seed)),
    ),
    "parity": (
        ("24 checks", lambda seed: parity(24, 4, seed)),
        ("80 checks", lambda seed: parity(80, 4, seed)),
    ),
    "crew": (
        ("25 roles, 27 people", lambda seed: crew(25, 27, 9, 0.4, seed)),
        ("40 roles, 43 people", lambda seed: crew(40, 43, 12, 0.4, seed)),
    ),
    "Langford": (("8", lambda seed: langford(8, seed)), ("11", lambda seed: langford(11, seed))),
}
"""What is only measured."""

UNSEEN: dict[str, Family] = {
    "frequencies": (
        ("40 radios, 10 channels", lambda seed: frequencies(40, 10, 0.3, seed)),
        ("80 radios, 14 channels", lambda seed: frequencies(80, 14, 0.25, seed)),
    ),
    "plant": (
        ("5 layers of 4 roles of 2", lambda seed: plant(5, 4, 2, 12, 7, seed)),
        ("10 layers of 6 roles of 2", lambda seed: plant(10, 6, 2, 16, 8, seed)),
    ),
    "agreements": (
        ("30 roles, 8 parameters", lambda seed: agreements(30, 8, 8, 8, 0.4, seed)),
        ("60 roles, 12 parameters", lambda seed: agreements(60, 8, 12, 10, 0.4, seed)),
    ),
}
"""What is measured once the search is finished."""

SMALL: dict[str, Family] = {
    "grid": (("3 x 3", lambda seed: grid(3, 4, 4, seed)),),
    "pigeonholes": (("4 in 3", lambda seed: pigeonholes(4, 3, seed)),),
    "Latin square": (("4, half open", lambda seed: latin(4, 0.5, seed)),),
    "ring": (("5 roles of 2", lambda seed: ring(5, 2, 5, 3, seed)),),
}
"""One small size of some, to see that everything runs."""


def instances(families: Mapping[str, Family], seeds: Iterable[int]) -> Iterator[Instance]:
    """The instances of some families, one for each seed."""
    for family, sizes in families.items():
        for size, (name, make) in enumerate(sizes):
            for seed in seeds:
                yield Instance(family, f"{name}, seed {seed}", size, partial(make, seed))

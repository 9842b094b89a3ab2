"""Families of roles whose candidates go together at random."""

from __future__ import annotations

import random
from functools import partial
from itertools import combinations, product

from benchmarks.search.families.wiring import Goes, counted, heard_by_name, hearing, in_pairs, iri, made, profile
from selfconf.model.partition import ANY_VALUE, Candidate, Variable
from selfconf.search.problem import Problem


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

"""Families that were made once the search did well on `further_families`, to find what it still lacks.

`LATER_CHOOSING` are those on which it was changed again, and `LATER_REPORTING` those on which that was only measured.
"""

from __future__ import annotations

import math
import random
from collections.abc import Mapping
from itertools import combinations, product

from benchmarks.search.families import iri, made, profile
from benchmarks.search.further_families import Family, counted
from selfconf.model.partition import ANY_VALUE, Candidate, Variable
from selfconf.search.problem import Problem


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


def coloured_parameters(nodes: int, colours: int, degree: float, seed: int) -> Problem:
    """A random graph to be coloured: a free parameter for each node, a role for each edge that names two colours."""
    rng = random.Random(seed)
    edges = rng.sample(list(combinations(range(nodes), 2)), round(nodes * degree / 2))
    variables = tuple(
        Variable(iri(f"node{n:03}"), tuple(iri(f"colour{n:03}.{c}") for c in range(colours))) for n in range(nodes)
    )
    pairs = [(a, b) for a, b in product(range(colours), repeat=2) if a != b]
    parts = []
    for number, (one, other) in enumerate(edges):
        some = []
        for k, (a, b) in enumerate(rng.sample(pairs, len(pairs))):
            admits = [ANY_VALUE] * nodes
            admits[one], admits[other] = 1 << a, 1 << b
            some.append(Candidate(profile(f"edge{number:03}.{k:02}"), tuple(admits)))
        parts.append(some)
    return counted(parts, [1] * len(parts), (), variables)


def domination(side: int, most: int, seed: int) -> Problem:
    """So many guards on a square with gaps that see every cell between them: their own one, and those beside it."""
    rng = random.Random(seed)
    cells = [cell for cell in product(range(side), repeat=2) if rng.random() > 0.1]
    guards = [
        Candidate(
            profile(
                f"guard{k:03}",
                (),
                [f"{a}.{b}" for a, b in ((x, y), (x, y + 1), (x + 1, y), (x, y - 1), (x - 1, y)) if (a, b) in cells],
            )
        )
        for k, (x, y) in enumerate(rng.sample(cells, len(cells)))
    ]
    sink = [Candidate(profile("sink", [f"{x}.{y}" for x, y in cells]))]
    return counted([guards, sink], [most, 1], [(0, 1)])


def sums(checks: int, degree: int, seed: int) -> Problem:
    """Checks on a random regular graph whose edges are digits of three: each wants some balance of what comes and goes.

    In three of ten, one check is off by one.
    """
    rng = random.Random(seed)
    ends = [k for k in range(checks) for _ in range(degree)]
    rng.shuffle(ends)
    digits = [(a, b) for a, b in zip(ends[::2], ends[1::2], strict=True) if a != b]
    hidden = [rng.randrange(3) for _ in digits]
    off = rng.random() < 0.3
    parts = [
        [Candidate(profile(f"digit{k:03}.{v}", (), [f"digit{k}.{v}"])) for v in range(3)] for k in range(len(digits))
    ]
    edges = []
    for check in range(checks):
        mine = [k for k, pair in enumerate(digits) if check in pair]
        signs = [1 if digits[k][0] == check else -1 for k in mine]
        wanted = sum(sign * hidden[k] for sign, k in zip(signs, mine, strict=True)) + (off and check == 0)
        ways = [
            way
            for way in product(range(3), repeat=len(mine))
            if (sum(sign * v for sign, v in zip(signs, way, strict=True)) - wanted) % 3 == 0
        ]
        parts.append(
            [
                Candidate(profile(f"check{check:03}.{n:02}", [f"digit{k}.{v}" for k, v in zip(mine, way, strict=True)]))
                for n, way in enumerate(ways)
            ]
        )
        edges += [(k, len(digits) + check) for k in mine]
    return made(parts, edges)


def latin_parameters(side: int, holes: float, seed: int) -> Problem:
    """A Latin square with open cells: a free parameter says where a symbol stands in a row, or in a column."""
    rng = random.Random(seed)
    rows, columns, symbols = (rng.sample(range(side), side) for _ in range(3))
    names = list(product("rc", range(side), range(side)))
    variables = tuple(
        Variable(iri(f"{of}{line}.{symbol}"), tuple(iri(f"{of}{line}.{symbol}.{k}") for k in range(side)))
        for of, line, symbol in names
    )
    place = {name: number for number, name in enumerate(names)}
    parts = []
    for x, y in product(range(side), repeat=2):
        known = symbols[(rows[x] + columns[y]) % side]
        some = []
        for symbol in range(side) if rng.random() < holes else (known,):
            admits = [ANY_VALUE] * len(names)
            admits[place["r", x, symbol]], admits[place["c", y, symbol]] = 1 << y, 1 << x
            some.append(Candidate(profile(f"cell{x}.{y}.{symbol}"), tuple(admits)))
        parts.append(some)
    return counted(parts, [1] * len(parts), (), variables)


def crossword(side: int, words: int, letters: int, seed: int) -> Problem:
    """As many random words across as down, which agree where they cross; none twice."""
    rng = random.Random(seed)
    lexicon = list(dict.fromkeys("".join(rng.choice("abcdefgh"[:letters]) for _ in range(side)) for _ in range(words)))
    across = [
        [
            Candidate(profile(f"word-{word}", (), [f"{row}.{k}.{letter}" for k, letter in enumerate(word)]))
            for word in lexicon
        ]
        for row in range(side)
    ]
    down = [
        [
            Candidate(profile(f"word-{word}", [f"{k}.{column}.{letter}" for k, letter in enumerate(word)]))
            for word in lexicon
        ]
        for column in range(side)
    ]
    return made([*across, *down], list(product(range(side), range(side, 2 * side))))


LATER_CHOOSING: Mapping[str, Family] = {
    "relay chain": (
        ("8 hops, 60 relays", lambda seed: relay_chain(8, 60, 0.2, seed)),
        ("14 hops, 100 relays", lambda seed: relay_chain(14, 100, 0.16, seed)),
    ),
    "missions": (
        ("9 of 50 robots, 4 of 24 chargers", lambda seed: missions(50, 9, 24, 4, 24, seed)),
        ("12 of 80 robots, 6 of 40 chargers", lambda seed: missions(80, 12, 40, 6, 36, seed)),
    ),
    "relief": (("12 shifts of 5 of 100", lambda seed: relief(12, 5, 100, 4, seed)),),
    "coloured parameters": (
        ("20 nodes, 3 colours", lambda seed: coloured_parameters(20, 3, 4.2, seed)),
        ("40 nodes, 4 colours", lambda seed: coloured_parameters(40, 4, 8.0, seed)),
    ),
}
"""What the search was changed on."""

LATER_REPORTING: Mapping[str, Family] = {
    "domination": (
        ("12 on 7 x 7", lambda seed: domination(7, 12, seed)),
        ("16 on 8 x 8", lambda seed: domination(8, 16, seed)),
    ),
    "sums": (("16 checks", lambda seed: sums(16, 4, seed)), ("40 checks", lambda seed: sums(40, 4, seed))),
    "Latin by parameters": (
        ("6, half open", lambda seed: latin_parameters(6, 0.5, seed)),
        ("8, 45 % open", lambda seed: latin_parameters(8, 0.45, seed)),
    ),
    "crossword": (
        ("4 x 4, 100 words", lambda seed: crossword(4, 100, 6, seed)),
        ("5 x 5, 300 words", lambda seed: crossword(5, 300, 5, seed)),
    ),
}
"""What was only measured."""

LATER_SMALL: Mapping[str, Family] = {
    "relay chain": (("2 hops", lambda seed: relay_chain(2, 8, 0.5, seed)),),
    "missions": (("3 of 8 robots", lambda seed: missions(8, 3, 4, 2, 6, seed)),),
    "relief": (("3 shifts of 2", lambda seed: relief(3, 2, 12, 2, seed)),),
    "coloured parameters": (("4 nodes", lambda seed: coloured_parameters(4, 3, 2.0, seed)),),
    "domination": (("4 on 3 x 3", lambda seed: domination(3, 4, seed)),),
    "sums": (("4 checks", lambda seed: sums(4, 3, seed)),),
    "Latin by parameters": (("3, half open", lambda seed: latin_parameters(3, 0.5, seed)),),
    "crossword": (("2 x 2", lambda seed: crossword(2, 8, 2, seed)),),
}
"""One small size of each, to see that everything runs."""

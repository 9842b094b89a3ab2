"""Families after puzzles and problems on boards."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping
from functools import partial
from itertools import combinations, permutations, product
from operator import ne

from benchmarks.search.families.wiring import Goes, counted, in_pairs, iri, made, profile
from selfconf.model.partition import ANY_VALUE, Candidate, Variable
from selfconf.search.problem import Problem


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
    return in_pairs(domains, dict.fromkeys(combinations(range(pigeons), 2), ne))


def latin(side: int, holes: float, seed: int) -> Problem:
    """A Latin square, shuffled, with a share of its cells left open."""
    rng = random.Random(seed)
    rows, columns, symbols = (rng.sample(range(side), side) for _ in range(3))
    square = [[symbols[(a + b) % side] for b in columns] for a in rows]
    domains = [list(range(side)) if rng.random() < holes else [square[x][y]] for x in range(side) for y in range(side)]
    pairs = {
        (a, b): ne for a, b in combinations(range(side * side), 2) if a // side == b // side or a % side == b % side
    }
    return in_pairs(domains, pairs)


def queens(side: int, seed: int = 0, given: int = 0) -> Problem:
    """So many queens, a role for each column; with some of their places taken away at random."""
    rng = random.Random(seed)
    domains = [sorted(rng.sample(range(side), side - given)) for _ in range(side)]
    return in_pairs(domains, {(a, b): partial(_no_attack, b - a) for a, b in combinations(range(side), 2)})


def _no_attack(apart: int, one: int, other: int) -> bool:
    return one != other and abs(one - other) != apart


def langford(pairs: int, seed: int) -> Problem:
    """Langford's problem: the two of number k stand k apart; a role for each number, a candidate for each place."""
    rng = random.Random(seed)
    domains = [rng.sample(range(places), places) for places in (2 * pairs - k - 1 for k in range(1, pairs + 1))]

    def apart(first: int, second: int) -> Goes:
        def goes(a: int, b: int) -> bool:
            return len({a, a + first + 1, b, b + second + 1}) == 4

        return goes

    return in_pairs(domains, {(a, b): apart(a + 1, b + 1) for a, b in combinations(range(pairs), 2)})


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

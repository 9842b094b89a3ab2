"""Families after sums, parities and circuits of gates."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from itertools import product

from benchmarks.search.families.wiring import made, profile
from selfconf.model.partition import Candidate
from selfconf.search.problem import Problem


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

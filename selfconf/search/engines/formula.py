"""A formula: clauses, and bounds on how many of some literals hold, as solvers read them.

Literals are whole numbers from one; the negation of a literal is its negative. A formula grows by what is added to it,
and never loses anything.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterator, Sequence
from enum import IntEnum
from functools import reduce
from operator import and_, or_
from typing import NamedTuple

FEW_TO_COUNT = 4
"""At most this number of some is counted one after the other, in fewer clauses than a totalizer has; more by that."""


class Counted(IntEnum):
    """Which bounds a solver that counts by itself gets as clauses that count instead, about which it can learn."""

    NONE = 0
    MANY = 1
    """Those that count many: of few, and of most of them, there is little to learn."""
    ALL = 2
    """All but those that say that options exclude each other; with which option plays in a role of one slot."""


class AtMost(NamedTuple):
    """At most a number of the literals hold, if the literals whose negations are in `force` do."""

    literals: Sequence[int]
    most: int
    force: Sequence[int] = ()
    exactly: bool = False
    """Whether as many as that do hold."""

    @property
    def counts(self) -> bool:
        """Whether it counts several of the literals, and no more than half of them."""
        return 1 < self.most <= len(self.literals) // 2

    @property
    def counts_many(self) -> bool:
        """Whether it counts many of the literals, and no more than half of them."""
        return self.counts and self.most > FEW_TO_COUNT

    def is_counted(self, counted: Counted) -> bool:
        """Whether it is one of these bounds."""
        return self.counts_many if counted is Counted.MANY else bool(counted) and (self.most > 1 or self.exactly)


class Implied(NamedTuple):
    """Each of the literals implies the literal: a clause of two literals for each, written when a solver reads it."""

    literal: int
    literals: Sequence[int]
    alone: bool = True
    """Whether nothing else brings the literal about, so that some solvers take them as one constraint."""


class Formula:
    """Clauses and bounds, with literals for what is said of others."""

    def __init__(self) -> None:
        self.top = 0
        """The highest literal so far."""
        self.statements: list[list[int] | Implied] = []
        """The clauses, as lists of literals or several in one."""
        self.bounds: list[AtMost] = []
        self._sums: dict[tuple[int, ...], int] = {}
        """The literals that hold iff one of others does, by these."""

    @property
    def size(self) -> int:
        """About how many clauses there are, for a solver that needs them to count."""
        clauses = sum([len(one.literals) if isinstance(one, Implied) else 1 for one in self.statements])
        return clauses + sum([len(some) * min(most, len(some) - most) for some, most, *_ in self.bounds])

    def clauses(self) -> Iterator[list[int]]:
        """Yield the clauses one by one."""
        for statement in self.statements:
            if isinstance(statement, Implied):
                for one in statement.literals:
                    yield [-one, statement.literal]
            else:
                yield statement

    def literal(self) -> int:
        """Return a new literal."""
        self.top += 1
        return self.top

    def contradict(self) -> None:
        """Let there be no model."""
        self.statements += [[self.literal()], [-self.top]]

    def at_most(self, literals: Sequence[int], most: int, force: Sequence[int] = (), exactly: bool = False) -> None:
        """Let at most so many of some literals hold, where what is in force says so; `exactly` if no fewer ever do."""
        if most < len(literals):
            self.bounds.append(AtMost(literals, most, force, exactly))

    def any_of(self, literals: list[int]) -> int:
        """Return a literal that holds iff one of some does."""
        if len(literals) == 1:
            return literals[0]
        known = tuple(literals)
        found = self._sums.get(known)
        if found is None:
            found = self._sums[known] = self.literal()
            self.statements.append([-found, *literals])
            self.statements.append(Implied(found, literals))
        return found

    def one_value(self, constrained: Sequence[tuple[int, int]], force: Sequence[int]) -> list[tuple[int, int]]:
        """Let what holds have a value of a variable in common, given literals with the masks of what they admit.

        Return the masks of values that have a literal, with that.
        """
        by_mask: defaultdict[int, list[int]] = defaultdict(list)
        for literal, mask in constrained:
            by_mask[mask].append(literal)
        if reduce(and_, by_mask):
            return []  # one value suits all of them
        values = [(alike, self.literal()) for alike in _told_apart(by_mask)]
        self.at_most([value for _, value in values], 1)
        for mask, literals in by_mask.items():
            # A mask below zero admits every value but some: it only forbids these, and a model may set none at all.
            said = (
                [[*force, *[value for some, value in values if mask & some]]]
                if mask >= 0
                else [[*force, -value] for some, value in values if not mask & some]
            )
            self.statements += [[-literal, *rest] for rest in said for literal in literals]
        return values

    def ascending(self, first: Sequence[int], second: Sequence[int]) -> None:
        """Let what holds of the first literals stand before what holds of the second; one of each does."""
        before: int | None = None
        for earlier, later in zip(first, second, strict=True):
            self.statements.append([-later] if before is None else [-later, before])
            reached = self.literal()
            self.statements.append([-reached, earlier] if before is None else [-reached, earlier, before])
            before = reached


def _told_apart(masks: Collection[int]) -> list[int]:
    """Return the values that masks of zero or more admit, as disjoint masks: together those that none tells apart.

    What only masks below zero admit is left out, as each of them admits values beside those that have a bit.
    """
    named = reduce(or_, [mask for mask in masks if mask >= 0], 0)
    if named.bit_count() <= len(masks):
        # So many masks leave hardly any values alike, so that to look for these takes longer than it saves.
        return [1 << bit for bit in range(named.bit_length()) if named >> bit & 1]
    parts = [named]
    for mask in masks:
        parts = [one for part in parts for one in (part & mask, part & ~mask) if one]
    return parts

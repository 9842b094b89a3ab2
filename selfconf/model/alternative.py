"""A candidate for a role beside the others: its preference, its cost, and what a configuration with it costs."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction
from typing import NamedTuple

from selfconf.model.term import IRI


class Alternative(NamedTuple):
    """A candidate for a role, and what comes of it."""

    component: IRI
    preference: Decimal
    cost: tuple[Fraction, ...]
    """What it costs in the role, by level; empty where the template states no cost."""
    unknown_terms: int
    """How many terms of the cost are over a property that it does not have."""
    chosen: bool
    """Whether it plays the role in the answer."""
    outcome: str
    """`possible` with it, `impossible`, `undecided` within the time, or `not tried`."""
    total: tuple[Fraction, ...] = ()
    """What the cheapest configuration with it costs, by level; empty where no cost is stated, or there is none."""
    total_unknown_terms: int = 0
    """How many terms of that cost are unknown."""
    proved: bool = True
    """Whether nothing with it costs less for sure."""

    def extra(self, best: Alternative | None) -> tuple[Fraction, ...]:
        """What the cheapest configuration with it costs beyond that with another candidate, by level."""
        if best is None or not self.total or len(self.total) != len(best.total):
            return ()
        return tuple(mine - other for mine, other in zip(self.total, best.total, strict=True))

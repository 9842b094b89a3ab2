"""An optimum: a configuration with what it costs, and whether nothing costs less."""

from __future__ import annotations

from fractions import Fraction

from selfconf.model.configuration import Configuration
from selfconf.model.immutable import immutable
from selfconf.model.refusal import Outcome
from selfconf.model.term import IRI


@immutable
class Optimum:
    """A configuration, what its solution costs on each level, and what any solution costs at least."""

    configuration: Configuration
    cost: tuple[Fraction, ...]
    bound: tuple[Fraction, ...]
    missing: tuple[tuple[IRI, IRI], ...]
    """Components of the solution and the properties that terms ask for in vain, with nothing said for that."""
    proved: bool
    """Whether nothing costs less for sure."""
    first: bool = True
    """Whether none that costs as little comes before it for sure."""
    unaided: bool = False
    """Whether it was found without the extra `solvers`, which might have proved more."""

    @property
    def unknown_terms(self) -> int:
        """How many terms of the cost are over a property that a component does not have."""
        return len(self.missing)


def outcome_of(answer: Optimum | Outcome) -> Outcome:
    """What a search has come to, without what that costs."""
    return answer.configuration if isinstance(answer, Optimum) else answer

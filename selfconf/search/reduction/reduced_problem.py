"""The problem in small integers: needs, and the kinds of candidates that may serve them.

An input that role r must have fed is a *need*: the role, the links that may feed it, and the signal. Needs are
numbered. What a candidate needs in a role, what it gives to the roles fed by that role, and what it lets the variables
be make its *kind*; two candidates of a role with the same ports and values have the same kind, which is worked out
once. Output types are expanded upward, once per output and role, to the needs they serve (`wiring`).

A compact problem has only the candidates that can matter, as options of slots (`kernel`), and loses more of them to
arc consistency (`consistency`).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from operator import attrgetter

from selfconf.model.partition import Candidate
from selfconf.model.profile import Ports
from selfconf.model.term import IRI
from selfconf.search.problem import Problem
from selfconf.search.reduction.needs import Need

Likeness = tuple[Ports, tuple[int, ...]]
"""All of a candidate that its kind depends on: its ports, and what it lets the variables be."""

likeness: Callable[[Candidate], Likeness] = attrgetter("profile.ports", "admits")


class InterchangeabilityClass:
    """What a candidate is to the search, in one role: numbers of needs, and masks of values."""

    __slots__ = ("admits", "gives", "likes", "needs", "number", "role")

    def __init__(
        self,
        role: int,
        needs: tuple[int, ...],
        gives: tuple[int, ...],
        admits: tuple[int, ...],
        number: int = -1,
        likes: tuple[Likeness, ...] = (),
    ) -> None:
        self.role, self.needs, self.gives, self.admits = role, needs, gives, admits
        self.number, self.likes = number, likes
        """The number of the first candidate of this kind, and what candidates of this kind have."""


class Option:
    """A candidate that a slot may take: its number in the role's order, its component and its kind."""

    __slots__ = ("component", "kind", "number")

    def __init__(self, number: int, component: IRI, kind: InterchangeabilityClass) -> None:
        self.number, self.component, self.kind = number, component, kind


@dataclass(frozen=True, slots=True)
class Removal:
    """Why a kind left: a need that nobody left can serve, or a variable with no value that every role can have."""

    kind: InterchangeabilityClass
    need: int | None = None
    variable: int | None = None


@dataclass(frozen=True, slots=True)
class ReducedProblem:
    """The kernel of a problem: options per role, the needs by number, and how others left."""

    slots: tuple[int, ...]
    """The role of each slot, in order; a role that asks for k components has k slots."""
    options: tuple[tuple[Option, ...], ...]
    needs: tuple[Need, ...]
    values: tuple[int, ...]
    """What each variable may be before anybody plays."""
    departures: tuple[Removal, ...] = ()

    def short(self) -> int | None:
        """The first role with fewer options than slots, if there is one: then there is no solution."""
        asked = Counter(self.slots)
        return next((role for role, slots in asked.items() if len(self.options[role]) < slots), None)

    def kinds(self) -> list[InterchangeabilityClass]:
        """The kinds that options are of, in order."""
        return list(dict.fromkeys([option.kind for options in self.options for option in options]))


def assigned(problem: Problem, chosen: Iterable[Option]) -> list[list[Candidate]]:
    """Return for each role of a problem the candidates that the chosen options stand for."""
    playing: list[list[Candidate]] = [[] for _ in problem.roles]
    for option in chosen:
        role = option.kind.role
        playing[role].append(problem.candidates[role][option.number])
    return playing

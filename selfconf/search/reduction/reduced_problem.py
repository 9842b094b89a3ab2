"""The reduced problem: needs, and the interchangeability classes of candidates that may support them, in numbers.

An input that role r must have fed is a *need*: the role, the links that may feed it, and the signal. Needs are
numbered. What a candidate needs in a role, what it supports in the roles fed by that role, and which values of the
variables it admits make its *interchangeability class* (Freuder, AAAI 1991), in identifiers `kind` for short: in every
solution, a candidate can be exchanged for a free one of its class. Candidates of a role with equal ports and values
have the same class, which is worked out once.

A reduced problem has only the candidates that can matter, as options of slots (`dominance`), and loses more of them to
arc consistency (`arc_consistency`). In terms of constraint satisfaction a slot is a variable, its options are the
domain of the variable, and a need is a constraint between the slots of a role and those of the roles that feed it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Set
from operator import attrgetter
from typing import NamedTuple

from selfconf.model.immutable import immutable, replace
from selfconf.model.partition import Candidate
from selfconf.model.profile import Ports
from selfconf.model.term import IRI
from selfconf.search.problem import Problem
from selfconf.search.reduction.needs import Needs

Signature = tuple[Ports, tuple[int, ...]]
"""All of a candidate that decides its interchangeability class: its ports, and the values that it admits."""

signature: Callable[[Candidate], Signature] = attrgetter("profile.ports", "admits")


class InterchangeabilityClass:
    """Candidates of one role that the search need not tell apart: numbers of needs, and masks of values.

    It admits any value of a variable for which there is no mask: of many variables most classes constrain few.
    """

    __slots__ = ("admits", "needs", "number", "role", "signatures", "supports")

    def __init__(
        self,
        role: int,
        needs: tuple[int, ...],
        supports: tuple[int, ...],
        admits: Mapping[int, int],
        number: int = -1,
        signatures: tuple[Signature, ...] = (),
    ) -> None:
        self.role, self.needs, self.supports, self.admits = role, needs, supports, admits
        self.number, self.signatures = number, signatures
        """The number of the first candidate of this class, and the signatures of its candidates."""


class Option:
    """A candidate that a slot may take: its number in the role's order, its component and its class."""

    __slots__ = ("component", "kind", "number")

    def __init__(self, number: int, component: IRI, kind: InterchangeabilityClass) -> None:
        self.number, self.component, self.kind = number, component, kind


class Removal(NamedTuple):
    """Why a class is in no solution: a need without support, or a variable without a value that every role admits."""

    kind: InterchangeabilityClass
    need: int | None = None
    variable: int | None = None


class Limit(NamedTuple):
    """Options, by their roles and numbers, of which no more than a number play in any solution."""

    options: Set[tuple[int, int]]
    most: int


@immutable
class ReducedProblem:
    """Options for each role, the needs by number, and the removals by which arc consistency made the options fewer."""

    slots: tuple[int, ...]
    """The role of each slot, in order; a role that asks for k components has k slots."""
    options: tuple[tuple[Option, ...], ...]
    needs: Needs
    values: tuple[int, ...]
    """The values that each variable may have before any slot is filled, as a mask."""
    removals: tuple[Removal, ...] = ()
    limits: tuple[Limit, ...] = ()
    """What is known of all solutions beside."""

    def wiped_out(self) -> int | None:
        """Return the first role with fewer options than slots, if there is one: then there is no solution."""
        asked = Counter(self.slots)
        return next((role for role, slots in asked.items() if len(self.options[role]) < slots), None)

    def kinds(self) -> list[InterchangeabilityClass]:
        """Return the interchangeability classes of the options, in order."""
        return list(dict.fromkeys([option.kind for options in self.options for option in options]))

    def constraining(self) -> list[list[tuple[int, int, int]]]:
        """Return for each variable the options that admit some values alone: role, number in all, and values.

        Options are numbered through all roles.
        """
        found: list[list[tuple[int, int, int]]] = [[] for _ in self.values]
        start, values = 0, self.values
        for role, options in enumerate(self.options if values else ()):
            for number, option in enumerate(options, start):
                for variable, mask in option.kind.admits.items():
                    found[variable].append((role, number, mask & values[variable]))
            start += len(options)
        return found

    def components(self) -> list[list[IRI]]:
        """Return for each role the components of its options, in order: what matching works on."""
        return [[option.component for option in options] for options in self.options]

    def shares_components(self) -> bool:
        """Return whether some component is an option of two roles; if not, every choice is a matching."""
        components = self.components()
        return len(set[IRI]().union(*components)) < sum(map(len, components))


def in_order(given: ReducedProblem) -> ReducedProblem:
    """Return a problem with the options of each role in the order of the candidates."""
    return replace(given, options=tuple(tuple(sorted(some, key=_number)) for some in given.options))


_number: Callable[[Option], int] = attrgetter("number")


def assigned(problem: Problem, chosen: Iterable[Option]) -> list[list[Candidate]]:
    """Return for each role of a problem the candidates that the chosen options stand for."""
    playing: list[list[Candidate]] = [[] for _ in problem.roles]
    for option in chosen:
        role = option.kind.role
        playing[role].append(problem.candidates[role][option.number])
    return playing

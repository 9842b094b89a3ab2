"""The partition F1 ... Fn: for each role, in order, who is eligible (section 3.2 of the paper).

A parameter that is left unbound is a variable shared by the roles that mention it. What a candidate allows the
variable to be is a bit mask over the variable's domain; `ANY_VALUE` (all bits set) does not constrain it at all.
Candidates can play together iff, for each variable, the conjunction of their masks is not zero.
"""

from __future__ import annotations

from dataclasses import dataclass

from selfconf.model.profile import Profile, candidate_order
from selfconf.model.term import IRI, Term

ANY_VALUE = -1


@dataclass(frozen=True, slots=True)
class Variable:
    """A parameter left unbound, and the values that some candidate could give it; bit k stands for `domain[k]`."""

    parameter: IRI
    domain: tuple[Term, ...]

    def first(self, mask: int) -> Term | None:
        """The first value that a mask allows, or None if it allows any value at all."""
        if mask < 0:
            return None
        return self.domain[(mask & -mask).bit_length() - 1]


@dataclass(frozen=True, slots=True)
class Candidate:
    """A component that is eligible for a role, and what it allows each variable to be."""

    profile: Profile
    admits: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class NearMiss:
    """A component that a role would take, but for one thing."""

    role: IRI
    component: IRI
    obstacle: str

    def __str__(self) -> str:
        whose = "it" if self.obstacle.startswith(("has ", "is ", "declares ")) else "its"
        return f"{whose} {self.obstacle}"


@dataclass(frozen=True, slots=True)
class Partition:
    """F1 ... Fn in the order of the template's roles, each in the order in which candidates are tried."""

    candidates: tuple[tuple[Candidate, ...], ...]
    variables: tuple[Variable, ...] = ()

    def without(self, lost: frozenset[IRI]) -> Partition:
        """The same partition after some components have left the ecology."""
        return Partition(
            tuple(tuple(c for c in role if c.profile.component not in lost) for role in self.candidates),
            self.variables,
        )


def ordered(candidates: list[Candidate]) -> tuple[Candidate, ...]:
    """Candidates in the order in which they are tried."""
    return tuple(sorted(candidates, key=lambda candidate: candidate_order(candidate.profile)))

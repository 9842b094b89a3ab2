"""Why a candidate plays a role and another does not: its preference, its cost, and what a configuration with it costs.

For each candidate the task is composed once more as if it alone were eligible for the role. Where the template states
a cost, the cheapest such configuration is reported; else only whether there is one.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from fractions import Fraction

from selfconf.api.configuring import Inquiry
from selfconf.composition import TimeLimit
from selfconf.model import cost
from selfconf.model.alternative import Alternative
from selfconf.model.configuration import Configuration
from selfconf.model.optimum import Optimum, outcome_of
from selfconf.model.partition import Candidate
from selfconf.model.refusal import Outcome, Refusal, Undecided
from selfconf.model.template import Role
from selfconf.model.term import IRI

MOST_TRIED = 12
"""How many candidates of a role are tried, in their order; with thousands no user reads the others."""
SECONDS_FOR_ALL = 20.0
"""The seconds that the trials of all roles may take together."""


def alternatives(inquiry: Inquiry, seconds: float = SECONDS_FOR_ALL) -> dict[IRI, list[Alternative]]:
    """The candidates of each role in their order, each with what would come of it; within so many seconds in all."""
    limit = TimeLimit(seconds)
    partition = inquiry.composer.partition(inquiry.ecology)
    roles = list(zip(inquiry.task.roles, partition.candidates, strict=True))
    held = {c.profile.component for role, some in roles for c in some if inquiry.holder(role, c.profile) is not None}
    taken = held.union(inquiry.holders)  # recruits, too, which have no role
    answer = _answer(inquiry, None, taken, limit)
    return {role.iri: list(_of_role(inquiry, role, candidates, answer, taken, limit)) for role, candidates in roles}


def _of_role(
    inquiry: Inquiry,
    role: Role,
    candidates: Sequence[Candidate],
    answer: Optimum | Outcome,
    taken: Collection[IRI],
    limit: TimeLimit,
) -> Iterator[Alternative]:
    levels, hierarchy = inquiry.composer.task.template.cost, inquiry.composer.hierarchy
    chosen = _players(answer, role.iri)
    for number, candidate in enumerate(candidates):
        profile = candidate.profile
        unknown, *price = cost.cost(levels, role.iri, profile, hierarchy) if levels else (Fraction(0),)
        one = Alternative(
            component=profile.component,
            preference=profile.preference,
            cost=tuple(price),
            unknown_terms=int(unknown),
            chosen=False,
            outcome="not tried",
        )
        if profile.component in chosen:
            yield _with(one._replace(chosen=True), answer)
        elif profile.component in taken or role.minimum != 1 or number >= MOST_TRIED:
            yield one  # one that another task holds cannot play, and of several players none is alone
        else:
            alone = _with(one, _answer(inquiry, (role.iri, profile.component), taken, limit))
            # Where there may be several players, one that cannot be the only one may play beside others all the same.
            beside = alone.outcome == "impossible" and role.maximum != 1 and bool(chosen)
            yield one if beside else alone


def _answer(
    inquiry: Inquiry, played: tuple[IRI, IRI] | None, taken: Collection[IRI], limit: TimeLimit
) -> Optimum | Outcome:
    """The last answer in the time, of the whole task or of one with a role that is played by one component."""

    def ask() -> Optimum | Outcome:
        *_, last = inquiry.composer.answers(inquiry.ecology, frozenset(taken), None, played)
        return last

    too_late: Optimum | Outcome = Undecided(seconds=limit.seconds)
    return limit.within(ask, too_late)


def _with(one: Alternative, answer: Optimum | Outcome) -> Alternative:
    if isinstance(answer, Optimum):
        return one._replace(
            outcome="possible", total=answer.cost, total_unknown_terms=answer.unknown_terms, proved=answer.proved
        )
    if isinstance(answer, Configuration):
        return one._replace(outcome="possible")
    return one._replace(outcome="impossible" if isinstance(answer, Refusal) else "undecided")


def _players(answer: Optimum | Outcome, role: IRI) -> tuple[IRI, ...]:
    outcome = outcome_of(answer)
    if not isinstance(outcome, Configuration):
        return ()
    return next((one.components for one in outcome.assignments if one.role == role), ())

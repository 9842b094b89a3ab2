"""The strategy `best` over recruits finds what enumeration finds: least cost, then the first."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from itertools import combinations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from selfconf import certificate
from selfconf.model.configuration import Configuration
from selfconf.model.cost import CostTerm, cost
from selfconf.model.optimum import Optimum
from selfconf.model.partition import Recruit
from selfconf.model.profile import Profile
from selfconf.model.term import IRI, XSD_NAMESPACE, Literal
from selfconf.search.cost_table import NO_ROLE
from selfconf.search.problem import Problem
from selfconf.search.strategies import best
from tests.search.oracle import Players
from tests.search.test_recruiting import RecruitingWorld, recruiting
from tests.search.worlds import agreement, iri

LATENCY, ERROR = iri("latency"), iri("error")
Cost = tuple[Fraction, ...]


def stated(profile: Profile, **amounts: float) -> Profile:
    """A component with numbers for properties."""
    said = tuple((iri(name), Literal(str(value), IRI(XSD_NAMESPACE + "decimal"))) for name, value in amounts.items())
    return replace(profile, properties=said)


@st.composite
def priced_recruiting(draw: st.DrawFn) -> Problem:
    """Problems with recruits and a cost of one or two levels, of which some reward."""
    plain = draw(recruiting())
    known: dict[IRI, Profile] = {}

    def priced(profile: Profile) -> Profile:
        if profile.component not in known:
            amounts = {name: draw(st.integers(-1, 3)) / 2 for name in ("latency", "error") if draw(st.integers(0, 3))}
            known[profile.component] = stated(profile, **amounts)
        return known[profile.component]

    partition = replace(
        plain.partition,
        candidates=tuple(
            tuple(replace(c, profile=priced(c.profile)) for c in some) for some in plain.partition.candidates
        ),
        recruits=tuple(Recruit(priced(recruit.profile), recruit.roles) for recruit in plain.partition.recruits),
    )
    terms = st.builds(
        CostTerm,
        st.sampled_from([LATENCY, ERROR]),
        st.sampled_from([Fraction(1), Fraction(1), Fraction(-1, 3), Fraction(2)]),
        st.sampled_from([None, Fraction(1), Fraction(0)]),
        st.sampled_from([None, None, *(role.iri for role in plain.roles)]),
    )
    levels = draw(st.lists(st.lists(terms, min_size=1, max_size=2).map(tuple), min_size=1, max_size=2))
    template = replace(plain.task.template, cost=tuple(levels))
    return Problem(replace(plain.task, template=template), partition, plain.hierarchy)


class PricedWorld(RecruitingWorld):
    """The rules of the contract with recruits and costs, as plain loops."""

    def whole(self) -> Iterator[tuple[Players, tuple[Recruit, ...]]]:
        """Every solution: players with recruits that are enough, of which none can be spared, in order."""
        for players, needs in self.playable():
            enough: list[tuple[Recruit, ...]] = []
            for size in range(len(self.recruits) + 1):
                for chosen in combinations(self.recruits, size):
                    if not any(set(map(id, few)) <= set(map(id, chosen)) for few in enough) and self.enough(
                        players, needs, chosen
                    ):
                        enough.append(chosen)
                        yield players, chosen

    def total(self, players: Players, recruits: tuple[Recruit, ...]) -> Cost:
        """What players and recruits cost, with the unknown terms first."""
        counted = [(r.iri, c.profile) for r, some in zip(self.roles, players, strict=True) for c in some]
        counted += [(NO_ROLE, recruit.profile) for recruit in recruits]
        rows = [cost(self.template.cost, role, profile, self.hierarchy) for role, profile in counted]
        return tuple(sum((row[k] for row in rows), Fraction(0)) for k in range(1 + len(self.template.cost)))

    def newcomers(self, running: Configuration, players: Players, recruits: tuple[Recruit, ...]) -> int:
        """How many of them did not run, each in its role or as a recruit."""
        played = {a.role: a.components for a in running.assignments}
        pairs = [(role.iri, c) for role, some in zip(self.roles, players, strict=True) for c in some]
        new = sum(c.profile.component not in played[role] for role, c in pairs)
        return new + sum(recruit.component not in running.recruits for recruit in recruits)


def is_solution(found: Configuration, solution: tuple[Players, tuple[Recruit, ...]]) -> None:
    """Hold a configuration against a solution."""
    players, recruits = solution
    assert [a.components for a in found.assignments] == [tuple(c.profile.component for c in some) for some in players]
    assert found.recruits == tuple(recruit.component for recruit in recruits)


@given(priced_recruiting(), st.data())
@agreement(0.3)
def test_the_best_with_recruits_is_the_first_of_least_cost(problem: Problem, data: st.DataObject) -> None:
    pytest.importorskip("pysat")
    world, answer = PricedWorld(problem), best.best_configuration(problem)
    solutions = list(world.whole())
    assert isinstance(answer, Optimum) == bool(solutions)
    if not isinstance(answer, Optimum):
        return
    least = min(solutions, key=lambda one: world.total(*one))
    assert answer.proved
    assert (answer.unknown, *answer.cost) == world.total(*least)
    is_solution(answer.configuration, least)
    assert not certificate.broken_conditions(problem.task, problem.partition, answer.configuration, problem.hierarchy)
    if not answer.configuration.components:
        return
    lost = frozenset((data.draw(st.sampled_from(answer.configuration.components)),))
    left = Problem(problem.task, problem.partition.without(lost), problem.hierarchy)
    other, after = PricedWorld(left), best.best_configuration(left, running=answer.configuration)
    remaining = list(other.whole())
    assert isinstance(after, Optimum) == bool(remaining)
    if isinstance(after, Optimum):
        running = answer.configuration
        nearest = min(remaining, key=lambda one: (other.newcomers(running, *one), *other.total(*one)))
        assert after.proved
        assert (after.unknown, *after.cost) == other.total(*nearest)
        # Of equally many, recruits that run come before others, which enumeration does not know.
        assert [a.components for a in after.configuration.assignments] == [
            tuple(c.profile.component for c in some) for some in nearest[0]
        ]

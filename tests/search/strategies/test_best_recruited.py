"""The strategy `best` over recruits finds what enumeration finds: least cost, then the first."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from itertools import combinations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from selfconf.configuration_certificate import broken_conditions
from selfconf.model.configuration import Configuration
from selfconf.model.cost import CostTerm, cost
from selfconf.model.optimum import Optimum
from selfconf.model.partition import Recruit
from selfconf.model.profile import Profile
from selfconf.model.term import IRI, XSD_NAMESPACE, Literal
from selfconf.search.cost_table import NO_ROLE
from selfconf.search.problem import Problem
from selfconf.search.strategies import best
from tests.search.chance import Chance, by_chance
from tests.search.oracle import Players
from tests.search.recruiting.test_recruiting import RecruitingWorld, a_recruiting_problem, with_recruits
from tests.search.without_solvers import without_solvers
from tests.search.worlds import agreement, component, iri, problem

LATENCY, ERROR = iri("latency"), iri("error")
Cost = tuple[Fraction, ...]


def stated(profile: Profile, **amounts: float) -> Profile:
    """A component with numbers for properties."""
    said = tuple((iri(name), Literal(str(value), IRI(XSD_NAMESPACE + "decimal"))) for name, value in amounts.items())
    return replace(profile, properties=said)


def priced_recruiting() -> st.SearchStrategy[Problem]:
    """Problems as `a_priced_problem` makes them."""
    return by_chance(a_priced_problem)


def a_priced_problem(chance: Chance) -> Problem:
    """A problem with recruits and a cost of one or two levels, of which some reward."""
    plain = a_recruiting_problem(chance)
    known: dict[IRI, Profile] = {}

    def priced(profile: Profile) -> Profile:
        if profile.component not in known:
            amounts = {name: chance.number(-1, 3) / 2 for name in ("latency", "error") if chance.below(4)}
            known[profile.component] = stated(profile, **amounts)
        return known[profile.component]

    partition = replace(
        plain.partition,
        candidates=tuple(
            tuple(replace(c, profile=priced(c.profile)) for c in some) for some in plain.partition.candidates
        ),
        recruits=tuple(Recruit(priced(recruit.profile), recruit.roles) for recruit in plain.partition.recruits),
    )

    def term() -> CostTerm:
        return CostTerm(
            chance.one_of([LATENCY, ERROR]),
            chance.one_of([Fraction(1), Fraction(1), Fraction(-1, 3), Fraction(2)]),
            chance.one_of([None, Fraction(1), Fraction(0)]),
            chance.one_of([None, None, *(role.iri for role in plain.roles)]),
        )

    levels = tuple(tuple(term() for _ in range(chance.number(1, 2))) for _ in range(chance.number(1, 2)))
    template = replace(plain.task.template, cost=levels)
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
@agreement(0.15)
def test_the_best_with_recruits_is_the_first_of_least_cost(problem: Problem, data: st.DataObject) -> None:
    pytest.importorskip("pysat")
    world, answer = PricedWorld(problem), best.best_configuration(problem)
    solutions = list(world.whole())
    assert isinstance(answer, Optimum) == bool(solutions)
    if not isinstance(answer, Optimum):
        return
    least = min(solutions, key=lambda one: world.total(*one))
    assert answer.proved
    assert (answer.unknown_terms, *answer.cost) == world.total(*least)
    is_solution(answer.configuration, least)
    assert not broken_conditions(problem.task, problem.partition, answer.configuration, problem.hierarchy)
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
        assert (after.unknown_terms, *after.cost) == other.total(*nearest)
        # Of equally many, recruits that run come before others, which enumeration does not know.
        assert [a.components for a in after.configuration.assignments] == [
            tuple(c.profile.component for c in some) for some in nearest[0]
        ]


def cheap_or_dear() -> Problem:
    """A user that a dear supplier feeds, which is preferred, or two cheap ones in a row."""
    user = stated(component("user", "s:S"), latency=1)
    dear = stated(component("dear", "", "s:S"), latency=5)
    first, second = stated(component("x", "t:T", "s:S"), latency=1), stated(component("y", "", "t:T"), latency=2)
    helped = with_recruits(problem({"user": [user]}), dear, first, second)
    template = replace(helped.task.template, cost=((CostTerm(LATENCY),),))
    return Problem(replace(helped.task, template=template), helped.partition)


def test_the_cheapest_recruits_may_be_more_than_the_fewest() -> None:
    pytest.importorskip("pysat")
    answer = best.best_configuration(cheap_or_dear())
    assert isinstance(answer, Optimum)
    assert (answer.cost, answer.bound, answer.proved) == ((Fraction(4),), (Fraction(4),), True)
    assert answer.configuration.recruits == (iri("x"), iri("y"))


def dear_before_cheap() -> Problem:
    """A player whose need either of two recruits feeds, of which the dear one comes first by IRI."""
    user = stated(component("user", "s:S"), latency=0)
    some = (stated(component(name, "", "s:S"), latency=cost) for name, cost in (("a-dear", 5), ("cheap", 1)))
    helped = with_recruits(problem({"user": [user]}), *some)
    template = replace(helped.task.template, cost=((CostTerm(LATENCY),),))
    return Problem(replace(helped.task, template=template), helped.partition)


def test_without_a_solver_a_bound_holds_though_recruits_are_of_unknown_cost() -> None:
    users = [stated(component("user", "s:S"), latency=2), component("alone")]
    helped = with_recruits(problem({"user": users}), component("supplier", "", "s:S"))
    template = replace(helped.task.template, cost=((CostTerm(LATENCY),),))
    with without_solvers():
        answer = best.best_configuration(Problem(replace(helped.task, template=template), helped.partition))
    assert isinstance(answer, Optimum)
    assert (answer.cost, answer.unknown_terms, answer.proved) == ((Fraction(2),), 1, False)
    # The other user, whose latency is not known either, needs no recruit: with it the level is 0.
    assert answer.bound == (Fraction(0),)


def test_of_recruits_that_issue_the_same_the_cheapest_is_taken() -> None:
    pytest.importorskip("pysat")
    answer = best.best_configuration(dear_before_cheap())
    assert isinstance(answer, Optimum)
    assert (answer.cost, answer.proved) == ((Fraction(1),), True)
    assert answer.configuration.recruits == (iri("cheap"),)


@pytest.mark.usefixtures("no_solvers")
def test_without_a_solver_the_cheapest_of_equally_few_recruits_is_taken() -> None:
    answer = best.best_configuration(dear_before_cheap())
    assert isinstance(answer, Optimum)
    assert (answer.cost, answer.proved) == ((Fraction(1),), False)
    assert answer.configuration.recruits == (iri("cheap"),)


def test_a_recruit_that_could_be_spared_is_not_taken_for_its_reward() -> None:
    pytest.importorskip("pysat")
    given_ = cheap_or_dear()
    template = replace(given_.task.template, cost=((CostTerm(LATENCY, weight=Fraction(-1)),),))
    answer = best.best_configuration(Problem(replace(given_.task, template=template), given_.partition))
    assert isinstance(answer, Optimum)
    assert (answer.cost, answer.proved) == ((Fraction(-6),), True)
    assert answer.configuration.recruits == (iri("dear"),)


@pytest.mark.usefixtures("no_solvers")
def test_without_a_solver_recruits_are_the_fewest_and_nothing_is_proved() -> None:
    answer = best.best_configuration(cheap_or_dear())
    assert isinstance(answer, Optimum)
    assert (answer.cost, answer.proved) == ((Fraction(6),), False)
    assert answer.bound <= (Fraction(4),)


@pytest.mark.parametrize("steps", [1, 2, 3, 5, 8])
def test_what_few_steps_find_has_a_true_bound(steps: int) -> None:
    pytest.importorskip("pysat")
    answer = best.best_configuration(cheap_or_dear(), steps)
    if isinstance(answer, Optimum):
        assert answer.bound <= (Fraction(4),) <= answer.cost
        assert not answer.proved or answer.cost == (Fraction(4),)

"""The strategy `best` finds a solution of least cost, and among those the first."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import replace
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from selfconf.model.configuration import Configuration
from selfconf.model.cost import CostTerm, cost
from selfconf.model.optimum import Optimum
from selfconf.model.partition import Partition
from selfconf.model.profile import Profile
from selfconf.model.refusal import Refusal
from selfconf.model.term import IRI, XSD_NAMESPACE, Literal
from selfconf.search import explain
from selfconf.search.extension import solved
from selfconf.search.problem import Problem
from selfconf.search.strategies import best, first
from tests.harness.effort import NIGHTLY, thorough
from tests.search.chance import Chance, by_chance, with_chance
from tests.search.oracle import Players, World
from tests.search.without_solvers import without_solvers
from tests.search.worlds import a_problem, agreement, component, explained_once, iri, problem

LATENCY, ERROR = iri("latency"), iri("error")


def priced(profile: Profile, **values: float) -> Profile:
    """A component with numbers for properties."""
    said = tuple((iri(name), Literal(str(value), IRI(XSD_NAMESPACE + "decimal"))) for name, value in values.items())
    return replace(profile, properties=said)


def stating(problem: Problem, *levels: tuple[CostTerm, ...]) -> Problem:
    """The problem with a cost."""
    template = replace(problem.task.template, cost=levels)
    return Problem(replace(problem.task, template=template), problem.partition, problem.hierarchy)


def priced_problems(plain_ports: bool = False) -> st.SearchStrategy[Problem]:
    """Problems as `_priced_problem` makes them."""
    return by_chance(lambda chance: _priced_problem(chance, plain_ports), 440)


def _priced_problem(chance: Chance, plain_ports: bool = False) -> Problem:
    """A problem with a cost of up to two levels over properties that some components have."""
    plain = a_problem(chance, plain=plain_ports)
    known = {
        name: tuple((predicate, _amount(chance)) for predicate in (LATENCY, ERROR) if chance.below(4))
        for name in sorted({c.profile.component for role in plain.candidates for c in role})
    }
    candidates = tuple(
        tuple(replace(c, profile=replace(c.profile, properties=known[c.profile.component])) for c in role)
        for role in plain.candidates
    )
    roles = [None, None, *(role.iri for role in plain.roles)]
    levels = [tuple(_term(chance, roles) for _ in range(chance.number(1, 2))) for _ in range(chance.number(0, 2))]
    whole = Problem(plain.task, Partition(candidates, plain.variables), plain.hierarchy)
    return stating(whole, *levels)


def _amount(chance: Chance) -> Literal:
    return Literal(str(chance.number(-2, 3) / 2), IRI(XSD_NAMESPACE + "decimal"))


def _term(chance: Chance, roles: Sequence[IRI | None]) -> CostTerm:
    return CostTerm(
        chance.one_of([LATENCY, ERROR]),
        chance.one_of([Fraction(1), Fraction(-1, 3), Fraction(2)]),
        chance.one_of([None, Fraction(1)]),
        chance.one_of(roles),
    )


def _total(world: World, players: Players) -> tuple[Fraction, ...]:
    rows = [
        cost(world.template.cost, role.iri, c.profile, world.hierarchy)
        for role, some in zip(world.roles, players, strict=True)
        for c in some
    ]
    return tuple(sum((row[k] for row in rows), Fraction(0)) for k in range(1 + len(world.template.cost)))


@given(priced_problems())
@agreement(0.4)
def test_the_best_is_the_first_of_least_cost(problem: Problem) -> None:
    world = World(problem.task, problem.partition, problem.hierarchy)
    solutions = list(world.solutions())
    answer = best.best_configuration(problem)
    if not solutions:
        assert not isinstance(answer, Optimum)
        return
    least = min(solutions, key=lambda players: _total(world, players))
    assert isinstance(answer, Optimum)
    assert answer.proved
    assert (answer.unknown_terms, *answer.cost) == _total(world, least)
    assert answer.configuration == world.configuration(least)


@given(with_chance(_priced_problem, 460))
@agreement(0.75)
def test_the_best_after_a_failure_is_the_cheapest_of_the_nearest(drawn: tuple[Problem, Chance]) -> None:
    problem, chance = drawn
    running = first.search(problem)
    if not isinstance(running, Configuration) or not running.components:
        return
    lost = frozenset((chance.one_of(running.components),))
    left = Problem(problem.task, problem.partition.without(lost), problem.hierarchy)
    world = World(left.task, left.partition, left.hierarchy)
    played = {assignment.role: assignment.components for assignment in running.assignments}

    def newcomers(players: Players) -> int:
        pairs = zip(world.roles, players, strict=True)
        return sum(c.profile.component not in played[role.iri] for role, some in pairs for c in some)

    answer = best.best_configuration(left, running=running)
    solutions = list(world.solutions())
    assert isinstance(answer, Optimum) == bool(solutions)
    if isinstance(answer, Optimum):
        nearest = min(solutions, key=lambda players: (newcomers(players), *_total(world, players)))
        assert answer.proved
        assert (answer.unknown_terms, *answer.cost) == _total(world, nearest)
        assert answer.configuration == solved(left, nearest, running)


@given(priced_problems())
@agreement(0.5)
def test_clause_learning_finds_the_best_that_branch_and_bound_finds(problem: Problem) -> None:
    pytest.importorskip("pysat")
    expected = best.best_configuration(problem)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(best, "BRANCHING_STEPS", 0)
        answer = best.best_configuration(problem)
    assert not isinstance(expected, Optimum) or answer == expected


@thorough
@pytest.mark.slow
@pytest.mark.parametrize("aided", [False, True])
def test_what_is_found_in_few_steps_has_a_true_bound(
    aided: bool, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest
) -> None:
    if aided:
        pytest.importorskip("pysat")
        monkeypatch.setattr(best, "BRANCHING_STEPS", 1)
    else:
        request.getfixturevalue("no_solvers")
    monkeypatch.setattr(explain, "refusal", explained_once(explain.refusal))
    unproved: list[bool] = []
    """For each answer without a proof whether there is a better one."""

    @given(priced_problems(plain_ports=True))
    @agreement(1.0 if NIGHTLY else 8.0)  # so many that ten answers and more lack a proof
    def search(problem: Problem) -> None:
        world = World(problem.task, problem.partition, problem.hierarchy)
        least = min((_total(world, players) for players in world.solutions()), default=None)
        decided = False
        for steps in range(1, 11):
            if decided and steps < 10:  # with more steps than it takes, the search is the same
                continue
            answer = best.best_configuration(problem, steps)
            decided = isinstance(answer, Refusal) or (isinstance(answer, Optimum) and answer.proved)
            if isinstance(answer, Refusal):
                assert least is None
            elif isinstance(answer, Optimum):
                found = (answer.unknown_terms, *answer.cost)
                assert least is not None
                assert found >= least
                assert answer.bound <= min(answer.cost, least[1:])
                if answer.proved:
                    assert found == least
                else:
                    unproved.append(found > least)

    search()
    assert len(unproved) >= 10
    assert any(unproved)


def test_an_answer_says_whether_the_solvers_were_missing() -> None:
    plain = problem({"r": [component("a")]})
    for without in (False, True):
        with without_solvers() if without else nullcontext():
            found = best.best_configuration(plain)
        assert isinstance(found, Optimum)
        assert found.unaided is without


def test_first_takes_the_preferred_and_best_the_cheapest() -> None:
    quick = priced(component("quick", outputs="p:Pose"), latency=0.1)
    liked = priced(component("liked", outputs="p:Pose", preference=5), latency=0.5)
    given_ = stating(
        problem({"position": [liked, quick], "control": [component("cap", "p:Pose")]}, "position>control"),
        (CostTerm(LATENCY, role=iri("position")),),
    )
    answer = best.best_configuration(given_)
    assert isinstance(answer, Optimum)
    assert answer.cost == (Fraction(1, 10),)
    assert answer.configuration.components[0].short == "quick"
    preferred = first.search(given_)
    assert isinstance(preferred, Configuration)
    assert preferred.components[0].short == "liked"


def test_a_cost_over_a_property_that_no_component_has_changes_nothing_and_is_counted() -> None:
    given_ = stating(problem({"eye": [component("a"), component("b")]}), (CostTerm(LATENCY),))
    answer = best.best_configuration(given_)
    assert isinstance(answer, Optimum)
    assert answer.configuration.components[0].short == "a"
    assert answer.unknown_terms == 1


def test_a_known_cost_is_better_than_an_unknown_one() -> None:
    known = priced(component("known"), latency=100)
    answer = best.best_configuration(stating(problem({"eye": [component("unknown"), known]}), (CostTerm(LATENCY),)))
    assert isinstance(answer, Optimum)
    assert answer.configuration.components[0].short == "known"


def test_when_the_steps_end_the_cheapest_solution_that_clause_learning_met_is_the_answer(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    pytest.importorskip("pysat")
    monkeypatch.setattr(best, "BRANCHING_STEPS", 1)
    given_ = stating(
        problem(
            {
                "eye": [
                    priced(component("red", outputs="p:Red"), latency=7),
                    priced(component("blue", outputs="p:Blue"), latency=3),
                ],
                "mind": [
                    priced(component("r", "p:Red", "q:Red"), latency=4),
                    priced(component("b", "p:Blue", "q:Blue"), latency=8),
                ],
                "leg": [priced(component("left", "q:Red"), latency=5), priced(component("right", "q:Blue"), latency=3)],
            },
            "eye>mind mind>leg",
        ),
        (CostTerm(LATENCY),),
    )
    unhurried = best.best_configuration(given_, 1_000)
    assert isinstance(unhurried, Optimum)
    assert unhurried.cost == (14,)
    # Three conflicts prove that nothing costs less than 14, and none is left to prove which solution is the first.
    answer = best.best_configuration(given_, 3)
    assert isinstance(answer, Optimum)
    assert (answer.cost, answer.proved) == ((14,), True)

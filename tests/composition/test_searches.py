"""Everything at once against enumeration.

Optional inputs, conditions, operations, free parameters, cardinalities, recruits, optional roles, the inside of a
composite, and costs, in one generator; the answers of both strategies, and those to a failure.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations_with_replacement

import pytest
from hypothesis import given
from hypothesis import strategies as st

from selfconf.composition import searches
from selfconf.composition.outside import with_outside, with_outside_candidate
from selfconf.composition.searches import Searches, Strategy
from selfconf.configuration_certificate import broken_conditions
from selfconf.model.configuration import Configuration
from selfconf.model.cost import CostTerm
from selfconf.model.optimum import Optimum
from selfconf.model.profile import Input, Output, needed_operation, offered_operation
from selfconf.model.refusal import Outcome, Refusal, Undecided
from selfconf.model.template import TemplatePort
from selfconf.search.additions import asking_for
from selfconf.search.problem import Problem
from selfconf.search.relaxations.relaxations import with_relaxations
from selfconf.search.relaxations.relaxed_problem import relaxed_by
from tests.harness.effort import NIGHTLY, thorough
from tests.search.chance import Chance, by_chance
from tests.search.possibility import possible
from tests.search.recruiting.test_recruiting import Players, Recruit
from tests.search.strategies.test_best_recruited import LATENCY, PricedWorld, a_priced_problem, stated
from tests.search.worlds import CLASSES, SIGNALS, agreement, component, iri, problem

Solution = tuple[Players, tuple[Recruit, ...]]


def ecologies() -> st.SearchStrategy[Problem]:
    """Problems as `an_ecology` makes them."""
    return by_chance(an_ecology)


def an_ecology(chance: Chance) -> Problem:
    """A problem with all that a template and an advertisement say; a third of them are the inside of a composite."""
    given_ = a_priced_problem(chance)
    spread = [0, 0, 0, 1, None]
    roles = tuple(
        replace(role, maximum=None if (more := chance.one_of(spread)) is None else role.minimum + more)
        for role in given_.roles
    )
    task = replace(given_.task, template=replace(given_.task.template, roles=roles))
    partition = given_.partition
    if chance.below(3) == 0:
        names = [role.iri for role in roles]
        ports = tuple(TemplatePort(chance.one_of(names), _port(chance, name)) for name in "pq"[: chance.below(3)])
        ported = replace(task, template=replace(task.template, ports=ports))
        task = with_outside(ported, iri("composite"))
        partition = with_outside_candidate(partition, ported, iri("composite"), given_.hierarchy)
    return Problem(task, partition, given_.hierarchy)


def _port(chance: Chance, name: str) -> Input | Output:
    """A port that a template has itself, perhaps an operation."""
    signal, is_input = chance.one_of(SIGNALS), chance.flip()
    if chance.below(3):
        return Input(name, (signal,)) if is_input else Output(name, (signal,))
    return (needed_operation if is_input else offered_operation)(name, chance.one_of([None, *CLASSES]), signal)


def raised(problem: Problem) -> Iterator[Problem]:
    """The problem, and those in which optional roles that feed others are asked for, the fewest first."""
    yield problem
    optional = [k for k, role in enumerate(problem.roles) if role.minimum == 0 and problem.sinks[k]]
    for size in range(1, sum(len(problem.candidates[k]) for k in optional) + 1):
        for chosen in combinations_with_replacement(optional, size):
            minima = Counter(chosen)
            if all(
                count <= len(problem.candidates[k]) and ((most := problem.roles[k].maximum) is None or count <= most)
                for k, count in minima.items()
            ):
                yield asking_for(problem, minima)


def solutions(problem: Problem) -> tuple[Problem, PricedWorld, list[Solution]]:
    """Every solution by enumeration, with as few optional roles as it takes; and the problem that they solve."""
    for asked in raised(problem):
        world = PricedWorld(asked)
        found = list(world.whole())
        if found:
            return asked, world, found
    return problem, PricedWorld(problem), []


def holds(problem: Problem, asked: Problem, answer: Configuration, solution: Solution) -> None:
    """Hold an answer against the solution that it extends, and against the certificate."""
    players, recruits = solution
    for assignment, role, some in zip(answer.assignments, asked.roles, players, strict=True):
        assert set(assignment.components) >= {c.profile.component for c in some}
        assert assignment.components[: role.minimum] == tuple(c.profile.component for c in some)
    assert answer.recruits == tuple(recruit.component for recruit in recruits)
    assert not broken_conditions(problem.task, problem.partition, answer, problem.hierarchy)


def outcome(strategy: Strategy, problem: Problem, running: Configuration | None = None) -> Optimum | Outcome:
    """The last answer of a strategy."""
    *_, last = Searches(strategy).answers(problem, running)
    return last


@thorough
@pytest.mark.slow
@given(ecologies(), st.data())
@agreement(1.0 if NIGHTLY else 500 / 75)  # 500 for every push
def test_everything_at_once_is_answered_as_enumeration_does(problem: Problem, data: st.DataObject) -> None:
    pytest.importorskip("pysat")
    asked, world, found = solutions(problem)
    first, best = outcome(Strategy.FIRST, problem), outcome(Strategy.BEST, problem)
    if not found:
        assert isinstance(first, Refusal)
        assert isinstance(best, Refusal)
        refused(problem, first)
        return
    assert isinstance(first, Configuration)
    # In order of the players, then of the number of recruits: the first is the first.
    holds(problem, asked, first, found[0])
    assert isinstance(best, Optimum)
    assert best.proved
    least = min(found, key=lambda one: world.total(*one))
    assert (best.unknown_terms, *best.cost) == world.total(*least)
    holds(problem, asked, best.configuration, least)
    if first.components:
        after_failure(problem, first, data)


def refused(problem: Problem, refusal: Refusal) -> None:
    """Hold a refusal against enumeration: its reasons cannot hold, could without any one, and each repair works."""
    assert refusal.reasons
    world = PricedWorld(problem)
    for reason in refusal.reasons:
        assert str(reason)
        assert not possible(world, reason.requirements), reason
        for dropped in reason.requirements if refusal.irreducible else ():
            assert possible(world, [one for one in reason.requirements if one != dropped]), (str(reason), dropped)
    for repair in with_relaxations(problem, refusal).repairs:
        *_, possible_now = solutions(relaxed_by(problem, repair))
        assert possible_now, str(repair)


def after_failure(problem: Problem, running: Configuration, data: st.DataObject) -> None:
    """Hold the answer to the loss of a component against enumeration: there is one where there is any."""
    lost = frozenset((data.draw(st.sampled_from(running.components)),)) - {iri("composite")}
    left = Problem(problem.task, problem.partition.without(lost), problem.hierarchy)
    answer = outcome(Strategy.FIRST, left, running)
    *_, possible = solutions(left)
    assert isinstance(answer, Configuration) == bool(possible)
    if isinstance(answer, Configuration):
        assert not broken_conditions(left.task, left.partition, answer, left.hierarchy)


def test_of_those_that_cost_the_least_the_first_is_named_in_a_later_slice(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("pysat")
    # Both cameras cost as much, with the one tracker that each can feed. With few steps it is soon proved that nothing
    # costs less, but not that the dearer camera, which comes first, does not cost more in all.
    monkeypatch.setattr(searches, "SLICES", (60, 100_000))
    roles = {
        "camera": [stated(component("a", outputs="o:X"), latency=2), stated(component("b", outputs="o:Y"), latency=1)],
        "tracker": [stated(component("s", "i:X"), latency=1), stated(component("t", "i:Y"), latency=2)],
    }
    for role in range(8):
        lamps = [component(f"lamp-{role}-{number}", outputs=f"o:Light{number}") for number in range(10)]
        roles[f"light-{role}"] = [stated(lamp, latency=3 - number / 9) for number, lamp in enumerate(lamps)]
    plain = problem(roles, "camera>tracker")
    template = replace(plain.task.template, cost=((CostTerm(LATENCY),),))
    quick, found = Searches(Strategy.BEST).answers(Problem(replace(plain.task, template=template), plain.partition))
    assert isinstance(quick, Optimum)
    assert (quick.proved, quick.first) == (True, False)
    assert isinstance(found, Optimum)
    assert (found.proved, found.first) == (True, True)
    assert quick.cost == found.cost
    assert found.configuration.components[:2] == (iri("a"), iri("s"))


def test_after_a_failure_paper_begins_anew_and_first_keeps_what_runs() -> None:
    sources = [component("a", outputs="o:X"), component("b", outputs="o:Y"), component("c", outputs="o:X")]
    asked = problem({"source": sources, "sink": [component("s", "i:X"), component("t", "i:Y")]}, "source>sink")
    running = outcome(Strategy.FIRST, asked)
    assert isinstance(running, Configuration)
    assert running.components == (iri("a"), iri("s"))
    left = Problem(asked.task, asked.partition.without(frozenset((iri("a"),))), asked.hierarchy)
    for strategy, kept in ((Strategy.PAPER, ("b", "t")), (Strategy.FIRST, ("c", "s"))):
        for answer in (outcome(strategy, left, running), Searches(strategy).after(left, running)):
            assert isinstance(answer, Configuration)
            assert answer.components == tuple(map(iri, kept))


def test_where_the_best_after_a_failure_is_not_decided_the_first_comes_with_its_recruits(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(searches, "best_configuration", lambda *_: Undecided(1))
    plain = problem({"sink": [component("s", "i:X")]})
    template = replace(plain.task.template, roles=(replace(plain.roles[0], recruits=True),))
    suppliers = tuple(Recruit(component(name, outputs="o:X"), frozenset((0,))) for name in "ab")
    asked = Problem(
        replace(plain.task, template=template), replace(plain.partition, recruits=suppliers), plain.hierarchy
    )
    running = outcome(Strategy.FIRST, asked)
    assert isinstance(running, Configuration)
    assert running.recruits == (iri("a"),)
    left = Problem(asked.task, asked.partition.without(frozenset((iri("a"),))), asked.hierarchy)
    after = Searches(Strategy.BEST).after(left, running)
    assert isinstance(after, Configuration)
    assert after.recruits == (iri("b"),)


@pytest.mark.parametrize("strategy", Strategy)
def test_what_comes_after_a_failure_is_decided_within_the_steps_of_a_search(strategy: Strategy) -> None:
    sources = [component("a", outputs="o:X"), *(component(name, outputs="o:Y") for name in "bc")]
    asked = problem(
        {"source": [*sources, component("d", outputs="o:X")], "sink": [component("s", "i:X")]}, "source>sink"
    )
    running = outcome(Strategy.FIRST, asked)
    assert isinstance(running, Configuration)
    left = Problem(asked.task, asked.partition.without(frozenset((iri("a"),))), asked.hierarchy)
    assert isinstance(Searches(strategy, steps=1).after(left, running), Undecided)
    after = Searches(strategy, steps=1000).after(left, running)
    assert isinstance(after, Configuration)
    assert after.components == (iri("d"), iri("s"))

"""Cores: the fewest needs that keep all candidates out, found within a budget."""

from __future__ import annotations

from itertools import combinations, islice

import pytest
from hypothesis import given

from benchmarks.search.families.scaling import distinct
from selfconf.model.refusal import Refusal, Undecided
from selfconf.model.requirement import InputFed
from selfconf.search import cores
from selfconf.search.budget import Budget
from selfconf.search.cores import FeasibilityOracle, core
from selfconf.search.explain import refusal
from selfconf.search.problem import Problem
from selfconf.search.reduction import (
    Fed,
    InterchangeabilityClass,
    LazyReduction,
    Played,
    ReducedProblem,
    all_of,
)
from selfconf.search.strategies import first
from tests.search.worlds import agreement, component, problem, problems


def test_of_needs_that_nothing_supports_the_fewest_are_named_that_keep_all_out() -> None:
    # The first two candidates lack a signal each and a common one, the third another one; a role before them follows.
    given_ = problem(
        {
            "screen": [component("lamp", "pose:Pose")],
            "position": [
                component("a", "s:Sonar t:Time", "p:Pose"),
                component("b", "s:Radar t:Time", "p:Pose"),
                component("c", "s:Lidar", "p:Pose"),
            ],
        },
        "position>screen",
    )
    answer = first.search(given_)
    assert isinstance(answer, Refusal)
    (reason,) = answer.reasons
    assert {r.wanted.signals[0].short for r in reason.requirements if isinstance(r, InputFed)} == {"Time", "Lidar"}
    assert answer.irreducible


def test_a_thousand_candidates_with_a_need_each_are_explained_without_a_question() -> None:
    many = [component(f"c{number}", f"i:Signal{number}") for number in range(1000)]
    unsolvable = LazyReduction(problem({"r": many, "s": [component("source", outputs="o:Other")]}, "s>r"))
    found = refusal(unsolvable, steps=1)
    (reason,) = found.reasons
    assert (len(reason.requirements), found.irreducible) == (1001, True)


def test_the_budget_of_an_explanation_bounds_the_questions_that_arc_consistency_answers() -> None:
    # Each candidate needs what only a component issues that cannot play, and whose role another one can.
    many = [component(f"c{number}", f"i:Signal{number}") for number in range(40)]
    source = component("source", "x:Nothing", " ".join(f"o{number}:Signal{number}" for number in range(40)))
    unsolvable = LazyReduction(problem({"s": [source, component("spare")], "r": many}, "s>r"))
    assert refusal(unsolvable).irreducible
    assert not refusal(unsolvable, steps=5).irreducible


def test_once_enough_was_read_a_question_stays_open_even_where_no_search_would_be_needed() -> None:
    deaf = problem({"eye": [component("deaf")], "mind": [component("mind", "i:Image")]}, "eye>mind")
    given_ = LazyReduction(deaf).reduced
    oracle = FeasibilityOracle(given_, Budget())
    assert oracle.feasible(all_of(given_)) is False
    oracle.readings.steps = 0
    assert isinstance(oracle.feasible(all_of(given_)), Undecided)


def test_each_option_that_a_question_writes_down_counts_as_read_though_its_class_needs_nothing() -> None:
    alike = [component(f"c{number:02}") for number in range(40)]
    given_ = LazyReduction(problem({"a": alike, "b": alike}, counts={"a": (20, 20), "b": (20, 20)})).reduced
    readings = Budget(1000)
    FeasibilityOracle(given_, Budget(), readings).feasible(all_of(given_))
    assert readings.steps is not None
    assert 1000 - readings.steps >= sum(map(len, given_.options)) == 80


def test_all_roles_of_a_chain_that_fails_are_looked_at_in_one_pass(monkeypatch: pytest.MonkeyPatch) -> None:
    # Of the first role only a component feeds the second one that cannot play itself, so that none after it can.
    roles = {f"r{k}": [component(f"c{k}", f"i:S{k}", f"o:S{k + 1}")] for k in range(60)}
    roles["r0"].append(component("spare"))
    chain = problem({"s": [component("source")], **roles}, "s>r0 " + " ".join(f"r{k}>r{k + 1}" for k in range(59)))
    oracle = FeasibilityOracle(LazyReduction(chain).reduced, Budget())
    passes: list[ReducedProblem] = []
    kinds = ReducedProblem.kinds

    def counted(given_: ReducedProblem) -> list[InterchangeabilityClass]:
        passes.append(given_)
        return kinds(given_)

    monkeypatch.setattr(ReducedProblem, "kinds", counted)
    assert set(core(oracle)) == {Played(2), Fed(0), Fed(1)}
    assert len(passes) < 30


def test_that_roles_outnumber_their_components_is_not_found_out_anew_to_prove_a_reason_smallest() -> None:
    found = refusal(LazyReduction(distinct(20, 19)))
    assert isinstance(found, Refusal)
    (reason,) = found.reasons
    assert found.smallest, "pigeonholes are hard for a solver, but that one role fewer has components enough is not"
    assert len(reason.roles) == 20


@pytest.fixture
def unloaded(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let no solver be loaded, which takes several times as long as a small refusal."""

    def loaded(*_: object, **__: object) -> None:
        raise AssertionError("a solver was asked")

    monkeypatch.setattr(cores, "ClauseSolver", loaded)


@pytest.mark.usefixtures("unloaded")
def test_no_solver_is_loaded_where_each_requirement_of_a_reason_is_soon_seen_to_be_indispensable() -> None:
    speakers = [component("left", "i:Sound"), component("right", "i:Sound")]
    roles = {"radio": [component("radio", outputs="o:Sound")], "r": speakers, "s": speakers, "t": speakers}
    found = refusal(LazyReduction(problem(roles, "radio>r radio>s radio>t")))
    (reason,) = found.reasons
    assert {role.short for role in reason.roles} == {"r", "s", "t"}
    assert found.smallest


@pytest.mark.usefixtures("unloaded")
def test_no_solver_is_loaded_for_one_of_several_reasons_of_three_requirements() -> None:
    one, other = [component("a")], [component("b")]
    found = refusal(LazyReduction(problem({"r": one, "s": one, "t": other, "u": other})))
    assert found.smallest


def test_a_reason_of_two_requirements_is_found_where_the_first_one_has_three() -> None:
    eyes = [component("a", "i:Infrared"), component("b", "i:Radar")]
    ears = [component("c", "i:Sound")]
    roles = {"source": [component("x", outputs="o:Light")], "eye": eyes, "ear": ears}
    found = refusal(LazyReduction(problem(roles, "source>eye source>ear")))
    (reason,) = found.reasons
    assert [one.wanted.signals[0].short for one in reason.requirements if isinstance(one, InputFed)] == ["Sound"]


@agreement()
@given(problems())
def test_no_smaller_set_fails_than_a_reason_that_is_said_to_be_the_smallest(problem_: Problem) -> None:
    given_ = LazyReduction(problem_).reduced
    oracle, every = FeasibilityOracle(given_, Budget()), all_of(given_)
    if oracle.feasible(every) or not all(oracle.feasible([one]) for one in every):
        return
    found, proved = cores.smallest_of(oracle, cores.core(oracle))
    # With more constraints no more holds, so that sets of one fewer are enough; the budget may end before the proof.
    smaller = islice(combinations(every, len(found) - 1), 400 if proved else 0)
    assert all(oracle.feasible(some) for some in smaller)


def test_a_smaller_reason_is_found_where_the_first_one_is_dispensable() -> None:
    pair, lone = [component("a"), component("b")], [component("c")]
    found = refusal(LazyReduction(problem({"r": pair, "s": pair, "t": pair, "u": lone, "v": lone})))
    (reason,) = found.reasons
    assert {role.short for role in reason.roles} == {"u", "v"}
    assert found.smallest

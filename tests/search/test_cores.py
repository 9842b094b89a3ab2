"""Cores: the fewest needs that keep all candidates out, found within a budget."""

from __future__ import annotations

import pytest

from benchmarks.search.families import distinct
from selfconf.model.refusal import Refusal, Undecided
from selfconf.model.requirement import InputFed
from selfconf.search import cores
from selfconf.search.budget import Budget
from selfconf.search.cores import FeasibilityOracle
from selfconf.search.explain import refusal
from selfconf.search.reduction import LazyReduction, all_of
from selfconf.search.strategies import first
from tests.search.worlds import component, problem


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


def test_that_roles_outnumber_their_components_is_not_found_out_anew_to_prove_a_reason_smallest() -> None:
    found = refusal(LazyReduction(distinct(20, 19)))
    assert isinstance(found, Refusal)
    (reason,) = found.reasons
    assert found.smallest, "pigeonholes are hard for a solver, but that one role fewer has components enough is not"
    assert len(reason.roles) == 20


def test_no_solver_is_loaded_where_each_requirement_of_a_reason_is_soon_seen_to_be_indispensable(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def loaded(*_: object, **__: object) -> None:
        raise AssertionError("to load a solver takes several times as long as such a refusal")

    monkeypatch.setattr(cores, "ClauseSolver", loaded)
    speakers = [component("left", "i:Sound"), component("right", "i:Sound")]
    roles = {"radio": [component("radio", outputs="o:Sound")], "r": speakers, "s": speakers, "t": speakers}
    found = refusal(LazyReduction(problem(roles, "radio>r radio>s radio>t")))
    (reason,) = found.reasons
    assert {role.short for role in reason.roles} == {"r", "s", "t"}
    assert found.smallest


def test_a_smaller_reason_is_found_where_the_first_one_is_dispensable() -> None:
    pair, lone = [component("a"), component("b")], [component("c")]
    found = refusal(LazyReduction(problem({"r": pair, "s": pair, "t": pair, "u": lone, "v": lone})))
    (reason,) = found.reasons
    assert {role.short for role in reason.roles} == {"u", "v"}
    assert found.smallest

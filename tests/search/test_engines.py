"""Each engine by itself, where a quicker one would otherwise answer first."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.search import families
from selfconf.model.partition import Candidate, Partition, Variable
from selfconf.model.refusal import Undecided
from selfconf.model.template import Interaction, Role, Task, Template
from selfconf.search.budget import Budget
from selfconf.search.engines import clause_learning as sat
from selfconf.search.engines.candidate_search import CandidateSearch
from selfconf.search.engines.matching import FollowedMatching, Shortage, impossible, shortage
from selfconf.search.engines.reduced_search import first_solution
from selfconf.search.problem import Problem
from selfconf.search.reduction.constraints import pruned
from selfconf.search.reduction.dominance import LazyReduction, reduced
from selfconf.search.reduction.reduced_problem import Option, ReducedProblem
from selfconf.search.strategies import first as solve
from tests.search.oracle import World
from tests.search.worlds import agreement, component, iri, problems
from tests.search.worlds import problem as written


def _numbers(problem: Problem) -> list[int] | None:
    """The candidates of the least solution by number, slot by slot, as enumeration finds them."""
    players = next(World(problem.task, problem.partition, problem.hierarchy).solutions(), None)
    if players is None:
        return None
    return [problem.candidates[role].index(c) for role, chosen in enumerate(players) for c in chosen]


def _chosen(found: list[Option] | Undecided | None) -> list[int] | None:
    assert not isinstance(found, Undecided)
    return None if found is None else [option.number for option in found]


@given(problems())
@agreement(0.6)
def test_depth_first_on_the_kernel_finds_the_least_solution(problem: Problem) -> None:
    expected = _numbers(problem)
    assert _chosen(first_solution(pruned(reduced(problem)), Budget())) == expected
    assert _chosen(first_solution(reduced(problem), Budget())) == expected


@given(problems(components=7))
@agreement(0.6)
def test_who_is_passed_over_for_sharing_ports_is_in_no_least_solution(problem: Problem) -> None:
    assert _chosen(first_solution(reduced(problem), Budget())) == _numbers(problem)


def test_one_of_each_kind_is_not_enough_where_roles_share_candidates() -> None:
    deaf, first, second = component("deaf", outputs="n:Noise"), *(component(c, outputs="p:Pose") for c in "ab")
    cap = component("cap", "p:Pose")
    given_ = written({"pose": [deaf, first], "spare": [first, second], "cap": [cap]}, "pose>cap")
    assert _chosen(first_solution(reduced(given_), Budget())) == [1, 1, 0]


def test_who_suits_two_parameters_not_at_all_leaves_once() -> None:
    template = Template(
        iri("template"), (Role(iri("camera")), Role(iri("tracker"))), (Interaction(iri("camera"), iri("tracker")),)
    )
    odd, even = component("odd", outputs="p:Picture"), component("even", outputs="p:Picture")
    variables = tuple(Variable(iri(name), (iri("one"), iri("two"))) for name in ("robot", "room"))
    partition = Partition(
        ((Candidate(odd, (2, 2)), Candidate(even, (1, 1))), (Candidate(component("eye", "p:Picture"), (1, 1)),)),
        variables,
    )
    given_ = pruned(reduced(Problem(Task(template), partition)))
    assert _chosen(first_solution(given_, Budget())) == [1, 0]
    assert len(given_.departures) == 1


@given(problems())
@agreement(0.6)
def test_clause_learning_finds_the_least_solution(problem: Problem) -> None:
    pytest.importorskip("pysat")
    expected = _numbers(problem)
    assert _chosen(sat.least_by_clauses(pruned(reduced(problem)), Budget())) == expected
    assert _chosen(sat.least_by_clauses(reduced(problem), Budget(10_000))) == expected


@given(problems())
@agreement(0.3)
def test_a_few_steps_find_the_least_solution_or_nothing(problem: Problem) -> None:
    found = CandidateSearch(problem, Budget(6)).first()
    if found is not None:
        assert [problem.candidates[r].index(c) for r, some in enumerate(found) for c in some] == _numbers(problem)


def test_many_roles_that_draw_on_one_pool_are_filled_in_a_few_steps_each() -> None:
    pool = [component(f"c{number:02}") for number in range(60)]
    given_ = written({f"role{number:02}": pool for number in range(60)})
    found = CandidateSearch(given_, Budget(4 * 60)).first()
    assert found == [[candidate] for candidate in given_.candidates[0]]


def test_passing_over_those_who_play_already_uses_up_a_budget_too() -> None:
    pool = [component(f"c{number:02}") for number in range(60)]
    given_ = written({f"role{number:02}": pool for number in range(60)})
    assert CandidateSearch(given_, Budget(60)).first() is None


@given(problems())
@agreement(0.3)
def test_a_shortage_of_components_is_real(problem: Problem) -> None:
    given_: ReducedProblem = reduced(problem)
    found = shortage(given_.slots, [[o.component for o in options] for options in given_.options])
    if found is not None:
        everybody = {o.component for role in found.roles for o in given_.options[role]}
        assert found.found == len(everybody) < found.wanted == sum(r in found.roles for r in given_.slots)
        assert _numbers(problem) is None


@given(problems())
@agreement(0.3)
def test_a_budget_that_ends_is_no_answer(problem: Problem) -> None:
    expected = _numbers(problem)
    for steps in range(12):
        found = first_solution(pruned(reduced(problem)), Budget(steps))
        assert isinstance(found, Undecided) or _chosen(found) == expected


@given(problems())
@agreement(0.4)
def test_what_is_in_no_matching_is_in_none(problem: Problem) -> None:
    given_ = reduced(problem)
    options = [[o.component for o in some] for some in given_.options]
    found = impossible(given_.slots, options)
    if isinstance(found, Shortage):
        return
    choices = product(*(options[role] for role in given_.slots))
    used = {
        pair for choice in choices if len(set(choice)) == len(choice) for pair in zip(given_.slots, choice, strict=True)
    }
    assert found == {(role, one) for role in set(given_.slots) for one in options[role]} - used


@given(problems())
@agreement(0.4)
def test_a_matching_beside_depth_first_leaves_no_solution_out(problem: Problem) -> None:
    given_ = reduced(problem)
    partners = FollowedMatching(given_.slots, [[o.component for o in some] for some in given_.options])
    assert _chosen(first_solution(given_, Budget(), partners=partners)) == _numbers(problem)


def _first_roles(problem: Problem, roles: int) -> Problem:
    """The first so many roles by themselves, without the inputs that a later one may feed."""
    template = problem.task.template
    kept = {role.iri for role in template.roles[:roles]}
    candidates = []
    for links, some in zip(problem.links, problem.candidates[:roles], strict=False):
        later = {link.input for link in links if link.source >= roles}
        candidates.append(
            tuple(
                replace(
                    c,
                    profile=replace(
                        c.profile,
                        ports=c.profile.ports._replace(
                            inputs=tuple(one for one in c.profile.inputs if not later & {None, one.name})
                        ),
                    ),
                )
                for c in some
            )
        )
    between = tuple(one for one in template.interactions if {one.source, one.sink} <= kept)
    shorter = replace(template, roles=template.roles[:roles], interactions=between)
    partition = replace(problem.partition, candidates=tuple(candidates))
    return Problem(replace(problem.task, template=shorter), partition, problem.hierarchy)


@given(problems(), st.integers(1, 3))
@agreement()
def test_the_first_roles_are_asked_for_nothing_that_a_later_one_may_feed(problem: Problem, roles: int) -> None:
    given_ = reduced(problem, roles=roles)
    expected = _numbers(_first_roles(problem, min(roles, len(problem.roles))))
    assert _chosen(first_solution(given_, Budget())) == expected
    if expected is None:
        assert _numbers(problem) is None
    if sat.solver_available():
        assert (sat.any_by_clauses(given_, Budget()) is None) == (expected is None)


def test_what_a_later_role_may_feed_refuses_nobody_among_the_first() -> None:
    parts = {"cap": [component("cap", "pose:Pose")], "deaf": [component("deaf")], "pose": [component("pose")]}
    by_type, by_name = written(parts, "deaf>cap pose>cap"), written(parts, "deaf>cap.pose pose>cap.pose")
    for given_ in (by_type, by_name):
        assert first_solution(reduced(given_, roles=3), Budget()) is None
        assert _chosen(first_solution(reduced(given_, roles=2), Budget())) == [0, 0]
    assert first_solution(reduced(written(parts, "deaf>cap"), roles=2), Budget()) is None


@pytest.mark.parametrize("seed", range(12))
def test_a_cause_near_the_beginning_is_found_there_and_the_answer_is_the_same(seed: int) -> None:
    pytest.importorskip("pysat")
    problem = families.graph("graph", 150, 10 + seed, 3, seed)
    given_ = LazyReduction(problem)
    found = solve.solution(given_, Budget())
    expected = _chosen(sat.least_by_clauses(reduced(problem), Budget()))
    assert isinstance(found, list) == (expected is not None)
    if isinstance(found, list):
        assert [problem.candidates[r].index(c) for r, some in enumerate(found) for c in some] == expected


def test_for_a_cause_near_the_beginning_the_rest_is_not_even_prepared() -> None:
    pytest.importorskip("pysat")
    given_ = LazyReduction(families.graph("graph", 200, 10, 3, 7_001))
    assert solve.solution(given_, Budget()) is None
    assert "reduced" not in vars(given_)

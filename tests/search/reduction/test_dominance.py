"""A dominated candidate is in no least solution, and no other one is left out."""

from __future__ import annotations

from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st

from selfconf.search.budget import Budget
from selfconf.search.engines import clause_learning
from selfconf.search.engines.least_solution import any_by_clauses
from selfconf.search.engines.reduced_search import first_solution
from selfconf.search.problem import Problem
from selfconf.search.reduction.dominance import reduced
from tests.search.comparison import least_numbers, numbers
from tests.search.worlds import agreement, component, problem, problems


@given(problems(components=7))
@agreement(0.6)
def test_a_candidate_left_out_for_sharing_ports_is_in_no_least_solution(problem: Problem) -> None:
    assert numbers(first_solution(reduced(problem), Budget())) == least_numbers(problem)


def test_one_candidate_of_each_class_is_not_enough_where_roles_share_candidates() -> None:
    deaf, first, second = component("deaf", outputs="n:Noise"), *(component(c, outputs="p:Pose") for c in "ab")
    cap = component("cap", "p:Pose")
    given_ = problem({"pose": [deaf, first], "spare": [first, second], "cap": [cap]}, "pose>cap")
    assert numbers(first_solution(reduced(given_), Budget())) == [1, 1, 0]


def _first_roles(problem: Problem, roles: int) -> Problem:
    """Return the problem of the first roles by themselves, without the inputs that a later one may feed."""
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
    expected = least_numbers(_first_roles(problem, min(roles, len(problem.roles))))
    assert numbers(first_solution(given_, Budget())) == expected
    if expected is None:
        assert least_numbers(problem) is None
    if clause_learning.solver_available():
        assert (any_by_clauses(given_, Budget()) is None) == (expected is None)

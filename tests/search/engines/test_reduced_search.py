"""Depth-first search over a reduced problem: the least solution, or no answer when the budget ends."""

from __future__ import annotations

from hypothesis import given

from selfconf.model.partition import ANY_VALUE, Candidate, Partition, Variable
from selfconf.model.refusal import Undecided
from selfconf.model.template import Role, Task, Template
from selfconf.search.budget import Budget
from selfconf.search.engines.matching import MaintainedMatching
from selfconf.search.engines.reduced_search import first_solution
from selfconf.search.problem import Problem
from selfconf.search.reduction.constraints import pruned
from selfconf.search.reduction.dominance import reduced
from tests.search.comparison import least_numbers, numbers
from tests.search.worlds import agreement, component, iri, problems


@given(problems())
@agreement(0.6)
def test_the_least_solution_is_found_before_and_after_arc_consistency(problem: Problem) -> None:
    expected = least_numbers(problem)
    assert numbers(first_solution(pruned(reduced(problem)), Budget())) == expected
    assert numbers(first_solution(reduced(problem), Budget())) == expected


def test_nothing_plays_where_a_variable_has_no_value() -> None:
    template = Template(iri("template"), (Role(iri("eye")),))
    free = Variable(iri("room"), (), listed=True)
    given_ = reduced(Problem(Task(template), Partition(((Candidate(component("left"), (ANY_VALUE,)),),), (free,))))
    assert first_solution(given_, Budget()) is None


@given(problems())
@agreement(0.3)
def test_a_budget_that_ends_is_no_answer(problem: Problem) -> None:
    expected = least_numbers(problem)
    for steps in range(12):
        found = first_solution(pruned(reduced(problem)), Budget(steps))
        assert isinstance(found, Undecided) or numbers(found) == expected


@given(problems())
@agreement(0.4)
def test_a_maintained_matching_leaves_no_solution_out(problem: Problem) -> None:
    given_ = reduced(problem)
    matching = MaintainedMatching(given_.slots, [[o.component for o in some] for some in given_.options])
    assert numbers(first_solution(given_, Budget(), matching=matching)) == least_numbers(problem)

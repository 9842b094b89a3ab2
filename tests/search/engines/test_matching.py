"""Hall's sets are real, and an option is excluded only if no matching has it."""

from __future__ import annotations

from itertools import product

from hypothesis import given

from selfconf.search.engines.matching import HallSet, hall_set, unmatchable
from selfconf.search.problem import Problem
from selfconf.search.reduction.dominance import reduced
from selfconf.search.reduction.reduced_problem import ReducedProblem
from tests.search.comparison import least_numbers
from tests.search.worlds import agreement, problems


@given(problems())
@agreement(0.3)
def test_the_roles_of_a_hall_set_have_fewer_components_than_slots(problem: Problem) -> None:
    given_: ReducedProblem = reduced(problem)
    found = hall_set(given_.slots, [[o.component for o in options] for options in given_.options])
    if found is not None:
        components = {o.component for role in found.roles for o in given_.options[role]}
        assert found.found == len(components) < found.wanted == sum(r in found.roles for r in given_.slots)
        assert least_numbers(problem) is None


@given(problems())
@agreement(0.4)
def test_what_is_unmatchable_is_in_no_matching_and_all_else_is_in_one(problem: Problem) -> None:
    given_ = reduced(problem)
    options = [[o.component for o in some] for some in given_.options]
    found = unmatchable(given_.slots, options)
    if isinstance(found, HallSet):
        return
    choices = product(*(options[role] for role in given_.slots))
    used = {
        pair for choice in choices if len(set(choice)) == len(choice) for pair in zip(given_.slots, choice, strict=True)
    }
    assert found == {(role, one) for role in set(given_.slots) for one in options[role]} - used

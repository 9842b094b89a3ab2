"""Which inputs are needs, where only the first roles count."""

from __future__ import annotations

from selfconf.search.budget import Budget
from selfconf.search.engines.reduced_search import first_solution
from selfconf.search.reduction.dominance import reduced
from tests.search.comparison import numbers
from tests.search.worlds import component, problem


def test_an_input_that_a_later_role_may_feed_is_no_need_of_the_first_roles() -> None:
    parts = {"cap": [component("cap", "pose:Pose")], "deaf": [component("deaf")], "pose": [component("pose")]}
    by_type, by_name = problem(parts, "deaf>cap pose>cap"), problem(parts, "deaf>cap.pose pose>cap.pose")
    for given_ in (by_type, by_name):
        assert first_solution(reduced(given_, roles=3), Budget()) is None
        assert numbers(first_solution(reduced(given_, roles=2), Budget())) == [0, 0]
    assert first_solution(reduced(problem(parts, "deaf>cap"), roles=2), Budget()) is None

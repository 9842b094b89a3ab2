"""Counting what roles can serve removes options of which enumeration knows no solution, and refuses at once."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.search.families.installations import beds, capacity
from selfconf.search.budget import Budget
from selfconf.search.engines import (
    ClauseSolver,
    capacity_counting,
    first_solution,
    least_of_clauses,
    within_capacity,
)
from selfconf.search.engines.encoding import Encoding
from selfconf.search.problem import Problem
from selfconf.search.reduction import LazyReduction, pruned, reduced
from selfconf.search.strategies.first import solution
from tests.search.comparison import least_numbers, numbers
from tests.search.oracle import World
from tests.search.without_solvers import without_solvers
from tests.search.worlds import agreement, problems, rivalries


@st.composite
def inns(draw: st.DrawFn) -> Problem:
    """Few guests, as enumeration goes through all loads of all holes."""
    holes, room = draw(st.sampled_from([(2, 1), (2, 2), (3, 1)]))
    guests = draw(st.integers(1, 4))
    made = draw(st.sampled_from([capacity, beds]))
    return made(holes, room, guests, draw(st.integers(1, holes)), draw(st.integers(0, 10_000)))


@given(st.one_of(inns(), problems(), rivalries()), st.booleans())
@agreement()
def test_what_is_removed_is_in_no_solution(problem: Problem, generous: bool) -> None:
    before = pruned(reduced(problem))
    if before.wiped_out() is not None:
        return
    with pytest.MonkeyPatch.context() as patch:
        if generous:
            patch.setattr(capacity_counting, "SPARE_PLACES", 100)
            patch.setattr(capacity_counting, "SHARE_PARTNERS", 1)
            patch.setattr(capacity_counting, "LOOKS_PER_OPTION", 100)
        after = within_capacity(before)
    options = {(role, option.number) for role, some in enumerate(before.options) for option in some}
    left = set() if after is None else {(r, option.number) for r, some in enumerate(after.options) for option in some}
    for players in World(problem.task, problem.partition, problem.hierarchy).solutions():
        playing = {(role, problem.candidates[role].index(one)) for role, some in enumerate(players) for one in some}
        if playing <= options:
            assert playing <= left


@given(inns())
@agreement()
def test_the_least_solution_stays(problem: Problem) -> None:
    after = within_capacity(pruned(reduced(problem)))
    found = None if after is None or after.wiped_out() is not None else first_solution(after, Budget())
    assert numbers(found) == least_numbers(problem)


@given(st.one_of(inns(), problems(), rivalries()))
@agreement()
def test_with_what_counting_adds_to_the_clauses_the_answer_is_the_least(problem: Problem) -> None:
    pytest.importorskip("pysat")
    given_ = pruned(reduced(problem))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(capacity_counting, "SPARE_PLACES", 100)
        encoding = Encoding(given_, ordered=True)
        encoding.count()
    with ClauseSolver(given_, encoding=encoding) as clauses:
        possible = clauses.solve((), Budget())
        found = least_of_clauses(clauses, Budget()) if possible else None
    assert numbers(found) == least_numbers(problem)


@pytest.mark.parametrize("made", [capacity, beds])
def test_more_guests_than_places_are_refused_without_search(made: Callable[..., Problem]) -> None:
    assert within_capacity(pruned(reduced(made(8, 2, 17, 5, 7)))) is None


@pytest.mark.parametrize("made", [capacity, beds])
def test_where_each_place_is_taken_no_hole_is_left_half_empty(made: Callable[..., Problem]) -> None:
    before = pruned(reduced(made(4, 2, 8, 3, 7)))
    after = within_capacity(before)
    assert after is not None
    assert sum(map(len, after.options)) < sum(map(len, before.options))
    assert all("." in o.component for some in after.options for o in some if o.component.startswith("load"))


@pytest.mark.parametrize("made", [capacity, beds])
def test_the_search_decides_what_no_engine_does_within_seconds(made: Callable[..., Problem]) -> None:
    assert solution(LazyReduction(made(8, 2, 17, 5, 7)), Budget(20_000)) is None
    with without_solvers():
        assert solution(LazyReduction(made(8, 2, 17, 5, 7)), Budget(20_000)) is None


@pytest.mark.parametrize("made", [capacity, beds])
def test_with_places_to_spare_nothing_is_removed(made: Callable[..., Problem]) -> None:
    before = pruned(reduced(made(4, 3, 6, 3, 7)))
    assert within_capacity(before) is before

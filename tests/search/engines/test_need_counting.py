"""Counting needs removes options of which enumeration knows no solution, and finds what lacks slots at once."""

from __future__ import annotations

import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.search.families import profile
from benchmarks.search.further_families import counted
from selfconf.model.partition import Candidate
from selfconf.model.refusal import Conflict, Refusal
from selfconf.search.budget import Budget
from selfconf.search.engines import Undersupply, counted_needs, first_solution, supplied
from selfconf.search.problem import Problem
from selfconf.search.reduction import LazyReduction, pruned, reduced
from selfconf.search.strategies import first, solution
from tests.search.comparison import least_numbers, numbers
from tests.search.oracle import World
from tests.search.worlds import agreement, problems


def hubs(signals: int, slots: int, each: int, idle: int, seed: int, number: int = 1, double: float = 0.0) -> Problem:
    """Roles whose components issue one of the signals that a sink wants, now and then two, or none of them."""
    rng = random.Random(seed)
    parts = []
    for hub in range(number):
        issued = [[f"s{k}"] + [f"s{rng.randrange(signals)}"] * (rng.random() < double) for k in range(signals)] * each
        some = [*issued, *([] for _ in range(idle))]
        rng.shuffle(some)
        parts.append([Candidate(profile(f"hub{hub}.{k}", (), [f"own{k}", *one])) for k, one in enumerate(some)])
    sink = [Candidate(profile("sink", [f"s{k}" for k in range(signals)]))]
    return counted([*parts, sink], [*([slots] * number), 1], [(hub, number) for hub in range(number)])


@st.composite
def small_hubs(draw: st.DrawFn) -> Problem:
    number, slots = draw(st.integers(1, 2)), draw(st.integers(1, 3))
    signals = max(1, number * slots + draw(st.integers(-2, 1)))
    idle = draw(st.integers(max(0, slots - signals), 2))
    return hubs(signals, slots, 1, idle, draw(st.integers(0, 10_000)), number, draw(st.sampled_from([0.0, 0.3])))


@given(st.one_of(small_hubs(), problems()))
@agreement()
def test_what_is_removed_is_in_no_solution(problem: Problem) -> None:
    before = pruned(reduced(problem))
    if before.wiped_out() is not None:
        return
    after = supplied(before, counted_needs(before))
    left = (
        set()
        if isinstance(after, Undersupply)
        else {(r, o.number) for r, some in enumerate(after.options) for o in some}
    )
    removed = {(r, o.number) for r, some in enumerate(before.options) for o in some} - left
    for players in World(problem.task, problem.partition, problem.hierarchy).solutions():
        assert not removed & {
            (role, problem.candidates[role].index(one)) for role, chosen in enumerate(players) for one in chosen
        }


@given(st.one_of(small_hubs(), problems(plain=True)))
@agreement(0.5)
def test_a_search_that_counts_finds_the_least_solution(problem: Problem) -> None:
    before = pruned(reduced(problem))
    counted_ = counted_needs(before)
    if before.wiped_out() is None and counted_:
        assert numbers(first_solution(before, Budget(), counted=counted_)) == least_numbers(problem)


@given(small_hubs())
@agreement(0.5)
def test_the_answer_is_that_of_enumeration(problem: Problem) -> None:
    found = solution(LazyReduction(problem), Budget())
    least = least_numbers(problem)
    assert (least is None) == (found is None)


@pytest.mark.parametrize("seed", range(3))
def test_a_slot_too_few_is_found_without_going_through_all_ways_to_fill_them(seed: int) -> None:
    assert solution(LazyReduction(hubs(16, 15, 4, 5, seed)), Budget(3_000)) is None


@pytest.mark.parametrize(("signals", "slots", "number"), [(14, 16, 1), (12, 12, 1), (14, 8, 2)])
def test_slots_to_spare_are_spent_on_the_first_components(signals: int, slots: int, number: int) -> None:
    """Whether one more slot can be spared has taken clause learning as long as all else."""
    found = solution(LazyReduction(hubs(signals, slots, 3, 10, 7, number)), Budget(3_000))
    assert isinstance(found, list)
    issued = {str(output.signals[0]) for some in found for one in some for output in one.profile.outputs}
    assert {f"urn:bench:s{k}" for k in range(signals)} <= issued


def test_needs_with_many_slots_to_spare_are_not_counted() -> None:
    assert counted_needs(pruned(reduced(hubs(4, 9, 3, 4, 1)))) == []


def test_too_few_slots_are_explained_by_the_needs_that_lack_them() -> None:
    refusal = first.search(hubs(16, 15, 4, 5, 1))
    assert isinstance(refusal, Refusal)
    assert refusal.irreducible
    (reason,) = refusal.reasons
    assert isinstance(reason, Conflict)
    assert len(reason.requirements) == 17

"""Counting needs removes options of which enumeration knows no solution, and finds what lacks slots at once."""

from __future__ import annotations

import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.search.families.wiring import counted, profile
from selfconf.model.partition import Candidate
from selfconf.model.refusal import Conflict, Refusal, Undecided
from selfconf.search.budget import Budget
from selfconf.search.engines import Undersupply, counted_needs, first_solution, supplied
from selfconf.search.problem import Problem
from selfconf.search.reduction import LazyReduction, ReducedProblem, pruned, reduced
from selfconf.search.strategies import first, solution
from tests.harness.effort import thorough
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


@thorough
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


@thorough
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


def test_what_counting_makes_unavoidable_is_counted_before_another_search(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two slots for two signals spare none for the idle one, which alone needs no power; and none is left for that."""
    workers = [Candidate(profile(name, ["power"], [name])) for name in ("lift", "turn")]
    crew = [Candidate(profile("idle")), *workers]
    plant = [Candidate(profile(name, (), [name])) for name in ("light", "heat", "power")]
    sinks = [[Candidate(profile("task", ["lift", "turn"]))], [Candidate(profile("house", ["light", "heat"]))]]
    problem = counted([crew, plant, *sinks], [2, 2, 1, 1], [(1, 0), (0, 2), (1, 3)])
    searches: list[ReducedProblem] = []

    def no_solution_yet(given: ReducedProblem, *_: object, **__: object) -> Undecided:
        searches.append(given)
        return Undecided(0)

    monkeypatch.setattr(first, "first_solution", no_solution_yet)
    assert first.least_of(reduced(problem), Budget(), lambda *_: pytest.fail("clauses were written")) is None
    assert len(searches) == 1


def test_needs_with_many_slots_to_spare_are_not_counted() -> None:
    assert counted_needs(pruned(reduced(hubs(4, 9, 3, 4, 1)))) == []


@st.composite
def small_teams(draw: st.DrawFn) -> Problem:
    """Teams of one pool, each of which has a task of its own that wants some skills."""
    skills = [f"skill{k}" for k in range(4)]
    some = st.lists(st.sampled_from(skills), max_size=2, unique=True)
    pool = [Candidate(profile(f"person{k}", (), draw(some))) for k in range(6)]
    wanted = [draw(st.lists(st.sampled_from(skills), min_size=1, unique=True)) for _ in range(2)]
    parts = [draw(st.lists(st.sampled_from(pool), min_size=2, unique_by=id)) for _ in wanted]
    tasks = [[Candidate(profile(f"task{k}", needs))] for k, needs in enumerate(wanted)]
    return counted([*parts, *tasks], [2, 2, 1, 1], [(0, 2), (1, 3)])


@given(small_teams())
@agreement()
def test_counting_for_teams_of_one_pool_keeps_the_least_solution(problem: Problem) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(first, "REDUCED_PACE", 0.0)
        found = first.least_of(reduced(problem), Budget())
    assert (None if found is None else numbers(found)) == least_numbers(problem)


def test_too_few_slots_are_explained_by_the_needs_that_lack_them() -> None:
    refusal = first.search(hubs(16, 15, 4, 5, 1))
    assert isinstance(refusal, Refusal)
    assert refusal.irreducible
    (reason,) = refusal.reasons
    assert isinstance(reason, Conflict)
    assert len(reason.requirements) == 17

"""Groups are counted until nothing more follows, each from where it was not counted before."""

from __future__ import annotations

import pytest

from benchmarks.search.families.coverage import couples, tiling, triples
from benchmarks.search.families.graphs import frequencies, tour
from benchmarks.search.families.puzzles import latin, pigeonholes, queens
from selfconf.model.partition import ANY_VALUE
from selfconf.search.budget import Budget
from selfconf.search.engines.exclusion import exclusive_groups
from selfconf.search.engines.group_counting import GroupCounting
from selfconf.search.problem import Problem
from selfconf.search.reduction import LazyReduction, pruned, reduced
from selfconf.search.strategies import solution


@pytest.mark.parametrize(("pigeons", "holes"), [(9, 8), (30, 29)])
@pytest.mark.parametrize("aided", [True, False])
def test_pigeonholes_through_ports_are_refused_by_counting(
    pigeons: int, holes: int, aided: bool, request: pytest.FixtureRequest
) -> None:
    if not aided:
        request.getfixturevalue("no_solvers")
    assert solution(LazyReduction(pigeonholes(pigeons, holes)), Budget(20_000)) is None


@pytest.mark.parametrize(
    "problem", [latin(7, 0.6, 1), queens(9, 1, 2), tour(12, 4.0, 2)], ids=["Latin square", "queens", "tour"]
)
def test_what_has_as_many_groups_as_slots_has_each_of_them_played(problem: Problem) -> None:
    assert exclusive_groups(pruned(reduced(problem))).played


@pytest.mark.parametrize("aided", [True, False])
def test_a_board_of_more_fields_of_one_colour_is_covered_by_no_dominoes(
    aided: bool, request: pytest.FixtureRequest
) -> None:
    if not aided:
        request.getfixturevalue("no_solvers")
    assert solution(LazyReduction(tiling(10, 2, 1, fair=False)), Budget(20_000)) is None


def test_what_covers_all_that_there_is_plays_an_option_of_each_group() -> None:
    pytest.importorskip("pysat")
    for problem, groups in ((tiling(8, 2, 1), 60), (triples(9, 12, 1), 36)):
        assert len(exclusive_groups(pruned(reduced(problem))).played) >= groups
        assert isinstance(solution(LazyReduction(problem), Budget(20_000)), list)
    assert exclusive_groups(pruned(reduced(triples(9, 13, 1)))).crowded == {0}


def test_what_only_one_option_takes_is_a_group_as_well() -> None:
    problem = couples(60, 4, 5)
    known = {place for pair in problem.candidates[0] for place, mask in enumerate(pair.admits) if mask != ANY_VALUE}
    assert len(known) < 60  # one person knows nobody
    assert exclusive_groups(pruned(reduced(problem))).crowded == {0}


def test_counting_does_not_begin_from_a_group_that_was_put_together_before(monkeypatch: pytest.MonkeyPatch) -> None:
    begun: list[int] = []
    met: set[int] = set()
    cover = GroupCounting._cover

    def watched(counting: GroupCounting, start: int, shares: dict[int, int]) -> bool:
        assert start not in met
        begun.append(start)
        found = cover(counting, start, shares)
        met.update(shares)
        return found

    monkeypatch.setattr(GroupCounting, "_cover", watched)
    exclusive_groups(pruned(reduced(latin(12, 0.42, 1))))
    assert len(begun) > 1


def test_counting_that_is_left_for_want_of_results_is_gone_on_with(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = pruned(reduced(frequencies(30, 8, 0.4, 3)))
    begun: list[int] = []
    cover = GroupCounting._cover

    def watched(counting: GroupCounting, start: int, shares: dict[int, int]) -> bool:
        begun.append(start)
        return cover(counting, start, shares)

    monkeypatch.setattr(GroupCounting, "_cover", watched)
    whole = exclusive_groups(problem)
    every = list(begun)
    begun.clear()
    left = exclusive_groups(problem, patience=2)
    assert begun == every[:2]
    assert left.all_counted() == whole
    assert begun == every
    assert whole.all_counted() is whole


def test_patience_does_not_end_where_counting_has_results() -> None:
    problem = pruned(reduced(latin(12, 0.42, 5)))
    assert exclusive_groups(problem, patience=3) == exclusive_groups(problem)

"""Options are counted beside those that bear on the same needs, which spares clause learning most of its conflicts."""

from __future__ import annotations

import pytest
from hypothesis import given

from benchmarks.search.families.puzzles import domination
from benchmarks.search.families.wiring import counted, profile
from selfconf.model.partition import Candidate
from selfconf.search.budget import Budget
from selfconf.search.engines import counting_order, encoding
from selfconf.search.engines.clause_learning import ClauseSolver
from selfconf.search.engines.encoding import Encoding
from selfconf.search.engines.formula import Counted
from selfconf.search.engines.least_solution import least_of_clauses
from selfconf.search.problem import Problem
from selfconf.search.reduction import Option, pruned, reduced
from tests.search.worlds import agreement, problems


@given(problems())
@agreement(0.5)
def test_each_option_has_one_place_in_the_order(problem: Problem) -> None:
    for options in reduced(problem).options:
        assert sorted(counting_order.counting_order(options)) == [*range(len(options))]


def _of_regions(regions: str, wanted: str = "abc") -> tuple[Option, ...]:
    """Return options that issue a signal of their region, and each one of its own."""
    issued = [[region, f"{region}{place}"] for place, region in enumerate(regions)]
    stations = [Candidate(profile(f"station{place}", (), some)) for place, some in enumerate(issued)]
    sink = [Candidate(profile("sink", [*wanted, *(some[1] for some in issued)]))]
    return reduced(counted([stations, sink], [len(regions), 1], [(0, 1)])).options[0]


@pytest.mark.parametrize(
    ("regions", "order"), [("abab", "aabb"), ("abcabc", "aabbcc"), ("abba", "aabb"), ("aba", "aab")]
)
def test_options_of_one_region_stand_side_by_side(regions: str, order: str) -> None:
    assert "".join(regions[place] for place in counting_order.counting_order(_of_regions(regions))) == order


def test_an_option_is_compared_with_the_next_ones_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(counting_order, "COMPARED", 1)
    assert "".join("abab"[place] for place in counting_order.counting_order(_of_regions("abab"))) == "abab"


@pytest.mark.parametrize("seed", [94_211, 94_213])
def test_guards_of_one_neighbourhood_are_counted_together(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """In the order of the candidates, which is random, it takes many times the conflicts."""
    conflicts, found = [], []
    for order in (counting_order.counting_order, lambda options: [*range(len(options))]):
        monkeypatch.setattr(encoding, "counting_order", order)
        given_ = pruned(reduced(domination(7, 12, seed)))
        with ClauseSolver(given_, encoding=Encoding(given_, ordered=True), counted=Counted.MANY) as clauses:
            assert clauses.solve((), Budget()) is True
            found.append([option.number for option in least_of_clauses(clauses, Budget())])
            conflicts.append(clauses.conflicts)
    assert found[0] == found[1]
    assert 5 * conflicts[0] < conflicts[1]

"""Options that exclude each other are in one group, and each group excludes within itself pair by pair."""

from __future__ import annotations

from itertools import combinations

from benchmarks.search.families.graphs import colouring
from benchmarks.search.families.scaling import distinct
from selfconf.search.engines.conflict_graph import ConflictGraph, mask_of, numbers_of
from selfconf.search.reduction import pruned, reduced


def test_a_mask_has_the_numbers_that_it_was_made_of() -> None:
    assert list(numbers_of(mask_of([5, 0, 64]))) == [0, 5, 64]
    many = [*range(900, 3, -7)]
    assert mask_of(many) == sum(1 << number for number in many)
    assert list(numbers_of(0)) == []


def test_options_that_are_one_component_are_a_group() -> None:
    graph = ConflictGraph(reduced(distinct(3, 3)), {})
    assert not any(graph.across)
    graph.add_components()
    assert sorted(graph.groups()) == [[0, 3, 6], [1, 4, 7], [2, 5, 8]]


def test_each_conflict_of_a_graph_is_in_a_group_and_each_group_is_a_clique() -> None:
    problem = pruned(reduced(colouring(12, 3, 4.0, 1)))
    needs = {
        source: {
            need
            for options in problem.options
            for option in options
            for need in option.kind.needs
            if {s.role for s in problem.needs.scopes[need].sources} == {source}
        }
        for source in range(len(problem.options))
    }
    graph = ConflictGraph(problem, needs)
    across = {(one, other) for one, mask in enumerate(graph.across) for other in numbers_of(mask)}
    assert across
    groups = list(graph.groups())
    assert across <= {pair for group in groups for one in group for pair in ((one, other) for other in group)}
    for group in groups:
        for one, other in combinations(group, 2):
            same_role = graph.role[one] == graph.role[other] and graph.asked[graph.role[one]] == 1
            assert same_role or (one, other) in across

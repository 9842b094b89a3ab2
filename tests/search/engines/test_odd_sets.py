"""Of the edges of an odd set of nodes no more play than fit between them, and triples are counted by their points."""

from __future__ import annotations

from itertools import combinations, product

import pytest

from benchmarks.search.families.coverage import triples
from benchmarks.search.families.wiring import counted, iri, profile
from selfconf.model.partition import ANY_VALUE, Candidate, Variable
from selfconf.search.budget import Budget
from selfconf.search.engines import odd_sets as module
from selfconf.search.engines.exclusion import exclusive_groups
from selfconf.search.engines.odd_sets import odd_sets
from selfconf.search.problem import Problem
from selfconf.search.reduction import LazyReduction, pruned, reduced
from selfconf.search.strategies import solution


def edges(*paths: str) -> tuple[list[list[int]], list[list[int]]]:
    """The groups of the nodes of a graph, given by closed paths, and the groups of each edge."""
    some = [(one, other) for path in paths for one, other in zip(path, path[1:] + path[0], strict=True)]
    nodes = sorted(set().union(*some))
    groups = [[number for number, edge in enumerate(some) if node in edge] for node in nodes]
    return groups, [[nodes.index(node) for node in edge] for edge in some]


def matchings(graphs: int) -> Problem:
    """Edges of some complete graphs of three nodes each, of which as many are to play as there are pairs of nodes."""
    nodes = [*product(range(graphs), range(3))]
    some = []
    for graph in range(graphs):
        for pair in combinations(range(3), 2):
            masks = [ANY_VALUE] * len(nodes)
            for node in pair:
                masks[nodes.index((graph, node))] = 1 << (sum(pair) - node)
            some.append(Candidate(profile(f"edge{graph}.{pair[0]}{pair[1]}"), tuple(masks)))
    values = tuple(Variable(iri(f"node{a}.{b}"), tuple(iri(f"to{k}") for k in range(3))) for a, b in nodes)
    return counted([some], [len(nodes) // 2], (), values)


def test_of_the_edges_of_a_triangle_one_fits() -> None:
    assert odd_sets(*edges("abc", "def")) == {frozenset((0, 1, 2)): 1, frozenset((3, 4, 5)): 1}


def test_a_group_of_an_option_that_is_in_no_other_is_in_no_set() -> None:
    assert odd_sets([[0], [0, 1], [1]], [[0, 1], [1, 2]]) == {frozenset((0, 1)): 1}
    assert odd_sets([[0, 1], [0]], [[0, 1], [0]]) == {}


def test_sets_that_become_too_large_are_left(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "LARGEST_SET", 3)
    assert odd_sets(*edges("abcde")) == {}
    monkeypatch.setattr(module, "LARGEST_SET", 6)
    assert odd_sets(*edges("abcde")) == {frozenset(range(5)): 2}


@pytest.mark.parametrize("graphs", [2, 20])
@pytest.mark.parametrize("aided", [True, False])
def test_triangles_have_no_perfect_matching(graphs: int, aided: bool, request: pytest.FixtureRequest) -> None:
    if not aided:
        request.getfixturevalue("no_solvers")
    assert solution(LazyReduction(matchings(graphs)), Budget(20_000)) is None


def test_of_eight_points_there_are_eight_triples_that_share_one_point_at_most() -> None:
    found = exclusive_groups(pruned(reduced(triples(8, 8, 1))))
    assert not found.crowded
    sets = odd_sets(found.groups, [[k for k, some in enumerate(found.groups) if n in some] for n in range(56)])
    assert {(len(some), most) for some, most in sets.items()} == {(21, 3)}  # the triples with one of the points
    assert exclusive_groups(pruned(reduced(triples(8, 9, 1)))).crowded == {0}

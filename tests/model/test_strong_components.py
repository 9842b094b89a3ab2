"""Strongly connected components: what lies in circles together."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from selfconf.model.strong_components import strong_components


def test_nodes_of_one_circle_have_one_name_and_others_have_their_own() -> None:
    found = strong_components({"a": ["b"], "b": ["c"], "c": ["b", "d"]})
    assert found["b"] == found["c"]
    assert len({found["a"], found["b"], found["d"]}) == 3


def test_a_chain_of_many_takes_no_recursion() -> None:
    assert len(set(strong_components({n: [n + 1] for n in range(100_000)}).values())) == 100_001


@given(st.dictionaries(st.integers(0, 7), st.sets(st.integers(0, 7))))
def test_two_nodes_are_together_if_each_is_reached_from_the_other(edges: dict[int, set[int]]) -> None:
    def reached(node: int) -> set[int]:
        seen, waiting = {node}, [node]
        while waiting:
            further = edges.get(waiting.pop(), set()) - seen
            seen |= further
            waiting += further
        return seen

    found = strong_components(edges)
    assert found.keys() == edges.keys() | {other for others in edges.values() for other in others}
    for one in found:
        for other in found:
            assert (found[one] == found[other]) == (other in reached(one) and one in reached(other))

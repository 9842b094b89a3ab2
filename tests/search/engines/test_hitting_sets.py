"""Smallest sets that cannot hold together, by hitting sets, against enumeration."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from itertools import combinations

from hypothesis import given
from hypothesis import strategies as st

from selfconf.model.refusal import Undecided
from selfconf.search.budget import Budget
from selfconf.search.engines.hitting_sets import smallest_core
from tests.search.worlds import agreement

UNIVERSE = range(7)
Held = Callable[[Collection[int]], Collection[int] | Undecided | None]


def held_apart(*conflicts: Collection[int]) -> Held:
    """Let everything hold together but the members of each conflict: what is asked for, and what else can join in."""

    def possible(members: Collection[int]) -> bool:
        return not any(set(conflict) <= set(members) for conflict in conflicts)

    def held(asked: Collection[int]) -> list[int] | None:
        if not possible(asked):
            return None
        grown = list(asked)
        for one in UNIVERSE:
            if one not in grown and possible([*grown, one]):
                grown.append(one)
        return grown

    return held


def irreducible(held: Held) -> Sequence[int]:
    """A set that cannot hold together, without what it can do without, by deletion."""
    core = list(UNIVERSE)
    for one in UNIVERSE:
        less = [other for other in core if other != one]
        if held(less) is None:
            core = less
    return core


def test_a_smaller_set_than_the_one_that_is_known_is_found_and_proved() -> None:
    held = held_apart((4, 5, 6), (3, 1))
    assert smallest_core((4, 5, 6), UNIVERSE, held, Budget()) == ([1, 3], True)


def test_a_set_of_one_member_is_the_smallest_without_a_question() -> None:
    def unasked(asked: Collection[int]) -> None:
        raise AssertionError(asked)

    assert smallest_core([2], UNIVERSE, unasked, Budget()) == ([2], True)


@given(st.lists(st.sets(st.sampled_from(UNIVERSE), min_size=1, max_size=4), min_size=1, max_size=5))
@agreement(0.05)
def test_the_size_is_that_of_the_smallest_set_by_enumeration(conflicts: list[set[int]]) -> None:
    held = held_apart(*conflicts)
    core, proved = smallest_core(irreducible(held), UNIVERSE, held, Budget())
    smallest = next(
        size for size in range(1, len(UNIVERSE) + 1) if any(held(some) is None for some in combinations(UNIVERSE, size))
    )
    assert proved
    assert len(core) == smallest
    assert held(core) is None


def test_when_the_budget_ends_the_known_set_is_returned_without_a_proof() -> None:
    known, held = (4, 5, 6), held_apart((4, 5, 6), (3, 1))
    answers = [smallest_core(known, UNIVERSE, held, Budget(steps)) for steps in range(20)]
    few = answers.index(([1, 3], True))
    assert few > 0
    assert answers == [(known, False)] * few + [([1, 3], True)] * (20 - few)


def test_where_a_question_stays_open_the_known_set_is_returned_without_a_proof() -> None:
    assert smallest_core((4, 5), UNIVERSE, lambda asked: Undecided(7), Budget()) == ((4, 5), False)

"""The solver that decides on options in order: the first model that it meets is the least solution."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.search.families.coverage import cover
from benchmarks.search.families.puzzles import queens
from benchmarks.search.families.random_relations import grid
from benchmarks.search.families.scaling import satisfiability
from selfconf.search.budget import Budget
from selfconf.search.engines import ordered_decisions
from selfconf.search.engines.encoding import Encoding
from selfconf.search.engines.least_solution import least_by_clauses
from selfconf.search.engines.ordered_decisions import OrderedDecisions
from selfconf.search.problem import Problem
from selfconf.search.reduction import ReducedProblem, pruned, reduced
from tests.sdk.living import until
from tests.search.comparison import least_numbers, numbers
from tests.search.worlds import agreement, component, problem, problems, rivalries

pytest.importorskip("clingo")
pytest.importorskip("pysat")

ENOUGH = 1_000_000
"""More conflicts than any of these problems takes."""
BLIND = problem({"eye": [component("deaf")], "mind": [component("mind", "i:Image")]}, "eye>mind")


def in_order(given_: ReducedProblem, ordered: bool = True) -> OrderedDecisions:
    """The solver, with a problem."""
    return OrderedDecisions(Encoding(given_, ordered=ordered), given_.slots)


def found(given_: ReducedProblem, search: OrderedDecisions) -> list[int] | None:
    """What it has found, as numbers of candidates."""
    assert search.possible is not None
    chosen = [given_.options[role][number] for role, number in zip(given_.slots, search.settled(), strict=False)]
    return numbers(chosen) if search.possible else None


@given(st.one_of(problems(), rivalries()), st.booleans())
@agreement()
def test_the_first_model_that_it_meets_is_the_least_solution(problem: Problem, ordered: bool) -> None:
    given_ = reduced(problem)
    with in_order(given_, ordered) as search:
        search.search(ENOUGH)
        assert found(given_, search) == least_numbers(problem)


@pytest.mark.parametrize(
    "made",
    [
        lambda: grid(5, 12, 8, 1, 3),
        lambda: grid(6, 10, 8, 2),
        lambda: queens(14, 1, 3),
        lambda: cover(16, 12, 4, 0.3, 1),
    ],
    ids=["grid, few fit", "grid", "queens", "cover"],
)
def test_it_agrees_with_the_others_where_many_conflicts_are_met(
    made: Callable[[], Problem], monkeypatch: pytest.MonkeyPatch
) -> None:
    given_ = pruned(reduced(made()))
    with in_order(given_) as search:
        search.search(ENOUGH)
        answer = found(given_, search)
    monkeypatch.setattr(OrderedDecisions, "available", staticmethod(lambda _: False))
    assert answer == numbers(least_by_clauses(given_, Budget()))


def test_in_a_thread_of_its_own_it_finds_the_same_and_says_so() -> None:
    given_ = pruned(reduced(grid(5, 12, 8, 1, 3)))
    with in_order(given_) as alone:
        alone.search(ENOUGH)
        expected = list(alone.settled())
    ended = threading.Event()
    with in_order(given_) as search:
        search.begin(ended.set)
        assert ended.wait(60)
        while search.possible is None:
            search.settled()
            os.sched_yield()
        assert list(search.settled()) == expected


def conflicts(given_: ReducedProblem) -> int:
    """How many conflicts it meets until it has the least solution."""
    with in_order(given_) as search:
        search.search(ENOUGH)
        assert search.possible
        return int(search._control.statistics["solving"]["solvers"]["conflicts"])


def test_it_learns_about_how_many_play_a_role(monkeypatch: pytest.MonkeyPatch) -> None:
    given_ = pruned(reduced(cover(60, 40, 9, 0.2, 500)))
    counting = conflicts(given_)
    monkeypatch.setattr(ordered_decisions, "COUNTING", "--trans-ext=no")
    assert 10 * counting < conflicts(given_)


def test_that_there_is_no_solution_is_known_without_any_option() -> None:
    with in_order(reduced(BLIND)) as search:
        search.search(ENOUGH)
        assert search.possible is False
        assert list(search.settled()) == []


def test_what_takes_more_conflicts_is_left_open_and_gone_on_with() -> None:
    given_ = reduced(satisfiability(120, 4.26, 1))
    with in_order(given_) as search:
        search.search(1)
        assert search.possible is None
        assert list(search.settled()) == []
        search.search(ENOUGH)
        assert search.possible is not None


def test_a_search_ends_once_it_is_needless() -> None:
    asked: list[bool] = []
    with in_order(reduced(satisfiability(400, 4.26, 1))) as search:
        search.search(ENOUGH, lambda: asked.append(True) or len(asked) > 1)
        assert search.possible is None
    assert len(asked) > 1


def threads() -> set[str]:
    """The threads of this process, those that Python has not begun included."""
    return {path.name for path in Path("/proc/self/task").iterdir()}


@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="only Linux lists the threads of a process")
def test_a_search_that_goes_on_ends_when_it_is_left() -> None:
    before = threads()
    with in_order(reduced(satisfiability(400, 4.26, 1))) as search:
        search.begin(lambda: None)
        begun = threads() - before
        assert begun
        assert search.possible is None
    assert until(lambda: not begun & threads())


def test_a_signal_is_handled_while_a_search_lasts() -> None:
    class OutOfTimeError(Exception):
        """The search took as long as it may."""

    def end(*_: object) -> None:
        raise OutOfTimeError

    before = signal.signal(signal.SIGALRM, end)
    try:
        with in_order(reduced(satisfiability(400, 4.26, 1))) as search:
            signal.setitimer(signal.ITIMER_REAL, 0.2)
            with pytest.raises(OutOfTimeError):
                search.search(10**9)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def test_more_options_than_levels_are_not_asked_about(monkeypatch: pytest.MonkeyPatch) -> None:
    encoding = Encoding(reduced(BLIND))
    assert OrderedDecisions.available(encoding)
    monkeypatch.setattr(ordered_decisions, "LEVELS", 0)
    assert not OrderedDecisions.available(encoding)

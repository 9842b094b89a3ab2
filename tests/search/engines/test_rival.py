"""The engine in a process of its own: what it settles, and that it ends with its search."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from benchmarks.search.families.scaling import distinct
from selfconf.search.engines import rival
from selfconf.search.engines.encoding import Encoding
from selfconf.search.engines.rival import Rival
from selfconf.search.problem import Problem
from selfconf.search.reduction import reduced
from tests.search.worlds import component, problem

pytest.importorskip("pysat")

EYES = [component(name, outputs="o:Image") for name in ("left", "right")]
SEEING = problem({"eye": [component("deaf"), *EYES], "mind": [component("mind", "i:Image")]}, "eye>mind")
BLIND = problem({"eye": [component("deaf")], "mind": [component("mind", "i:Image")]}, "eye>mind")


def asked(problem: Problem) -> Rival:
    """A rival that looks for the least solution of a problem."""
    given = reduced(problem)
    return Rival(Encoding(given), given.slots, least=True)


def wait(condition: Callable[[], bool]) -> bool:
    """Wait for a condition, or for the deadline."""
    deadline = time.monotonic() + 30
    while not condition() and time.monotonic() < deadline:
        os.sched_yield()
    return condition()


@pytest.mark.process
def test_it_settles_the_options_of_the_least_solution_slot_after_slot() -> None:
    with asked(SEEING) as other:
        assert wait(lambda: len(other.settled()) == 2)
        given = reduced(SEEING)
        players = [given.options[role][number].component for role, number in enumerate(other.settled())]
        assert players == [EYES[0].component, SEEING.candidates[1][0].profile.component]
        assert other.possible is True


@pytest.mark.process
def test_that_there_is_no_solution_is_known_without_any_option() -> None:
    with asked(BLIND) as other:
        assert other.possible is None
        assert wait(lambda: list(other.settled()) == [] and other.possible is not None)
        assert other.possible is False


@pytest.mark.process
def test_a_process_that_has_ended_too_soon_leaves_everything_open(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rival.sys, "executable", "true")
    with asked(SEEING) as other:
        other._process.wait()
        assert list(other.settled()) == []
        assert other.possible is None


@pytest.mark.process
def test_the_process_has_ended_when_the_block_has() -> None:
    with asked(SEEING) as other:
        assert other._process.poll() is None
    assert other._process.poll() is not None


@pytest.mark.process
def test_there_is_none_without_a_thread_and_no_process_is_left(monkeypatch: pytest.MonkeyPatch) -> None:
    begun, start = [], rival.subprocess.Popen

    def no_thread(_: threading.Thread) -> None:
        raise RuntimeError("can't start new thread")

    def noted(*arguments: Any, **options: Any) -> Any:
        begun.append(start(*arguments, **options))
        return begun[0]

    monkeypatch.setattr(rival.threading.Thread, "start", no_thread)
    monkeypatch.setattr(rival.subprocess, "Popen", noted)
    with pytest.raises(OSError, match="can't start new thread"):
        asked(SEEING)
    assert begun[0].poll() is not None


def test_there_is_none_without_an_interpreter_to_start(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rival.os, "sched_getaffinity", lambda _: {0, 1})
    assert Rival.available()
    monkeypatch.setattr(rival.sys, "executable", "")
    assert not Rival.available()


@pytest.mark.process
def test_a_question_of_any_size_is_sent_and_its_answer_is_told_while_nobody_asks() -> None:
    """A socket takes some hundred kilobytes at once; the question goes on while the search is in a call."""
    ends = threading.Event()
    given = reduced(distinct(60, 59))
    encoding = Encoding(given)
    encoding.statements += [[1, 2, 3 + k % 50] for k in range(200_000)]
    with Rival(encoding, given.slots, True, ends.set) as other:
        assert ends.wait(60)
        assert list(other.settled()) == []
        assert other.possible is False


@pytest.mark.process
def test_a_process_is_ended_that_has_not_read_its_question(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    idle = tmp_path / "idle.py"
    idle.write_text("import signal\nsignal.pause()\n")
    monkeypatch.setattr(rival, "PROGRAM", idle)
    given = reduced(SEEING)
    encoding = Encoding(given)
    encoding.statements += [[1, 2, 3] for _ in range(200_000)]
    with Rival(encoding, given.slots, True) as other:
        assert other.possible is None
    assert other._process.poll() is not None
    assert not other._thread.is_alive()

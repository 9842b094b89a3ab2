"""The lines of `selfconf run`: one for each event, and nothing twice."""

from __future__ import annotations

import errno
import sys
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import pytest

import selfconf as sc
from selfconf.cli import run_lines
from selfconf.cli.run_lines import LinePrinter, TextLines
from selfconf.model.configuration import Assignment, Configuration
from selfconf.model.refusal import Refusal, TooFewEligible
from selfconf.model.run_event import (
    CallDeclined,
    ComponentLost,
    EcologyAsked,
    EcologyDiscovered,
    RunEvent,
    SearchEnded,
    TaskRefused,
    TaskRunning,
    TaskStopped,
    TaskWaiting,
)
from selfconf.model.term import IRI

CLOCK = Path(__file__).parents[2] / "examples" / "clock" / "tell-the-time.ttl"
SCREEN, ROLE, TEMPLATE = IRI("urn:c:screen"), IRI("urn:r:screen"), IRI("urn:t:clock")
REFUSAL = Refusal(TEMPLATE, (TooFewEligible(ROLE, 1, 0),))
FOUND = Configuration(TEMPLATE, (Assignment(ROLE, (SCREEN,)),))
LOOK = [EcologyAsked(), EcologyDiscovered(3, ("desk",), ()), SearchEnded(REFUSAL, 0.001), TaskWaiting(REFUSAL, {})]
ELSEWHERE = [LOOK[0], EcologyDiscovered(4, ("desk",), ()), *LOOK[2:]]


def told(capsys: pytest.CaptureFixture[str], events: Iterable[RunEvent]) -> list[str]:
    """What is told of each of some events, one a second, without the times."""
    report = TextLines(sc.template(CLOCK))
    for second, event in enumerate(events):
        report(replace(event, time=float(second)))
    return [line.partition(" s  ")[2] or line for line in capsys.readouterr().err.splitlines()]


def test_a_task_that_looks_in_vain_again_and_again_says_so_once(capsys: pytest.CaptureFixture[str]) -> None:
    once = told(capsys, LOOK)
    assert once[-1].strip() == "waiting for the ecology to change"
    assert told(capsys, LOOK * 4) == once
    assert told(capsys, [*LOOK, *LOOK[:2], *LOOK]) == once, "a look that was broken off says nothing"
    for looks in (LOOK * 3, [*LOOK, *LOOK[:2]]):
        assert told(capsys, [*looks, TaskStopped()]) == [*once, "       taken down"]


def test_what_a_look_comes_to_is_told_once_it_differs(capsys: pytest.CaptureFixture[str]) -> None:
    once, other = told(capsys, LOOK), told(capsys, ELSEWHERE)
    assert once != other
    assert told(capsys, [*LOOK * 2, *ELSEWHERE * 2, *LOOK * 2]) == [*once, *other, *once]


def test_a_task_that_runs_after_it_has_waited_tells_everything_since_it_looked(
    capsys: pytest.CaptureFixture[str],
) -> None:
    runs = [*LOOK[:2], SearchEnded(FOUND, 0.001), TaskRunning(FOUND, 1)]
    assert told(capsys, [*LOOK * 2, *runs]) == [*told(capsys, LOOK), *told(capsys, runs)]
    again = [*LOOK * 2, *runs, ComponentLost(SCREEN, "crash", ""), *LOOK * 2]
    lines = told(capsys, again)
    assert lines[-len(told(capsys, LOOK)) :] == told(capsys, LOOK)
    assert sum("LOST" in line for line in lines) == 1


def test_an_interaction_that_connects_nothing_is_named_once(capsys: pytest.CaptureFixture[str]) -> None:
    roles = [role.iri for role in sc.template(CLOCK).roles]
    both = Configuration(TEMPLATE, tuple(Assignment(role, (SCREEN,)) for role in roles))
    lines = told(capsys, [SearchEnded(both, 0.001), ComponentLost(SCREEN, "crash", ""), SearchEnded(both, 0.001)])
    named = [line.strip() for line in lines if "connects nothing" in line]
    assert named == [
        ":source feeds :screen, which connects nothing: no output of the one matches an input of the other"
    ]


def test_of_what_has_crashed_it_is_told_once_where_its_last_words_are(capsys: pytest.CaptureFixture[str]) -> None:
    report = TextLines(sc.template(CLOCK), "--ecology mine")
    for cause in ("fail", "crash", "crash"):
        report(ComponentLost(SCREEN if cause == "crash" else ROLE, cause, ""))
    lines = capsys.readouterr().err.splitlines()
    hints = {number: line.strip() for number, line in enumerate(lines) if "selfconf log" in line}
    assert hints == {2: "`selfconf log screen --ecology mine` shows what it has printed"}


def test_what_takes_long_is_told_as_it_begins(capsys: pytest.CaptureFixture[str]) -> None:
    report = TextLines(sc.template(CLOCK))
    report(LOOK[0])
    assert capsys.readouterr().err


def test_a_failure_is_told_once(capsys: pytest.CaptureFixture[str]) -> None:
    declines = CallDeclined(SCREEN, "the cable is out")
    lines = told(capsys, [declines, ComponentLost(SCREEN, "refused", "the cable is out")])
    assert sum("the cable is out" in line for line in lines) == 1


@pytest.mark.parametrize("end", [TaskRefused(REFUSAL, owed=(SCREEN,)), TaskStopped(owed=(SCREEN,))])
def test_what_is_out_of_control_at_the_end_is_named(capsys: pytest.CaptureFixture[str], end: RunEvent) -> None:
    lines = told(capsys, [*LOOK[:3], end])
    assert "  out of control: <urn:c:screen> was turned off and has not obeyed" in lines


def test_all_events_are_reported_in_order_before_the_end() -> None:
    reported: list[RunEvent] = []
    printer = LinePrinter(reported.append, sys.stderr, lambda: None)
    for event in LOOK:
        printer.put(event)
    printer.end()
    assert (reported, printer.trouble) == (LOOK, None)


@pytest.mark.parametrize(
    "trouble", [OSError(errno.ENOSPC, "full"), BrokenPipeError()], ids=["full disk", "gone reader"]
)
def test_lines_that_cannot_be_written_end_the_run_and_a_reader_that_has_gone_is_no_trouble(
    trouble: OSError, monkeypatch: pytest.MonkeyPatch
) -> None:
    silenced: list[object] = []
    broken: list[bool] = []
    monkeypatch.setattr(run_lines, "silence", silenced.append)

    def report(event: RunEvent) -> None:
        raise trouble

    printer = LinePrinter(report, sys.stdout, lambda: broken.append(True))
    printer.put(LOOK[0])
    printer.put(LOOK[1])
    printer.end()
    gone = isinstance(trouble, BrokenPipeError)
    assert broken == [True]
    assert silenced == [sys.stdout, *[sys.stderr] * gone]
    assert printer.trouble is (None if gone else trouble)

"""Searches that end before they are through: an honest "not decided", and never a wrong answer."""

from __future__ import annotations

import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from benchmarks.search.families import scaling
from selfconf.api.reading import read
from selfconf.composition import TimeLimit, composed
from selfconf.composition.composer import Composer
from selfconf.composition.searches import Strategy
from selfconf.model.optimum import Optimum
from selfconf.model.refusal import Refusal, Undecided
from selfconf.rdf.deadline import TimeUp
from selfconf.rdf.tasks import templates
from selfconf.rdf.turtle import document as turtle
from selfconf.search import explain
from selfconf.search.budget import Budget
from selfconf.search.engines import ClauseSolver, clause_learning
from selfconf.search.reduction.dominance import reduced
from tests.cli.command import Outcome, run
from tests.lab import PREFIXES

ROLES = 7
CROWD = "\n".join(f":c{k} a sc:Component, :Worker ." for k in range(ROLES - 1))
"""One worker too few: Algorithm 1 tries them all in every order, which takes longer than anyone waits."""
TEAM = f":team a sc:Template ; sc:roles ( {' '.join(f':r{k}' for k in range(ROLES))} ) .\n" + "\n".join(
    f":r{k} a sc:Role ; sh:class :Worker ." for k in range(ROLES)
)


@pytest.fixture
def team(tmp_path: Path) -> Path:
    """A template and a folder of advertisements beside it."""
    (tmp_path / "ads").mkdir()
    (tmp_path / "ads" / "crowd.ttl").write_text(PREFIXES + CROWD)
    (tmp_path / "team.ttl").write_text(PREFIXES + TEAM)
    return tmp_path


def configure(capsys: pytest.CaptureFixture[str], team: Path, *arguments: str) -> Outcome:
    """Run `configure` for the team."""
    return run(capsys, "configure", str(team / "team.ttl"), "--ads", str(team / "ads"), *arguments)


@pytest.mark.parametrize(
    ("budget", "words"), [(("--steps", "50"), "within 50 steps"), (("--seconds", "0.3"), "within 0.3 s")]
)
def test_a_search_that_ends_before_it_is_through_is_undecided(
    capsys: pytest.CaptureFixture[str], team: Path, budget: tuple[str, ...], words: str
) -> None:
    assert configure(capsys, team, "--strategy", "paper", *budget).is_one_sentence("not decided", words)
    outcome = configure(capsys, team, "--strategy", "paper", "--format", "json", *budget)
    assert outcome.code == 2
    assert outcome.body["status"] == "undecided"
    assert words in outcome.body["message"]
    assert len(outcome.body["eligible"]) == ROLES


def test_the_time_is_kept(capsys: pytest.CaptureFixture[str], team: Path) -> None:
    began = time.monotonic()
    configure(capsys, team, "--strategy", "paper", "--seconds", "0.2")
    assert time.monotonic() - began < 10  # some 40 s without


def test_a_budget_that_is_enough_changes_nothing(capsys: pytest.CaptureFixture[str], team: Path) -> None:
    plain = configure(capsys, team)
    assert plain.code == 1
    assert configure(capsys, team, "--steps", "1000000", "--seconds", "600").out == plain.out
    (team / "ads" / "more.ttl").write_text(PREFIXES + ":c9 a sc:Component, :Worker .")
    plain = configure(capsys, team)
    assert plain.code == 0
    assert configure(capsys, team, "--steps", "1000000", "--seconds", "600").out == plain.out


def test_when_the_time_is_up_the_best_answer_so_far_remains(team: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ecology = read(team / "ads").advertisements()
    cost = "sc:cost ( [ sc:term [ sc:property :p ] ] )"
    text = PREFIXES + f":solo a sc:Template ; sc:roles ( :a ) ; {cost} .\n:a a sc:Role ."
    composer = Composer(templates.read_task(turtle.parse(text, "solo")), strategy=Strategy.BEST)
    (proved,) = composer.answers(ecology, frozenset(), None)
    clock = TimeLimit(0.2)

    def endless(*_: object) -> object:
        yield proved
        while True:
            pass

    monkeypatch.setattr(composer, "answers", endless)
    assert composed(composer, ecology, frozenset(), None, clock) is proved
    assert isinstance(proved, Optimum)
    assert composed(composer, ecology, frozenset(), None, clock) == Undecided(seconds=0.2)


def test_that_there_is_none_is_told_even_if_no_time_is_left_for_reasons(
    capsys: pytest.CaptureFixture[str], team: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def too_long(*_: object) -> Refusal:
        raise TimeUp

    monkeypatch.setattr(explain, "refusal", too_long)
    outcome = configure(capsys, team, "--seconds", "30")
    assert outcome.code == 1
    assert "no time was left to find out why" in outcome.out


def test_what_is_asked_without_a_limit_is_always_answered() -> None:
    unlimited = TimeLimit(None)
    assert [unlimited.within(lambda: "answer", "no answer") for _ in range(3)] == ["answer"] * 3


def test_what_is_asked_later_has_less_time_and_none_once_it_is_over() -> None:
    limit, asked = TimeLimit(0.2), list[int]()

    def endless() -> str:
        asked.append(1)
        while True:
            pass

    assert limit.within(lambda: "answer", "no answer") == "answer"
    began = time.monotonic()
    assert limit.within(endless, "no answer") == "no answer"
    assert limit.within(endless, "no answer") == "no answer"
    assert (len(asked), limit.seconds) == (1, 0.2)
    assert time.monotonic() - began < 5.0


def test_a_call_of_a_solver_which_hears_no_alarm_is_ended_when_the_time_is_up(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("pysat")
    monkeypatch.setattr(clause_learning, "CONFLICTS_PER_CALL", 10**9)
    hard, began = reduced(scaling.satisfiability(400, 4.26, 1)), time.monotonic()
    with ClauseSolver(hard) as solver:
        assert TimeLimit(0.2).within(lambda: solver.ask((), Budget()), "no answer") == "no answer"
    assert time.monotonic() - began < 10.0  # minutes without


def test_calls_are_ended_in_the_main_thread_alone_as_elsewhere_there_is_no_limit() -> None:
    def ending() -> bool:
        return "time limit" in [thread.name for thread in threading.enumerate()]

    for thread in threading.enumerate():
        if thread.name == "time limit":
            thread.join()  # that of a limit before, which ends just now
    with ThreadPoolExecutor(1) as threads:
        assert not threads.submit(TimeLimit(60.0).within, ending, True).result()
    assert TimeLimit(60.0).within(ending, False)


def test_an_error_of_what_is_asked_is_no_answer_of_the_limit() -> None:
    with pytest.raises(ZeroDivisionError):
        TimeLimit(60.0).within(lambda: 1 // 0, 0)

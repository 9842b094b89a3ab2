"""`stop`: what is deployed is taken down, and components are turned off, not ended."""

from __future__ import annotations

import pytest

from tests.cli.command import run
from tests.cli.processes import Home

pytestmark = pytest.mark.process


def test_stop_tells_programs_what_it_took_down(inhabited: Home, capsys: pytest.CaptureFixture[str]) -> None:
    where = inhabited.arguments()
    program = inhabited.run()
    program.act("running")
    (status,) = run(capsys, "status", "--format", "json", *where).body
    stopped = {"ecology": inhabited.ecology, "stopped": [status["task"]]}
    assert run(capsys, "stop", "--format", "json", *where).body == stopped
    assert program.ended() == 0
    assert run(capsys, "stop", "--format", "json", *where).body == {**stopped, "stopped": []}


def test_what_answers_is_taken_down_though_a_configurator_lives_that_does_not(
    inhabited: Home, capsys: pytest.CaptureFixture[str]
) -> None:
    program = inhabited.run()
    program.act("running")
    with inhabited.mute_configurator() as name:
        outcome = run(capsys, "stop", *inhabited.arguments())
    assert outcome.code == 2
    assert f"the configurator '{name}' lives, but does not answer" in outcome.err
    assert program.ended() == 0


def test_of_a_task_and_a_configurator_one_is_given(capsys: pytest.CaptureFixture[str]) -> None:
    outcome = run(capsys, "stop", "tidy", "--configurator", "main")
    assert (outcome.code, outcome.out) == (2, "")
    assert "a task and --configurator both say what to stop; give one of them" in outcome.err


def test_without_an_ecology_it_says_what_to_start(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(capsys, "stop").is_one_sentence("no site runs on this machine", "selfconf site")

"""`selfconf why`, of a living ecology."""

from __future__ import annotations

import signal
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import pytest

from tests.cli.command import Outcome, run
from tests.cli.processes import Home


@pytest.mark.process
def test_who_plays_a_role_and_why_is_told_now_and_then(home: Home, capsys: pytest.CaptureFixture[str]) -> None:
    home.site("peis-home", "ads")
    home.components("sonar", "encoder", "tracker", "odometry", "control", "drive")
    running = home.run()
    running.act("running")
    (home.folder / "tracker.fail").touch()
    lost, _ = running.act("lost"), running.act("running")
    said = run(capsys, "why", "position", *home.arguments())
    assert said.code == 0
    assert "position in navigate: absolute-odometry, since" in said.out
    assert "it took over from person-tracker: lost at" in said.out
    assert "passed over, though first in order: person-tracker" in said.out
    told = said.out.partition(", since ")[2].partition("\n")[0]
    assert "absolute-odometry, since" in run(capsys, "why", "position", "--at", told, *home.arguments()).out
    moment = datetime.fromtimestamp(lost["time"] - 0.001).isoformat()
    then = run(capsys, "why", "position", "--at", moment, *home.arguments())
    assert "position in navigate: person-tracker, since" in then.out
    nothing = run(capsys, "why", "cellar", *home.arguments())
    assert (nothing.code, nothing.out.startswith("no task has to do with cellar,")) == (1, True)
    before = run(capsys, "why", "position", "--at", "2020-01-01", *home.arguments())
    assert (before.code, before.out.startswith("no task has to do with position at 2020-01-01 ")) == (1, True)


@pytest.mark.parametrize("text", ["noon", "25:00", "2026-13-01"])
def test_what_is_no_time_is_one_sentence(text: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(capsys, "why", "position", "--at", text).is_one_sentence(f"{text!r} is no time")


def test_a_moment_that_no_clock_has_is_one_sentence(capsys: pytest.CaptureFixture[str]) -> None:
    said = run(capsys, "why", "position", "--at", "0001-01-01")
    assert said.is_one_sentence("'0001-01-01' is before or after all moments that are known")


def test_a_moment_that_has_not_come_yet_is_one_sentence(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """What is known now is no answer about later; the second that lasts now is known, though its end is not."""

    def said(moment: datetime) -> Outcome:
        text = moment.isoformat(timespec="seconds")
        return run(capsys, "why", "position", "--at", text, "--history", str(tmp_path))

    assert said(datetime.now() + timedelta(minutes=1)).is_one_sentence("has not come yet, it is ")
    assert said(datetime.now()).is_one_sentence("holds no history")


@pytest.mark.process
def test_what_a_server_has_kept_answers_for_every_moment_as_the_run_has_told(
    home: Home, capsys: pytest.CaptureFixture[str]
) -> None:
    """Three failures; `why` from the history, before, between and after them, beside the events of the run."""
    pytest.importorskip("starlette", reason="the extra `serve` is not installed")
    home.site("peis-home", "ads")
    home.components("sonar", "encoder", "control", "drive")
    programs = {name: home.components(name) for name in ("tracker", "odometry")}
    history = home.folder / "history"
    server = home.selfconf("serve", "--ecology", home.ecology, "--port", "0", "--history", str(history))
    assert "http://" in server.line()
    run_of_task = home.run()
    told = [run_of_task.act("running")]
    losses = []
    for failing, standing in (("tracker", "odometry"), ("odometry", "tracker"), ("tracker", "odometry")):
        if losses:  # what failed lives anew, to take over
            programs[standing].end()
            programs[standing] = home.components(standing)
        (home.folder / f"{failing}.fail").touch()
        losses.append(run_of_task.act("lost"))
        told.append(run_of_task.act("running"))

    def answer(*arguments: str) -> str:
        return run(capsys, "why", "position", "--history", str(history), *arguments).out

    def player(body: Any) -> str:
        roles = body["configuration"]["roles"]
        return next(role["components"][0] for role in roles if role["role"].endswith("#position")).rpartition("#")[2]

    assert home.until(lambda: answer().startswith(f"position in navigate: {player(told[-1])}, since"))
    for before, event in zip((None, *losses), told, strict=True):
        at = datetime.fromtimestamp(event["time"] + 0.01).isoformat()
        said = answer("--at", at)
        assert said.startswith(f"position in navigate: {player(event)}, since"), said
        assert before is None or f"it took over from {before['component'].rpartition('#')[2]}: lost at" in said
        assert before is None or "(fail, told to)" in said
    assert answer("--at", datetime.fromtimestamp(told[0]["time"] - 60).isoformat()).startswith("no task")
    rows = run(
        capsys, "query", "SELECT ?c { ?c a sc:Configuration }", "--history", str(history), "--format", "json"
    ).body["results"]["bindings"]
    assert len(rows) == 4
    assert run_of_task.end() == 0
    assert home.until(lambda: ", until " in answer())
    assert server.end(signal.SIGKILL) != 0
    assert ", until " in answer()


def test_a_folder_without_a_history_is_one_sentence(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    nowhere = str(tmp_path / "nowhere")
    assert run(capsys, "why", "x", "--history", nowhere).is_one_sentence("holds no history")
    assert run(capsys, "query", "ASK {}", "--history", nowhere).is_one_sentence("holds no history")
    both = "--history", nowhere, "--endpoint", "http://127.0.0.1:9"
    assert run(capsys, "query", "ASK {}", *both).is_one_sentence("an endpoint holds what it holds")

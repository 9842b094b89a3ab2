"""`selfconf why`, of a living ecology."""

from __future__ import annotations

from datetime import datetime

import pytest

from tests.cli.command import run
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
    moment = datetime.fromtimestamp(lost["time"] - 0.001).isoformat()
    then = run(capsys, "why", "position", "--at", moment, *home.arguments())
    assert "position in navigate: person-tracker, since" in then.out
    nothing = run(capsys, "why", "cellar", *home.arguments())
    assert (nothing.code, nothing.out.startswith("no task has to do with cellar")) == (1, True)


@pytest.mark.parametrize("text", ["noon", "25:00", "2026-13-01"])
def test_what_is_no_time_is_one_sentence(text: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(capsys, "why", "position", "--at", text).is_one_sentence(f"{text!r} is no time")

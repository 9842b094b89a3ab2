"""`top`: one table where there is no terminal, a table that is renewed where there is one."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time

import pytest

from tests.cli.command import run
from tests.cli.processes import Home
from tests.lab import iri

pytestmark = pytest.mark.process


def test_who_lives_and_who_holds_it_is_shown_with_rates_and_memory(
    inhabited: Home, capsys: pytest.CaptureFixture[str]
) -> None:
    program = inhabited.run()
    program.act("running")
    outcome = run(capsys, "top", "--every", "0.5", *inhabited.arguments())
    assert outcome.code == 0
    lines = outcome.out.splitlines()
    assert lines[0] == f"ecology {inhabited.ecology}: 7 of 7 components live, 5 held by tasks"
    (tracker,) = (line for line in lines if line.startswith(":person-tracker"))
    assert "active" in tracker
    assert "navigate" in tracker
    assert "pose" in tracker
    assert " MB" in tracker
    body = run(capsys, "top", "--every", "0.5", "--format", "json", *inhabited.arguments()).body
    found = {one["component"]: one for one in body["components"]}
    assert found[iri("person-tracker")]["rates"]["pose"] > 1
    assert found[iri("absolute-odometry")]["rates"] == {"pose": 0.0}
    assert program.end() == 0


def test_on_a_terminal_the_table_is_renewed_until_ctrl_c(inhabited: Home) -> None:
    ours, theirs = os.openpty()
    command = [sys.executable, "-m", "selfconf", "top", "--every", "0.2", *inhabited.arguments()]
    program = subprocess.Popen(
        command, stdout=theirs, stderr=subprocess.PIPE, env={**inhabited.environment, "TERM": "xterm"}
    )
    os.close(theirs)
    shown = b""
    while shown.count(b"\x1b[H\x1b[2J") < 3:
        shown += os.read(ours, 1 << 16)
    program.send_signal(signal.SIGINT)
    try:
        while os.read(ours, 1 << 16):
            pass
    except OSError:  # the other end is closed
        pass
    _, said = program.communicate(timeout=60)
    os.close(ours)
    assert program.returncode == 0, said
    assert b"Traceback" not in said
    assert b"\x1b[32malive" in shown


def test_on_a_terminal_it_goes_on_once_the_site_is_back(home: Home) -> None:
    site = home.site("peis-home", "ads")
    ours, theirs = os.openpty()
    command = [sys.executable, "-m", "selfconf", "top", "--every", "0.2", *home.arguments()]
    program = subprocess.Popen(command, stdout=theirs, env={**home.environment, "TERM": "xterm"})
    os.close(theirs)

    def shown(words: bytes) -> None:
        so_far, deadline = b"", time.monotonic() + 60.0
        while words not in so_far:
            assert time.monotonic() < deadline, so_far[-500:]
            so_far += os.read(ours, 1 << 16)

    shown(b"of 7 components")
    site.end(signal.SIGKILL)
    shown(b"cut off from the ecology")
    home.site("peis-home", "ads")
    shown(b"of 7 components")
    program.send_signal(signal.SIGINT)
    assert program.wait(60) == 0
    os.close(ours)


def test_a_time_that_is_none_is_one_sentence(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(capsys, "top", "--every", "0").is_one_sentence("no time")

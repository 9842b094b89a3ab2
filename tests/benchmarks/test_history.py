"""kill -9 of a server in the middle of writing: a few times here, a hundred times by `make nightly`."""

from __future__ import annotations

import subprocess
import sys
import threading
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from benchmarks import history
from benchmarks.history import ALLOWED, Killed, kill, kills, report
from tests.harness.effort import thorough

KILLED = Killed(3, 0.02, (), ())


@thorough
@pytest.mark.process
@pytest.mark.slow
def test_the_history_opens_is_whole_and_lacks_at_most_the_last_second(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("starlette", reason="the extra `serve` is not installed")
    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", "")  # the benchmark chooses its own; this puts the present one back
    found = kills(5, 1)
    assert [(one.lost, one.torn) for one in found] == [((), ())] * 5
    assert max(one.lacks for one in found) <= ALLOWED
    assert [one.kept for one in found] == sorted(one.kept for one in found)
    assert found[-1].kept > 5


@pytest.mark.process
def test_a_server_that_follows_nothing_is_no_success(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(history, "PATIENCE", 0.05)
    monkeypatch.setattr(history, "past_graphs", lambda folder: {})
    restless: Any = SimpleNamespace(told={}, sizes={})
    program = "import time; print('http://127.0.0.1/', flush=True); time.sleep(60)"  # until it is killed

    def serve() -> subprocess.Popen[str]:
        return subprocess.Popen([sys.executable, "-c", program], stdout=-1, stderr=-1, text=True)

    with pytest.raises(RuntimeError, match="does not follow"):
        kill(restless, serve, tmp_path, 0.0)


def test_what_ran_as_the_server_began_to_follow_may_be_missing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The next configuration may have overtaken the answer that tells it."""
    monkeypatch.setattr(history, "past_graphs", lambda folder: {})
    restless: Any = SimpleNamespace(told={}, sizes={})

    def begin() -> str:
        threading.Timer(1.0, restless.told.setdefault, ("urn:running", 0.0)).start()
        return "http://127.0.0.1/"

    talk = SimpleNamespace(readline=begin)
    server: Any = SimpleNamespace(stdout=talk, kill=lambda: None, communicate=lambda: ("", ""))
    assert kill(restless, lambda: server, tmp_path, 0.0) == Killed(0, 0.0, (), ())


def test_the_report_tells_what_is_torn_and_what_is_missing() -> None:
    said = report([KILLED, KILLED._replace(kept=9, lacks=1.5, lost=("urn:a",), torn=("urn:b", "urn:c"))])
    assert "opens: 2 of 2, 9 configurations in the end" in said
    assert "2 configurations are torn; kept: 1 are missing that should be there" in said
    assert "1500 ms at most" in said

"""`log`: what components have printed, while they run and after they have died."""

from __future__ import annotations

import json
import signal
from datetime import datetime, timedelta, timezone
from pathlib import Path

import pytest

from tests.cli.command import run
from tests.cli.processes import Home
from tests.lab import PREFIXES, iri

pytestmark = pytest.mark.process

TALKER = """\
import sys, time
from pathlib import Path
from selfconf.sdk import Component, main

class Talker(Component):
    advertisement = Path(__file__).parent / "ads" / "talker.ttl"

    def started(self):
        print("begins", flush=True)
        print("a warning", file=sys.stderr, flush=True)
        self.every(0.1, lambda: print("goes on", flush=True))

main(Talker)
"""
TASK = ":t a sc:Template ; sc:roles ( :r ) .\n:r a sc:Role ; sc:minCount 1 ; sh:class :Talker ."


@pytest.fixture
def talking(home: Home) -> Home:
    """An ecology with one component, which its site can start."""
    (home.folder / "talker.py").write_text(TALKER)
    (home.folder / "own").mkdir()
    command = f"python {home.folder}/talker.py"
    (home.folder / "own" / "talker.ttl").write_text(
        f'{PREFIXES} :talker a sc:Component, :Talker ; sc:grounding [ sc:command "{command}" ] .'
    )
    (home.folder / "talker.py").write_text(TALKER.replace('"ads"', '"own"'))
    (home.folder / "t.ttl").write_text(PREFIXES + TASK)
    return home


def test_lines_are_shown_while_it_runs_followed_and_shown_after_its_death(
    talking: Home, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", str(talking.runtime))
    site = talking.site("home", "own")
    program = talking.selfconf("run", "t.ttl", "--ecology", talking.ecology, "--format", "json")
    program.act("running")
    follower = talking.selfconf("log", "talker", "--follow", "--lines", "0", "--format", "json")
    line = json.loads(follower.line())
    assert (line["text"], line["stream"], line["components"]) == ("goes on", "stdout", [iri("talker")])
    ended = talking.selfconf("log", "talker", "--follow", "--lines", "0")
    assert ended.line()
    for one, number in ((follower, signal.SIGINT), (ended, signal.SIGTERM)):
        assert one.end(number) == 0
        assert one.complaints == ""
    for follow in ((), ("--follow",)):
        nobody = run(capsys, "log", "nobody", "--ecology", talking.ecology, *follow)
        assert nobody.is_one_sentence("no component nobody is advertised")
    assert program.end() == 0
    assert site.end(signal.SIGKILL) != 0
    outcome = run(capsys, "log", "talker", "--ecology", talking.ecology)
    assert outcome.code == 0
    assert "talker: a warning" in outcome.out
    assert "talker: started as process" in outcome.out
    last = run(capsys, "log", iri("talker"), "--lines", "2", "--format", "json").out.splitlines()
    assert len(last) == 2
    assert {"time", "stream", "components", "text"} == json.loads(last[0]).keys()
    nothing = run(capsys, "log", "nobody")
    assert (nothing.code, nothing.out) == (1, "")
    assert nothing.err == "nothing that nobody has printed is kept in the log\n"


def test_where_no_log_is_kept_there_is_one_sentence(
    home: Home, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", str(home.runtime))
    assert run(capsys, "log").is_one_sentence("no site has kept a log")
    assert run(capsys, "log", "--lines", "x").is_one_sentence("is no number of lines")
    (home.runtime / "log").mkdir(parents=True)
    (home.runtime / "log" / f"{home.ecology}@a.log").touch()
    assert run(capsys, "log", "\udcff").is_one_sentence("the name of a component is no text in UTF-8")
    for pattern in ("*", "**", "/home", ""):
        assert run(capsys, "log", "--ecology", pattern).is_one_sentence(f"{pattern!r} cannot name an ecology")


def test_lines_of_another_day_have_its_date(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    now = datetime.now(timezone.utc)
    before = now - timedelta(days=2)
    (tmp_path / "e@home.log").write_text(
        "".join(f"{when:%Y-%m-%dT%H:%M:%S.123Z} stdout {iri('talker')} said\n" for when in (before, now))
    )
    shown = run(capsys, "log", "--log", str(tmp_path), "--ecology", "e").out.splitlines()
    assert shown[0] == f"{before.astimezone():%Y-%m-%d %H:%M:%S}.123 talker: said"
    assert shown[1].endswith(f"{now.astimezone():%H:%M:%S}.123 talker: said")

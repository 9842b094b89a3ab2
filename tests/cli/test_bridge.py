"""`bridge`: Things and nodes of others as components, in a process of its own; misuse in one sentence."""

from __future__ import annotations

import importlib.util
import signal
import sys
from pathlib import Path

import pytest

from selfconf.cli.main import parser
from tests.cli.command import run
from tests.cli.processes import Home

pytestmark = pytest.mark.process
THING = Path(__file__).parents[2] / "examples" / "wot" / "thing.py"
wot = pytest.mark.skipif(importlib.util.find_spec("aiohttp") is None, reason="the extra `wot` is not installed")
LAMP = "https://example.org/my-home#desk-lamp"


@wot
def test_a_thing_is_discovered_while_it_is_there(home: Home, capsys: pytest.CaptureFixture[str]) -> None:
    lamp = home.program(sys.executable, "-u", str(THING), "lamp", "desk")
    url = lamp.line()
    bridge = home.selfconf("bridge", "wot", url, "--ecology", home.ecology, "--name", "things", "--rate", "5")

    def state() -> str:
        if not list(home.runtime.glob("*@things.json")):
            return ""
        rows = run(capsys, "discover", "--format", "json", *home.arguments()).body["components"]
        return next((row["state"] for row in rows if row["component"] == LAMP), "")

    assert home.until(lambda: state() == "alive"), bridge.complaints
    lamp.end(signal.SIGKILL)
    assert home.until(lambda: state() not in ("", "alive"))
    assert "desk-lamp is here" in bridge.complaints
    assert home.until(lambda: f"GET {url}on does not answer" in bridge.complaints)
    assert bridge.end(signal.SIGINT) == 0


@wot
def test_what_it_cannot_do_is_one_sentence(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    secret = tmp_path / "things.json"
    secret.write_text("{}")
    secret.chmod(0o644)
    source = str(tmp_path)
    for arguments, words in (
        (("wot", str(tmp_path / "none.json"), "--ecology", "e"), "no file or folder"),
        (("wot", source), "give --ecology NAME"),
        (("wot", source, "--ecology", "a/b"), "cannot name an ecology"),
        (("wot", source, "--ecology", "e", "--credentials", str(secret)), "chmod 600"),
    ):
        ended = run(capsys, "bridge", *arguments)
        assert ended.code == 2
        assert words in ended.err
        assert ended.err.count("\n") == 1


@pytest.mark.parametrize("rate", ["0", "-1", "nan", "101", "often"])
def test_a_rate_is_a_number_of_hertz(rate: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        parser(["bridge"]).parse_args(["bridge", "wot", "x", "--rate", rate])
    assert ended.value.code == 2
    assert "is no rate" in capsys.readouterr().err


def test_an_extra_that_is_missing_is_named(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    ended = run(capsys, "bridge", "wot", "x", "--ecology", "e")
    assert ended.code == 2
    assert "install the extra `wot`" in ended.err

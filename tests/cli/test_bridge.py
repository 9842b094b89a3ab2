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
ros2 = pytest.mark.skipif(importlib.util.find_spec("rosbags") is None, reason="the extra `ros2` is not installed")
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
def test_with_keys_it_speaks_by_the_certificate_of_its_site(home: Home, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("cryptography", reason="the extra `keys` is not installed")
    keys = str(home.folder / "keys")
    assert home.selfconf("keys", "init", keys).ended() == 0
    lamp = home.program(sys.executable, "-u", str(THING), "lamp", "desk")
    site = ("--ecology", home.ecology, "--name", "things", "--keys", keys)
    bridge = home.selfconf("bridge", "wot", lamp.line(), *site)

    def state() -> str:
        if not list(home.runtime.glob("*@things.json")):
            return ""
        rows = run(capsys, "discover", "--format", "json", *home.arguments(), "--keys", keys).body["components"]
        return next((row["state"] for row in rows if row["component"] == LAMP), "")

    assert home.until(lambda: state() == "alive"), bridge.complaints
    assert " on tls/127.0.0.1:" in bridge.complaints
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
        (("wot", "http://[::1/", "--ecology", "e"), "http://[::1/ is no http or https URL"),
        (("wot", "http://localhost:99999/", "--ecology", "e"), "http://localhost:99999/ is no http or https URL"),
    ):
        run(capsys, "bridge", *arguments).is_one_sentence(words)


@ros2
def test_a_domain_without_a_router_is_one_sentence(capsys: pytest.CaptureFixture[str], home: Home) -> None:
    bridge = home.selfconf("bridge", "ros2", "--connect", "tcp/127.0.0.1:1", "--ecology", home.ecology)
    assert bridge.ended() == 2
    site, trouble = bridge.complaints.splitlines()
    assert f"ecology {home.ecology} serves" in site
    assert "no router of ROS 2 answers at tcp/127.0.0.1:1;" in trouble
    assert home.left_behind() == []


@ros2
def test_what_is_no_endpoint_is_one_sentence_and_no_site_begins(capsys: pytest.CaptureFixture[str], home: Home) -> None:
    for endpoint in ("", "nonsense", "tcp/127.0.0.1"):
        said = run(capsys, "bridge", "ros2", f"--connect={endpoint}", "--ecology", home.ecology)
        said.is_one_sentence(f"{endpoint} is no endpoint; write it like tcp/127.0.0.1:7447")


@ros2
def test_definitions_that_are_not_there_are_one_sentence(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    given = run(capsys, "bridge", "ros2", "--definitions", str(tmp_path), "--ecology", "lab")
    given.is_one_sentence(f"there is no definition of ROS 2 below {tmp_path}, such as lab_msgs/msg/Mood.msg")


@pytest.mark.parametrize("domain", ["-1", "233", "x", ""])
def test_a_domain_is_a_number(domain: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        parser(["bridge"]).parse_args(["bridge", "ros2", f"--domain={domain}"])
    assert ended.value.code == 2
    assert "is no domain; it takes a number from 0 to 232" in capsys.readouterr().err


@pytest.mark.parametrize("rate", ["0", "-1", "nan", "101", "often"])
def test_a_rate_is_a_number_of_hertz(rate: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        parser(["bridge"]).parse_args(["bridge", "wot", "x", "--rate", rate])
    assert ended.value.code == 2
    assert "is no rate" in capsys.readouterr().err


@pytest.mark.parametrize("host", ["", "a b", "http://lamp.local", "lamp.local:80", "192.0.2.7/24", "me@lamp"])
def test_a_host_is_a_name_or_an_address(host: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        parser(["bridge"]).parse_args(["bridge", "wot", "x", "--host", host])
    assert ended.value.code == 2
    assert f"{host!r} is no host" in capsys.readouterr().err
    hosts = [word for one in ("lamp.local", "192.0.2.7", "::1", "[2001:DB8::1]") for word in ("--host", one)]
    given = parser(["bridge"]).parse_args(["bridge", "wot", "x", *hosts])
    assert given.host == ["lamp.local", "192.0.2.7", "::1", "2001:DB8::1"]


def test_an_extra_that_is_missing_is_named(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    run(capsys, "bridge", "wot", "x", "--ecology", "e").is_one_sentence("install the extra `wot`")
    run(capsys, "bridge", "ros2", "--ecology", "e").is_one_sentence("install the extra `ros2`")

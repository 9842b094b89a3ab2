"""The logs of sites: where those of this machine are found, and what the sites of others tell of theirs."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from selfconf import this_machine
from selfconf.api.living.site_logs import local_log, logs_of_other_sites, names_of_log, site_logs
from selfconf.api.synchronous_bus import SynchronousBus
from selfconf.bus.memory import Network
from selfconf.bus.port import Request
from selfconf.errors import AuthorError, NetworkError
from selfconf.model.log_line import LogLine
from selfconf.protocol.codec import encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import LogPart, LogQuestion


@pytest.fixture
def runtime(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", str(tmp_path / "runtime"))
    return tmp_path / "runtime"


def test_logs_are_found_where_they_are_usual_and_where_sites_that_run_say(runtime: Path, tmp_path: Path) -> None:
    with pytest.raises(NetworkError, match="no site has kept a log in"):
        site_logs(None)
    (runtime / "log").mkdir(parents=True)
    (runtime / "log" / "home@gone.log").touch()
    assert [path.name for path in site_logs(None)] == ["home@gone.log"]
    (tmp_path / "own").mkdir()
    (tmp_path / "own" / "home@here.log").touch()
    this_machine.announce(
        this_machine.LocalSite(
            "home", "here", "tcp/127.0.0.1:1", os.getpid(), log=str(tmp_path / "own" / "home@here.log")
        )
    )
    assert [path.name for path in site_logs("home")] == ["home@here.log", "home@gone.log"]
    assert [path.name for path in site_logs("home", tmp_path / "own")] == ["home@here.log"]
    with pytest.raises(NetworkError, match="no site of the ecology 'other'"):
        site_logs("other")


@pytest.mark.usefixtures("runtime")
def test_the_log_of_a_site_that_runs_can_be_followed_before_it_is_there(tmp_path: Path) -> None:
    log = tmp_path / "home@here.log"
    this_machine.announce(this_machine.LocalSite("home", "here", "tcp/127.0.0.1:1", os.getpid(), log=str(log)))
    assert site_logs(None) == [log]
    source = local_log(log)
    before = source(LogQuestion(lines=10))
    assert not before.lines
    log.write_text("2026-11-22T06:30:01.000Z stdout urn:x hello\n")
    assert [line.text for line in source(LogQuestion(position=before.position)).lines] == ["hello"]


def test_of_several_ecologies_the_one_that_lives_is_meant_else_one_has_to_be_named(runtime: Path) -> None:
    (runtime / "log").mkdir(parents=True)
    for name in ("home", "lab"):
        (runtime / "log" / f"{name}@x.log").touch()
    with pytest.raises(AuthorError, match="with ecology: home, lab"):
        site_logs(None)
    this_machine.announce(this_machine.LocalSite("lab", "x", "tcp/127.0.0.1:1", os.getpid()))
    assert [path.name for path in site_logs(None)] == ["lab@x.log"]


def test_a_local_log_answers_in_full_and_its_name_says_whose_it_is(tmp_path: Path) -> None:
    path = tmp_path / "my-home@site.1.log"
    line = "2026-11-22T06:30:01.000Z stdout urn:x " + "y" * 8000 + "\n"
    path.write_text(100 * line)
    assert len(local_log(path)(LogQuestion(lines=1000)).lines) == 100
    assert names_of_log(path) == ("my-home", "site.1")


def test_the_sites_that_live_are_asked_but_those_that_are_known_and_a_silent_one_is_named_once() -> None:
    network, keys, complaints = Network(), Keys("lab"), list[str]()
    part = LogPart((LogLine("12:00:00", "out", (), "hello"),), "9", False)

    def site(name: str, payload: bytes) -> None:
        def tell(request: Request) -> None:
            request.reply(keys.log(name), payload)
            request.finish()

        node = network.node()
        node.announce(keys.site_life(name, "1"))
        node.serve(keys.log(name), tell)

    for name, payload in (("attic", encode(part)), ("cellar", b"no log"), ("here", encode(part))):
        site(name, payload)
    bus = SynchronousBus(network.node())
    attic, cellar = logs_of_other_sites(bus, keys, ["here"], complaints.append, "the hint").values()
    assert attic(LogQuestion()) == part
    assert [cellar(LogQuestion(position="3")) for _ in range(2)] == [LogPart((), "3")] * 2
    (complaint,) = complaints
    said = "the site cellar does not tell what its components have printed"
    assert complaint.startswith(f"{said}: the hint: not a message")

"""How programs on one machine find each other's routers."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from selfconf import access, rendezvous, this_machine
from selfconf.access import Authority, Principal
from selfconf.bus import zenoh
from selfconf.bus.credentials import Credentials
from selfconf.bus.zenoh import ZenohBus
from selfconf.errors import AuthorError, NetworkError, ProgrammerError
from selfconf.model.term import IRI
from selfconf.rendezvous import usual_endpoints
from selfconf.this_machine import LocalSite
from tests.suspended_run import suspended_run
from tests.test_this_machine import meeting


def test_of_several_ecologies_one_must_be_named() -> None:
    this_machine.announce(meeting("home"))
    this_machine.announce(meeting("office"))
    with pytest.raises(NetworkError, match="with ecology: home, office"):
        rendezvous.find(None, [])


def test_what_is_given_counts_before_what_the_environment_names(monkeypatch: pytest.MonkeyPatch) -> None:
    assert rendezvous.asked_for(None, []) == (None, [])
    monkeypatch.setenv("SELFCONF_ECOLOGY", "lab")
    monkeypatch.setenv("SELFCONF_CONNECT", "tcp/127.0.0.1:1 tcp/127.0.0.1:2")
    assert rendezvous.asked_for(None, []) == ("lab", ["tcp/127.0.0.1:1", "tcp/127.0.0.1:2"])
    assert rendezvous.asked_for("home", ["tcp/127.0.0.1:3"]) == ("home", ["tcp/127.0.0.1:3"])


def test_the_usual_endpoints_of_an_ecology_are_the_same_each_time_and_its_own() -> None:
    assert usual_endpoints("home") == usual_endpoints("home")
    assert not set(usual_endpoints("home")) & set(usual_endpoints("office"))
    for name in ("home", "office", "lab"):
        assert len(set(usual_endpoints(name))) == rendezvous.PLACES
        for endpoint in usual_endpoints(name):
            assert 1024 < int(endpoint.rpartition(":")[2]) < 32768


def test_the_usual_endpoints_are_the_same_where_a_locale_cannot_say_how_the_folder_is_called(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", "/tmp/Häuser ☃")
    plain = {**os.environ, "LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
    program = "from selfconf.rendezvous import usual_endpoints; print(*usual_endpoints('home'))"
    said = subprocess.run([sys.executable, "-c", program], env=plain, capture_output=True, text=True, check=True)
    assert said.stdout.split() == usual_endpoints("home")


def test_an_endpoint_that_several_sites_share_is_found_once() -> None:
    shared = meeting(site="a")
    this_machine.announce(shared)
    this_machine.announce(LocalSite("home", "b", shared.endpoint, os.getpid(), relays=False))
    assert rendezvous.find("home", []) == ("home", [shared.endpoint, *usual_endpoints("home")])


def test_programs_of_a_host_first_try_where_it_alone_reaches_its_hub() -> None:
    clients = [replace(meeting(site=name), relays=False) for name in "ac"]
    relaying = replace(meeting(site="b"), from_here="tls/127.0.0.1:20001")
    for site in (*clients, relaying):
        this_machine.announce(site)
    assert rendezvous.find("home", [])[1][:2] == ["tls/127.0.0.1:20001", relaying.endpoint]


def test_where_no_site_answers_the_suspended_one_of_this_machine_is_named() -> None:
    with suspended_run("home", "patrol") as program:
        this_machine.announce(meeting(process=program.pid))
        suspended = rf"process {program.pid} of this machine, the site 'a' of ecology 'home', is suspended; `kill -CONT"
        with pytest.raises(NetworkError, match=suspended), rendezvous.suspended_sites_named([meeting().endpoint]):
            raise NetworkError("nothing answers")
        with pytest.raises(NetworkError, match="nothing"), rendezvous.suspended_sites_named(["tcp/127.0.0.1:1"]):
            raise NetworkError("nothing answers")


def test_where_no_site_runs_it_is_said_what_to_start() -> None:
    with pytest.raises(NetworkError, match="selfconf site"):
        rendezvous.find(None, [])
    with pytest.raises(NetworkError, match="of the ecology 'home'"):
        rendezvous.find("home", [])


@pytest.mark.parametrize("connect", [[], ["tcp/127.0.0.1:1"]])
def test_what_cannot_be_a_name_is_no_ecology(connect: list[str]) -> None:
    this_machine.announce(meeting())
    for name in ("", "a/b"):
        with pytest.raises(AuthorError, match="cannot name an ecology"):
            rendezvous.find(name, connect)


def test_endpoints_that_are_given_need_no_file() -> None:
    assert rendezvous.find("office", ["tcp/127.0.0.1:1"]) == ("office", ["tcp/127.0.0.1:1"])


def test_the_environment_says_where_the_ecology_is_unless_it_is_given(monkeypatch: pytest.MonkeyPatch) -> None:
    for name, value in rendezvous.environment("home", "tcp/127.0.0.1:1").items():
        monkeypatch.setenv(name, value)
    assert rendezvous.find(None, []) == ("home", ["tcp/127.0.0.1:1"])
    assert rendezvous.find("office", []) == ("office", ["tcp/127.0.0.1:1"])
    assert rendezvous.find(None, ["tcp/127.0.0.1:2"]) == ("home", ["tcp/127.0.0.1:2"])
    monkeypatch.setenv(rendezvous.CONNECT_VARIABLE, "tcp/127.0.0.1:3  tcp/[::1]:4")
    assert rendezvous.find(None, []) == ("home", ["tcp/127.0.0.1:3", "tcp/[::1]:4"])
    monkeypatch.setenv(rendezvous.ECOLOGY_VARIABLE, "a/b")
    with pytest.raises(AuthorError, match="cannot name an ecology"):
        rendezvous.find(None, [])


def test_an_environment_that_names_an_ecology_alone_has_its_sites_looked_for_here(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    this_machine.announce(meeting("home"))
    this_machine.announce(meeting("office", "bb"))
    monkeypatch.setenv(rendezvous.ECOLOGY_VARIABLE, "office")
    monkeypatch.setenv(rendezvous.CONNECT_VARIABLE, "")
    assert rendezvous.find(None, []) == ("office", [meeting("office", "bb").endpoint, *usual_endpoints("office")])
    monkeypatch.setenv(rendezvous.ECOLOGY_VARIABLE, "")
    with pytest.raises(NetworkError, match="several"):
        rendezvous.find(None, [])


def test_a_program_that_is_started_hears_of_the_ontologies_of_its_site(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = rendezvous.environment("home", "tcp/127.0.0.1:1", [tmp_path / "12:30" / "a.ttl", tmp_path / "b"])
    monkeypatch.setenv(rendezvous.ONTOLOGY_VARIABLE, found[rendezvous.ONTOLOGY_VARIABLE])
    assert rendezvous.site_ontologies() == [tmp_path / "12:30" / "a.ttl", tmp_path / "b"]
    monkeypatch.setenv(rendezvous.ONTOLOGY_VARIABLE, rendezvous.environment("home", "x")[rendezvous.ONTOLOGY_VARIABLE])
    assert rendezvous.site_ontologies() == []


def test_a_process_of_components_has_keys_that_speak_for_each_of_them(tmp_path: Path) -> None:
    authority = Authority.init(tmp_path / "keys")
    lamp, bell = IRI("urn:lamp"), IRI("urn:bell")
    authority.issue(Principal.component(lamp), tmp_path / "lamp")
    for folder in (authority.path, tmp_path / "lamp"):
        shown = rendezvous.component_credentials(folder, [lamp])
        assert shown is not None
        assert shown.name == Principal.component(lamp).common_name
    assert rendezvous.component_credentials(authority.path, [lamp, bell]) is not None
    with pytest.raises(AuthorError, match=r"lamp speaks for comp\.\w+, not for urn:bell"):
        rendezvous.component_credentials(tmp_path / "lamp", [lamp, bell])
    with pytest.raises(ProgrammerError, match="has to say which components it is"):
        rendezvous.component_credentials(authority.path, [])


def test_a_hub_that_lets_nothing_in_leaves_no_connection(monkeypatch: pytest.MonkeyPatch) -> None:
    closed: list[ZenohBus] = []

    def client(endpoints: list[str], **how: object) -> ZenohBus:
        bus = zenoh.client(endpoints)
        close = bus.close
        monkeypatch.setattr(bus, "close", lambda: (closed.append(bus), close()))
        return bus

    def introduce(*who: object) -> None:
        raise NetworkError("let in nowhere")

    monkeypatch.setattr(rendezvous, "client", client)
    monkeypatch.setattr(access, "introduce", introduce)
    shown = Credentials("conf.alice", Path("c"), Path("k"), Path("a"), Path("f"))
    hub = zenoh.router()
    try:
        with pytest.raises(NetworkError, match="let in nowhere"):
            rendezvous.member_bus("home", [hub.endpoint], shown)
        assert len(closed) == 1
    finally:
        hub.close()

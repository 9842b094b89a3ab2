"""One site of a machine relays for all; when it is gone, or hangs, another takes its place."""

from __future__ import annotations

import json
import shutil
import signal
import socket
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

import pytest

from selfconf import rendezvous, this_machine
from selfconf.api.sites import hub_health, hub_wait, joining
from selfconf.api.sites.joining import Joining
from selfconf.bus.zenoh import client, router
from selfconf.errors import NetworkError
from selfconf.protocol.keys import Keys, owner_of
from tests.cli.processes import Home

pytestmark = pytest.mark.process


class Machine:
    """Sites of one ecology in this process, as far as they join it."""

    def __init__(self) -> None:
        self.sites: dict[str, Joining] = {}

    def join(self, name: str, listen: str | None = None, connect: tuple[str, ...] = ()) -> Joining:
        """Let a site join, and be seen."""
        with this_machine.turn():
            site = Joining("machine", name, listen, connect)
            site.announce(Path("site.log"), ())
        site.bus.announce(Keys("machine").site_life(name, "1"))
        self.sites[name] = site
        return site

    def leave(self, name: str) -> None:
        """End a site."""
        site = self.sites.pop(name)
        site.leave()
        site.bus.close()

    def until(self, condition: Callable[[], bool], seconds: float = 10.0) -> bool:
        """Let all sites do what they have to do until a condition holds."""
        deadline = time.monotonic() + seconds
        while not condition() and time.monotonic() < deadline:
            for site in self.sites.values():
                site.bus.poll(0.002)
        return condition()

    def seen_by(self, name: str) -> set[str]:
        """The sites that one of them sees."""
        heard: list[tuple[str, ...]] = []
        self.sites[name].bus.roll_call(Keys("machine").any_site_life(), 1.0, heard.append)
        self.until(lambda: bool(heard))
        return {owner_of(key) for key in heard[0]}

    def united(self) -> bool:
        """Whether each sees all."""
        return all(self.seen_by(name) == set(self.sites) for name in self.sites)

    def relaying(self) -> list[str]:
        """Those that relay."""
        return [name for name, site in self.sites.items() if site.bus.endpoint]


NOBODY = "tcp/127.0.0.1:1"
"""An endpoint on which nothing listens."""


@pytest.fixture
def machine() -> Iterator[Machine]:
    """A machine without sites."""
    machine = Machine()
    yield machine
    for name in list(machine.sites):
        machine.leave(name)


def test_one_site_relays_and_the_others_are_its_clients(machine: Machine) -> None:
    for name in "abcdef":
        machine.join(name)
    assert machine.until(machine.united)
    assert machine.relaying() == ["a"]
    (endpoint,) = {site.endpoint for site in machine.sites.values()}
    assert endpoint in rendezvous.usual_endpoints("machine")  # another program may listen at the first
    assert rendezvous.find("machine", []) == ("machine", rendezvous.usual_endpoints("machine"))


def check_that_a_place_is_inherited(machine: Machine) -> None:
    """Of three sites the one that relays goes, and one of the others relays where it did."""
    for name in "abc":
        machine.join(name)
    before = machine.sites["a"].endpoint
    machine.leave("a")
    assert machine.until(lambda: bool(machine.relaying()) and machine.united())
    assert len(machine.relaying()) == 1
    assert [site.endpoint for site in machine.sites.values()] == [before, before]


def test_when_the_one_that_relays_is_gone_another_does_so_on_the_same_port(machine: Machine) -> None:
    check_that_a_place_is_inherited(machine)


def test_a_place_is_taken_by_one_that_has_lost_its_hub_before_it_was_announced(
    machine: Machine, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(joining, "STILL_MINE", 0.1)
    machine.join("a")
    site = machine.sites["b"] = Joining("machine", "b", None, ())
    machine.leave("a")
    assert not machine.until(lambda: site.relays, seconds=0.3)
    assert not site.bus.link
    site.announce(Path("site.log"), ())
    assert machine.until(lambda: site.relays)


@pytest.mark.parametrize("suspended", [True, False])
def test_the_place_of_one_that_does_not_answer_is_taken_sooner_if_its_process_is_suspended(
    machine: Machine, monkeypatch: pytest.MonkeyPatch, suspended: bool
) -> None:
    """One whose process runs may only be busy, as when all others have lost it at once."""
    monkeypatch.setattr(hub_wait, "SLOW", 60.0)
    monkeypatch.setattr(this_machine, "stopped", lambda process: suspended)
    for name in "ab":
        machine.join(name)
    site = machine.sites["b"]
    assert machine.until(lambda: bool(site.bus.link))
    silent = machine.sites.pop("a")  # nothing runs on its loop, so that it does not take its place itself
    silent.bus.relay_no_more()
    try:
        assert machine.until(lambda: site.relays, seconds=10.0 if suspended else 2.0) is suspended
        monkeypatch.setattr(hub_wait, "SLOW", 0.1)
        assert machine.until(lambda: site.relays)
    finally:
        machine.sites["a"] = silent


def test_sites_that_have_a_hub_do_not_read_from_time_to_time_what_all_others_have_written(
    machine: Machine, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(joining, "STILL_MINE", 0.05)
    read, relaying_sites = list[str](), this_machine.relaying_sites
    for name in ("a", "b"):
        machine.join(name)
    assert machine.until(lambda: bool(machine.sites["b"].bus.link))
    machine.until(lambda: False, seconds=0.5)
    monkeypatch.setattr(this_machine, "relaying_sites", lambda ecology: read.append(ecology) or relaying_sites(ecology))
    assert not machine.until(lambda: bool(read), seconds=0.5)


def test_sites_are_found_again_when_the_runtime_folder_was_removed(
    machine: Machine, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(joining, "STILL_MINE", 0.1)
    for name in "ab":
        machine.join(name)
    before = this_machine.local_sites("machine")
    shutil.rmtree(this_machine.runtime_folder())
    assert machine.until(lambda: this_machine.local_sites("machine") == before)


def test_a_site_that_leaves_does_not_announce_itself_anew(machine: Machine, monkeypatch: pytest.MonkeyPatch) -> None:
    site, leave = machine.join("a"), this_machine.leave

    def leave_slowly(path: Path) -> None:
        leave(path)
        site._look_from_time_to_time()

    monkeypatch.setattr(this_machine, "leave", leave_slowly)
    machine.leave("a")
    assert not list(this_machine.runtime_folder().glob("*.json"))


def test_a_place_is_taken_once_the_runtime_folder_can_be_used_again(
    machine: Machine, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(joining, "STILL_MINE", 0.1)
    for name in "abc":
        machine.join(name)
    folder = this_machine.runtime_folder()
    shutil.rmtree(folder)
    folder.write_text("no folder")
    assert machine.until(lambda: len(caplog.records) == 3)
    machine.leave("a")
    assert machine.until(lambda: not any(site.bus.link for site in machine.sites.values()))
    folder.unlink()
    assert machine.until(lambda: bool(machine.relaying()) and machine.united())
    assert machine.until(lambda: [site.site for site in this_machine.local_sites("machine")] == ["b", "c"])
    assert {record.getMessage().partition(f"cannot write in {folder}")[0] for record in caplog.records} == {
        "programs of this machine may not find this site: "
    }


def test_a_place_is_taken_though_nothing_can_be_written(machine: Machine, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in "ab":
        machine.join(name)

    def full(*_: object, **__: object) -> None:
        raise NetworkError("cannot write: no space left")

    monkeypatch.setattr(this_machine, "announce", full)
    monkeypatch.setattr(this_machine, "announce_no_relay", full)
    machine.leave("a")
    assert machine.until(lambda: machine.relaying() == ["b"] and machine.united())
    assert not machine.until(lambda: not machine.relaying(), seconds=1.0)  # its file says still that it does not relay


def test_a_place_is_taken_though_the_hub_of_another_ecology_listens_at_a_usual_port(machine: Machine) -> None:
    first, second, *_ = rendezvous.usual_endpoints("machine")
    stranger = router(first)
    try:
        for name in "abc":
            machine.join(name)
        machine.leave("a")
        assert machine.until(lambda: len(machine.relaying()) == 1 and machine.united())
        (relaying,) = machine.relaying()
        assert machine.sites[relaying].endpoint == second
        assert [site.site for site in this_machine.local_sites("machine") if site.relays] == [relaying]
    finally:
        stranger.close()
    assert machine.until(lambda: all(site.bus.link for site in machine.sites.values()) and machine.united())


def test_a_site_knows_at_which_endpoints_of_others_nothing_answers(
    machine: Machine, monkeypatch: pytest.MonkeyPatch
) -> None:
    elsewhere = router()
    try:
        named = elsewhere.endpoint.replace("127.0.0.1", "localhost")
        local = "unixsock-stream//tmp/nobody.sock"  # whether anything answers there is not known
        site = machine.join("a", connect=(NOBODY, named, local))
        assert machine.until(lambda: elsewhere.endpoint in site.bus.reached)  # its own hub is reached as well
        monkeypatch.setattr(joining, "listens", lambda endpoint: endpoint == named and pytest.fail("it is linked"))
        assert site.reaches_others
        assert site.unanswered() == [NOBODY]
        client_of_it = machine.join("b")
        assert not client_of_it.reaches_others
        assert client_of_it.unanswered() == []
    finally:
        elsewhere.close()


def test_a_site_that_is_told_where_to_listen_or_what_to_connect_to_relays_beside_the_other(machine: Machine) -> None:
    machine.join("a")
    machine.join("b", listen="tcp/127.0.0.1:0")
    machine.join("c", connect=(machine.sites["b"].endpoint,))  # this is here, and known already
    machine.join("d", connect=("tcp/127.0.0.1:1",))
    assert machine.until(machine.united)
    assert machine.relaying() == ["a", "b", "d"]


def test_where_every_usual_port_is_taken_any_other_will_do(machine: Machine, monkeypatch: pytest.MonkeyPatch) -> None:
    with socket.create_server(("127.0.0.1", 0)) as stranger:
        taken = f"tcp/127.0.0.1:{stranger.getsockname()[1]}"
        monkeypatch.setattr(rendezvous, "usual_endpoints", lambda ecology, secure: [taken])
        machine.join("a")
        assert machine.relaying() == ["a"]
        assert machine.sites["a"].endpoint != taken


def test_where_every_usual_port_is_taken_the_place_is_taken_where_the_one_before_had_it(
    machine: Machine, monkeypatch: pytest.MonkeyPatch
) -> None:
    with socket.create_server(("127.0.0.1", 0)) as stranger:
        taken = f"tcp/127.0.0.1:{stranger.getsockname()[1]}"
        monkeypatch.setattr(rendezvous, "usual_endpoints", lambda ecology, secure: [taken])
        check_that_a_place_is_inherited(machine)


@pytest.fixture
def home(tmp_path: Path) -> Iterator[Home]:
    """An ecology of processes."""
    home = Home(tmp_path)
    yield home
    home.close()


def seen_at(home: Home, endpoint: str) -> set[str]:
    """The sites that are seen from an endpoint."""
    heard: list[tuple[str, ...]] = []
    with suppress(NetworkError):
        bus = client([endpoint], seconds=0.5, credentials=home.credentials())
        bus.roll_call(home.keys.any_site_life(), 1.0, heard.append)
        deadline = time.monotonic() + 2.0
        bus.run(lambda: bool(heard) or time.monotonic() > deadline)
        bus.close()
    return {owner_of(key) for keys in heard for key in keys}


def test_all_sites_that_were_stopped_together_see_each_other_again(home: Home) -> None:
    sites = [home.site(name, "ads/drive.ttl") for name in "abc"]
    for site in sites:
        site.send(signal.SIGSTOP)
    assert not home.until(lambda: False, 2.5)  # longer than the lease
    for site in sites:
        site.send(signal.SIGCONT)
    assert home.until(lambda: seen_at(home, home.endpoint()) == {"a", "b", "c"})


def test_relays_of_several_hosts_see_each_other_again_after_one_was_stopped(home: Home) -> None:
    options = "--ecology", home.ecology, "--listen", home.anywhere, "--name"
    sites = []
    for name in "abc":
        sites.append(home.selfconf("site", "ads/drive.ttl", *options, name))
        assert home.until(lambda name=name: (home.runtime / f"{home.ecology}@{name}.json").exists())
    ends = [home.endpoint(name) for name in "abc"]
    assert home.until(lambda: all(seen_at(home, end) == {"a", "b", "c"} for end in ends))
    sites[0].send(signal.SIGSTOP)
    assert home.until(lambda: seen_at(home, ends[1]) == {"b", "c"})
    sites[0].send(signal.SIGCONT)
    assert home.until(lambda: all(seen_at(home, end) == {"a", "b", "c"} for end in ends))


def test_a_site_whose_own_hub_has_broken_opens_another(machine: Machine, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(joining, "STILL_MINE", 0.1)
    monkeypatch.setattr(hub_health, "HUB_ANSWER", 0.3)
    site = machine.join("a")
    machine.join("b")
    relay = site.bus._relay
    assert relay is not None
    broken, answers = relay._hub, site.bus.roll_call

    def silent(key: str, seconds: float, done: Callable[[tuple[str, ...]], None]) -> None:
        """A hub that is there, but answers nothing: the time is over before anything is heard."""
        if site.bus._relay is relay:
            site.bus.later(seconds, lambda: done(()))
        else:
            answers(key, seconds, done)

    monkeypatch.setattr(site.bus, "roll_call", silent)
    assert machine.until(lambda: site.bus._relay is not None and site.bus._relay._hub is not broken)
    assert machine.until(machine.united)


def test_a_site_that_hears_nothing_from_a_hub_connects_to_it_anew(
    machine: Machine, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It asks once more as soon as the time of a question is over, however seldom it looks while all is well."""
    monkeypatch.setattr(joining, "STILL_MINE", 0.1)
    monkeypatch.setattr(joining, "STILL_HEARD", 600)
    monkeypatch.setattr(hub_health, "HUB_ANSWER", 0.3)
    machine.join("a")
    site = machine.join("b")
    links: list[str] = []
    site.bus.watch_link(lambda: links.append(site.bus.link))
    answers = site.bus.roll_call

    def deaf(key: str, seconds: float, done: Callable[[tuple[str, ...]], None]) -> None:
        """Until it is connected anew, nothing is heard."""
        if links:
            answers(key, seconds, done)
        else:
            site.bus.later(seconds, lambda: done(()))

    monkeypatch.setattr(site.bus, "roll_call", deaf)
    assert machine.until(lambda: bool(links) and bool(site.bus.link))
    assert machine.until(machine.united)


def test_the_place_of_one_that_hangs_is_taken_and_it_joins_the_others_when_it_goes_on(home: Home) -> None:
    sites = {name: home.site(name, "ads/drive.ttl") for name in "abc"}
    before = home.endpoint("a")
    sites["a"].send(signal.SIGSTOP)
    assert home.until(lambda: home.endpoint("b") != before or home.endpoint("c") != before)
    taker = "b" if home.endpoint("b") != before else "c"
    assert home.until(lambda: seen_at(home, home.endpoint(taker)) == {"b", "c"})
    sites["a"].send(signal.SIGCONT)
    assert home.until(lambda: home.endpoint("a") == home.endpoint(taker))
    assert home.until(lambda: seen_at(home, home.endpoint(taker)) == {"a", "b", "c"})


def test_one_site_alone_takes_the_place_of_one_that_hangs_and_all_say_where_it_is(home: Home) -> None:
    """The others wait for one that hangs for longer than until another takes its place."""
    sites = {name: home.site(name, "ads/drive.ttl") for name in "abcde"}
    took: set[str] = set()

    def settled() -> bool:
        files = [json.loads((home.runtime / f"{home.ecology}@{name}.json").read_text()) for name in "bcde"]
        took.update(site["endpoint"] for site in files if site["relays"])
        return {site["endpoint"] for site in files} == took

    sites["a"].send(signal.SIGSTOP)
    assert home.until(lambda: settled() and seen_at(home, home.endpoint("b")) == {"b", "c", "d", "e"})
    assert len(took) == 1

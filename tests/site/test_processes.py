"""Dormant components: how a site starts their processes, what it says when they end, and that they end with it."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from selfconf import rendezvous
from selfconf.bus.memory import Network
from selfconf.bus.port import Sample
from selfconf.errors import PeerError
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.messages import Fail, Page, Release, Wake
from selfconf.site import Site
from selfconf.site.component_program import ComponentProgram
from selfconf.site.process_group import ProcessGroup
from selfconf.site.site import FILE_CHECK
from tests.lab import iri, write_advertisements
from tests.site.served import KEYS, SLEEPER, ask, dormant, live, python, serve, until

pytestmark = pytest.mark.process


def group_of(site: Site) -> ProcessGroup:
    """The process that the site has started for the sleeper."""
    group = site.processes.by_component[SLEEPER].group
    assert group is not None
    return group


@pytest.fixture
def sites(network: Network) -> Iterator[Callable[[Path], Site]]:
    """Sites that can start components, and that end them again."""
    made: list[Site] = []

    def make(folder: Path) -> Site:
        made.append(serve(network, folder, rendezvous.environment("lab", "tcp/127.0.0.1:1")))
        return made[-1]

    yield make
    for site in made:
        site.close()


def test_a_dormant_component_is_startable_and_an_ordinary_one_is_not(network: Network, tmp_path: Path) -> None:
    write_advertisements(dormant(tmp_path, "true"), "tracker")
    serve(network, tmp_path)
    pages = [decode(sample.attachment, Page) for sample in ask(network, KEYS.advertisements()).samples]
    assert {(page.component, page.startable) for page in pages} == {(SLEEPER, True), (iri("person-tracker"), False)}


def test_a_dormant_component_is_started_beside_its_advertisement_with_its_ecology(
    network: Network, tmp_path: Path, sites: Callable[[Path], Site]
) -> None:
    code = (
        'import os; open("woken", "w").write(" ".join(map(os.environ.get, ("SELFCONF_ECOLOGY", "SELFCONF_CONNECT"))))'
    )
    folder = dormant(tmp_path / "here", python(code))
    sites(folder)
    replies = ask(network, KEYS.wake("home"), encode(Wake(SLEEPER)))
    assert replies.errors == ()
    assert len(replies.samples) == 1
    assert until(lambda: (folder / "woken").exists() and (folder / "woken").read_text() != "")
    assert (folder / "woken").read_text() == "lab tcp/127.0.0.1:1"


def test_a_component_that_runs_is_not_started_twice_and_ends_with_its_site(
    network: Network, tmp_path: Path, sites: Callable[[Path], Site]
) -> None:
    code = 'import os; open(str(os.getpid()), "w")'
    folder = dormant(tmp_path / "here", python(code))
    site = sites(folder)
    for _ in range(3):
        ask(network, KEYS.wake("home"), encode(Wake(SLEEPER)))
    group = group_of(site)
    assert until(lambda: (folder / str(group.number)).exists())
    site.close()
    assert group.code() is not None
    assert len([path for path in folder.iterdir() if path.name.isdigit()]) == 1


def test_a_process_that_runs_with_other_ports_than_are_advertised_is_told_of(
    network: Network, tmp_path: Path, sites: Callable[[Path], Site]
) -> None:
    command, port = python("pass"), '; sc:hasOutput [ sc:name "{}" ; sc:signalType rob:Text ]'
    dormant(tmp_path, command, more=port.format("time"))
    site, told = sites(tmp_path), list[str]()
    site.shelf.complain = told.append
    ask(network, KEYS.wake("home"), encode(Wake(SLEEPER)))
    file = tmp_path / "sleeper.ttl"
    for text, named in (
        (f"# It sleeps.\n{file.read_text()}", 0),
        (file.read_text().replace(" a sc:Component", " :bed :long ; a sc:Component"), 0),
        (file.read_text().replace('"time"', '"hour"'), 1),
    ):
        file.write_text(text)
        network.run(lambda: False, 2 * FILE_CHECK)
        assert len(told) == named, text
    assert "`selfconf site restart sleeper` starts it anew" in told[0]
    site.close()


def test_a_component_that_has_ended_may_be_started_again_and_its_end_is_reported(
    network: Network, tmp_path: Path, sites: Callable[[Path], Site]
) -> None:
    end = tmp_path / "end"
    os.mkfifo(end)  # each process ends when it has been read: not before it has been looked at
    site = sites(dormant(tmp_path / "here", f"{sys.executable} -c 'open(\"{end}\").read(); raise SystemExit(3)'"))
    fails: list[Sample] = []
    network.node().subscribe(KEYS.any_fail(), fails.append)
    ask(network, KEYS.wake("home"), encode(Wake(SLEEPER)))
    first = group_of(site)
    end.write_text("")
    assert live(network, lambda: bool(fails))
    assert b"ended with code 3" in fails[0].payload
    ask(network, KEYS.wake("home"), encode(Wake(SLEEPER)))
    second = group_of(site)
    assert second.number != first.number
    end.write_text("")
    assert second.wait(10)


@pytest.mark.parametrize(
    ("command", "reason"),
    [
        ("/no/such/program --really", "does not start: /no/such/program: No such file or directory"),
        ("'unbalanced", "cannot be read: No closing quotation"),
        ("", "has no sc:command"),
    ],
)
def test_a_command_that_does_not_start_is_refused_with_a_reason(
    network: Network, tmp_path: Path, sites: Callable[[Path], Site], command: str, reason: str
) -> None:
    sites(dormant(tmp_path / "here", command))
    replies = ask(network, KEYS.wake("home"), encode(Wake(SLEEPER)))
    assert replies.samples == ()
    assert reason in replies.errors[0]


def test_only_what_the_site_itself_advertises_with_a_command_can_be_started(
    network: Network, tmp_path: Path, sites: Callable[[Path], Site]
) -> None:
    site = sites(write_advertisements(tmp_path, "tracker"))
    for payload in (
        encode(Wake(iri("person-tracker"))),
        encode(Wake(IRI("urn:somebody"))),
        b"rm -rf /",
        encode(Release(1, "x")),
        b"",
    ):
        replies = ask(network, KEYS.wake("home"), payload)
        assert replies.samples == ()
        assert len(replies.errors) == 1
    assert site.processes.by_component == {}


def test_a_site_without_an_environment_starts_nothing(network: Network, tmp_path: Path) -> None:
    site = serve(network, dormant(tmp_path / "here", "true"))
    with pytest.raises(PeerError, match="cannot start"):
        site.start(SLEEPER)


def test_a_broad_question_starts_no_component(network: Network, tmp_path: Path, sites: Callable[[Path], Site]) -> None:
    site = sites(dormant(tmp_path / "here", python("pass")))
    for key in ("**", "selfconf/lab/site/**", "selfconf/**"):
        ask(network, key, encode(Wake(SLEEPER)))
    assert site.processes.by_component == {}


def test_a_process_that_does_not_want_to_end_is_killed(
    network: Network, tmp_path: Path, sites: Callable[[Path], Site], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("selfconf.site.processes.ENDING", 0.1)
    code = 'import signal; signal.signal(signal.SIGTERM, signal.SIG_IGN); open("deaf", "w").close()'
    folder = dormant(tmp_path / "here", python(code))
    site = sites(folder)
    site.start(SLEEPER)
    assert until(lambda: (folder / "deaf").exists())
    group = group_of(site)
    site.close()
    assert group.code() == -9


def test_what_a_process_leaves_behind_may_end_in_order_as_its_site_ends(
    tmp_path: Path, sites: Callable[[Path], Site]
) -> None:
    rests = "import signal, time, pathlib; "
    rests += 'signal.signal(signal.SIGTERM, lambda *_: (time.sleep(0.3), pathlib.Path("rests").touch(), exit())); '
    rests += 'pathlib.Path("acts").touch(); time.sleep(60)'
    (tmp_path / "motor.py").write_text(rests)
    started = f'sh -c "{sys.executable} {tmp_path / "motor.py"}; true"'  # the shell ends by the signal at once
    folder = dormant(tmp_path / "here", started)
    site = sites(folder)
    site.start(SLEEPER)
    assert until((folder / "acts").exists)
    site.close()
    assert (folder / "rests").exists()


RESTS_LATE = """import signal, sys, time
def rest(*_):
    time.sleep(0.3 if sys.argv[1] == "motor" else 0.0)  # as long as the motor takes to come to rest
    open("ended", "a").write(sys.argv[1] + " ")
    raise SystemExit
signal.signal(signal.SIGTERM, rest)
open(sys.argv[1], "w").close()
time.sleep(60)  # until it is ended
"""


def test_actuators_come_to_rest_before_what_feeds_them_as_their_site_ends(
    tmp_path: Path, sites: Callable[[Path], Site], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("selfconf.site.processes.ENDING", 20.0)
    folder = tmp_path / "here"
    for name in ("camera", "motor", "sonar"):
        output = "" if name == "motor" else '; sc:hasOutput [ sc:name "out" ; sc:signalType rob:RangeScan ]'
        dormant(folder, f"{sys.executable} program.py {name}", name, more=output)
    (folder / "program.py").write_text(RESTS_LATE)
    site = sites(folder)
    for name in ("camera", "motor", "sonar"):
        site.start(iri(name))
        assert until((folder / name).exists)
    site.close()
    first, *others = (folder / "ended").read_text().split()
    assert (first, set(others)) == ("motor", {"camera", "sonar"})


def test_processes_that_do_not_want_to_end_are_waited_for_together(
    network: Network, tmp_path: Path, sites: Callable[[Path], Site], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("selfconf.site.processes.ENDING", 1.0)
    code = 'import signal; signal.signal(signal.SIGTERM, signal.SIG_IGN); open("deaf", "w").close()'
    folder = dormant(tmp_path / "here", python(code))
    site = sites(folder)
    (advertisement,) = site.shelf.advertisements.values()
    for number in range(6):
        profile = advertisement.profile
        command = f"{profile.command} {number}"
        site.processes.start(replace(profile, component=IRI(f"urn:sleeper:{number}"), command=command))
        assert until((folder / "deaf").exists)
        (folder / "deaf").unlink()
    began = time.monotonic()
    site.close()
    assert time.monotonic() - began < 5.0


def test_a_process_that_goes_just_while_its_site_ends_is_no_trouble(
    tmp_path: Path, sites: Callable[[Path], Site], monkeypatch: pytest.MonkeyPatch
) -> None:
    site = sites(dormant(tmp_path / "here", python("pass")))
    site.start(SLEEPER)
    group = group_of(site)
    looks = iter([group])
    monkeypatch.setattr(ComponentProgram, "group", property(lambda _: next(looks, None)))
    site.close()
    assert group.code() is not None


def test_each_end_of_a_process_that_is_started_again_at_once_is_reported_once(
    network: Network, tmp_path: Path, sites: Callable[[Path], Site]
) -> None:
    code = 'import os; count = len(os.listdir()); open(str(count), "w"); raise SystemExit(count)'
    site = sites(dormant(tmp_path / "here", f"{sys.executable} -c '{code}'"))
    fails: list[Sample] = []
    network.node().subscribe(KEYS.any_fail(), fails.append)
    for number in range(3):
        site.start(SLEEPER)
        assert live(network, lambda number=number: len(fails) > number)
    assert [decode(fail.payload, Fail).detail.split(";")[0].split()[-1] for fail in fails] == ["1", "2", "3"]


def test_the_end_of_a_process_is_told_as_its_site_ends(
    network: Network, tmp_path: Path, sites: Callable[[Path], Site]
) -> None:
    """A task that ends in the same moment would not know otherwise whether its component is at rest."""
    site = sites(dormant(tmp_path / "here", "sleep 60"))
    told: list[Fail] = []
    network.node().subscribe(KEYS.any_fail(), lambda sample: told.append(decode(sample.payload, Fail)))
    site.start(SLEEPER)
    site.close()
    assert live(network, lambda: bool(told))
    assert [(one.component, one.detail) for one in told] == [(SLEEPER, "its process has ended with its site")]

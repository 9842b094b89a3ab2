"""A site: what lies on its shelf, how it notices changes, and how it starts what is dormant."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from selfconf.api.reading import read
from selfconf.bus.memory import Network
from selfconf.bus.port import Replies, Sample
from selfconf.errors import AuthorError, PeerError
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Page, Release, Wake
from selfconf.site.site import FILE_CHECK, Shelf, Site
from tests.lab import ADVERTISEMENTS, PREFIXES, iri, write_advertisements

KEYS = Keys("lab")
SLEEPER = iri("sleeper")


def until(condition: Callable[[], bool], seconds: float = 10.0) -> bool:
    """Wait in real time for a condition."""
    deadline = time.monotonic() + seconds
    while not condition() and time.monotonic() < deadline:
        os.sched_yield()
    return condition()


def touch(path: Path, text: str) -> None:
    """Write a file so that its time of change differs for sure."""
    path.write_text(text)
    status = path.stat()
    os.utime(path, ns=(status.st_atime_ns, status.st_mtime_ns + 1_000_000))


# The shelf.


def test_a_shelf_holds_what_lies_in_its_files_and_folders(tmp_path: Path) -> None:
    write_advertisements(tmp_path / "deep" / "deeper", "tracker")
    write_advertisements(tmp_path / "other", "drive", "pippi")
    complaints: list[str] = []
    shelf = Shelf([tmp_path / "deep", tmp_path / "other" / "drive.ttl"], complaints.append)
    assert shelf.refresh()
    assert set(shelf.advertisements) == {iri("person-tracker"), iri("astrid-drive")}
    assert not shelf.refresh()
    assert complaints == []


def test_a_file_that_comes_changes_or_goes_is_noticed(tmp_path: Path) -> None:
    shelf = Shelf([write_advertisements(tmp_path, "tracker")], print)
    shelf.refresh()
    write_advertisements(tmp_path, "drive")
    assert shelf.refresh()
    assert len(shelf.advertisements) == 2
    touch(tmp_path / "drive.ttl", PREFIXES + ADVERTISEMENTS["drive"].replace("Astrid", "Pippi"))
    assert shelf.refresh()
    (tmp_path / "drive.ttl").unlink()
    assert shelf.refresh()
    assert set(shelf.advertisements) == {iri("person-tracker")}


def test_a_file_means_what_it_means_to_a_command(tmp_path: Path) -> None:
    lamp = PREFIXES + "<#lamp> a sc:Component, :Lamp ."
    (tmp_path / "marked.ttl").write_bytes(b"\xef\xbb\xbf" + lamp.encode())
    complaints: list[str] = []
    shelf = Shelf([tmp_path], complaints.append)
    assert shelf.refresh()
    assert set(shelf.advertisements) == {IRI(f"{(tmp_path / 'marked.ttl').as_uri()}#lamp")}
    assert shelf.advertisements.keys() == read(tmp_path).advertisements().keys()
    assert complaints == []


def test_a_folder_that_is_called_like_a_file_is_a_folder(tmp_path: Path) -> None:
    write_advertisements(tmp_path / "lamps.ttl", "tracker")
    complaints: list[str] = []
    shelf = Shelf([tmp_path], complaints.append)
    assert shelf.refresh()
    assert set(shelf.advertisements) == {iri("person-tracker")}
    assert complaints == []


def test_a_complaint_is_made_once_until_it_changes(tmp_path: Path) -> None:
    complaints: list[str] = []
    shelf = Shelf([write_advertisements(tmp_path, "tracker")], complaints.append)
    (tmp_path / "lamp.ttl").write_text("no turtle")
    shelf.refresh()
    assert len(complaints) == 1
    write_advertisements(tmp_path, "drive")
    assert shelf.refresh()
    assert len(complaints) == 1
    touch(tmp_path / "lamp.ttl", "\nno turtle")
    shelf.refresh()
    assert len(complaints) == 2
    touch(tmp_path / "lamp.ttl", PREFIXES)
    shelf.refresh()
    touch(tmp_path / "lamp.ttl", "\nno turtle")
    shelf.refresh()
    assert len(complaints) == 3


def test_a_file_that_is_broken_is_named_and_the_others_stay(tmp_path: Path) -> None:
    complaints: list[str] = []
    shelf = Shelf([write_advertisements(tmp_path, "tracker", "drive")], complaints.append)
    shelf.refresh()
    touch(tmp_path / "drive.ttl", "this is no turtle")
    assert shelf.refresh()
    assert set(shelf.advertisements) == {iri("person-tracker")}
    assert "drive.ttl:1" in complaints[0]
    touch(tmp_path / "drive.ttl", PREFIXES + ADVERTISEMENTS["drive"])
    assert shelf.refresh()
    assert len(shelf.advertisements) == 2


def test_an_advertisement_that_does_not_conform_is_named_with_what_it_lacks(tmp_path: Path) -> None:
    complaints: list[str] = []
    (tmp_path / "bad.ttl").write_text(PREFIXES + ":lamp a sc:Component .\n" + ADVERTISEMENTS["drive"])
    shelf = Shelf([tmp_path], complaints.append)
    shelf.refresh()
    assert set(shelf.advertisements) == {iri("astrid-drive")}
    assert len(complaints) == 1
    assert "bad.ttl" in complaints[0]
    assert "needs a type of its own" in complaints[0]


def test_of_two_advertisements_of_one_component_the_first_counts_and_the_other_is_named(tmp_path: Path) -> None:
    complaints: list[str] = []
    (tmp_path / "a.ttl").write_text(PREFIXES + ADVERTISEMENTS["tracker"])
    (tmp_path / "b.ttl").write_text(PREFIXES + ADVERTISEMENTS["tracker"].replace("10", "20"))
    shelf = Shelf([tmp_path], complaints.append)
    shelf.refresh()
    assert shelf.advertisements[iri("person-tracker")].profile.preference == 10
    assert len(complaints) == 1
    assert "b.ttl" in complaints[0]


def test_a_folder_that_is_called_like_a_file_is_named_not_stumbled_over(tmp_path: Path) -> None:
    (tmp_path / "folder.ttl").mkdir()
    complaints: list[str] = []
    shelf = Shelf([tmp_path], complaints.append)
    shelf.refresh()
    assert shelf.advertisements == {}


# The site.


@pytest.fixture
def network() -> Network:
    """A simulated network."""
    return Network()


def serve(network: Network, folder: Path, environment: dict[str, str] | None = None) -> Site:
    """A site over a folder."""
    return Site(network.node(), "lab", "home", Shelf([folder], lambda _: None), environment)


def ask(network: Network, key: str, payload: bytes = b"") -> Replies:
    """Ask the site something."""
    replies: list[Replies] = []
    network.node().ask(key, payload, 1.0, replies.append)
    assert network.run(lambda: bool(replies), 5.0)
    return replies[0]


def test_every_advertisement_is_one_reply_on_a_key_of_its_own(network: Network, tmp_path: Path) -> None:
    serve(network, write_advertisements(tmp_path))
    samples = ask(network, KEYS.advertisements()).samples
    assert len({sample.key for sample in samples}) == len(ADVERTISEMENTS)
    pages = [decode(sample.attachment, Page) for sample in samples]
    assert [page.index for page in pages] == list(range(len(ADVERTISEMENTS)))
    assert {page.total for page in pages} == {len(ADVERTISEMENTS)}


def test_one_advertisement_may_be_asked_for_alone_or_all_come(network: Network, tmp_path: Path) -> None:
    serve(network, write_advertisements(tmp_path, "tracker"))
    assert len(ask(network, KEYS.advertisement("home", iri("person-tracker"))).samples) == 1


def test_a_change_is_told_and_the_next_answer_has_a_new_revision(network: Network, tmp_path: Path) -> None:
    serve(network, write_advertisements(tmp_path, "tracker"))
    told: list[Sample] = []
    network.node().subscribe(KEYS.changed(), told.append)
    before = decode(ask(network, KEYS.advertisements()).samples[0].attachment, Page)
    write_advertisements(tmp_path, "drive")
    network.run(lambda: bool(told), 2 * FILE_CHECK)
    assert len(told) == 1
    after = [decode(sample.attachment, Page) for sample in ask(network, KEYS.advertisements()).samples]
    assert {page.revision for page in after} == {before.revision + 1}
    assert {page.total for page in after} == {2}


def test_nothing_is_told_while_nothing_changes(network: Network, tmp_path: Path) -> None:
    serve(network, write_advertisements(tmp_path, "tracker"))
    told: list[Sample] = []
    network.node().subscribe(KEYS.changed(), told.append)
    network.run(lambda: False, 10 * FILE_CHECK)
    assert told == []


def test_a_site_that_is_closed_is_not_called_any_more(network: Network, tmp_path: Path) -> None:
    site = serve(network, write_advertisements(tmp_path, "tracker"))
    called: list[tuple[str, ...]] = []
    node = network.node()
    node.roll_call(KEYS.any_site_life(), 1.0, called.append)
    network.run(lambda: bool(called))
    assert len(called[0]) == 1
    site.close()
    node.roll_call(KEYS.any_site_life(), 1.0, called.append)
    network.run(lambda: len(called) == 2)
    assert called[1] == ()


def test_a_site_needs_a_name_that_can_stand_in_a_key(network: Network, tmp_path: Path) -> None:
    with pytest.raises(AuthorError, match="cannot name a site"):
        Site(network.node(), "lab", "a/b", Shelf([tmp_path], print))


# Dormant components.


def dormant(folder: Path, command: str) -> Path:
    """An advertisement of a component that a site can start."""
    folder.mkdir(parents=True, exist_ok=True)
    quoted = command.replace("\\", "\\\\").replace('"', '\\"')
    (folder / "sleeper.ttl").write_text(
        PREFIXES + f':sleeper a sc:Component, rob:Encoder ; sc:grounding [ sc:command "{quoted}" ] .\n'
    )
    return folder


@pytest.fixture
def sites(network: Network) -> Iterator[Callable[[Path], Site]]:
    """Sites that can start components, and that end them again."""
    made: list[Site] = []

    def make(folder: Path) -> Site:
        made.append(serve(network, folder, {"SELFCONF_ECOLOGY": "lab", "SELFCONF_CONNECT": "tcp/127.0.0.1:1"}))
        return made[-1]

    yield make
    for site in made:
        site.close()


def python(code: str) -> str:
    """A command that runs some Python and then waits to be ended."""
    return f"{sys.executable} -c '{code}; import signal; signal.pause()'"


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
    (process,) = site._processes.values()
    assert until(lambda: (folder / str(process.pid)).exists())
    site.close()
    assert process.poll() is not None
    assert len([path for path in folder.iterdir() if path.name.isdigit()]) == 1


def test_a_component_that_has_ended_may_be_started_again_and_its_end_is_told(
    network: Network, tmp_path: Path, sites: Callable[[Path], Site]
) -> None:
    site = sites(dormant(tmp_path / "here", f"{sys.executable} -c 'raise SystemExit(3)'"))
    fails: list[Sample] = []
    network.node().subscribe(KEYS.any_fail(), fails.append)
    ask(network, KEYS.wake("home"), encode(Wake(SLEEPER)))
    (first,) = site._processes.values()
    first.wait(10)
    network.run(lambda: bool(fails), 5.0)
    assert b"ended with code 3" in fails[0].payload
    ask(network, KEYS.wake("home"), encode(Wake(SLEEPER)))
    (second,) = site._processes.values()
    assert second.pid != first.pid
    second.wait(10)


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
    assert site._processes == {}


def test_a_site_that_is_not_told_its_ecology_starts_nothing(network: Network, tmp_path: Path) -> None:
    site = serve(network, dormant(tmp_path / "here", "true"))
    with pytest.raises(PeerError, match="cannot start"):
        site.start(SLEEPER)


def test_a_broad_question_wakes_nobody(network: Network, tmp_path: Path, sites: Callable[[Path], Site]) -> None:
    site = sites(dormant(tmp_path / "here", python("pass")))
    for key in ("**", "selfconf/lab/site/**", "selfconf/**"):
        ask(network, key, encode(Wake(SLEEPER)))
    assert site._processes == {}


def test_a_process_that_does_not_want_to_end_is_killed(
    network: Network, tmp_path: Path, sites: Callable[[Path], Site], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("selfconf.site.site.ENDING", 0.1)
    code = 'import signal; signal.signal(signal.SIGTERM, signal.SIG_IGN); open("deaf", "w").close()'
    folder = dormant(tmp_path / "here", python(code))
    site = sites(folder)
    site.start(SLEEPER)
    assert until(lambda: (folder / "deaf").exists())
    (process,) = site._processes.values()
    site.close()
    assert process.poll() == -9

"""A site on the bus: what it replies, and what it tells when its files change."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest

from selfconf.bus.memory import Network
from selfconf.bus.port import Replies, Sample
from selfconf.errors import AuthorError
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.messages import Apply, End, Page, Release
from selfconf.site import Shelf, Site
from selfconf.site.site import FILE_CHECK, FILE_CHECK_PAUSE, pause_after
from tests.lab import ADVERTISEMENTS, Lab, iri, write_advertisements
from tests.site.served import KEYS, ask, serve


def test_every_advertisement_is_one_reply_on_a_key_of_its_own(network: Network, tmp_path: Path) -> None:
    serve(network, write_advertisements(tmp_path))
    samples = ask(network, KEYS.advertisements()).samples
    assert len({sample.key for sample in samples}) == len(ADVERTISEMENTS)
    pages = [decode(sample.attachment, Page) for sample in samples]
    assert [page.index for page in pages] == list(range(len(ADVERTISEMENTS)))
    assert {page.total for page in pages} == {len(ADVERTISEMENTS)}


def test_a_file_with_a_name_that_is_no_text_is_advertised_like_any_other(network: Network, tmp_path: Path) -> None:
    file = tmp_path / os.fsdecode(b"sonar-\xff.ttl")
    write_advertisements(tmp_path, "sonar").joinpath("sonar.ttl").rename(file)
    serve(network, tmp_path)
    (sample,) = ask(network, KEYS.advertisements()).samples
    assert decode(sample.attachment, Page).source.startswith(str(tmp_path / "sonar-?.ttl"))


def test_one_advertisement_may_be_asked_for_alone_or_all_come(network: Network, tmp_path: Path) -> None:
    serve(network, write_advertisements(tmp_path, "tracker"))
    assert len(ask(network, KEYS.advertisement("home", iri("person-tracker"))).samples) == 1


def test_a_change_is_announced_and_the_next_answer_has_a_new_revision(network: Network, tmp_path: Path) -> None:
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


def test_a_look_at_the_files_that_breaks_is_not_the_last_one(
    network: Network, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    site = serve(network, write_advertisements(tmp_path, "tracker"))
    told: list[Sample] = []
    network.node().subscribe(KEYS.changed(), told.append)
    with monkeypatch.context() as broken:
        broken.setattr(Shelf, "refresh", breaks)
        with pytest.raises(ArithmeticError):
            network.run(lambda: False, 2 * FILE_CHECK)
    write_advertisements(tmp_path, "drive")
    network.run(lambda: bool(told), 2 * FILE_CHECK)
    assert len(site.shelf.advertisements) == 2


def breaks(_: Shelf) -> bool:
    """Break, as nothing should."""
    raise ArithmeticError


def test_files_are_looked_at_again_soon_however_long_reading_has_taken() -> None:
    assert pause_after(0.001) == FILE_CHECK
    assert pause_after(0.04) == pytest.approx(2.0)
    assert pause_after(30.0) == FILE_CHECK_PAUSE


def test_nothing_is_announced_while_nothing_changes(network: Network, tmp_path: Path) -> None:
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


def test_a_process_is_not_ended_for_a_task_that_its_component_has_let_go_of_or_shares_with_another(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As where the release was lost with a link that was cut for a moment: the process may be that of others by now."""
    lab = Lab(tmp_path)
    lab.site("home", "tracker")
    lab.component("tracker")
    site, runtime, caller = lab.sites["home"], lab.runtimes["tracker"], lab.network.node()
    ended: list[str] = []

    def end_process(component: IRI, life: str, gone: Callable[[], None]) -> None:
        ended.append(life)
        gone()

    monkeypatch.setattr(site.processes, "end", end_process)

    def call(name: str, message: Apply | Release) -> None:
        caller.ask(lab.keys.call(runtime.profile.component, name), encode(message), 1.0, lambda _: None)
        lab.let_pass(0.5)

    def asked_to_end(task: str) -> tuple[list[bytes], tuple[str, ...]]:
        replies: list[Replies] = []
        end = End(runtime.profile.component, runtime.life, task)
        caller.ask(lab.keys.end("home"), encode(end), 2.0, replies.append)
        assert lab.until(lambda: bool(replies))
        return [sample.payload for sample in replies[0].samples], replies[0].errors

    for task in ("one~1", "other~2"):
        supervisor = lab.keys.configurator_life(task[:3], "1")
        caller.announce(supervisor)
        call("apply", Apply(1, supervisor, task))
    assert asked_to_end("one~1") == ([], (f"{runtime.profile.component} acts for other tasks as well",))
    call("release", Release(2, lab.keys.configurator_life("one", "1"), "one~1"))
    assert asked_to_end("one~1") == ([b"let go"], ())
    assert ended == []
    assert runtime.active
    assert asked_to_end("other~2") == ([b"ended"], ())
    assert ended == [runtime.life]

"""The things of files, URLs and directories: they come, go, and are described anew."""

from __future__ import annotations

import itertools
import json
import time
from collections.abc import Callable
from dataclasses import replace
from http.server import BaseHTTPRequestHandler
from pathlib import Path

import pytest

from selfconf.files import advertisements
from selfconf.protocol.messages import Release
from tests.bridging.thing_server import ThingServer, reply
from tests.bridging.wot.bridged import HASTY, active, bridging, written
from tests.sdk.living import LivingStage, until

Start = Callable[[], ThingServer]
FORM = {"forms": [{"href": "blink"}]}


def test_the_things_of_a_directory_come_and_go(thing_server: Start, living: LivingStage, tmp_path: Path) -> None:
    server = thing_server()
    server.values.update({"/on": True, "/things": [server.describe("a")]})
    with bridging(living, tmp_path / "ads", f"{server.url}/things") as found:
        assert until(lambda: found.lives("a"))
        server.values["/things"] = [server.describe("b"), server.describe("c")]
        assert until(lambda: found.lives("b") and found.lives("c") and not found.lives("a"))
        advertised = [one.component for path in found.folder.glob("*.ttl") for one in advertisements(path)[0]]
        assert sorted(advertised) == ["urn:thing:b", "urn:thing:c"]
        server.answers["/things"] = lambda handler: reply(handler, b"", 500)
        assert until(lambda: found.complained("answers 500"))
        assert found.lives("b")
        del server.answers["/things"]
        server.values["/things"] = [server.describe("d")]
        assert until(lambda: found.lives("d"))
        server.answers["/things"] = lambda handler: reply(handler, b"", 500)
        assert until(lambda: sum("answers 500" in one for one in found.complaints) == 2), "each time is news"


def test_the_things_of_all_pages_of_a_directory_are_here(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    server = thing_server()
    server.values["/on"] = True
    first, second = (json.dumps([server.describe(name)]).encode() for name in "ab")
    server.answers["/things"] = lambda handler: reply(handler, first, Link='<more>; rel="next"')
    server.answers["/more"] = lambda handler: reply(handler, second, Link="<http://elsewhere.example/>; rel=next")
    with bridging(living, tmp_path / "ads", f"{server.url}/things") as found:
        assert until(lambda: found.lives("a") and found.lives("b"))
        assert until(lambda: found.complained("http://elsewhere.example/, which is another server"))
        server.answers["/more"] = lambda handler: reply(handler, b"", 500)
        assert until(lambda: found.complained("answers 500"))
        assert found.lives("a")
        assert found.lives("b"), "a page that cannot be read has its things stay"
        server.answers["/things"] = lambda handler: reply(handler, first)
        assert until(lambda: not found.lives("b"))
        assert found.lives("a")


def test_a_collection_is_read_and_what_describes_no_thing_is_named(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    server = thing_server()
    members = [server.describe("a"), {"status": "ok"}]
    server.values |= {"/on": True, "/things": {"@type": "ThingCollection", "members": members}}
    with bridging(living, tmp_path / "ads", f"{server.url}/things") as found:
        assert until(lambda: found.lives("a"))
        assert found.complained(f"{server.url}/things holds what describes no thing")


def test_a_thing_that_is_described_anew_is_another_component(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    server = thing_server()
    server.values["/on"] = True
    source = written(tmp_path, server.describe())
    with bridging(living, tmp_path / "ads", source) as found:
        assert until(lambda: found.lives("lamp"))
        (path,) = found.folder.glob("*.ttl")
        written(tmp_path, server.describe(**{"@type": "rob:Display"}))
        assert until(lambda: "rob:Display" in path.read_text() and found.lives("lamp"))
        assert len(list(found.folder.glob("*.ttl"))) == 1


def test_a_thing_that_a_source_describes_twice_is_one_component(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    server = thing_server()
    server.values["/on"] = True
    with bridging(living, tmp_path / "ads", written(tmp_path, *[server.describe()] * 3)) as found:
        assert until(lambda: found.complained("urn:thing:lamp is described twice; the first description counts"))
        assert until(lambda: found.lives("lamp"))
        assert [path.name for path in found.folder.glob("*.ttl")] == ["urn-thing-lamp-1.ttl"]


def test_things_that_have_no_identifier_are_not_one_as_their_files_have_like_names(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    server, folder = thing_server(), tmp_path / "things"
    server.values["/on"] = True
    folder.mkdir()
    for name in ("Lampe Küche", "Lampe Kuche", "Lampe-K-che"):
        description = {member: said for member, said in server.describe(title=name).items() if member != "id"}
        (folder / f"{name}.json").write_text(json.dumps(description))
    with bridging(living, tmp_path / "ads", str(folder)) as found:
        assert until(lambda: len(list(found.folder.glob("*.ttl"))) == 3)
        assert not found.complained("is described twice")


def test_a_thing_that_is_described_with_more_is_advertised_anew_once_no_task_holds_it(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    server = thing_server()
    server.values.update({"/on": True, "/things": [server.describe()]})
    with bridging(living, tmp_path / "ads", f"{server.url}/things") as found:
        active(found)
        (path,) = found.folder.glob("*.ttl")
        asked = len(server.received)
        server.values["/things"] = [server.describe(description="by the door", actions={"blink": FORM})]
        assert until(lambda: sum(one.path == "/things" for one in server.received[asked:]) > 5)
        assert "blink" not in path.read_text()
        assert found.causes() == []
        released = living.call("urn:thing:lamp", "release", Release(2, living.supervisor, "task~1"))
        assert until(lambda: released)
        assert until(lambda: "blink" in path.read_text() and "by the door" in path.read_text())
        assert found.causes() == []


@pytest.mark.parametrize(("then", "words"), [("rob:Display", "describes it anew"), (None, "describes it no more")])
def test_a_task_hears_why_a_thing_that_it_holds_lives_no_more(
    thing_server: Start, living: LivingStage, tmp_path: Path, then: str | None, words: str
) -> None:
    server = thing_server()
    server.values.update({"/on": True, "/things": [server.describe()]})
    source = f"{server.url}/things"
    with bridging(living, tmp_path / "ads", source) as found:
        active(found)
        server.values["/things"] = [] if then is None else [server.describe(**{"@type": then})]
        assert until(lambda: found.causes() == [f"{source} {words}"])
        assert until(lambda: found.lives("lamp") is (then is not None))


def test_a_thing_goes_on_of_which_a_directory_says_when_it_was_asked(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    server, times = thing_server(), itertools.count()

    def things(handler: BaseHTTPRequestHandler) -> None:
        registration = {"retrieved": f"2026-01-01T00:00:{next(times):02}Z"}
        reply(handler, json.dumps([server.describe(registration=registration)]).encode())

    server.values["/on"] = True
    server.answers["/things"] = things
    with bridging(living, tmp_path / "ads", f"{server.url}/things") as found:
        assert until(lambda: found.lives("lamp"))
        asked = next(times)
        assert until(lambda: next(times) > asked + 20)
        assert len(found.complaints) == 1, found.complaints


def test_a_thing_that_cannot_be_advertised_for_now_is_so_later(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    server = thing_server()
    server.values["/on"] = True
    source, folder, away = tmp_path / "things", tmp_path / "ads", tmp_path / "away"
    source.mkdir()
    with bridging(living, folder, str(source)) as found:
        folder.rename(away)
        written(source, server.describe())
        assert until(lambda: found.complained("lamp cannot be advertised: No such file or directory"))
        away.rename(folder)
        assert until(lambda: found.lives("lamp"))
        folder.rename(away)
        written(source, server.describe(**{"@type": "rob:Display"}))
        assert until(lambda: not found.lives("lamp"))
        written(source, server.describe())
        away.rename(folder)
        assert until(lambda: found.lives("lamp"))


def test_a_description_that_was_fetched_leads_to_its_own_host_alone(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    server, private = thing_server(), thing_server()
    private.values["/on"] = True
    server.values["/td"] = server.describe(base=f"http://localhost:{private.port}/")
    with bridging(living, tmp_path / "ads", f"{server.url}/td") as found:
        assert until(lambda: found.complained("allow it with host='localhost'"))
        assert until(lambda: found.complained("there is no form by which it could be reached"))
        assert not found.lives("lamp")
    assert private.received == []
    allowed = replace(HASTY, hosts=frozenset(("LocalHost",)))
    with bridging(living, tmp_path / "ads", f"{server.url}/td", settings=allowed) as found:
        assert until(lambda: found.lives("lamp"))


def test_what_cannot_be_read_is_named_once_and_hinders_nothing(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    server = thing_server()
    server.values["/on"] = True
    folder = tmp_path / "things"
    folder.mkdir()
    (folder / "broken.json").write_text('{"title": ')
    written(folder, server.describe(), server.describe())
    with bridging(living, tmp_path / "ads", str(folder)) as found:
        assert until(lambda: found.lives("lamp") and found.complained("broken.json:1:11: this is not JSON"))
        requests = len(server.received)
        assert until(lambda: len(server.received) > requests + 10)
        assert sum("broken.json" in complaint for complaint in found.complaints) == 1


def test_a_thing_stays_while_its_description_is_being_written(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    server = thing_server()
    server.values["/on"] = True
    source = tmp_path / "things"
    source.mkdir()
    (source / "other.td.json").write_text(json.dumps(server.describe("other")))
    written(source, server.describe())
    with bridging(living, tmp_path / "ads", str(source)) as found:
        assert until(lambda: found.complained("lamp is here") and found.lives("other"))
        before = len(found.complaints)
        (source / "things.td.json").write_text('{"title": ')
        (source / "other.td.json").unlink()
        assert until(lambda: found.complained("things.td.json:1:11: this is not JSON") and not found.lives("other"))
        assert found.lives("lamp")
        written(source, server.describe())
        (source / "other.td.json").write_text(json.dumps(server.describe("other")))
        assert until(lambda: found.lives("other"))
        assert found.lives("lamp")
        assert not any("lamp is here" in complaint for complaint in found.complaints[before:])
        (source / "things.td.json").unlink()
        assert until(lambda: not found.lives("lamp"))


def test_descriptions_that_are_too_long_or_no_json_are_named_and_one_that_never_comes_holds_up_nothing(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    server = thing_server()
    server.values.update({"/on": True, "/td": server.describe()})
    server.answers["/long"] = lambda handler: reply(handler, b" " * (20 << 20))
    server.answers["/html"] = lambda handler: reply(handler, b"<html>", media="text/html")
    server.answers["/moved"] = lambda handler: reply(handler, b"", 302, Location="http://192.0.2.7/")
    server.answers["/silent"] = server.say_nothing
    sources = [f"{server.url}/{name}" for name in ("silent", "long", "html", "moved", "td")]
    with bridging(living, tmp_path / "ads", *sources) as found:
        assert until(lambda: found.lives("lamp"))
        for words in ("/long answers more than 16 MiB", "/html:1:1: this is not JSON", "/moved answers 302, go to "):
            assert until(lambda: found.complained(words))  # noqa: B023 - it is waited for in this turn
        began = time.monotonic()
    assert time.monotonic() - began < 8.0  # though a description may take 20 seconds

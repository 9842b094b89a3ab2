"""The directory API of W3C WoT Discovery."""

from __future__ import annotations

import asyncio
from urllib.parse import quote

import pytest
from starlette.requests import Request
from starlette.types import ASGIApp

from selfconf.serve.board import Board
from selfconf.serve.directory import Directory
from selfconf.serve.watching.change import EcologyChange
from tests.lab import ADVERTISEMENTS, iri
from tests.serve.asgi import ask, served

TRACKER = f"/things/{quote(iri('person-tracker'), safe='')}"


@pytest.fixture
def app(board: Board) -> ASGIApp:
    return served(board)


def test_all_things_are_listed(app: ASGIApp) -> None:
    answer = ask(app, "/things")
    assert (answer.status, answer.media) == (200, "application/ld+json")
    assert len(answer.json) == len(ADVERTISEMENTS)


def test_things_are_listed_page_by_page(app: ASGIApp) -> None:
    found, path = [], "/things?limit=3&offset=0"
    while path:
        answer = ask(app, path)
        found += [thing["id"] for thing in answer.json]
        links = answer.headers["link"].split(", ")
        path = next((link[1:].partition(">")[0] for link in links if 'rel="next"' in link), "")
    assert found == sorted(found)
    assert len(found) == len(ADVERTISEMENTS)


def test_a_collection_says_how_many_there_are_and_what_is_next(app: ASGIApp) -> None:
    answer = ask(app, "/things?format=collection&limit=2").json
    assert (answer["total"], len(answer["members"])) == (len(ADVERTISEMENTS), 2)
    assert answer["@context"] == "https://www.w3.org/2022/wot/discovery"
    assert answer["@id"] == "/things?limit=2&format=collection"
    following = ask(app, answer["next"]).json
    assert (following["@type"], following["@id"]) == ("ThingCollection", answer["next"])


def test_a_page_far_beyond_the_end_is_empty(app: ASGIApp) -> None:
    number = 4300 * "9"  # of as many digits as Python reads and writes; the sum of two has one more
    answer = ask(app, f"/things?offset={number}&limit={number}")
    assert (answer.status, answer.json) == (200, [])


def test_a_collection_of_all_things_names_no_limit(app: ASGIApp) -> None:
    answer = ask(app, "/things?format=collection").json
    assert (answer["@id"], len(answer["members"])) == ("/things?format=collection", len(ADVERTISEMENTS))
    assert "next" not in answer


@pytest.mark.parametrize(
    "parameters", ["limit=0", "limit=x", "offset=-1", "format=table", "limit=1&limit=2", "limit=1_0", "offset=%D9%A3"]
)
def test_a_parameter_that_makes_no_sense_is_a_problem(app: ASGIApp, parameters: str) -> None:
    answer = ask(app, f"/things?{parameters}")
    assert (answer.status, answer.media) == (400, "application/problem+json")


def test_who_wants_another_order_hears_that_there_is_none(app: ASGIApp) -> None:
    answer = ask(app, "/things?sort_by=title&sort_order=desc")
    assert (answer.status, answer.media) == (501, "application/problem+json")
    assert "sort_by" in answer.json["detail"]


def test_one_thing_is_found_by_its_iri_as_description_or_as_turtle(app: ASGIApp) -> None:
    answer = ask(app, TRACKER)
    assert (answer.status, answer.media, answer.json["id"]) == (200, "application/td+json", iri("person-tracker"))
    answer = ask(app, TRACKER, accept="text/turtle")
    assert b"rob:PositionSensor" in answer.body
    refused = ask(app, TRACKER, accept="image/png")
    assert (refused.status, refused.headers["vary"]) == (406, "Accept")
    assert ask(app, "/things/urn:nothing").status == 404


def test_nothing_can_be_written(app: ASGIApp) -> None:
    for method in ("PUT", "DELETE", "PATCH"):
        answer = ask(app, TRACKER, method)
        assert (answer.status, answer.media) == (405, "application/problem+json")


def test_the_directory_describes_itself(app: ASGIApp) -> None:
    answer = ask(app, "/.well-known/wot")
    assert (answer.media, answer.json["@type"]) == ("application/td+json", "ThingDirectory")


def test_events_of_another_type_are_a_problem(app: ASGIApp) -> None:
    assert ask(app, "/events/thing_renamed").status == 404


def test_a_stream_tells_of_things_from_the_last_event_on(board: Board) -> None:
    async def play() -> list[bytes]:
        last = [(b"last-event-id", board.stream.last.encode())]
        board.apply(EcologyChange({iri("pippi-drive"): None}))
        scope = {"type": "http", "method": "GET", "headers": last, "query_string": b"", "path_params": {}}
        response = await Directory(board).events(Request({**scope, "path_params": {"kind": "thing_deleted"}}))
        lines = response.body_iterator  # type: ignore[attr-defined]  # a StreamingResponse
        return [await anext(lines), await anext(lines)]

    _, event = asyncio.run(play())
    assert b"event: thing_deleted" in event
    assert iri("pippi-drive").encode() in event

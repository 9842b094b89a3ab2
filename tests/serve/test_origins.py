"""Pages of other origins are refused before a query costs anything; those of an origin that is named are not."""

from __future__ import annotations

import pytest
from starlette.types import ASGIApp

from selfconf.query import StandingDataset
from selfconf.serve.board import Board
from tests.serve.asgi import Answer, ask, served

YASGUI, STRANGER = "https://yasgui.example", "https://stranger.example"
FORM = "application/x-www-form-urlencoded"


@pytest.fixture
def app(board: Board, dataset: StandingDataset) -> ASGIApp:
    return served(board, dataset, origins=[YASGUI])


def asked_by(app: ASGIApp, origin: str, **headers: str) -> Answer:
    """The answer to a query as YASGUI sends it."""
    return ask(app, "/sparql", "POST", b"query=ASK{}", origin=origin, content_type=FORM, **headers)


def test_a_page_of_an_origin_that_is_named_asks_and_reads_the_answer(app: ASGIApp) -> None:
    answer = asked_by(app, YASGUI, accept="application/sparql-results+json", sec_fetch_site="cross-site")
    assert answer.json["boolean"] is True
    assert answer.headers["access-control-allow-origin"] == YASGUI
    assert answer.headers["vary"] == ask(app, "/things").headers["vary"] == "Origin", "what keeps answers is told apart"
    assert "access-control-allow-credentials" not in answer.headers
    assert asked_by(app, YASGUI, accept="image/png").headers["access-control-allow-origin"] == YASGUI
    for path in ("/things", "/things/urn:none", "/search/sparql?query=ASK{}", "/.well-known/wot", "/sparql"):
        answer = ask(app, path, origin=YASGUI)
        assert answer.headers["access-control-allow-origin"] == YASGUI, path
        assert answer.status == (404 if "none" in path else 200), path


def test_a_browser_that_asks_beforehand_is_told_what_its_page_may_do(app: ASGIApp) -> None:
    asks = {"access_control_request_method": "POST", "access_control_request_headers": "content-type"}
    answer = ask(app, "/sparql", "OPTIONS", origin=YASGUI, **asks)
    assert (answer.status, answer.body) == (204, b"")
    assert "POST" in answer.headers["access-control-allow-methods"]
    assert "Content-Type" in answer.headers["access-control-allow-headers"]
    assert "access-control-allow-private-network" not in answer.headers
    local = ask(app, "/sparql", "OPTIONS", origin=YASGUI, access_control_request_private_network="true", **asks)
    assert local.headers["access-control-allow-private-network"] == "true"
    refused = ask(app, "/sparql", "OPTIONS", origin=STRANGER, **asks)
    assert refused.status == 403
    assert "access-control-allow-origin" not in refused.headers
    assert ask(app, "/sparql", "OPTIONS").status == 405


@pytest.mark.parametrize("path", ["/state", "/changes", "/look", "/fit", "/metrics", "/", "/sparqlx"])
def test_what_people_look_at_is_for_no_other_origin(app: ASGIApp, path: str) -> None:
    answer = ask(app, path, origin=YASGUI)
    assert answer.status == 403
    assert "and nothing else" in answer.json["detail"]


@pytest.mark.parametrize(
    "origin", [STRANGER, "http://yasgui.example", "https://yasgui.example:444", "null", "http://["]
)
def test_a_page_of_another_origin_is_refused_and_told_by_what_it_would_not_be(app: ASGIApp, origin: str) -> None:
    answer = asked_by(app, origin, sec_fetch_site="cross-site")
    assert answer.status == 403
    assert "--allow-origin" in answer.json["detail"]
    assert "access-control-allow-origin" not in answer.headers


def test_what_another_page_embeds_is_refused_and_a_link_to_the_page_is_not(app: ASGIApp) -> None:
    for mode, target in (("no-cors", "image"), ("no-cors", "script"), ("navigate", "iframe")):
        found = ask(app, "/sparql?query=ASK{}", sec_fetch_site="cross-site", sec_fetch_mode=mode, sec_fetch_dest=target)
        assert found.status == 403
    linked = ask(app, "/", sec_fetch_site="cross-site", sec_fetch_mode="navigate", sec_fetch_dest="document")
    assert linked.status == 200


@pytest.mark.parametrize(
    "headers",
    [
        {"origin": "http://localhost:8000"},
        {"origin": "https://ecology.example", "sec_fetch_site": "same-origin"},  # a proxy has changed the host
        {"sec_fetch_site": "same-origin"},
        {"sec_fetch_site": "none"},
        {},
    ],
)
def test_its_own_page_and_programs_are_answered(app: ASGIApp, headers: dict[str, str]) -> None:
    assert ask(app, "/sparql", "POST", b"query=ASK{}", content_type=FORM, **headers).json["boolean"] is True

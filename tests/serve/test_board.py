"""What the server knows of an ecology, and what it tells of changes."""

from __future__ import annotations

import json

import pytest

from selfconf.serve.board import MOST_SHARED, Board
from selfconf.serve.metrics import Metrics
from selfconf.serve.watching.change import EcologyChange
from tests.lab import ADVERTISEMENTS, iri
from tests.serve.shown import advertised, found


def test_the_state_is_all_changes_together(board: Board) -> None:
    assert len(board.state()["components"]) == len(ADVERTISEMENTS)
    gone = iri("pippi-drive")
    board.apply(EcologyChange({gone: None}, {gone: None}, events=({"act": "ended", "time": 1.0},)))
    state = board.state()
    assert gone not in state["components"]
    assert state["events"] == [{"act": "ended", "time": 1.0}]
    assert gone not in board.advertised


def test_an_answer_is_written_once_for_all_who_ask_until_something_changes(board: Board) -> None:
    written = board.shared("/state", lambda: "before")
    assert board.shared("/state", lambda: "after") is written
    board.apply(EcologyChange(events=({"act": "ended", "time": 1.0},)))
    assert board.shared("/state", lambda: "after") == b"after"


def test_a_client_who_asks_for_page_after_page_does_not_fill_the_memory(board: Board) -> None:
    for offset in range(100):
        board.shared(f"/things?offset={offset}", lambda: "[]")
    assert len(board._answers) <= MOST_SHARED


def test_a_thing_is_created_updated_and_deleted(board: Board) -> None:
    gone = iri("pippi-drive")
    before = board.stream.last
    tracker = found("tracker", ":person-tracker rdfs:label 'the tracker' .")
    board.apply(EcologyChange({tracker.advertisement.component: tracker}))
    board.apply(EcologyChange({gone: None}))
    board.apply(advertised("pippi"))
    missed = board.stream.missed(before) or []
    things = [event for event in missed if event.kind.startswith("thing")]
    assert [event.kind for event in things] == ["thing_updated", "thing_deleted", "thing_created"]
    assert things[0].data == {"id": iri("person-tracker"), "title": "the tracker"}, "no more than has changed"
    assert things[1].data == {"id": gone}
    assert things[2].data == json.loads(board.descriptions[gone])


def test_what_a_thing_has_no_more_is_told_as_gone_and_not_what_it_has_still(board: Board) -> None:
    rate = "sc:rate [ sc:value 2 ; sc:unit <http://qudt.org/vocab/unit/HZ> ]"
    ticks = f":person-tracker sc:hasOutput [ sc:name 'ticks' ; sc:signalType :Tick ; {rate} ] ."
    tracker = found("tracker", f"{ticks} :person-tracker rdfs:comment 'in the hall' .")
    component = tracker.advertisement.component
    board.apply(EcologyChange({component: tracker}))
    before = board.stream.last
    board.apply(EcologyChange({component: found("tracker", ticks)}))
    assert "sc:rate" in board.descriptions[component]
    (event,) = board.stream.missed(before) or ()
    assert event.data == {"id": component, "description": None}


@pytest.mark.parametrize(
    "more", ["rob:place :attic", 'sc:hasOutput [ sc:name "b" ; sc:rate [ sc:value 2 ; sc:unit unit:HZ ] ]']
)
def test_a_thing_of_other_properties_or_rates_is_updated(board: Board, more: str) -> None:
    before = board.stream.last
    prefix = "@prefix unit: <http://qudt.org/vocab/unit/> . "
    for said in (more, more.replace("attic", "cellar").replace("2", "3")):
        tracker = found("tracker", f"{prefix}:person-tracker {said} .")
        board.apply(EcologyChange({tracker.advertisement.component: tracker}))
    assert [event.kind for event in board.stream.missed(before) or []] == ["thing_updated"] * 2


def test_a_thing_that_is_described_as_before_is_not_told_as_updated(board: Board) -> None:
    before = board.stream.last
    board.apply(advertised("tracker", "sonar"))
    assert [event.kind for event in board.stream.missed(before) or []] == ["change"]


def test_what_is_there_at_first_is_not_told_as_created() -> None:
    board = Board("lab", Metrics())
    board.apply(advertised("tracker"))
    assert [event.kind for event in board.stream.missed(f"{board.stream.life}-0") or []] == ["change"]


def test_the_gauges_count_by_state_and_phase(board: Board) -> None:
    task = {"phase": "running", "over": False, "components": [iri("wheels")]}
    board.apply(EcologyChange(tasks={"a": task, "b": {**task, "over": True, "components": []}}))
    gauges = {name: list(values) for name, values in board.gauges(linked=True).items()}
    assert gauges["selfconf_components"][0] == ({"state": "alive"}, float(len(ADVERTISEMENTS)))
    assert gauges["selfconf_tasks"] == [({"phase": "running"}, 1.0)]
    assert gauges["selfconf_components_held"] == [({}, 1.0)]

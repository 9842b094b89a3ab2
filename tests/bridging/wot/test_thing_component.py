"""A thing as a component: it reads, follows, writes and calls while it is active, and fails by its sentence."""

from __future__ import annotations

import itertools
import json
from collections.abc import Callable
from http.server import BaseHTTPRequestHandler
from pathlib import Path
from typing import Any

import pytest

from selfconf.bridging.wot.thing_component import AGAIN
from selfconf.model.immutable import replace
from selfconf.model.term import IRI
from selfconf.protocol.messages import Reserve, Wire
from selfconf.sdk import Component, Response
from tests.bridging.thing_server import ROB, ThingServer, reply
from tests.bridging.wot.bridged import HASTY, Bridged, active, bridging, button, written
from tests.sdk.living import PATIENCE, LivingStage, until

Start = Callable[[], ThingServer]
SWITCH = {"@type": "rob:Switch", "type": "boolean"}


WIRE = (Wire(IRI("urn:c:button"), "on"),)


def test_a_property_is_read_at_the_rate_and_issued_as_its_signal_type(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    server = thing_server()
    server.values["/on"] = True
    with bridging(living, tmp_path / "ads", written(tmp_path, server.describe())) as found:
        values = found.heard("lamp", "on")
        active(found)
        assert until(lambda: len(values) > 5)
        assert values[-1] == {"on": True}
        server.values["/on"] = False
        assert until(lambda: values[-1] == {"on": False})


def test_what_is_observed_is_issued_as_it_comes(thing_server: Start, living: LivingStage, tmp_path: Path) -> None:
    server = thing_server()
    server.values["/a"] = server.values["/b"] = False
    turns = iter(range(3))

    def stream(handler: BaseHTTPRequestHandler) -> None:
        handler.send_response(200)
        handler.send_header("Content-Type", "text/event-stream")
        handler.end_headers()
        handler.wfile.write(b"data: true\n\n")
        server.released.wait(60.0)

    def poll(handler: BaseHTTPRequestHandler) -> None:
        turn = next(turns, None)
        if turn is None:
            server.released.wait(60.0)
        reply(handler, json.dumps(bool(turn)).encode())

    server.answers.update({"/a/changes": stream, "/b/changes": poll})
    description = server.describe(
        properties={
            name: {
                **SWITCH,
                "readOnly": True,
                "forms": [{"href": name}, {"href": f"{name}/changes", "op": "observeproperty", "subprotocol": how}],
            }
            for name, how in (("a", "sse"), ("b", "longpoll"))
        }
    )
    with bridging(living, tmp_path / "ads", written(tmp_path, description)) as found:
        a, b = found.heard("lamp", "a"), found.heard("lamp", "b")
        active(found)
        assert until(lambda: a[-1:] == [{"on": True}] and b[-1:] == [{"on": True}])


def test_what_changes_before_the_thing_tells_of_changes_is_not_missed(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    server = thing_server()
    server.values["/on"] = False
    streams: list[int] = []

    def stream(handler: BaseHTTPRequestHandler) -> None:
        streams.append(1)
        server.values["/on"] = len(streams) == 1
        handler.send_response(200)
        handler.send_header("Content-Type", "text/event-stream")
        handler.send_header("Connection", "close")
        handler.end_headers()
        server.released.wait(0.5 if len(streams) == 1 else 60.0)
        handler.close_connection = True

    server.answers["/on/changes"] = stream
    forms = [{"href": "on"}, {"href": "on/changes", "op": "observeproperty", "subprotocol": "sse"}]
    description = server.describe(properties={"on": {**SWITCH, "readOnly": True, "forms": forms}})
    with bridging(living, tmp_path / "ads", written(tmp_path, description)) as found:
        values = found.heard("lamp", "on")
        active(found)
        assert until(lambda: len(values) == 3)
    assert [value["on"] for value in values] == [False, True, False]


def test_what_changes_between_two_long_polls_is_not_missed(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    server = thing_server()
    server.values["/on"] = False
    turns = itertools.count()

    def changes(handler: BaseHTTPRequestHandler) -> None:
        if next(turns):
            server.released.wait(60.0)
        reply(handler, b"true")  # and by the next request it has changed back

    server.answers["/on/changes"] = changes
    forms = [{"href": "on"}, {"href": "on/changes", "op": "observeproperty", "subprotocol": "longpoll"}]
    description = server.describe(properties={"on": {**SWITCH, "readOnly": True, "forms": forms}})
    with bridging(living, tmp_path / "ads", written(tmp_path, description)) as found:
        values = found.heard("lamp", "on")
        active(found)
        assert until(lambda: values[-2:] == [{"on": True}, {"on": False}])


@pytest.mark.parametrize("how", ["sse", "longpoll"])
def test_a_connection_that_is_cut_while_a_thing_is_followed_is_made_anew(
    thing_server: Start, living: LivingStage, tmp_path: Path, how: str
) -> None:
    server = thing_server()
    server.values["/on"] = False
    turns = iter(range(3))

    def changes(handler: BaseHTTPRequestHandler) -> None:
        turn = next(turns, None)
        if turn in (0, 1):  # as what lies between cuts a connection on which nothing comes; aiohttp asks once more
            if how == "sse":
                handler.send_response(200)
                handler.send_header("Content-Type", "text/event-stream")
                handler.send_header("Transfer-Encoding", "chunked")
                handler.end_headers()
            server.released.wait(2 * AGAIN)
            handler.close_connection = True
        elif how == "sse":
            handler.send_response(200)
            handler.send_header("Content-Type", "text/event-stream")
            handler.end_headers()
            handler.wfile.write(b"data: true\n\n")
            server.released.wait(60.0)
        elif turn == 2:
            reply(handler, b"true")
        else:
            server.released.wait(60.0)

    server.answers["/on/changes"] = changes
    forms = [{"href": "on"}, {"href": "on/changes", "op": "observeproperty", "subprotocol": how}]
    description = server.describe(properties={"on": {**SWITCH, "readOnly": True, "forms": forms}})
    with bridging(living, tmp_path / "ads", written(tmp_path, description)) as found:
        values = found.heard("lamp", "on")
        active(found)
        assert until(lambda: values[-1:] == [{"on": True}])
        assert found.causes() == []


def test_a_signal_writes_a_property_and_calls_an_action(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    server = thing_server()
    server.values["/on"] = False
    description = server.describe(actions={"blink": {"@type": "rob:Switch", "forms": [{"href": "blink"}]}})
    with bridging(living, tmp_path / "ads", written(tmp_path, description)) as found:
        source = button(living)
        active(found, on=WIRE, blink=WIRE)
        source.emit("on", {"on": True})
        assert until(lambda: server.sent("PUT") and server.sent("POST"))
    assert server.values["/on"] is True
    assert server.sent("POST") == [b""]


def test_a_thing_is_not_to_blame_for_a_signal_that_cannot_be_sent_to_it(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    server = thing_server()
    server.values["/on"] = False
    show = {"@type": "rob:Switch", "forms": [{"href": "show", "contentType": "application/octet-stream"}]}
    description = server.describe(actions={"show": {**show, "input": {"type": "object"}}})
    with bridging(living, tmp_path / "ads", written(tmp_path, description)) as found:
        source = button(living)
        active(found, on=WIRE, show=WIRE)
        source.emit("on", {"on": True})
        assert until(lambda: server.sent("PUT"))
        assert until(lambda: found.complained("what button issues is not sent to 'show': "))
        assert found.causes() == []
    assert server.sent("POST") == []


def test_each_input_that_takes_no_signal_of_a_source_is_named_once(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    server = thing_server()
    server.values["/on"] = False
    show = {"@type": "rob:Switch", "input": {"type": "object"}}
    actions = {
        name: {**show, "forms": [{"href": name, "contentType": "application/octet-stream"}]}
        for name in ("show", "tell")
    }
    with bridging(living, tmp_path / "ads", written(tmp_path, server.describe(actions=actions))) as found:
        source = button(living)
        active(found, on=WIRE, show=WIRE, tell=WIRE)
        for number in range(4):
            source.emit("on", {"on": bool(number % 2)})
            assert until(lambda most=number: len(server.sent("PUT")) == most + 1)
        assert until(lambda: all(found.complained(f"is not sent to {name!r}: ") for name in actions))
        said = [one for one in found.complaints if "is not sent to" in one]
        assert len(said) == 2, said


class Caller(Component):
    """Calls the action of the lamp."""

    def __init__(self) -> None:
        self.answers: list[Response] = []

    def ask(self, request: Any) -> Response:
        """What comes of a call."""
        known = len(self.answers)
        self.call("fade", request, answered=self.answers.append, seconds=PATIENCE)
        assert until(lambda: len(self.answers) > known)
        return self.answers[-1]


FADE = {
    "input": {"@type": "rob:Switch", "type": "boolean"},
    "output": {"@type": "rob:Temperature", "type": "number"},
    "forms": [{"href": "fade"}],
}


def calling(found: Bridged) -> Caller:
    """A component that may call the action of the lamp, both of them active."""
    living, name = found.stage, "fade()"
    switch, heat = f"sc:request <{ROB}Switch>", f"sc:response <{ROB}Temperature>"
    kind = living.advertised(
        Caller, f'<urn:c:caller> a sc:Component, :Caller ; sc:needsOperation [ sc:name "fade" ; {switch} ; {heat} ] .'
    )
    active(found, callers={name: (IRI("urn:c:caller"),)})
    caller = living.component(kind())
    held = living.call("urn:c:caller", "reserve", Reserve(1, living.supervisor, "task~1"))
    assert until(lambda: held)
    answers = living.apply("urn:c:caller", inputs={name: (Wire(IRI("urn:thing:lamp"), name),)})
    assert until(lambda: answers)
    assert answers[0].active, answers
    return caller


def test_a_call_that_cannot_be_sent_is_refused_and_no_failure_of_the_thing(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    server = thing_server()
    server.values["/on"] = False
    raw = {**FADE, "input": {"type": "object"}, "forms": [{"href": "fade", "contentType": "application/octet-stream"}]}
    with bridging(living, tmp_path / "ads", written(tmp_path, server.describe(actions={"fade": raw}))) as found:
        answer = calling(found).ask({"on": True})
        assert answer.detail.endswith("takes application/octet-stream, which cannot be made of a value of JSON")
        assert found.lives("lamp")
        assert found.causes() == []


def test_an_action_is_called_as_an_operation_and_each_way_to_fail_is_a_sentence(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    server = thing_server()
    server.values["/on"] = False
    server.posts["/fade"] = lambda handler: reply(handler, b"21.5")
    with bridging(living, tmp_path / "ads", written(tmp_path, server.describe(actions={"fade": FADE}))) as found:
        caller = calling(found)
        assert caller.ask({"on": True}).value == {"temperature": 21.5}
        assert server.sent("POST") == [b"true"]
        server.posts["/fade"] = lambda handler: reply(handler, b"too hot", 503)
        assert caller.ask({"on": True}).detail == f"POST {server.url}/fade answers 503"
        assert found.causes() == []
        server.posts["/fade"] = lambda handler: reply(handler, b"<html>", media="text/html")
        wrong = f"POST {server.url}/fade answers text/html, where application/json is expected"
        assert caller.ask({"on": True}).detail == wrong
        assert until(lambda: found.causes() == [wrong])


def test_a_flood_of_signals_costs_a_slow_thing_the_newest_alone(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    server = thing_server()
    server.values["/on"] = False
    description = server.describe()
    description["properties"]["on"]["writeOnly"] = True
    with bridging(living, tmp_path / "ads", written(tmp_path, description)) as found:
        source = button(living)
        active(found, on=WIRE)
        for number in range(3000):
            source.emit("on", {"on": number % 2 == 0})

        def ends_on() -> bool:
            source.emit("on", {"on": True})  # again and again: the network may drop any signal of a flood
            return server.sent("PUT")[-1:] == [b"true"]

        assert until(ends_on)
        assert len(server.sent("PUT")) < 1000
    assert found.causes() == []


def test_a_thing_that_ends_fails_by_its_sentence_and_lives_again_when_it_is_back(
    thing_server: Callable[[int], ThingServer], living: LivingStage, tmp_path: Path
) -> None:
    server = thing_server(0)
    server.values["/on"] = True
    with bridging(living, tmp_path / "ads", written(tmp_path, server.describe())) as found:
        active(found)
        server.close()
        assert until(lambda: found.causes())
        assert found.causes()[0].startswith(f"GET {server.url}/on does not answer")
        assert until(lambda: not found.lives("lamp"))
        again = thing_server(server.port)
        again.values["/on"] = True
        assert until(lambda: found.lives("lamp"))
        values = found.heard("lamp", "on")
        active(found)
        assert until(lambda: values)


def test_a_thing_that_answers_html_fails_and_disturbs_no_other(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    good, bad = thing_server(), thing_server()
    good.values["/on"] = bad.values["/on"] = True
    source = written(tmp_path, good.describe("fine"), bad.describe("lamp"))
    with bridging(living, tmp_path / "ads", source) as found:
        active(found)
        assert until(lambda: found.lives("fine"))
        values = found.heard("fine", "on")
        answers = living.apply("urn:thing:fine")
        assert until(lambda: answers and values)
        bad.answers["/on"] = lambda handler: reply(handler, b"<html>", media="text/html")
        assert until(lambda: found.causes())
        assert "answers text/html, where application/json is expected" in found.causes()[0]
        before = len(values)
        assert until(lambda: len(values) > before + 5)
        assert found.lives("fine")


def test_a_value_that_is_not_of_its_signal_type_is_blamed_on_the_thing(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    server = thing_server()
    server.values["/on"] = True
    with bridging(living, tmp_path / "ads", written(tmp_path, server.describe())) as found:
        active(found)
        server.values["/on"] = "maybe"
        assert until(lambda: found.causes())
        assert "what it emits on 'on'" in found.causes()[0]


def test_so_is_a_value_that_is_not_of_a_type_of_further_ontologies(
    thing_server: Start, living: LivingStage, tmp_path: Path
) -> None:
    server, ontology = thing_server(), tmp_path / "own.ttl"
    ontology.write_text(
        f"@prefix rob: <{ROB}> . @prefix xsd: <http://www.w3.org/2001/XMLSchema#> .\n"
        '<urn:x:Level> rob:field ( [ rob:fieldName "litres" ; rob:datatype xsd:double ] ) .'
    )
    server.values["/on"] = 2.5
    level = {"on": {"@type": "urn:x:Level", "type": "number", "forms": [{"href": "on"}]}}
    source, settings = written(tmp_path, server.describe(properties=level)), replace(HASTY, ontologies=(ontology,))
    with bridging(living, tmp_path / "ads", source, settings=settings) as found:
        values = found.heard("lamp", "on")
        active(found)
        assert until(lambda: {"litres": 2.5} in values)
        server.values["/on"] = "full"
        assert until(lambda: found.causes())
        assert "what it emits on 'on' has 'full' as 'litres'" in found.causes()[0]

"""The values in messages: those of each kind are read as they were written, and what is none is refused."""

from __future__ import annotations

import json

import pytest
from hypothesis import given

from selfconf.errors import PeerError
from selfconf.model.configuration import Wants
from selfconf.model.profile import LONGEST_PORT_NAME
from selfconf.model.term import IRI, Term
from selfconf.model.wording import one_line
from selfconf.protocol.codec import KINDS, decode, encode
from selfconf.protocol.json_values import MOST_DIMENSIONS, decode_term, encode_term
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import (
    Apply,
    Fail,
    Notice,
    Release,
    Reserve,
    Stamp,
    Status,
    TaskRecord,
    Wire,
)
from tests.protocol import strategies


@given(strategies.terms)
def test_every_term_is_read_as_it_was_written(term: Term) -> None:
    again = decode_term(json.loads(json.dumps(encode_term(term))))
    assert again == term
    assert type(again) is type(term)


def test_a_number_that_no_float_holds_is_refused() -> None:
    body = json.loads(encode(Stamp(IRI("urn:a"), "l", 1, 0.0)))
    with pytest.raises(PeerError, match="number"):
        decode(json.dumps({**body, "time": 10**400}).encode(), Stamp)


@pytest.mark.parametrize(
    "encoding",
    [[], {"shape": [-1]}, {"shape": 3}, {"shape": [1.5]}, {"shape": [1] * (MOST_DIMENSIONS + 1)}, {"media": 1}],
)
def test_what_is_no_encoding_is_refused(encoding: object) -> None:
    body = json.loads(encode(Stamp(IRI("urn:a"), "l", 1, 0.0)))
    with pytest.raises(PeerError):
        decode(json.dumps({**body, "encoding": encoding}).encode(), Stamp)


@pytest.mark.parametrize("lonely", ["\ud800", "a\udfff"])
def test_half_a_surrogate_pair_is_no_text(lonely: str) -> None:
    body = json.loads(encode(Release(1, "s")))
    with pytest.raises(PeerError, match="text"):
        decode(json.dumps({**body, "supervisor": lonely}).encode(), Release)


@pytest.mark.parametrize("name", ["", "x" * (LONGEST_PORT_NAME + 3)])
def test_a_port_without_a_name_or_with_a_very_long_one_is_refused_for_there_is_no_key_for_it(name: str) -> None:
    supervisor = Keys("home").configurator_life("c", "1")
    for inputs in ({name: (Wire(IRI("urn:a"), "pose"),)}, {"position": (Wire(IRI("urn:a"), name),)}):
        for kind in (Reserve, Apply):
            with pytest.raises(PeerError, match="name"):
                decode(encode(kind(1, supervisor, inputs=inputs)), kind)


@pytest.mark.parametrize("period", ["0", "-1", "NaN", "Infinity"])
def test_a_promise_is_a_pause_that_one_can_wait_for(period: str) -> None:
    good = encode(Apply(1, "s", inputs={"position": (Wire(IRI("urn:a"), "pose", 8.5),)}))
    with pytest.raises(PeerError, match="period"):
        decode(good.replace(b"8.5", period.encode()), Apply)


@pytest.mark.parametrize("beginning", ["NaN", "Infinity", "-Infinity"])
def test_a_task_begins_at_a_moment_for_tasks_are_served_in_that_order(beginning: str) -> None:
    good = encode(Reserve(1, "s", "t~1", beginning=8.5))
    with pytest.raises(PeerError, match="finite"):
        decode(good.replace(b"8.5", beginning.encode()), Reserve)


@pytest.mark.parametrize("number", ["NaN", "-Infinity", "1e999", f"1{400 * '0'}"])
def test_what_is_handed_on_to_observers_holds_no_number_beyond_any_double(number: str) -> None:
    good = encode(Notice("c", 1, "t~1", {"act": "lost", "time": 8.5}))
    with pytest.raises(PeerError, match="finite"):
        decode(good.replace(b"8.5", number.encode()), Notice)


@pytest.mark.parametrize("text", ["a\nLOST b", "\x1b[2J", "\u202egnp.exe"])
def test_what_people_read_stands_on_one_line_and_what_names_something_has_no_controls(text: str) -> None:
    fail = {"kind": "fail", "component": "urn:a", "life": "1", "epoch": 1}
    said = decode(json.dumps({**fail, "detail": text}).encode(), Fail).detail
    assert said == one_line(text)
    for name in ("component", "life", "task"):
        with pytest.raises(PeerError, match="holds control characters"):
            decode(json.dumps({**fail, name: text}).encode(), Fail)


def test_what_is_no_cause_is_quoted_in_part() -> None:
    fail = {"kind": "fail", "component": "urn:a", "life": "1", "epoch": 1, "cause": "x" * 100_000}
    with pytest.raises(PeerError) as raised:
        decode(json.dumps(fail).encode(), Fail)
    assert len(str(raised.value)) < 200


@pytest.mark.parametrize(
    "task", ["", "a", "../../a~1", "a/b~1", "a~", "~1", "a~../1", ".a~1", f"{'a' * 65}~1", "a~1\n"]
)
def test_a_task_that_sites_keep_is_named_like_a_file(task: str) -> None:
    with pytest.raises(PeerError):
        decode(json.dumps({"kind": "task", "task": task, "revision": 1}).encode(), TaskRecord)


@pytest.mark.parametrize("number", [1 << 63, -(1 << 63) - 1, 10**4000])
def test_whole_numbers_have_64_bits(number: int) -> None:
    for kind, name in ((TaskRecord, "revision"), (Fail, "epoch")):
        body = {"kind": KINDS[kind], "task": "a~1", "revision": 1, "component": "urn:a", "life": "", "epoch": 1}
        assert decode(json.dumps(body).encode(), kind)
        with pytest.raises(PeerError, match="64 bits"):
            decode(json.dumps({**body, name: number}).encode(), kind)


@pytest.mark.parametrize("value", ['{"message": "\\ud800"}', '{"\\ud800": 1}', '{"cost": [NaN]}', '{"cost": Infinity}'])
def test_what_is_handed_on_as_it_is_can_be_written_again(value: str) -> None:
    whole = json.loads(encode(Notice("c1", 1, "t~1", {})))
    assert decode(json.dumps(whole | {"event": {"message": "ok"}}).encode(), Notice)
    payload = json.dumps(whole | {"event": "HERE"}).replace('"HERE"', value).encode()
    with pytest.raises(PeerError, match="whole characters"):
        decode(payload, Notice)


@pytest.mark.parametrize(
    "wants",
    [[], {"inputs": 1}, {"inputs": [["in", "urn:eye"]]}, {"inputs": [["", "urn:eye", "o"]]}, {"values": {"a": 1}}],
)
def test_what_is_wanted_of_a_component_are_inputs_and_values(wants: object) -> None:
    body = json.loads(encode(Status("c1", "running", IRI("urn:t"), 1, 0.0)))
    with pytest.raises(PeerError):
        decode(json.dumps({**body, "wants": {"urn:lamp": wants}}).encode(), Status)
    assert decode(json.dumps({**body, "wants": {"urn:lamp": {}}}).encode(), Status).wants == {"urn:lamp": Wants()}

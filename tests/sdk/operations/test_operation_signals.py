"""Requests and answers as signals: what is written is read again, and what is none, or too large, is refused."""

from __future__ import annotations

from typing import Any

import pytest

from selfconf.errors import PeerError
from selfconf.model.profile import needed_operation, offered_operation
from selfconf.model.signal_fields import SignalField, SignalFields
from selfconf.model.term import IRI, XSD_NAMESPACE
from selfconf.sdk.operations.operation_signals import (
    MOST_PAYLOAD,
    NotOfItsTypeError,
    OperationSignals,
    operation_fields,
    read_request,
    read_signal,
)
from selfconf.sdk.payloads import UnsayableError

ALBUM, GOAL, IMAGE = IRI("urn:c:album"), IRI("urn:c:Goal"), IRI("urn:c:Image")
FIELDS = SignalFields(GOAL, (SignalField("x", IRI(XSD_NAMESPACE + "double")),))


@pytest.mark.parametrize("value", [None, {"x": 1.5}, "line\nfeed", b"\n\x00\n", ["ü"]])
def test_a_request_is_read_as_it_was_written(value: Any) -> None:
    life, signal = read_request(OperationSignals(ALBUM, "7").request(value, None, ""))
    assert (life, signal.source, signal.value, signal.sequence) == ("7", ALBUM, value, 1)


def test_requests_and_answers_of_one_component_are_numbered_together() -> None:
    signals = OperationSignals(ALBUM, "7")
    _, first = read_request(signals.request(1, None, ""))
    payload, stamp = signals.write(2, None)
    _, second = read_signal(stamp, payload)
    assert (first.sequence, second.sequence) == (1, 2)


def test_the_media_type_of_bytes_travels_with_them() -> None:
    _, signal = read_request(OperationSignals(ALBUM, "7").request(b"GIF", None, "image/gif"))
    assert (signal.value, signal.media) == (b"GIF", "image/gif")


@pytest.mark.parametrize("text", [b"", b"{}", b"no stamp", b"{}\n{}", b"\n1"])
def test_what_has_no_stamp_is_no_request(text: bytes) -> None:
    with pytest.raises((PeerError, ValueError)):
        read_request(text)


def test_what_is_too_large_is_neither_written_nor_read() -> None:
    signals = OperationSignals(ALBUM, "7")
    with pytest.raises(UnsayableError, match="are allowed"):
        signals.request(b"x" * (MOST_PAYLOAD + 1), None, "")
    largest = signals.request(b"x" * MOST_PAYLOAD, None, "")
    assert read_request(largest)[1].value == b"x" * MOST_PAYLOAD
    with pytest.raises(PeerError, match="too large"):
        read_request(largest + b"x")


def test_a_value_that_is_not_of_its_type_is_told_from_one_that_nothing_can_carry() -> None:
    signals = OperationSignals(ALBUM, "7")
    with pytest.raises(NotOfItsTypeError):
        signals.request({"x": "far"}, FIELDS, "")
    with pytest.raises(UnsayableError) as nothing_can:
        signals.request(object(), None, "")
    assert not isinstance(nothing_can.value, NotOfItsTypeError)


def test_fields_are_known_by_the_names_of_operations_as_far_as_their_types_have_some() -> None:
    operations = (needed_operation("go", GOAL, IMAGE), offered_operation("stop", None, None))
    found = operation_fields(operations, {GOAL: FIELDS})
    assert {name: (one.request, one.response) for name, one in found.items()} == {
        "go": (FIELDS, None),
        "stop": (None, None),
    }

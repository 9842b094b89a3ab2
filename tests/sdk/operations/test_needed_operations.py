"""A component calls an operation of a peer that does what no component of this library would."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from selfconf.bus.port import Request
from selfconf.protocol.stamps import StampWriter
from selfconf.sdk.component import CallStatus
from selfconf.sdk.operations import MOST_CALLS, MOST_PAYLOAD
from tests.sdk.operations.photographs import (
    ALBUM,
    CALLING,
    CAMERA,
    Peer,
)
from tests.sdk.stage import apply, release


def replying(payload: bytes, attachment: bytes) -> Callable[[Request], None]:
    """A peer that replies something."""

    def reply(request: Request) -> None:
        request.reply(request.key, payload, attachment)
        request.finish()

    return reply


def test_an_answer_that_does_not_come_is_late() -> None:
    answer = Peer(lambda request: None).answer()
    assert (answer.status, answer.detail) == (CallStatus.LATE, "camera has not answered within 1 s")


def test_a_component_that_ends_with_the_request_in_its_hands_is_gone() -> None:
    answer = Peer(lambda request: request.finish()).answer()
    assert (answer.status, answer.detail) == (CallStatus.GONE, "camera ended before it answered")


@pytest.mark.parametrize(
    ("payload", "attachment", "detail"),
    [
        (b"{", StampWriter(CAMERA, "1").write(1, 0.0), "what it answers is no answer: "),
        (b"{}", b"{}", "what it answers is no answer: not a message of kind 'stamp'"),
        (bytes(MOST_PAYLOAD + 1), b"", f"its answer has {MOST_PAYLOAD + 1} bytes, and {MOST_PAYLOAD} are allowed"),
        (b"{}", StampWriter(ALBUM, "1").write(1, 0.0), "what it answers is no answer: it is one of album"),
    ],
)
def test_what_is_no_answer_is_a_refusal(payload: bytes, attachment: bytes, detail: str) -> None:
    answer = Peer(replying(payload, attachment)).answer()
    assert answer.status is CallStatus.REFUSED
    assert answer.detail.startswith(detail)


def test_a_component_that_was_stopped_hears_no_answer() -> None:
    peer = Peer(lambda request: None)
    peer.album.ask(seconds=1.0)
    peer.stage.call(release())
    peer.stage.call(apply(2, inputs=CALLING))
    peer.stage.let_pass(2.0)
    assert peer.album.answers == []


def test_a_component_that_has_rested_hears_no_answer_to_what_it_asked_before() -> None:
    peer = Peer(lambda request: None)
    peer.album.ask(seconds=1.0)
    peer.stage.call(apply(2, inputs=CALLING, rests=True))
    peer.stage.let_pass(0.1)
    peer.stage.call(apply(2, inputs=CALLING))
    peer.stage.let_pass(2.0)
    assert peer.album.answers == []
    peer.album.ask(seconds=1.0)
    peer.stage.let_pass(2.0)
    assert len(peer.album.answers) == 1


def test_a_component_that_has_rested_is_told_again_what_is_connected() -> None:
    peer = Peer(lambda request: None)
    peer.stage.call(apply(2, inputs=CALLING, rests=True))
    peer.stage.let_pass(0.1)
    assert peer.album.told == ["photo is connected"]
    peer.stage.call(apply(2, inputs=CALLING))
    peer.stage.let_pass(0.1)
    assert peer.album.told == ["photo is connected"] * 2


def test_a_component_at_rest_is_told_what_is_connected_once_it_starts_again() -> None:
    peer = Peer(lambda request: None)
    peer.stage.call(apply(2, inputs=CALLING, rests=True))
    peer.stage.call(apply(2, inputs={}, rests=True))
    peer.stage.call(apply(2, inputs=CALLING, rests=True))
    peer.stage.let_pass(0.1)
    assert peer.album.told == ["photo is connected"]
    peer.stage.call(apply(2, inputs=CALLING))
    peer.stage.let_pass(0.1)
    assert peer.album.told == ["photo is connected"] * 2


def test_a_component_that_starts_again_while_something_is_connected_is_told_once() -> None:
    peer = Peer(lambda request: None)
    peer.stage.call(apply(2, inputs={}, rests=True))
    peer.stage.runtime.component.started = lambda: peer.stage.runtime.needed_operations.follow(apply(2, inputs=CALLING))
    peer.stage.call(apply(2, inputs={}))
    peer.stage.let_pass(0.1)
    assert peer.album.told == ["photo is connected", "photo is not connected", "photo is connected"]


def test_a_component_that_calls_and_calls_is_told_to_wait() -> None:
    peer = Peer(lambda request: None)
    for _ in range(MOST_CALLS + 1):
        peer.album.ask()
    peer.stage.let_pass(0.5)
    (answer,) = peer.album.answers
    assert (answer.status, answer.detail) == (CallStatus.REFUSED, "64 calls wait for their answers already")

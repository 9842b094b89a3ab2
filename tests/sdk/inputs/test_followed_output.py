"""Signals wait while the code has no time for them: how many, and which of them are not delivered any more."""

from __future__ import annotations

import itertools
from dataclasses import replace
from typing import Any

import pytest

from selfconf.bus.memory import Network
from selfconf.bus.port import Replies, Sample, Urgency
from selfconf.model.profile import Input, Ports
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Stamp
from selfconf.sdk.code_thread import CodeThread
from selfconf.sdk.inputs import Inputs
from selfconf.sdk.inputs.followed_output import JUST_COME, FollowedOutput
from selfconf.sdk.inputs.signal_input import InputEvents
from selfconf.sdk.inputs.signal_queue import EVENTS, SignalQueue
from tests.sdk.stage import (
    CAP_PROFILE,
    KEYS,
    TRACKER,
    apply,
    follow,
)


class Slow:
    """An input that follows one output, and a component whose code has no time until `poll` of its thread."""

    def __init__(self, period: float | None = None, depth: int | None = None) -> None:
        self.network, self.code = Network(), CodeThread(inline=False)
        self.heard: list[Any] = []
        self.unfed: list[str] = []
        profile = replace(CAP_PROFILE, ports=Ports((Input("position", (IRI("urn:s:Pose"),), depth),)))
        events = InputEvents(lambda port, signal: self.heard.append(signal.value), lambda *_: None, self.unfed.append)
        self.inputs = Inputs(self.network.node(), KEYS, self.code, profile, events)
        self.inputs.follow(follow(period=period))
        self._source = self.network.node().publisher(KEYS.output(TRACKER, "pose"), Urgency.SIGNAL)
        self._numbers = itertools.count(1)

    def issue(self, count: int) -> None:
        """Signals come, numbered from 1."""
        for number in itertools.islice(self._numbers, count):
            self._source.put(b"%d" % number, encode(Stamp(TRACKER, "l", number, 0.0)))
        self.network.run(lambda: False, 0.1)


def test_of_an_output_with_a_rate_a_slow_component_gets_the_newest_signal() -> None:
    slow = Slow(period=0.1)
    slow.issue(100)
    slow.code.poll()
    assert slow.heard == [100]
    slow.issue(5)
    slow.code.poll()
    assert slow.heard == [100, 105]


def test_of_an_output_without_a_rate_a_slow_component_gets_every_signal_up_to_a_bound() -> None:
    slow = Slow()
    slow.issue(EVENTS)
    slow.code.poll()
    assert slow.heard == [*range(1, EVENTS + 1)]
    slow.heard.clear()
    slow.issue(EVENTS + 7)
    slow.code.poll()
    assert slow.heard == [*range(EVENTS + 8, 2 * EVENTS + 8)]


@pytest.mark.parametrize("period", [None, 0.1])
def test_an_input_may_say_itself_how_many_signals_wait(period: float | None) -> None:
    slow = Slow(period, depth=3)
    slow.issue(10)
    slow.code.poll()
    assert slow.heard == [8, 9, 10]


def test_what_is_dropped_is_counted() -> None:
    slow = Slow(depth=3)
    slow.issue(10)
    assert slow.inputs.dropped == 7
    slow.inputs.end()
    assert slow.inputs.dropped == 7


def test_what_waits_when_an_input_is_connected_to_something_else_is_not_delivered_any_more() -> None:
    slow = Slow()
    slow.issue(10)
    slow.inputs.follow(apply(2))
    slow.code.poll()
    assert slow.heard == []


def test_what_waits_when_an_output_is_lost_is_not_delivered_after_its_loss_and_feeds_nothing() -> None:
    """A slow component acts on what has come since it was unfed, not on what its dead source had said before."""
    slow = Slow()
    leave = slow.network.node().announce(KEYS.life(TRACKER, "l"))
    slow.issue(10)
    leave()
    slow.network.run(lambda: False, 0.1)
    slow.code.poll()
    assert (slow.unfed, slow.heard) == (["position"], [])
    slow.issue(1)
    slow.code.poll()
    assert slow.heard == [11]


class Heard:
    """An output that an input follows, with a clock that is set by hand."""

    def __init__(self) -> None:
        self.now, self.waits = 5.0, 0
        self.output = FollowedOutput(lambda: self.now, SignalQueue(None), self._wait)

    def _wait(self) -> None:
        self.waits += 1

    def receive(self, sequence: int, life: str = "l") -> None:
        """A signal comes."""
        self.output.receive(Sample("", b"%d" % sequence, encode(Stamp(TRACKER, life, sequence, 0.0))))


@pytest.mark.parametrize("lost", [False, True])
def test_a_last_signal_that_was_delivered_takes_no_room_unless_the_output_was_lost(lost: bool) -> None:
    heard = Heard()
    heard.output.muted, heard.output.order.newest, heard.output.lost = False, Stamp(TRACKER, "l", 2, 0.0), lost
    heard.now = 6.0
    heard.output.receive_again(Replies((Sample("", b"2", encode(Stamp(TRACKER, "l", 2, 0.0))),)))
    assert (heard.waits, heard.output.heard_at) == (int(lost), 6.0)


def test_of_what_comes_while_it_is_muted_the_newest_is_delivered_if_it_has_only_just_come() -> None:
    for passed, delivered in ((JUST_COME / 2, b"2"), (2 * JUST_COME, None)):
        heard = Heard()
        heard.receive(1)
        heard.receive(2)
        assert (heard.output.pop(), heard.waits) == (None, 0)
        heard.now += passed
        assert heard.output.unmute() == (delivered is not None)
        heard.output.deliver()
        sample = heard.output.pop()
        assert (sample.payload if sample is not None else None) == delivered
        assert heard.waits == (delivered is not None)


def test_the_life_that_is_heard_is_that_of_the_newest_signal_though_it_was_not_read_yet() -> None:
    heard = Heard()
    assert heard.output.heard_life == ""
    heard.receive(9, "before")
    heard.receive(1, "after")
    assert heard.output.heard_life == "after"


def test_what_cannot_be_read_is_no_sign_that_it_issues_and_is_complained_of_once() -> None:
    heard = Heard()
    heard.receive(1)
    heard.output.understood()
    for complained in (True, False):
        heard.now += 1.0
        heard.receive(2)
        assert heard.output.not_understood() == complained
        assert heard.output.heard_at == 5.0
    heard.receive(3)
    heard.output.understood()
    assert heard.output.heard_at == heard.now

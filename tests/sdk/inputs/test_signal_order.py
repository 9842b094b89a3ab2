"""Signals are news by the life of their source and their number in it, and nothing is news twice."""

from __future__ import annotations

import pytest

from selfconf.model.term import IRI
from selfconf.protocol.messages import Stamp
from selfconf.sdk.inputs.signal_order import LATE, NONE, SignalNumber, SignalOrder


def stamp(sequence: int, life: str = "t") -> Stamp:
    """The stamp of a signal of a life."""
    return Stamp(IRI("urn:tracker"), life, sequence, 0.0)


def order(newest: int = 5) -> SignalOrder:
    """The order of an output of which some signals were delivered."""
    made = SignalOrder()
    made.newest = SignalNumber("t", newest)
    return made


@pytest.mark.parametrize(
    ("signal", "old"),
    [
        (stamp(5), True),
        (stamp(4), True),
        (stamp(6), False),
        (stamp(1, "u"), False),
        (stamp(5 - LATE), False),  # the number of the newest was none of its source's
    ],
)
def test_what_is_late_or_doubled_is_old_and_a_new_life_counts_anew(signal: Stamp, old: bool) -> None:
    assert order().is_old(signal, lost=False) is old


def test_before_the_first_signal_nothing_is_old() -> None:
    assert not SignalOrder().is_old(stamp(1), lost=False)
    assert not SignalOrder().is_in_question


def test_what_a_lost_output_says_again_is_news_though_it_was_delivered() -> None:
    known = order()
    known.said_again = SignalNumber("t", 5)
    assert known.is_old(stamp(5), lost=False)
    assert not known.is_old(stamp(5), lost=True)
    assert known.is_old(stamp(4), lost=True)


def test_what_was_issued_before_a_failure_is_over_however_late_it_comes() -> None:
    known = order()
    known.over = SignalNumber("t", 7)
    known.said_again = SignalNumber("t", 7)
    assert known.is_in_question
    assert known.is_over(stamp(7))
    assert known.is_over(stamp(6))
    assert known.is_old(stamp(7), lost=True), "what it had said is over with it"
    assert not known.is_over(stamp(8))
    assert not known.is_over(stamp(1, "u"))


@pytest.mark.parametrize(
    ("signal", "living", "doubted"),
    [
        (stamp(5), (), True),
        (stamp(5 - LATE), (), True),  # the component has other outputs, which issue more
        (stamp(6), (), False),
        (stamp(1, "u"), (), True),
        (stamp(1, "u"), ("u",), False),
    ],
)
def test_a_doubt_is_settled_by_what_is_newer(signal: Stamp, living: tuple[str, ...], doubted: bool) -> None:
    known = order()
    known.doubted = SignalNumber("t", 5)
    assert known.is_in_question
    known.settle(signal, living.__contains__)
    assert (known.doubted is not None) is doubted


@pytest.mark.parametrize(
    ("last", "past"),
    [
        (SignalNumber("t", 4), True),
        (SignalNumber("t", 5), False),
        (SignalNumber("t", 6), False),
        (SignalNumber("t", 5 + LATE), False),  # the component has other outputs, which issue more
        (SignalNumber("u", 4), False),
        (SignalNumber("t", 0), False),
    ],
)
def test_what_was_delivered_is_past_an_end_before_it(last: SignalNumber, past: bool) -> None:
    assert order().is_past(last) is past


def test_no_signal_covers_none() -> None:
    assert not NONE.covers(stamp(1))

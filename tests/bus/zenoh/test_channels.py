"""Channels of Zenoh as they are read: many at a time, and asked whether they have ended."""

from __future__ import annotations

from typing import Any

import pytest
import zenoh
from zenoh.handlers import Callback

from selfconf.bus.zenoh.channels import READ_TOGETHER, at_hand, each, may_be_many, read_together


class Channel:
    """A channel with something in it, that has ended or not."""

    def __init__(self, content: int, ended: bool = False) -> None:
        self.content, self.ended = list(range(content)), ended

    def try_recv(self) -> int | None:
        """The next of what is there."""
        if self.content:
            return self.content.pop(0)
        if self.ended:
            raise zenoh.ZError("the channel is empty and has ended")
        return None

    recv = try_recv


@pytest.mark.parametrize("ended", [False, True], ids=["goes on", "has ended"])
def test_what_is_at_hand_says_whether_more_may_come(ended: bool) -> None:
    assert at_hand(Channel(3, ended)) == ([0, 1, 2], not ended)
    assert at_hand(Channel(0, ended)) == ([], not ended)


def test_of_very_many_the_first_are_at_hand_and_whether_more_may_come_is_not_known() -> None:
    some, goes_on = at_hand(Channel(READ_TOGETHER + 1))
    assert (len(some), goes_on) == (READ_TOGETHER, False)


def test_what_is_received_is_handed_over_together_and_nothing_is_the_end() -> None:
    channel = Channel(READ_TOGETHER + 1, ended=True)
    assert [len(read_together(channel)) for _ in range(3)] == [READ_TOGETHER, 1, 0]


def test_a_callback_is_called_for_each_and_for_the_end() -> None:
    taken: list[Any] = []
    callback = each(taken.append, lambda: taken.append("the end"))
    assert isinstance(callback, Callback)
    callback("one")
    callback.drop()
    assert taken == [("one",), "the end"]


@pytest.mark.parametrize(("key", "many"), [("a/b/live/*", False), ("a/*/live/*", True), ("a/**", True)])
def test_under_a_key_of_several_components_there_may_be_many(key: str, many: bool) -> None:
    assert may_be_many(key) is many

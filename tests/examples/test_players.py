"""The processes of the examples: what they need, and what becomes of one that ends too soon."""

from __future__ import annotations

import time

import pytest

from examples import players
from examples.players import PATIENCE, Player, need


def test_what_is_to_be_installed_is_said_in_one_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(players, "find_spec", lambda module: None if module in ("numpy", "rosbags") else object())
    need("aiohttp")
    with pytest.raises(SystemExit, match=r"needs numpy, rosbags; type in the checkout: pip install numpy '\.\[ros2\]'"):
        need("aiohttp", "numpy", "rosbags")


@pytest.mark.process
def test_a_process_that_has_ended_is_not_waited_for() -> None:
    began = time.monotonic()
    player = Player("-c", "print('here')\nraise SystemExit('out of paper')")
    assert player.says("paper") == "out of paper"
    with pytest.raises(SystemExit, match="has ended before it said 'there'"):
        player.says("there")
    assert time.monotonic() - began < PATIENCE / 2

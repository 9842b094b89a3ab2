"""Chance."""

from __future__ import annotations

import pytest

pytest.importorskip("numpy", reason="the world needs numpy: install the extra sim")

from sim.physics.noise import stream


def test_a_stream_is_determined_by_seed_and_consumer() -> None:
    assert stream(1, "sonar").random() == stream(1, "sonar").random()
    assert stream(1, "sonar").random() != stream(2, "sonar").random()
    assert stream(1, "sonar").random() != stream(1, "stereo").random()

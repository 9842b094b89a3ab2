"""How often a crashed program is started again, and how long it takes until then."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from selfconf.deployment.components.waking import WAKING
from selfconf.site.restart_limit import CRASH_WINDOW, FIRST_PAUSE, LONGEST_RESTART_PAUSE, PAUSE_FACTOR, RestartLimit


def test_the_first_pause_is_short_and_each_further_one_longer() -> None:
    limit = RestartLimit()
    pauses = []
    for now in range(3):
        limit.crashed(now)
        pauses.append(limit.pause(now, 3))
    assert pauses == pytest.approx([FIRST_PAUSE, FIRST_PAUSE * PAUSE_FACTOR, FIRST_PAUSE * PAUSE_FACTOR**2])


def test_a_pause_begins_with_the_crash() -> None:
    limit = RestartLimit()
    limit.crashed(1.0)
    limit.crashed(2.0)
    assert limit.pause(2.25, 3) == pytest.approx(FIRST_PAUSE * PAUSE_FACTOR - 0.25)
    assert limit.pause(10.0, 3) == 0.0


def test_a_pause_is_no_longer_than_a_configurator_waits_however_many_crashes_are_allowed() -> None:
    limit = RestartLimit()
    for _ in range(2000):
        limit.crashed(0.0)
    assert limit.pause(0.0, 1_000_000) == LONGEST_RESTART_PAUSE < WAKING


def test_a_crash_is_the_first_of_its_window() -> None:
    limit = RestartLimit()
    firsts = []
    for now in (0.0, 1.0, CRASH_WINDOW + 1.0):
        limit.crashed(now)
        firsts.append(limit.first(now))
    assert firsts == [True, False, True]


def test_what_has_crashed_too_often_is_given_up_until_the_window_has_passed() -> None:
    limit = RestartLimit()
    for now in range(4):
        limit.crashed(now)
    assert limit.pause(3.0, 3) is None
    assert limit.wait(3.0, 3) == CRASH_WINDOW - 3.0
    assert limit.wait(CRASH_WINDOW, 3) == 0.0
    assert limit.pause(CRASH_WINDOW, 3) is not None


def test_what_is_not_to_be_started_again_is_not() -> None:
    limit = RestartLimit()
    assert limit.wait(0.0, 0) == 0.0
    assert limit.pause(0.0, 0) == FIRST_PAUSE, "it has not crashed"
    limit.crashed(1.0)
    assert limit.pause(1.0, 0) is None
    assert limit.wait(1.0, 0) == CRASH_WINDOW


@given(st.lists(st.floats(0.0, 30.0), max_size=40), st.integers(0, 5))
def test_it_is_never_started_again_more_often_than_said_within_the_window(gaps: list[float], restarts: int) -> None:
    limit, now, started = RestartLimit(), 0.0, []
    for gap in gaps:
        now += gap
        limit.crashed(now)
        assert (limit.pause(now, restarts) is None) == (limit.wait(now, restarts) > 0)
        if limit.pause(now, restarts) is not None:
            started.append(now)
        assert sum(one > now - CRASH_WINDOW for one in started) <= restarts

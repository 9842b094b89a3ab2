"""How long to wait before something that has failed is tried again."""

from __future__ import annotations

from selfconf.bus.growing_pause import WELL_AGAIN, GrowingPause


def test_a_pause_doubles_with_each_try_up_to_the_longest() -> None:
    pause = GrowingPause(5.0, 18.0)
    pauses = [pause.seconds]
    for _ in range(3):
        pause.tried()
        pauses.append(pause.seconds)
    assert pauses == [5.0, 10.0, 18.0, 18.0]


def test_a_pause_begins_anew_once_what_was_tried_has_been_well_for_a_while() -> None:
    pause = GrowingPause(5.0, 60.0)
    pause.tried()
    pause.failed_after(WELL_AGAIN - 1.0)
    assert pause.seconds == 10.0
    pause.failed_after(WELL_AGAIN + 1.0)
    assert pause.seconds == 5.0

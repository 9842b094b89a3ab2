"""A yardstick says how much slower than alone a machine is, and is never shorter than it is alone."""

from __future__ import annotations

import threading
import time

from tests.harness.yardstick import Yardstick


def test_where_no_work_was_done_meanwhile_nothing_is_excused() -> None:
    with Yardstick() as yardstick:
        assert yardstick.slower(0.0, 1.0) == 1.0


def test_work_that_has_to_wait_for_its_processor_says_how_much_longer_it_takes() -> None:
    """Threads of one process take turns, so that a second one that computes is a machine that is too busy."""
    over = threading.Event()

    def compute() -> None:
        while not over.is_set():
            pass

    other = threading.Thread(target=compute)
    began = time.time()
    with Yardstick() as yardstick:
        other.start()
        while yardstick.slower(began, time.time()) < 1.2:
            over.wait(0.01)
        over.set()
    other.join()

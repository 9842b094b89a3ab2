"""How long a search may take in seconds, and the best answer that a search has given when they are over.

The core has no clock. A budget of steps is its own; seconds are kept here, by an alarm in the main thread
(`selfconf.rdf.deadline`). It ends whatever is going on, and the last answer that the search has given remains. A call
of a solver that learns clauses hears no alarm, and may take seconds: another thread ends it, where it can be ended.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from typing import TypeVar

from selfconf.composition.composer import Composer
from selfconf.model.configuration import Configuration
from selfconf.model.optimum import Optimum
from selfconf.model.partition import Barred
from selfconf.model.refusal import Outcome, Undecided
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.deadline import RINGING, TimeUp, deadline
from selfconf.search.engines import end_calls

_Result = TypeVar("_Result")


class TimeLimit:
    """The time for one question, if it is limited: what is asked later has less of it."""

    def __init__(self, seconds: float | None) -> None:
        self.seconds = seconds
        self._ends = math.inf if seconds is None else time.monotonic() + seconds

    def within(self, ask: Callable[[], _Result], otherwise: _Result) -> _Result:
        """The answer to a question, or what holds without one when the time is up."""
        if self.seconds is None:
            return ask()
        left = self._ends - time.monotonic()
        try:
            if left > 0:
                with deadline(left), _calls_ended_after(left):
                    return ask()
        except TimeUp:
            return otherwise
        return otherwise


@contextmanager
def _calls_ended_after(seconds: float) -> Iterator[None]:
    """Have the calls of solvers end once the time of the block is up, by a thread that ends with it.

    In another thread than the main one the block has no limit, and its calls are left alone.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    left = threading.Event()

    def end_them() -> None:
        pause = seconds
        while not left.wait(pause):
            end_calls()
            pause = RINGING

    with suppress(RuntimeError):  # without a further thread the limit is kept later
        threading.Thread(target=end_them, daemon=True, name="time limit").start()
    try:
        yield
    finally:
        left.set()


def composed(
    composer: Composer,
    ecology: Mapping[IRI, Advertisement],
    left_out: frozenset[Barred],
    running: Configuration | None,
    limit: TimeLimit,
) -> Optimum | Outcome:
    """The best answer that the time allows. The partition is made first, and is not part of the search."""
    composer.partition(ecology)
    answers: list[Optimum | Outcome] = []

    def gather() -> bool:
        for answer in composer.answers(ecology, left_out, running):
            answers.append(answer)
        return True

    whole = limit.within(gather, False)
    if not whole and (not answers or isinstance(answers[-1], Undecided)):
        return Undecided(seconds=limit.seconds)
    return answers[-1]

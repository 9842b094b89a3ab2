"""How long a search may take: in steps, which mean the same on every machine, or in seconds.

The core has no clock. A step budget is its own; seconds are kept here, by an alarm in the one thread in which a command
works (`rdf.deadline`). It ends whatever is going on, and the last answer that the search has told of remains.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Callable, Mapping
from typing import TypeVar

from selfconf.composition import Composer
from selfconf.model.configuration import Configuration
from selfconf.model.optimum import Optimum
from selfconf.model.refusal import Outcome, Undecided
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.deadline import TimeUp, deadline

LONGEST = 1e6
"""Seconds that an alarm can be set to everywhere."""
T = TypeVar("T")


def add_budget_arguments(parser: argparse.ArgumentParser) -> None:
    """The options that limit a search."""
    parser.add_argument(
        "--steps", metavar="N", type=_steps, help="give up a search after so many steps, which all machines count alike"
    )
    parser.add_argument("--seconds", metavar="S", type=_seconds, help="give up a search after so many seconds")


def _steps(text: str) -> int:
    if not text.isdecimal() or not int(text):
        raise argparse.ArgumentTypeError(f"{text!r} is no number of steps; it takes a whole number above zero")
    return int(text)


def _seconds(text: str) -> float:
    try:
        seconds = float(text)
    except ValueError:
        seconds = math.nan
    if not 0 < seconds <= LONGEST:
        raise argparse.ArgumentTypeError(f"{text!r} is no time; it takes a number of seconds above zero")
    return seconds


class Clock:
    """The time for one question, if it is limited: what is asked later has less of it."""

    def __init__(self, seconds: float | None) -> None:
        self.seconds = seconds
        self._ends = math.inf if seconds is None else time.monotonic() + seconds

    def within(self, ask: Callable[[], T], otherwise: T) -> T:
        """The answer to a question, or what holds without one when the time is up."""
        if self.seconds is None:
            return ask()
        left = self._ends - time.monotonic()
        try:
            if left > 0:
                with deadline(left):
                    return ask()
        except TimeUp:
            return otherwise
        return otherwise


def composed(
    composer: Composer,
    ecology: Mapping[IRI, Advertisement],
    lost: frozenset[IRI],
    running: Configuration | None,
    clock: Clock,
) -> Optimum | Outcome:
    """The best answer that the time allows. The partition is made first, and is not part of the search."""
    composer.partition(ecology)
    answers: list[Optimum | Outcome] = []

    def gather() -> bool:
        for answer in composer.answers(ecology, lost, running):
            answers.append(answer)
        return True

    whole = clock.within(gather, False)
    if not whole and (not answers or isinstance(answers[-1], Undecided)):
        return Undecided(seconds=clock.seconds)
    return answers[-1]

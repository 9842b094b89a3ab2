"""`why`: why a component plays a role, now or at a moment, in sentences."""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from datetime import datetime
from pathlib import Path

from selfconf.cli.options import add_ecology_arguments, add_format_argument, complain_of, joined
from selfconf.cli.terminal import display, display_json
from selfconf.model.moments import parsed_moment
from selfconf.render import clock_time

EXAMPLE = """  selfconf why position
  selfconf why position --format json
  selfconf why Astrid --at 14:02
  selfconf why :position --at 14:02 --history history"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    parser.add_argument(
        "term",
        metavar="TERM",
        help="a role, a component, a value that a task is bound to, or a task; its IRI, or its local name with or"
        " without a prefix",
    )
    parser.add_argument(
        "--at",
        metavar="TIME",
        type=_moment,
        help="the moment to ask about: HH:MM, HH:MM:SS, or a date and time as ISO 8601 has it (default: now)",
    )
    parser.add_argument(
        "--history",
        metavar="DIR",
        type=Path,
        help="ask what `selfconf serve --history DIR` has kept, not the living ecology; the server may go on meanwhile",
    )
    add_format_argument(parser)
    add_ecology_arguments(parser)


def run(given: argparse.Namespace) -> int:
    """0 with an answer, 1 if no task that is remembered has to do with the term."""
    if given.history is not None:
        from selfconf.api.living.past import past_why

        return _tell(given, past_why(given.history, given.term, given.at), f" in {given.history}")
    with joined(given) as ecology:
        sentences = ecology.why(given.term, given.at)
        complain_of(ecology)
    return _tell(given, sentences, ", as far as the configurators remember")


def _tell(given: argparse.Namespace, sentences: Sequence[str], where: str) -> int:
    """Print the answer, and return the exit code."""
    if given.format == "json":
        display_json({"term": given.term, "at": given.at, "sentences": list(sentences)})
    elif sentences:
        display("\n".join(sentences))
    else:
        when = "" if given.at is None else f" at {clock_time(given.at)}"
        display(f"no task has to do with {given.term}{when}{where}")
    return 0 if sentences else 1


def _moment(text: str) -> float:
    """A moment in seconds of the Unix epoch; one without a date is today's.

    A time without a fraction is the end of its second, as answers name times by whole seconds: what has begun at
    14:02:07.4, they say, is so since 14:02:07. A second that has not begun is a mistake: nothing is known of it.
    """
    moment = _written(text)
    try:
        begins = moment.timestamp()
        known = (moment if moment.microsecond else moment.replace(microsecond=999_999)).timestamp()
    except (ValueError, OverflowError):  # of the first year or the last one, as it is elsewhere
        raise argparse.ArgumentTypeError(f"{text!r} is before or after all moments that are known") from None
    now = time.time()
    if begins > now:
        raise argparse.ArgumentTypeError(
            f"{text!r} has not come yet, it is {clock_time(now)}; a time of an earlier day takes its date"
        )
    return known


def _written(text: str) -> datetime:
    for form in ("%H:%M", "%H:%M:%S"):
        try:
            moment = datetime.strptime(text, form).time()
        except ValueError:
            continue
        return datetime.combine(datetime.now().date(), moment)
    try:
        return parsed_moment(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is no time; it takes HH:MM, HH:MM:SS, or ISO 8601") from None

"""`echo`: what an output of a component issues, as it comes, until Ctrl-C or a number of signals."""

from __future__ import annotations

import argparse
import json
from functools import partial
from typing import TYPE_CHECKING

from selfconf.cli.options import add_ecology_arguments, count_option, joined
from selfconf.cli.terminal import complain, paint

if TYPE_CHECKING:
    from selfconf.api.living.echo import HeardSignal

EXAMPLE = """  selfconf echo person-tracker pose --count 5"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    parser.add_argument(
        "component", metavar="COMPONENT", help="a component: its IRI, or its local name with or without a prefix"
    )
    parser.add_argument("output", metavar="PORT", help="the name of one of its outputs")
    parser.add_argument(
        "--count",
        metavar="N",
        type=partial(count_option, what="signals"),
        help="end after so many signals (default: at Ctrl-C)",
    )
    parser.add_argument(
        "--format",
        choices=["text", "json"],
        default="text",
        help="json: an object on a line for each signal; bytes and arrays are described (default: %(default)s)",
    )
    add_ecology_arguments(parser)


def run(given: argparse.Namespace) -> int:
    """0 after Ctrl-C, and once as many signals have come as were wanted."""
    from selfconf.termination import end_as_by_ctrl_c

    end_as_by_ctrl_c()
    show = _json if given.format == "json" else _text
    try:
        with joined(given) as ecology:
            for number, signal in enumerate(ecology.signals(given.component, given.output, complain), 1):
                print(show(signal), flush=True)
                if number == given.count:
                    break
    except KeyboardInterrupt:  # the way to end it
        return 0
    return 0


def _json(signal: HeardSignal) -> str:
    return json.dumps(signal.body(), ensure_ascii=False)


def _text(signal: HeardSignal) -> str:
    from selfconf.render import clock_time

    moment = clock_time(signal.stamp.time, exact=True)
    missed = f" ({signal.passed_over} passed over)" if signal.passed_over else ""
    rate = f"{signal.rate:6.1f}/s" if signal.rate else " " * 8  # of the first signals it is not known
    return f"{paint(moment, 'dim')}  {rate}  {signal.worded()}{missed}"

"""`log`: what components have printed, as their sites have kept it, also of those that have died."""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import TYPE_CHECKING

from selfconf.cli.options import add_ecology_arguments, add_format_argument, whole_number
from selfconf.cli.terminal import complain, display, paint

if TYPE_CHECKING:
    from selfconf.model.log_line import LogLine

EXAMPLE = """  selfconf log person-tracker --follow"""
LINES = 200
_COLOURS = {"stderr": "yellow", "site": "cyan"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    parser.add_argument(
        "component",
        metavar="COMPONENT",
        nargs="?",
        default="",
        help="only its lines: its IRI, or its local name with or without a prefix",
    )
    parser.add_argument("--follow", action="store_true", help="go on with new lines, until Ctrl-C")
    parser.add_argument(
        "--lines",
        metavar="N",
        type=_number,
        default=LINES,
        help="how many earlier lines to show (default: %(default)s)",
    )
    parser.add_argument(
        "--log",
        metavar="DIR",
        type=Path,
        help="only the logs in this folder (default: those of the sites of this machine, also of sites that have ended,"
        " and those that the sites of other machines send)",
    )
    add_ecology_arguments(parser)
    add_format_argument(parser)


def run(given: argparse.Namespace) -> int:
    """0 with lines, and after Ctrl-C where lines are followed; 1 if there are none.

    Raises AuthorError for a component that has none and is not advertised, where the ecology lives.
    """
    from selfconf.api.living.log_reader import log_reader
    from selfconf.termination import end_as_by_ctrl_c

    end_as_by_ctrl_c()
    show = _json if given.format == "json" else _text
    try:
        with log_reader(given.ecology, given.connect, given.keys, given.log, given.component, complain) as reader:
            found = reader.latest(given.lines)
            if found:
                display("\n".join(map(show, found)))
            elif given.lines:
                complain(reader.why_nothing())
            if not given.follow:
                return 0 if found or not given.lines else 1
            while True:
                time.sleep(reader.pause)  # nothing tells when a file has grown
                for line in reader.added():
                    print(show(line), flush=True)
    except KeyboardInterrupt:  # the way to end it
        return 0


def _json(line: LogLine) -> str:
    return json.dumps(line.body(), ensure_ascii=False)


def _text(line: LogLine) -> str:
    from selfconf.render import clock_time

    names = ",".join(component.short for component in line.components)
    moment = line.time if line.moment is None else clock_time(line.moment, exact=True)
    return f"{paint(moment, 'dim')} {names}: {paint(line.text, _COLOURS.get(line.stream, ''))}"


def _number(text: str) -> int:
    lines = whole_number(text)
    if lines is None or lines < 0:
        raise argparse.ArgumentTypeError(f"{text!r} is no number of lines; it takes a whole number from zero on")
    return lines

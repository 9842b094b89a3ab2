"""`log`: what components have printed, as the sites of this machine have kept it, also of those that have died."""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import TYPE_CHECKING

from selfconf.cli.terminal import display, paint

if TYPE_CHECKING:
    from selfconf.api.site_logs import LogLine

EXAMPLE = """  selfconf log person-tracker --follow"""
LINES = 200
_COLOURS = {"stderr": "yellow", "site": "cyan"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    parser.add_argument(
        "component", metavar="COMPONENT", nargs="?", default="", help="only its lines: its IRI or its local name"
    )
    parser.add_argument("--follow", action="store_true", help="go on with the lines to come, until Ctrl-C")
    parser.add_argument(
        "--lines", metavar="N", type=_number, default=LINES, help="how many lines of before (default: %(default)s)"
    )
    parser.add_argument(
        "--log",
        metavar="DIR",
        type=Path,
        help="where the logs are (default: where the sites of this machine say, and where they are kept usually)",
    )
    parser.add_argument(
        "--ecology", metavar="NAME", help="the ecology (default: $SELFCONF_ECOLOGY, or else the only one with a log)"
    )
    parser.add_argument("--format", choices=["text", "json"], default="text", help="default: %(default)s")


def run(given: argparse.Namespace) -> int:
    """0 with lines, and after Ctrl-C where lines are followed; 1 if there are none."""
    from selfconf.api.site_logs import followed_lines, kept_lines, site_logs
    from selfconf.rendezvous import asked_for
    from selfconf.termination import end_as_by_ctrl_c

    end_as_by_ctrl_c()
    show = _json if given.format == "json" else _text
    component = given.component.removeprefix("<").removesuffix(">").removeprefix(":")
    paths = site_logs(asked_for(given.ecology, ())[0], given.log)
    coming = followed_lines(paths, time.sleep, component)  # before what is kept is read, so that nothing is missed
    found = kept_lines(paths, component, given.lines)
    if found:
        display("\n".join(map(show, found)))
    if not given.follow:
        return 0 if found or not given.lines else 1
    try:
        for line in coming:
            print(show(line), flush=True)
    except KeyboardInterrupt:  # the way to end it
        pass
    return 0


def _json(line: LogLine) -> str:
    return json.dumps(line.body(), ensure_ascii=False)


def _text(line: LogLine) -> str:
    names = ",".join(component.short for component in line.components)
    return f"{paint(line.local_time, 'dim')} {names}: {paint(line.text, _COLOURS.get(line.stream, ''))}"


def _number(text: str) -> int:
    if not text.isdecimal():
        raise argparse.ArgumentTypeError(f"{text!r} is no number of lines")
    return int(text)

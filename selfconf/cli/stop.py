"""`stop`: takes down what is deployed, one task or all; components are turned off, not ended."""

from __future__ import annotations

import argparse

from selfconf.cli.options import add_ecology_arguments, add_format_argument, complain_of, joined
from selfconf.cli.terminal import display, display_json

EXAMPLE = """  selfconf stop"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    parser.add_argument("task", metavar="TASK", nargs="?", help="only this task (default: all tasks of the ecology)")
    parser.add_argument("--configurator", metavar="NAME", help="only what this configurator has deployed")
    add_format_argument(parser)
    add_ecology_arguments(parser)


def run(given: argparse.Namespace) -> int:
    """0 when nothing is deployed any more."""
    if given.task is not None and given.configurator is not None:
        given.misused("a task and --configurator both say what to stop; give one of them")
    with joined(given) as ecology:
        found = ecology.stop(given.task if given.task is not None else given.configurator)
        complain_of(ecology)
    if given.format == "json":
        display_json({"ecology": ecology.name, "stopped": found})
        return 0
    where = f"in ecology {ecology.name}"
    display(f"took down {', '.join(found)} {where}" if found else f"nothing is deployed {where}")
    return 0

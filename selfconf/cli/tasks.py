"""`tasks`: the tasks of an ecology, those that run and those that live in its sites."""

from __future__ import annotations

import argparse
import time
from typing import TYPE_CHECKING

from selfconf.cli.options import add_ecology_arguments, add_format_argument, complain_of, joined
from selfconf.cli.terminal import display, display_json

if TYPE_CHECKING:
    from selfconf.api.living.living_ecology import LivingEcology


EXAMPLE = """  selfconf tasks --format json"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    add_format_argument(parser)
    add_ecology_arguments(parser)


def run(given: argparse.Namespace) -> int:
    """Return 0 once every configurator has answered, also if there is no task; else as `code_of_tasks`."""
    from selfconf.render import duration, table

    with joined(given) as ecology:
        found = ecology.all_tasks()
        complain_of(ecology)
        code = code_of_tasks(ecology)
    if given.format == "json":
        display_json([task.body() for task in found])
    elif found:
        rows = [
            [
                task.name,
                str(task.priority),
                task.phase,
                duration(time.time() - task.beginning),
                task.configurator or "-",
                task.lives_in,
                ", ".join(component.short for component in task.components),
            ]
            for task in found
        ]
        head = ["task", "priority", "phase", "age", "configurator", "lives in", "components"]
        display(table(head, rows))
    elif not code:
        display(f"there is no task in ecology {ecology.name}")
    return code


def code_of_tasks(ecology: LivingEcology) -> int:
    """0 once every configurator of an ecology that was asked for its tasks has answered, also if there is no task.

    2 if one lives or holds components and does not answer, or if a run of this machine is suspended.
    """
    return 2 if ecology.silent or ecology.suspended else 0

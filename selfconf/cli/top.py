"""`top`: what lives, held by which task, how much each issues, and how much memory it takes."""

from __future__ import annotations

import argparse
import sys
import time
from typing import TYPE_CHECKING

from selfconf.cli.options import add_ecology_arguments, complain_of, joined, seconds_option
from selfconf.cli.terminal import Terminal, complain, display, display_json, styled_state
from selfconf.errors import NetworkError
from selfconf.model.wording import counted

if TYPE_CHECKING:
    from selfconf.api.living.component_states import ComponentState
    from selfconf.api.living.living_ecology import LivingEcology

EXAMPLE = """  selfconf top --every 2"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    parser.add_argument(
        "--every",
        metavar="S",
        type=seconds_option,
        default=1.0,
        help="seconds over which rates are taken, and after which a terminal gets a new table (default: %(default)g)",
    )
    parser.add_argument("--once", action="store_true", help="print one table and end, also on a terminal")
    parser.add_argument("--format", choices=["table", "json"], default="table", help="default: %(default)s")
    add_ecology_arguments(parser)


def run(given: argparse.Namespace) -> int:
    """0 once the table is shown; on a terminal, where it is renewed, after Ctrl-C."""
    from selfconf.termination import end_as_by_ctrl_c

    end_as_by_ctrl_c()
    screen = sys.stdout if isinstance(sys.stdout, Terminal) and not given.once else None
    try:
        with joined(given) as ecology:
            before, looked = ecology.component_states(), time.monotonic()
            while True:
                time.sleep(given.every)  # the time over which signals are counted
                try:
                    now, moment = ecology.component_states(), time.monotonic()
                except NetworkError as error:
                    if screen is None:
                        raise
                    screen.renew(f"{error}\n")  # until it is back
                    continue
                rates = _rates(before, now, moment - looked)
                if given.format == "json":
                    body = [{**one.body(), "rates": rates[one.component]} for one in now]
                    display_json({"ecology": ecology.name, "components": body})
                    complain_of(ecology)
                    return 0
                shown = _table(ecology, now, rates)
                if screen is None:
                    display(shown)
                    complain_of(ecology)
                    return 0
                screen.renew("\n".join((*shown.split("\n"), *ecology.complaints)) + "\n")
                before, looked = now, moment
    except KeyboardInterrupt:  # the way to end it
        complain("")
        return 0


def _rates(
    before: tuple[ComponentState, ...], now: tuple[ComponentState, ...], seconds: float
) -> dict[str, dict[str, float]]:
    """By component and output, the signals a second between two looks."""
    from selfconf.api.living.component_states import issue_rates

    found = issue_rates(before, now, seconds)
    return {component: {port: round(rate, 2) for port, rate in rates.items()} for component, rates in found.items()}


def _table(ecology: LivingEcology, now: tuple[ComponentState, ...], rates: dict[str, dict[str, float]]) -> str:
    from selfconf.rdf.sparql import QUERY_PREFIXES
    from selfconf.render import duration, ecology_names, table

    names, note = ecology_names(QUERY_PREFIXES, [one.component for one in now])
    rows = []
    for one in sorted(now, key=lambda one: (one.state != "alive", not one.active)):  # stable: then by IRI
        issued = ", ".join(f"{port} {rate:.1f}/s" for port, rate in rates[one.component].items())
        memory, age = f"{one.memory / 1e6:.0f} MB" if one.memory else "", duration(one.age) if one.life else ""
        state = "active" if one.active else one.shown
        rows.append([names(one.component), state, one.task, issued, memory, age, one.place, one.site])
    living, held = sum(one.state == "alive" for one in now), sum(bool(one.task) for one in now)
    head = ["component", "state", "held by", "issues", "memory", "age", "process", "site"]
    said = f"ecology {ecology.name}: {living} of {counted(len(now), 'component')} live, {held} held by tasks"
    return "\n".join(filter(None, (said, "", table(head, rows, styled_state), note and f"\n{note}")))

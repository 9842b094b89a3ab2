"""`discover`: what is out there, as a table."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from selfconf.cli.options import add_ecology_arguments, complain_of, joined
from selfconf.cli.terminal import display, display_json, styled_state
from selfconf.model.wording import counted

if TYPE_CHECKING:
    from selfconf.api.living.component_states import ComponentState
    from selfconf.model.term import IRI

EXAMPLE = """  selfconf discover --format json"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    parser.add_argument("--format", choices=["table", "json"], default="table", help="default: %(default)s")
    add_ecology_arguments(parser)


def run(given: argparse.Namespace) -> int:
    """0 once the ecology has answered."""
    with joined(given) as ecology:
        states = ecology.component_states()
        disobedient: Mapping[IRI, str] = {}
        if given.format != "json" and any(one.stopping for one in states):
            disobedient = ecology.out_of_control()
        discovery = ecology.discovery
        complain_of(ecology)
    if given.format == "json":
        body = {"ecology": ecology.name, "components": [one.body() for one in states], "sites": discovery.sites}
        display_json({**body, "missing": discovery.missing})
        return 0
    display(_table(states))
    for line in _sentences(states, disobedient):
        display(line)
    display(f"{counted(len(states), 'component')} at {counted(len(discovery.sites), 'site')} of ecology {ecology.name}")
    return 0


def _sentences(states: tuple[ComponentState, ...], disobedient: Mapping[IRI, str]) -> Iterator[str]:
    """Why components cannot act now, as far as their sites say so; and which do not come to rest."""
    from selfconf.rdf.sparql import QUERY_PREFIXES
    from selfconf.render import disobedience_text, ecology_names

    names, _ = ecology_names(QUERY_PREFIXES, [one.component for one in states])
    yield from (f"{names(one.component)} cannot act now: {one.reason}" for one in states if one.reason)
    yield from disobedience_text(disobedient, names)


def _table(states: tuple[ComponentState, ...]) -> str:
    from selfconf.rdf.sparql import QUERY_PREFIXES
    from selfconf.render import duration, ecology_names, table

    names, note = ecology_names(QUERY_PREFIXES, [one.component for one in states])
    rows = [
        [
            names(one.component),
            ", ".join(map(names, one.types)),
            one.site,
            one.shown,
            one.task,
            one.place,
            duration(one.age) if one.life else "",
        ]
        for one in states
    ]
    shown = table(["component", "types", "site", "state", "held by", "process", "age"], rows, styled_state)
    return f"{shown}\n{note}" if note else shown

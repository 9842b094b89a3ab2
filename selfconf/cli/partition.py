"""`partition`: which components could play each role, in the order of trying, and what keeps the others out."""

from __future__ import annotations

import argparse
import gc
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing
from typing import TYPE_CHECKING, Any

from selfconf.cli.options import (
    add_ecology_arguments,
    add_endpoint_argument,
    add_format_argument,
    add_task_arguments,
    complain_of,
    complain_of_left_out,
    given_ecology,
    task_of,
)
from selfconf.cli.progress import progress
from selfconf.cli.terminal import display, display_json
from selfconf.errors import AuthorError

if TYPE_CHECKING:
    from selfconf.api.configuring import Inquiry
    from selfconf.api.ecology import Ecology
    from selfconf.api.partition_table import PartitionTable, RolePartition
    from selfconf.model.alternative import Alternative
    from selfconf.model.term import IRI
    from selfconf.render import Names

    Why = Mapping[IRI, Sequence[Alternative]]
    """Of each role, its candidates with what would come of them."""

EXAMPLE = """  selfconf partition examples/navigate.ttl --ads examples/peis-home --bind robot=:Astrid --bind goal=x
  selfconf partition examples/navigate.ttl --ads examples/peis-home --bind robot=:Astrid --bind goal=x --show sparql
  selfconf partition examples/watch.ttl --ads examples/watch --why"""
SHOWN = 8
"""How many of those kept out are shown for each role, in text."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    add_task_arguments(parser, "as for configure; a partition is the same for each")
    add_endpoint_argument(parser)
    add_format_argument(parser)
    parser.add_argument(
        "--show", choices=["shape", "sparql"], help="print each role as the SHACL shape or SPARQL query it stands for"
    )
    parser.add_argument(
        "--why",
        action="store_true",
        help="show for each candidate its preference and cost, and what the cheapest configuration with it would cost",
    )
    add_ecology_arguments(parser)


def run(given: argparse.Namespace) -> int:
    """0 if every role has as many candidates as it asks for, else 1."""
    from selfconf.api.alternatives import alternatives
    from selfconf.api.configuring import Inquiry
    from selfconf.api.method import Method
    from selfconf.api.partition_table import PartitionTable

    if given.show and given.format != "text":
        raise AuthorError(f"--show {given.show} writes what other tools read as it is; leave out --format")
    task = task_of(given)
    with closing(_ecology(given)) as ecology:
        strategy = "best" if given.why else "first"
        with progress("looking which components are eligible"):
            inquiry = Inquiry(task, ecology, Method.of(strategy, given.reasoning, given.ontology))
        gc.freeze()  # the partition stays until the command ends, as the files do
        complain_of_left_out(inquiry.left_out)
        if given.ads is None:  # what does not conform among files was named when they were read
            complain_of(ecology)
    if given.show:
        display(_exported(inquiry, given.show))
        return 0
    found = PartitionTable.of(inquiry)
    why: Why = {}
    if given.why:
        with progress("computing what configurations with each candidate would cost"):
            why = alternatives(inquiry)
    if given.format == "json":
        display_json(_body(found, why))
    else:
        display("\n".join(line for one in found.roles for line in _lines(one, found.names, why, bool(inquiry.holders))))
    return 0 if found.sufficient else 1


def _ecology(given: argparse.Namespace) -> Ecology:
    """The ecology that the arguments name; an empty one for a shape, which says the same of any, if they name none."""
    if given.show == "shape" and given.ads is None and given.endpoint is None:
        from selfconf.api.reading import read

        return read()
    return given_ecology(given)


def _exported(inquiry: Inquiry, how: str) -> str:
    """Every role as a document or query of its own, under its name as a comment."""
    from selfconf.rdf import role_export

    partitioner = inquiry.composer.partitioner
    texts = {
        "shape": lambda role: role_export.shape(inquiry.task.document, role, partitioner.hierarchy),
        "sparql": lambda role: role_export.query(role, partitioner.hierarchy, inquiry.ecology.values()),
    }
    return "\n\n".join(f"# {role.iri}\n{texts[how](role)}" for role in partitioner.roles)


def _lines(one: RolePartition, names: Names, why: Why, some_held: bool) -> Iterator[str]:
    from selfconf.render import alternative_text, holder_text

    told = {found.component: found for found in why.get(one.role.iri, ())}
    chosen = next((found for found in told.values() if found.chosen), None)

    yield f"{names(one.role.iri)}  {len(one.eligible) or 'no component is'} eligible"
    for number, component in enumerate(one.eligible, 1):
        held = one.held.get(component)
        said = f": {alternative_text(told[component], chosen, some_held)}" if component in told else ""
        yield f"  {number}. {names(component)}{said}" + (f"  ({holder_text(held)})" if held is not None else "")
    if one.recruits:
        more = len(one.recruits) - SHOWN
        yield f"  may recruit {', '.join(map(names, one.recruits[:SHOWN]))}" + (f" and {more} more" if more > 0 else "")
    if one.excluded:
        yield "  kept out"
        yield from (f"    {names(e.component)}: {', '.join(map(str, e.obstacles))}" for e in one.excluded[:SHOWN])
    if len(one.excluded) > SHOWN:
        yield f"    and {len(one.excluded) - SHOWN} more; --format json has them all"


def _body(found: PartitionTable, why: Why) -> dict[str, Any]:
    from selfconf.render import alternative_body, holder_body, likeness_body, value_body

    return {
        "template": found.inquiry.task.iri,
        "bindings": {name: value_body(value) for name, value in found.inquiry.task.bindings.items()},
        "roles": [
            {
                "role": one.role.iri,
                "eligible": list(one.eligible),
                **({"held": [{"component": c, **holder_body(h)} for c, h in one.held.items()]} if one.held else {}),
                **({"candidates": list(map(alternative_body, why[one.role.iri]))} if why else {}),
                **({"recruits": list(one.recruits)} if one.role.recruits else {}),
                "excluded": [
                    {
                        "component": e.component,
                        "of_its_class": e.akin,
                        "obstacles": list(map(str, e.obstacles)),
                        **likeness_body(e.obstacles[0], e.likeness),
                    }
                    for e in one.excluded
                ],
            }
            for one in found.roles
        ],
        "seconds": {part: round(value, 6) for part, value in found.inquiry.seconds.items()},
    }

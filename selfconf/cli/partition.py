"""`partition`: who could play each role of a template, in the order of trying, and what keeps the others out."""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Mapping, Sequence
from typing import Any

from selfconf.cli import words
from selfconf.cli.endpoint import add_endpoint_argument
from selfconf.cli.inputs import add_task_arguments, read_hierarchy, read_task
from selfconf.cli.live import add_connection_arguments
from selfconf.cli.sources import read_ecology
from selfconf.cli.terminal import show
from selfconf.model.partition import Candidate
from selfconf.model.template import Role
from selfconf.rdf import role_export
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.eligibility import CompiledRole, Exclusion, Partitioner, exclusions
from selfconf.rdf.tasks import TaskDocument

NAME = "partition"
HELP = "show who could play each role of a template, and what keeps the others out"
EXAMPLE = """  selfconf partition examples/navigate.ttl --ads examples/peis-home --bind robot=:Astrid --bind goal=x
  selfconf partition examples/navigate.ttl --ads examples/peis-home --bind robot=:Astrid --bind goal=x --show sparql"""
SHOWN = 8
"""How many of those kept out are shown for each role, in text."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    add_task_arguments(parser)
    add_endpoint_argument(parser)
    parser.add_argument("--format", choices=["text", "json"], default="text", help="default: %(default)s")
    parser.add_argument(
        "--show", choices=["shape", "sparql"], help="print each role as the SHACL shape or SPARQL query it stands for"
    )
    add_connection_arguments(parser)


def run(given: argparse.Namespace) -> int:
    """0 if every role has as many candidates as it asks for, else 1."""
    task, seconds = read_task(given), dict[str, float]()
    hierarchy = read_hierarchy(given)
    partitioner = Partitioner(task, hierarchy)
    began = time.perf_counter()
    ecology = list(read_ecology(given, partitioner).values())
    seconds["load"] = time.perf_counter() - began
    roles = task.task.template.roles
    if given.show:
        show(_spelt(task, partitioner, ecology, given.show))
        return 0
    began = time.perf_counter()
    partition = partitioner.partition(ecology)
    seconds["partition"] = time.perf_counter() - began
    rows = [
        (role, candidates, exclusions(partitioner, compiled, {c.profile.component for c in candidates}, ecology))
        for role, compiled, candidates in zip(roles, partitioner.roles, partition.candidates, strict=True)
    ]
    if given.format == "json":
        show(json.dumps(_body(task, rows, seconds), indent=2, ensure_ascii=False))
    else:
        names = words.Names(task.document.prefixes)
        show("\n".join(line for row in rows for line in _lines(*row, names)))
    return 0 if all(len(candidates) >= role.minimum for role, candidates, _ in rows) else 1


Row = tuple[Role, Sequence[Candidate], list[Exclusion]]


def _spelt(task: TaskDocument, partitioner: Partitioner, ecology: Sequence[Advertisement], how: str) -> str:
    """Every role as a document or query of its own, under its name as a comment."""

    def spelt(role: CompiledRole) -> str:
        if how == "shape":
            return role_export.shape(task, role, partitioner.hierarchy)
        return role_export.query(role, partitioner.hierarchy, ecology)

    return "\n\n".join(f"# {role.iri}\n{spelt(role)}" for role in partitioner.roles)


def _lines(role: Role, candidates: Sequence[Candidate], kept_out: Sequence[Exclusion], names: words.Names) -> list[str]:
    lines = [f"{names(role.iri)}  {len(candidates) or 'nobody is'} eligible"]
    lines += [f"  {number}. {names(c.profile.component)}" for number, c in enumerate(candidates, 1)]
    if kept_out:
        lines.append("  kept out")
        lines += [f"    {names(e.component)}: {', '.join(map(str, e.obstacles))}" for e in kept_out[:SHOWN]]
    if len(kept_out) > SHOWN:
        lines.append(f"    and {len(kept_out) - SHOWN} more; --format json has them all")
    return lines


def _body(task: TaskDocument, rows: Sequence[Row], seconds: Mapping[str, float]) -> dict[str, Any]:
    return {
        "template": task.task.template.iri,
        "bindings": {name: words.plain(value) for name, value in task.task.by_name().items()},
        "roles": [
            {
                "role": role.iri,
                "eligible": [candidate.profile.component for candidate in candidates],
                "excluded": [
                    {
                        "component": e.component,
                        "of_its_class": e.akin,
                        "obstacles": [str(obstacle) for obstacle in e.obstacles],
                    }
                    for e in kept_out
                ],
            }
            for role, candidates, kept_out in rows
        ],
        "seconds": {part: round(value, 6) for part, value in seconds.items()},
    }

"""`configure`: computes a configuration, from files or from the living ecology, and changes nothing."""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from selfconf.cli import words
from selfconf.cli.endpoint import add_endpoint_argument
from selfconf.cli.inputs import add_task_arguments, read_hierarchy, read_task
from selfconf.cli.live import add_connection_arguments
from selfconf.cli.sources import read_ecology
from selfconf.configurator.compose import Composer, Strategy
from selfconf.model.configuration import Configuration
from selfconf.model.hierarchy import Reasoning
from selfconf.model.refusal import Refusal
from selfconf.model.term import IRI
from selfconf.rdf import write
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.templates import TaskDocument
from selfconf.search.whatif import Loss

NAME = "configure"
HELP = "compute a configuration for a template, or say why there is none; changes nothing"
EXAMPLE = """  selfconf configure examples/navigate.ttl --ads examples/peis-home \\
      --bind robot=:Astrid --bind goal='(AT BEDROOM)'"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    add_task_arguments(parser)
    add_endpoint_argument(parser)
    parser.add_argument(
        "--format", choices=["text", "json", "turtle", "mermaid"], default="text", help="default: %(default)s"
    )
    parser.add_argument(
        "--what-if", action="store_true", help="tell for each component what would replace it if it failed"
    )
    add_connection_arguments(parser)


def run(given: argparse.Namespace) -> int:
    """0 with a configuration, 1 with a refusal."""
    task = read_task(given)
    seconds: dict[str, float] = {}
    began = time.perf_counter()
    composer = Composer(task, read_hierarchy(given), Strategy(given.strategy))
    ecology = read_ecology(given, composer.partitioner)
    seconds["load"] = time.perf_counter() - began
    began = time.perf_counter()
    partition = composer.partition(ecology)
    seconds["partition"] = time.perf_counter() - began
    began = time.perf_counter()
    outcome = composer.compose(ecology, frozenset(), None)
    seconds["search"] = time.perf_counter() - began
    losses: list[Loss] | None = None
    if isinstance(outcome, Refusal):
        outcome = _with_hint(composer.mended(ecology, outcome), task, ecology, given)
    elif given.what_if:
        losses = composer.what_if(ecology, outcome)
    eligible = {
        str(role.iri): len(candidates)
        for role, candidates in zip(task.task.template.roles, partition.candidates, strict=True)
    }
    print(_shown(outcome, task, given.format, eligible, seconds, losses))
    return 1 if isinstance(outcome, Refusal) else 0


def _with_hint(
    refusal: Refusal, task: TaskDocument, ecology: Mapping[IRI, Advertisement], given: argparse.Namespace
) -> Refusal:
    """Whether subclass mode would have found an answer."""
    if given.reasoning != Reasoning.SYNTACTIC.value:
        return refusal
    hierarchy = read_hierarchy(given, Reasoning.SUBCLASS)
    if isinstance(Composer(task, hierarchy).compose(ecology, frozenset(), None), Refusal):
        return refusal
    return replace(refusal, hint="with --reasoning subclass there is a configuration")


def _shown(
    outcome: Configuration | Refusal,
    task: TaskDocument,
    form: str,
    eligible: Mapping[str, int],
    seconds: Mapping[str, float],
    losses: Sequence[Loss] | None,
) -> str:
    names = words.Names(task.document.prefixes)
    refused = isinstance(outcome, Refusal)
    if form == "json":
        bound = {name: words.plain(value) for name, value in task.task.by_name().items()}
        body: dict[str, Any] = {"status": "refused" if refused else "configured", "bindings": bound}
        body |= words.refusal_body(outcome) if isinstance(outcome, Refusal) else words.configuration_body(outcome)
        if losses is not None:
            body["what_if"] = words.losses_body(losses)
        body |= {
            "eligible": dict(eligible),
            "seconds": {part: round(value, 6) for part, value in seconds.items()},
        }
        return json.dumps(body, indent=2, ensure_ascii=False)
    if isinstance(outcome, Refusal):
        text = words.refusal_text(outcome, names)
        mark = {"turtle": "# ", "mermaid": "%% "}.get(form, "")
        return "\n".join(mark + line for line in text.splitlines())
    if form == "turtle":
        name = write.configuration_iri(outcome, 0)
        return write.turtle(write.configuration_triples(outcome, name), task.document.prefixes).rstrip()
    if form == "mermaid":
        return words.mermaid(outcome, names)
    text = words.configuration_text(outcome, names)
    return text if losses is None else f"{text}\n{words.losses_text(losses, names)}"

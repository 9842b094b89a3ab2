"""`configure`: computes a configuration, from files or from the living ecology, and changes nothing."""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from selfconf.cli import budget, words
from selfconf.cli.endpoint import add_endpoint_argument
from selfconf.cli.inputs import add_task_arguments, complain, composer_of, read_task
from selfconf.cli.live import add_connection_arguments
from selfconf.cli.places import Places
from selfconf.cli.sources import read_ecology
from selfconf.cli.terminal import show
from selfconf.cli.why import explained
from selfconf.composition import Composer
from selfconf.model.configuration import Configuration
from selfconf.model.consequence import Consequence
from selfconf.model.number import number
from selfconf.model.optimum import Optimum
from selfconf.model.refusal import Outcome, Refusal, Undecided
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.provenance import configuration_iri, configuration_triples
from selfconf.rdf.tasks import TaskDocument
from selfconf.rdf.turtle import to_turtle

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
    budget.add_budget_arguments(parser)
    add_connection_arguments(parser)


def run(given: argparse.Namespace) -> int:
    """0 with a configuration, 1 with a refusal, 2 where the budget ended before it was decided."""
    task = read_task(given)
    seconds: dict[str, float] = {}
    began = time.perf_counter()
    composer = composer_of(given, task)
    ecology = read_ecology(given, composer.partitioner)
    seconds["load"] = time.perf_counter() - began
    began = time.perf_counter()
    partition = composer.partition(ecology)
    seconds["partition"] = time.perf_counter() - began
    clock = budget.Clock(given.seconds)
    began = time.perf_counter()
    answer = budget.composed(composer, ecology, frozenset(), None, clock)
    seconds["search"] = time.perf_counter() - began
    losses: list[Consequence] | None = None
    if isinstance(answer, Refusal):
        answer = explained(composer, ecology, answer, given, clock)
    elif given.what_if and not isinstance(answer, Undecided):
        found = answer.configuration if isinstance(answer, Optimum) else answer
        losses = clock.within(lambda: composer.what_if(ecology, found), None)
        if losses is None:
            complain(f"no time is left to tell what would replace what; allow more than {given.seconds:g} s")
    if isinstance(answer, Undecided) and given.format != "json":
        complain(words.undecided_text(answer, task.task.template.iri, words.Names(task.document.prefixes)))
        return 2
    eligible = {
        str(role.iri): len(candidates)
        for role, candidates in zip(task.task.template.roles, partition.candidates, strict=True)
    }
    report = Report(task, composer, ecology, eligible, seconds, losses)
    if isinstance(answer, Undecided) or given.format == "json":
        show(json.dumps(report.body(answer), indent=2, ensure_ascii=False))
    else:
        show(report.text(answer, given.format))
    return 1 if isinstance(answer, Refusal) else 2 if isinstance(answer, Undecided) else 0


@dataclass(frozen=True)
class Report:
    """What there is to print around an answer."""

    task: TaskDocument
    composer: Composer
    ecology: Mapping[IRI, Advertisement]
    eligible: Mapping[str, int]
    seconds: Mapping[str, float]
    losses: Sequence[Consequence] | None

    def body(self, answer: Optimum | Outcome) -> dict[str, Any]:
        """The answer as JSON."""
        body: dict[str, Any] = {
            "template": self.task.task.template.iri,
            "bindings": {name: words.plain(value) for name, value in self.task.task.by_name().items()},
        }
        if isinstance(answer, Undecided):
            body = {"status": "undecided", **body, **words.undecided_body(answer)}
        elif isinstance(answer, Refusal):
            body = {"status": "refused", **body, **words.refusal_body(answer, self._places)}
        else:
            found = answer.configuration if isinstance(answer, Optimum) else answer
            body = {"status": "configured", **body, **words.configuration_body(found)}
        if isinstance(answer, Optimum):
            body["cost"] = words.cost_body(answer, self._strangers(answer))
        if self.losses is not None:
            body["what_if"] = words.losses_body(self.losses)
        timed = {part: round(value, 6) for part, value in self.seconds.items()}
        return body | {"eligible": dict(self.eligible), "seconds": timed}

    def text(self, answer: Optimum | Configuration | Refusal, form: str) -> str:
        """The answer as text, Turtle or Mermaid."""
        names = words.Names(self.task.document.prefixes)
        if isinstance(answer, Refusal):
            mark = {"turtle": "# ", "mermaid": "%% "}.get(form, "")
            lines = words.refusal_text(answer, names, self._places).splitlines()
            return "\n".join(mark + line for line in lines)
        found = answer.configuration if isinstance(answer, Optimum) else answer
        if form == "turtle":
            name = configuration_iri(found, 0)
            triples = configuration_triples(found, name, self.task.task)
            return to_turtle(triples, self.task.document.prefixes).rstrip()
        if form == "mermaid":
            return words.mermaid(found, names)
        parts = [words.configuration_text(found, names)]
        if isinstance(answer, Optimum):
            parts.append(words.cost_text(answer, self._strangers(answer), names))
        if self.losses is not None:
            parts.append(words.losses_text(self.losses, names))
        return "\n".join(parts)

    @property
    def _places(self) -> Places:
        return Places(self.task.task.template, self.ecology)

    def _strangers(self, optimum: Optimum) -> list[IRI]:
        """The properties of unknown terms that no component in the ecology has a number for."""
        wanted = {one for _, one in optimum.missing}
        for advertisement in self.ecology.values():
            for predicate, value in advertisement.profile.properties:
                if number(value) is not None:
                    wanted -= self.composer.hierarchy.superproperties(predicate)
            if not wanted:
                break
        return sorted(wanted)

"""`configure`: computes a configuration, from files or from the living ecology, and changes nothing."""

from __future__ import annotations

import argparse
import gc
from collections.abc import Iterable
from contextlib import closing
from typing import TYPE_CHECKING, Any

from selfconf.cli.options import (
    add_budget_arguments,
    add_ecology_arguments,
    add_endpoint_argument,
    add_task_arguments,
    complain_of,
    complain_of_left_out,
    given_ecology,
    method_of,
    task_of,
)
from selfconf.cli.progress import progress
from selfconf.cli.terminal import complain, display, display_json

if TYPE_CHECKING:
    from selfconf.api.answer import Answer
    from selfconf.api.configuring import Inquiry
    from selfconf.api.ecology import Ecology
    from selfconf.model.configuration import Configuration
    from selfconf.model.refusal import Refusal, Undecided
    from selfconf.model.term import IRI

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
        "--what-if", action="store_true", help="show for each component what would replace it if it failed"
    )
    add_budget_arguments(parser)
    add_ecology_arguments(parser)


def run(given: argparse.Namespace) -> int:
    """0 with a configuration, 1 with a refusal, 2 where the budget ended before it was decided."""
    from selfconf.api.answer import Answer
    from selfconf.api.configuring import Inquiry
    from selfconf.model.refusal import Undecided
    from selfconf.render import undecided_text

    what_if = _shows_what_if(given)
    task = task_of(given)
    method = method_of(given, task)
    with closing(given_ecology(given)) as ecology:
        with progress("looking which components are eligible"):
            inquiry = Inquiry(task, ecology, method)
        gc.freeze()  # the partition stays until the command ends, as the files do
        complain_of_left_out(inquiry.left_out)
        if given.ads is None:  # what does not conform among files was named when they were read
            complain_of(ecology)
        absent = _absent(ecology, inquiry.ecology) if given.ads is None and given.endpoint is None else frozenset()
    with progress("searching for a configuration"):
        answer = inquiry.answer(what_if)
    if isinstance(answer, Answer):
        _tell_absent(answer, absent)
        _tell_unconnected(answer)
        if what_if and answer.what_if is None:
            complain(f"no time is left to tell what would replace what; allow more than {given.seconds:g} s")
    if given.format == "json":
        display_json(_body(inquiry, answer))
    elif isinstance(answer, Undecided):
        complain(undecided_text(answer, task.iri, task.names))
    else:
        display(_text(inquiry, answer, given.format))
        if isinstance(answer, Answer) and given.format == "text" and given.ads is not None:
            _tell_insides(inquiry, answer)
    return 0 if answer else 2 if isinstance(answer, Undecided) else 1


def _shows_what_if(given: argparse.Namespace) -> bool:
    """Whether to find out what would replace what: it is asked for, and the format has a place for it."""
    shows = given.format in ("text", "json")
    if given.what_if and not shows:
        complain(f"--what-if is shown as text and as JSON, not by --format {given.format}")
    return bool(given.what_if and shows)


def _absent(ecology: Ecology, components: Iterable[IRI]) -> frozenset[IRI]:
    """The components, among some of the living ecology, that no process runs, and that no site can start."""
    from selfconf.api.living.living_ecology import LivingEcology

    if not isinstance(ecology, LivingEcology):
        return frozenset()
    return frozenset(one for one in components if ecology.state(one) == "absent")


def _tell_absent(answer: Answer, absent: frozenset[IRI]) -> None:
    """Tell which components of a configuration would have to be started first by other means than `run`."""
    for component in sorted(absent.intersection(answer.components)):
        complain(f"{answer.names(component)} is absent: `run` does without it, unless it is started before that")


def _tell_unconnected(answer: Answer) -> None:
    """Tell which interactions of the template connect nothing."""
    from selfconf.render import unconnected_text

    for line in unconnected_text(answer, answer.task.template.interactions, answer.names):
        complain(line)


def _tell_insides(inquiry: Inquiry, answer: Answer) -> None:
    """Tell what composites of a configuration would be inside, if their sites had these advertisements."""
    from selfconf.model.configuration import Configuration
    from selfconf.render import configuration_text

    for component, inside in inquiry.insides(answer):
        if not isinstance(inside, Configuration):
            why = inside if isinstance(inside, str) else f"its inside is {inside}"
            display(f"{answer.names(component)}: {why}")
            continue
        told = ("  " + line for line in configuration_text(inside, answer.names).splitlines())
        display("\n".join([f"inside of {answer.names(component)}, from these advertisements", *told]))


def _inside_body(inside: Configuration | Undecided | str) -> dict[str, Any]:
    """What a composite is inside, or why that is nothing or not known, as JSON."""
    from selfconf.model.configuration import Configuration
    from selfconf.render import configuration_body

    if isinstance(inside, str):
        return {"status": "refused", "reason": inside}
    if not isinstance(inside, Configuration):
        return {"status": "undecided", "reason": f"its inside is {inside}"}
    return {"status": "configured", "template": inside.template, **configuration_body(inside)}


def _body(inquiry: Inquiry, answer: Answer | Refusal | Undecided) -> dict[str, Any]:
    """The answer as JSON, with the figures of how it was found."""
    from selfconf.model.refusal import Refusal, Undecided
    from selfconf.render import (
        configuration_body,
        consequences_body,
        cost_body,
        refusal_body,
        undecided_body,
        value_body,
    )

    body: dict[str, Any] = {
        "template": inquiry.task.iri,
        "bindings": {name: value_body(value) for name, value in inquiry.task.bindings.items()},
    }
    if isinstance(answer, Undecided):
        body = {"status": "undecided", **body, **undecided_body(answer)}
    elif isinstance(answer, Refusal):
        body = {"status": "refused", **body, **refusal_body(answer)}
    else:
        body = {"status": "configured", **body, **configuration_body(answer)}
        if answer.optimum is not None:
            body["cost"] = cost_body(answer.optimum, answer.unknown_properties)
        if answer.what_if is not None:
            body["what_if"] = consequences_body(answer.what_if)
        inside = {component: _inside_body(one) for component, one in inquiry.insides(answer)}
        body |= {"insides": inside} if inside else {}
    timed = {part: round(value, 6) for part, value in inquiry.seconds.items()}
    return body | {"eligible": dict(inquiry.eligible), "seconds": timed}


def _text(inquiry: Inquiry, answer: Answer | Refusal, form: str) -> str:
    """The answer as text, Turtle or Mermaid; a refusal as a comment of the latter two."""
    from selfconf.model.refusal import Refusal
    from selfconf.render import refusal_text

    if isinstance(answer, Refusal):
        mark = {"turtle": "# ", "mermaid": "%% "}.get(form, "")
        return "\n".join(mark + line for line in refusal_text(answer, inquiry.task.names).splitlines())
    return {"text": answer.__str__, "turtle": answer.to_turtle, "mermaid": answer.to_mermaid}[form]()

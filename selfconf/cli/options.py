"""The options that several commands share, and the values that they stand for. An option takes one value."""

from __future__ import annotations

import argparse
import gc
import math
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from selfconf.cli.terminal import complain
from selfconf.errors import AuthorError, BindingError, NetworkError
from selfconf.files import STDIN
from selfconf.model.seconds import DELAY_IN_WORDS, LIMIT_IN_WORDS, is_delay, is_limit
from selfconf.project import BIND, REASONING, STRATEGIES

if TYPE_CHECKING:
    from selfconf.api.ecology import Ecology
    from selfconf.api.living.living_ecology import LivingEcology
    from selfconf.api.method import Method
    from selfconf.api.task import TaskSpecification
    from selfconf.model.left_out import LeftOut

MOST_DOMAIN = 232
"""The greatest ROS_DOMAIN_ID that ROS 2 takes."""
_WHOLE = re.compile(r"[+-]?[0-9]{1,18}")  # what any program can count to
_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")


def add_task_arguments(parser: argparse.ArgumentParser, strategy: str = "how to search") -> None:
    """The options by which a task is given: template, bindings, reasoning, strategy; `strategy` says what that does."""
    parser.add_argument(
        "template", metavar="TEMPLATE", type=Path, help="a Turtle file with a template or a task, or - for stdin"
    )
    parser.add_argument(
        "--template",
        dest="wanted",
        metavar="TERM",
        help="which template or task, where the file holds several: a CURIE or an <IRI>",
    )
    parser.add_argument(
        "--bind",
        metavar="NAME=TERM",
        action="append",
        default=[],
        help="a value for a parameter: a CURIE, an <IRI>, a Turtle literal; plain words are a string; repeatable",
    )
    add_ads_argument(parser)
    add_reasoning_argument(parser, "which triples the shape of a role sees")
    add_ontology_argument(parser)
    parser.add_argument(
        "--strategy", choices=STRATEGIES, default=STRATEGIES[0], help=f"{strategy} (default: %(default)s)"
    )


def add_ads_argument(parser: argparse.ArgumentParser) -> None:
    """The option for advertisements in files; without it a command asks the living ecology."""
    parser.add_argument(
        "--ads",
        metavar="PATH",
        type=Path,
        action="append",
        help="advertisements: a file, a folder with all *.ttl below it, or - for stdin; repeatable",
    )


def add_reasoning_argument(parser: argparse.ArgumentParser, meaning: str) -> None:
    """The option for the mode of reasoning, which decides what `meaning` says."""
    parser.add_argument(
        "--reasoning", choices=REASONING, default=REASONING[0], help=f"{meaning} (default: %(default)s)"
    )


def add_ontology_argument(parser: argparse.ArgumentParser) -> None:
    """The option for ontologies besides those that ship with selfconf."""
    parser.add_argument(
        "--ontology",
        metavar="PATH",
        type=Path,
        action="append",
        default=[],
        help="an ontology besides those of selfconf, or a folder of them; repeatable",
    )


def add_endpoint_argument(parser: argparse.ArgumentParser) -> None:
    """The option for an ecology behind a SPARQL endpoint."""
    parser.add_argument(
        "--endpoint",
        metavar="URL",
        help="a SPARQL 1.1 endpoint that holds the advertisements, in its default graph or in named ones",
    )


def add_budget_arguments(parser: argparse.ArgumentParser) -> None:
    """The options that limit a search."""
    parser.add_argument(
        "--steps",
        metavar="N",
        type=partial(count_option, what="steps"),
        help="give up a search after so many steps, which all machines count alike",
    )
    parser.add_argument("--seconds", metavar="S", type=seconds_option, help="give up a search after so many seconds")


def add_format_argument(parser: argparse.ArgumentParser) -> None:
    """The option of a command that prints its results as text or as JSON."""
    parser.add_argument("--format", choices=["text", "json"], default="text", help="default: %(default)s")


def add_ecology_arguments(parser: argparse.ArgumentParser) -> None:
    """The options by which a command finds the living ecology."""
    parser.add_argument(
        "--ecology",
        metavar="NAME",
        help="the ecology (default: $SELFCONF_ECOLOGY, or else the only one on this machine)",
    )
    parser.add_argument(
        "--connect",
        metavar="ENDPOINT",
        action="append",
        default=[],
        help="where a site listens, such as tcp/127.0.0.1:7447; repeatable (default: $SELFCONF_CONNECT, or else the"
        " sites on this machine)",
    )
    add_keys_argument(parser)


def add_keys_argument(parser: argparse.ArgumentParser) -> None:
    """The option for the keys by which a program is let in."""
    parser.add_argument(
        "--keys",
        metavar="DIR",
        type=Path,
        help="a folder of keys, as `selfconf keys` makes them: links are TLS, and each program may do only"
        " what its certificate permits (default: $SELFCONF_KEYS, or else none)",
    )


def count_option(text: str, what: str) -> int:
    """A number of something above zero, as an option takes it; `what` says of what."""
    count = whole_number(text)
    if count is None or count < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is no number of {what}; it takes a whole number above zero")
    return count


def whole_number(text: str) -> int | None:
    """A whole number as an option takes it; None for what is none, or has more digits than a count ever has.

    Python's own `int` takes `1_0` and the digits of every script.
    """
    return int(text) if _WHOLE.fullmatch(text) else None


def add_answer_seconds_argument(parser: argparse.ArgumentParser, what: str, default: float) -> None:
    """The option for how long an answer may take; `what` says which."""
    parser.add_argument(
        "--seconds",
        dest="answer_seconds",  # the key `seconds` of a project file limits searches
        metavar="S",
        type=seconds_option,
        default=default,
        help=f"how long {what} may take (default: %(default)g)",
    )


def seconds_option(text: str) -> float:
    """A number of seconds that something may take, as an option takes it."""
    seconds = number_option(text)
    if not is_limit(seconds):
        raise argparse.ArgumentTypeError(f"{text!r} is no time; it takes {LIMIT_IN_WORDS}")
    return seconds


def delay_option(text: str) -> float:
    """A number of seconds after which something is done, as an option takes it: zero is at once."""
    seconds = number_option(text)
    if not is_delay(seconds):
        raise argparse.ArgumentTypeError(f"{text!r} is no time; it takes {DELAY_IN_WORDS}")
    return seconds


def number_option(text: str) -> float:
    """A number as an option takes it; NaN for what is none, which lies in no range."""
    return float(text) if _NUMBER.fullmatch(text) else math.nan


def task_of(given: argparse.Namespace) -> TaskSpecification:
    """The task that the arguments describe, complete and checked. Raises AuthorError."""
    from selfconf.api.task import pairs, template
    from selfconf.api.unknown_terms import unknown_in_task

    one_stdin(given.template, *(given.ads or ()), *given.ontology)
    task, typed = template(given.template, given.wanted), pairs(given.bind)
    names = [name for one in (task.document.task.iri, task.iri) if one for name in (one, task.names(one), one.short)]
    table, values = given.project.bindings(*names)
    bound = {name: value for name, value in values.items() if name not in typed and name not in task.bindings}
    try:
        task = task.bind(**bound)
        for unknown in unknown_in_task(task):
            complain(unknown)
        return task.bind(**typed).complete()
    except BindingError as error:
        if error.parameter in bound:
            raise AuthorError(f"{error} (bound in {given.project.place(BIND, table, error.parameter)})") from None
        elsewhere = next((other for other, some in given.project.bound.items() if error.parameter in some), None)
        if elsewhere is None or error.parameter in typed:
            raise
        place = given.project.place(BIND, elsewhere, error.parameter)
        raise AuthorError(f"{error} (bound in {place} for {elsewhere!r} alone)") from None


def method_of(given: argparse.Namespace, task: TaskSpecification) -> Method:
    """How the arguments ask a task to be composed."""
    from selfconf.api.method import Method

    complain_of_strategy(given, task)
    steps, seconds = getattr(given, "steps", None), getattr(given, "seconds", None)
    return Method.of(given.strategy, given.reasoning, given.ontology, steps, seconds)


def complain_of_strategy(given: argparse.Namespace, task: TaskSpecification) -> None:
    """Say on stderr where the strategy has nothing to go by."""
    if given.strategy == "best" and not task.document.template.cost:
        complain(
            f"the template {task.iri!r} states no sc:cost: every configuration costs the same, "
            "and best is the one that first finds"
        )


def given_ecology(given: argparse.Namespace) -> Ecology:
    """The ecology that the arguments name: files, an endpoint, or else the living one, to be closed by `close`."""
    one_ecology(given)
    if given.ads is not None or given.endpoint is not None:
        not_living(given, "--endpoint" if given.ads is None else "--ads")
    if given.ads is not None:
        return read_files(given.ads)
    if given.endpoint is not None:
        from selfconf.api.ecology import EndpointEcology

        return EndpointEcology(given.endpoint)
    with files_named(given):
        return joined(given)


@contextmanager
def files_named(given: argparse.Namespace) -> Iterator[None]:
    """Where no site is there at all, have the NetworkError name the option by which advertisements are in files."""
    try:
        yield
    except NetworkError as error:
        from selfconf import rendezvous, this_machine

        ecology, endpoints = rendezvous.asked_for(given.ecology, given.connect)
        if ecology is not None or endpoints or this_machine.local_sites():
            raise
        raise NetworkError(f"{error}, or --ads PATH for advertisements in files") from None


def one_ecology(given: argparse.Namespace) -> None:
    """Raises AuthorError where two ecologies are named."""
    if given.ads is not None and given.endpoint is not None:
        raise AuthorError("--ads and --endpoint are two ecologies; give one of them")


def not_living(given: argparse.Namespace, option: str) -> None:
    """Raises AuthorError where an option names an ecology that does not live, and a living one is typed as well."""
    for one in ("ecology", "connect", "keys"):
        if getattr(given, one, None) and one not in given.from_project:
            raise AuthorError(f"{option} is an ecology of its own, and --{one} is for the living one; give one of them")


def read_files(paths: Iterable[Path]) -> Ecology:
    """The ecology in some files; what was left out of it is named on stderr."""
    from selfconf.api.reading import read
    from selfconf.api.unknown_terms import unknown_in_ecology

    paths = list(paths)
    ecology = read(*paths)
    gc.freeze()  # it stays until the command ends, so the collector need not look at a million values again and again
    complain_of(ecology)
    for unknown in unknown_in_ecology(ecology.advertisements()):
        complain(unknown)
    if not len(ecology) and not ecology.left_out:
        complain(f"there is no advertisement in {', '.join(map(str, paths))}")
    return ecology


def joined(given: argparse.Namespace) -> LivingEcology:
    """The living ecology that the arguments name. Raises NetworkError if there is none."""
    from selfconf.api.living.living_ecology import join

    return join(given.ecology, connect=given.connect, keys=given.keys)


def complain_of(ecology: Ecology) -> None:
    """Name on stderr what was left out of an ecology when it was last asked."""
    complain_of_left_out(ecology.left_out)
    for one in ecology.complaints:
        complain(one)


def complain_of_left_out(left_out: Iterable[LeftOut]) -> None:
    """Name on stderr what was left out of an ecology, each with its line where that is known."""
    for one in left_out:
        complain(str(one))


def one_stdin(*paths: Path) -> None:
    """Raises AuthorError where standard input, which can be read once, is to be more than one thing."""
    if paths.count(STDIN) > 1:
        raise AuthorError("- is standard input, which can be only one of these; give files for the others")


def domain(text: str) -> int:
    """The number of a domain of ROS 2."""
    number = whole_number(text)
    if number is None or not 0 <= number <= MOST_DOMAIN:
        raise argparse.ArgumentTypeError(f"{text!r} is no domain; it takes a number from 0 to {MOST_DOMAIN}")
    return number

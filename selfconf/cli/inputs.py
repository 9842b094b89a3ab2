"""Reading what a command is given: files and folders of advertisements, a template, ontologies."""

from __future__ import annotations

import argparse
import gc
import sys
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from selfconf import entailment, files, library
from selfconf.cli.terminal import show
from selfconf.composition import Composer, Strategy
from selfconf.errors import AuthorError, BindingError, TemplateError
from selfconf.model.diagnostic import Severity
from selfconf.model.hierarchy import Hierarchy, Reasoning
from selfconf.model.term import IRI
from selfconf.rdf import advertisements, tasks, turtle
from selfconf.rdf.advertisements import Advertisement, SegmentCache
from selfconf.rdf.eligibility import AdvertisementIndex
from selfconf.rdf.reasoning import HIERARCHY, hierarchy
from selfconf.rdf.tasks import TaskDocument
from selfconf.rdf.turtle import Document

STDIN = Path("-")
"""What stands for standard input where a file can be given."""


def complain(sentence: str) -> None:
    """Say something on stderr that is not a result."""
    show(sentence, sys.stderr)


def add_task_arguments(parser: argparse.ArgumentParser) -> None:
    """The options by which a task is given: template, bindings, reasoning, strategy."""
    parser.add_argument(
        "template",
        metavar="TEMPLATE",
        type=Path,
        nargs="?",
        help="a Turtle file with a template or a task, or - for stdin",
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
    parser.add_argument(
        "--reasoning",
        choices=[mode.value for mode in Reasoning],
        default=Reasoning.SYNTACTIC.value,
        help="which triples the shape of a role sees (default: %(default)s)",
    )
    add_ontology_argument(parser)
    parser.add_argument(
        "--strategy",
        choices=[strategy.value for strategy in Strategy],
        default=Strategy.FIRST.value,
        help="how to search (default: %(default)s)",
    )


def add_ads_argument(parser: argparse.ArgumentParser) -> None:
    """The option for advertisements in files; without it a command asks the living ecology."""
    parser.add_argument(
        "--ads",
        metavar="PATH",
        type=Path,
        nargs="+",
        action="extend",
        help="advertisements: files, folders with all *.ttl below them, or - for stdin; repeatable",
    )


def leading(given: argparse.Namespace, name: str) -> Path:
    """The one positional argument, which a list option before it has swallowed: `--ads FOLDER TEMPLATE`."""
    value: Path | None = getattr(given, name)
    for swallowing in (given.ads, given.ontology):
        if value is None and swallowing is not None and len(swallowing) > 1:
            value = swallowing.pop()
    if value is None:
        raise AuthorError(f"{name.upper()} is missing; see `selfconf {given.command} --help`")
    return value


def add_ontology_argument(parser: argparse.ArgumentParser) -> None:
    """The option for ontologies besides those that ship with selfconf."""
    parser.add_argument(
        "--ontology",
        metavar="FILE",
        type=Path,
        nargs="+",
        action="extend",
        default=[],
        help="ontologies besides those of selfconf; repeatable",
    )


def read_task(given: argparse.Namespace) -> TaskDocument:
    """The task that the arguments describe, complete and checked. Raises AuthorError."""
    path = leading(given, "template")
    one_stdin(path, *(given.ads or ()), *given.ontology)
    document = parse_file(path)
    wanted = None
    if given.wanted is not None:
        term = tasks.read_term(given.wanted, document.prefixes)
        if not isinstance(term, IRI):
            raise BindingError(f"--template takes a CURIE or an <IRI>, not {given.wanted!r}")
        wanted = term
    try:
        task = tasks.read_task(document, wanted)
    except TemplateError as error:
        raise located(path, error) from None
    return tasks.complete(tasks.bind(task, pairs(given.bind)))


def one_stdin(*paths: Path) -> None:
    """Raises AuthorError where standard input, which can be read once, is to be more than one thing."""
    if paths.count(STDIN) > 1:
        raise AuthorError("- is standard input, which can be only one of these; give files for the others")


def located(path: Path, error: TemplateError) -> TemplateError:
    """The error with the line and column of what is wrong, as `validate` would tell it."""
    from selfconf.cli.validate import check

    for problem in () if path == STDIN else check([str(path)]).diagnostics:
        if problem.severity is Severity.ERROR:
            return TemplateError(error.message, file=problem.file, line=problem.line, column=problem.column)
    return error


def pairs(bound: Iterable[str]) -> list[tuple[str, str]]:
    """NAME=TERM taken apart. Raises BindingError."""
    found: list[tuple[str, str]] = []
    for text in bound:
        name, equals, term = text.partition("=")
        if not equals or not name:
            raise BindingError(f"--bind takes NAME=TERM, not {text!r}; for example --bind robot=:Astrid")
        if term.startswith("_:"):
            raise BindingError(f"{term} is a blank node, which has a name in its own file alone; bind {name} to an IRI")
        found.append((name.strip(), term))
    return found


def read_hierarchy(given: argparse.Namespace, reasoning: Reasoning | None = None) -> Hierarchy:
    """The hierarchy that the reasoning mode lets the roles see."""
    mode = reasoning or Reasoning(given.reasoning)
    if mode is Reasoning.SYNTACTIC:
        for path in given.ontology:
            existing(path)
        return hierarchy([], mode)
    relevant = HIERARCHY if mode is Reasoning.SUBCLASS else None
    ontologies = [parse_file(path, relevant) for path in (*library.ontologies(), *given.ontology)]
    return hierarchy(ontologies, mode, entailment.entailed_hierarchy)


def composer_of(given: argparse.Namespace, task: TaskDocument) -> Composer:
    """Who composes a task, as the options ask for it."""
    if given.strategy == Strategy.BEST.value and not task.task.template.cost:
        complain(
            f"the template {task.task.template.iri!r} states no sc:cost: every configuration costs the same, "
            "and best is the one that first finds"
        )
    return Composer(task, read_hierarchy(given), Strategy(given.strategy), given.steps)


def read_advertisements(paths: Sequence[Path]) -> AdvertisementIndex:
    """The advertisements in files and folders, whatever the order in which they are given.

    One that does not conform is named on stderr and left out, and so is a second one of the same component.
    """
    found: dict[IRI, Advertisement] = {}
    segments = SegmentCache()
    with collector_at_rest():
        for path in turtle_files(paths):
            good, bad = advertisements.read(_text(path), _name(path), files.base(path), segments)
            for malformed in bad:
                complain(f"{_name(path)}: left out {malformed.component}: {malformed.problems[0]}")
            for advertisement in good:
                if found.setdefault(advertisement.component, advertisement) is not advertisement:
                    other = found[advertisement.component].profile.place
                    complain(f"{_name(path)}: left out {advertisement.component}: it is advertised in {other} already")
        ecology = AdvertisementIndex(found)
    if not found:
        complain(f"there is no advertisement in {', '.join(map(str, paths))}")
    return ecology


@contextmanager
def collector_at_rest() -> Iterator[None]:
    """No garbage collection while much is read that will stay; afterwards the collector leaves it alone.

    Values are not garbage, but looking at a million of them again and again takes as long as making them.
    """
    collecting = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        gc.freeze()
        if collecting:
            gc.enable()


def turtle_files(paths: Sequence[Path]) -> list[Path]:
    """The files, and all *.ttl below the folders, each once, sorted. Raises AuthorError for what is not there."""
    found: set[Path] = set()
    for path in paths:
        if path != STDIN:
            existing(path)
        found.update(files.within(path))
    return sorted(found, key=Path.absolute)


def existing(path: Path) -> Path:
    """The path, if there is something; raises AuthorError."""
    if not path.exists():
        raise AuthorError(f"there is no file or folder {path}")
    return path


def parse_file(path: Path, predicates: Iterable[IRI] | None = None) -> Document:
    """A Turtle file, or its triples with some predicates.

    Raises AuthorError for what is not there, cannot be read, or is not Turtle.
    """
    return turtle.parse(_text(path), _name(path), files.base(path), predicates)


def _name(path: Path) -> str:
    """How a file is spoken of."""
    return "<stdin>" if path == STDIN else str(path)


def _text(path: Path) -> bytes:
    """What is to be parsed of a file, or of standard input."""
    return files.text(sys.stdin.buffer.read() if path == STDIN else files.octets(path), _name(path))

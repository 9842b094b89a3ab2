"""Reading what a command is given: files and folders of advertisements, a template, ontologies."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path

from selfconf import entailment, library
from selfconf.configurator.compose import Strategy
from selfconf.errors import AuthorError, BindingError
from selfconf.model.hierarchy import Hierarchy, Reasoning
from selfconf.model.term import IRI
from selfconf.rdf import advertisements, bindings, templates, turtle
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.closure import hierarchy
from selfconf.rdf.templates import TaskDocument
from selfconf.rdf.turtle import Document


def complain(sentence: str) -> None:
    """Say something on stderr that is not a result."""
    print(sentence, file=sys.stderr, flush=True)


def add_task_arguments(parser: argparse.ArgumentParser) -> None:
    """The options by which a task is given: template, bindings, reasoning, strategy."""
    parser.add_argument(
        "template", metavar="TEMPLATE", type=Path, nargs="?", help="a Turtle file with a template or a task"
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
        help="advertisements: files, or folders with all *.ttl below them; repeatable",
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
    if given.strategy == Strategy.BEST.value:
        raise AuthorError("--strategy best is not finished yet; use first or paper")
    document = parse_file(leading(given, "template"))
    wanted = None
    if given.wanted is not None:
        term = bindings.read_term(given.wanted, document.prefixes)
        if not isinstance(term, IRI):
            raise BindingError(f"--template takes a CURIE or an <IRI>, not {given.wanted!r}")
        wanted = term
    return bindings.complete(bindings.bind(templates.read(document, wanted), pairs(given.bind)))


def pairs(bound: Iterable[str]) -> list[tuple[str, str]]:
    """NAME=TERM taken apart. Raises BindingError."""
    found: list[tuple[str, str]] = []
    for text in bound:
        name, equals, term = text.partition("=")
        if not equals or not name:
            raise BindingError(f"--bind takes NAME=TERM, not {text!r}; for example --bind robot=:Astrid")
        found.append((name.strip(), term))
    return found


def read_hierarchy(given: argparse.Namespace, reasoning: Reasoning | None = None) -> Hierarchy:
    """The hierarchy that the reasoning mode lets the roles see."""
    mode = reasoning or Reasoning(given.reasoning)
    if mode is Reasoning.SYNTACTIC:
        for path in given.ontology:
            existing(path)
        return hierarchy([], mode)
    return hierarchy([parse_file(path) for path in (*library.ontologies(), *given.ontology)], mode, entailment.owl_rl)


def read_advertisements(paths: Sequence[Path]) -> dict[IRI, Advertisement]:
    """The advertisements in files and folders. One that does not conform is named on stderr and left out."""
    found: dict[IRI, Advertisement] = {}
    for path in turtle_files(paths):
        good, bad = advertisements.read(parse_file(path))
        for malformed in bad:
            complain(f"{path}: left out {malformed.component}: {malformed.problems[0]}")
        for advertisement in good:
            component = advertisement.profile.component
            if component in found:
                other = found[component].profile.place
                complain(f"{path}: left out {component}: it is advertised in {other} already")
            else:
                found[component] = advertisement
    return found


def turtle_files(paths: Sequence[Path]) -> list[Path]:
    """The files, and all *.ttl below the folders, each once, sorted. Raises AuthorError for what is not there."""
    found: dict[Path, None] = {}
    for path in paths:
        existing(path)
        for file in sorted(path.rglob("*.ttl")) if path.is_dir() else [path]:
            found[file] = None
    return list(found)


def existing(path: Path) -> Path:
    """The path, if there is something; raises AuthorError."""
    if not path.exists():
        raise AuthorError(f"there is no file or folder {path}")
    return path


def parse_file(path: Path) -> Document:
    """A Turtle file. Raises AuthorError for what is not there, cannot be read, or is not Turtle."""
    if path.is_dir():
        raise AuthorError(f"{path} is a folder; a file is needed here")
    try:
        text = existing(path).read_bytes()
    except OSError as error:
        raise AuthorError(f"cannot read {path}: {error.strerror}") from None
    return turtle.parse(text, str(path), path.resolve().as_uri())

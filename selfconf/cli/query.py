"""`query`: SPARQL over files, at an endpoint, or over the discovered ecology and what is deployed in it."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from selfconf.cli.answers import FORMATS
from selfconf.cli.asking import ROWS, SECONDS, Question, answer
from selfconf.cli.endpoint import add_endpoint_argument
from selfconf.cli.inputs import (
    add_ads_argument,
    add_ontology_argument,
    complain,
    existing,
    leading,
    one_stdin,
    parse_file,
    read_advertisements,
)
from selfconf.cli.live import add_connection_arguments, ask, connected, discover
from selfconf.cli.sources import one_ecology
from selfconf.errors import AuthorError, TurtleError, reason
from selfconf.model.term import IRI
from selfconf.rdf import turtle
from selfconf.rdf.sparql import QUERY_PREFIXES, Dataset

NAME = "query"
HELP = "ask the ecology something in SPARQL, over files, at an endpoint, or over everything that is alive"
EXAMPLE = """  selfconf query 'SELECT ?c WHERE { ?c a rob:PositionSensor }' --ads examples/peis-home
  selfconf query 'SELECT ?c WHERE { ?c a rob:PositionSensor }' --endpoint http://127.0.0.1:7878/query"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    parser.add_argument(
        "sparql", metavar="SPARQL|-|FILE.rq", nargs="?", help="a query, a file that holds one, or - for stdin"
    )
    add_ads_argument(parser)
    add_endpoint_argument(parser)
    add_ontology_argument(parser)
    parser.add_argument(
        "--format",
        choices=FORMATS,
        default="table",
        help="default: %(default)s",
    )
    parser.add_argument(
        "--seconds",
        metavar="S",
        type=float,
        default=SECONDS,
        help="how long the answer may take (default: %(default)g)",
    )
    parser.add_argument(
        "--rows", metavar="N", type=int, default=ROWS, help="how many rows are shown at most (default: %(default)s)"
    )
    add_connection_arguments(parser)


def run(given: argparse.Namespace) -> int:
    """0 with an answer, be it empty."""
    asked = str(leading(given, "sparql"))
    one_stdin(Path(asked), *(given.ads or ()), *given.ontology)
    text = _text(asked)
    if given.rows < 1 or given.seconds <= 0:
        raise AuthorError("--rows and --seconds take numbers greater than 0")
    if given.endpoint is not None:
        one_ecology(given)
        if given.ontology:
            raise AuthorError("an endpoint holds what it holds; --ontology is for files and the living ecology")
        question = Question(text, given.format, given.rows, seconds=given.seconds, endpoint=given.endpoint)
        return _told(Dataset(), question)
    dataset = Dataset()
    prefixes: dict[str, str] = {}
    if given.ads is not None:
        dataset.add_advertisements(read_advertisements(given.ads).values())
    else:
        _add_living(dataset, given)
    for path in given.ontology:
        document = parse_file(path)
        prefixes |= document.prefixes
        dataset.add(IRI(path.resolve().as_uri()), document.triples())
    prefixes = {name: base for name, base in prefixes.items() if name and name not in QUERY_PREFIXES}
    return _told(dataset, Question(text, given.format, given.rows, prefixes, seconds=given.seconds))


def _told(dataset: Dataset, question: Question) -> int:
    shown = answer(dataset, question)
    print(shown.text)
    if shown.cut:
        complain(f"there are more than {question.rows} rows; ask for less, or for more by --rows")
    if shown.remark:
        complain(shown.remark)
    return 0


def _text(given: str) -> str:
    if given == "-":
        try:
            return sys.stdin.read().removeprefix("\ufeff")
        except UnicodeDecodeError as error:
            raise AuthorError(f"cannot read stdin: {error}") from None
    if given.endswith(".rq") or (len(given) < 255 and "\n" not in given and Path(given).is_file()):
        try:
            return existing(Path(given)).read_text(encoding="utf-8-sig")
        except OSError as error:
            raise AuthorError(f"cannot read {reason(error)}") from None
        except UnicodeDecodeError as error:
            raise AuthorError(f"cannot read {given}: {error}") from None
    return given


def _add_living(dataset: Dataset, given: argparse.Namespace) -> None:
    with connected(given) as ecology:
        dataset.add_advertisements(found.advertisement for found in discover(ecology).found.values())
        for sample in ask(ecology, ecology.keys.configuration()).samples:
            try:
                document = turtle.parse(sample.payload, sample.key)
            except TurtleError as error:
                complain(f"left out a configuration: {error}")
                continue
            dataset.add(IRI(f"urn:selfconf:{sample.key}"), document.triples())

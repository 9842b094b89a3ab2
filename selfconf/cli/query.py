"""`query`: SPARQL over advertisements in files, or over the discovered ecology and what is deployed in it."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

import pyoxigraph as ox

from selfconf.cli import words
from selfconf.cli.inputs import (
    add_ads_argument,
    add_ontology_argument,
    complain,
    existing,
    leading,
    parse_file,
    read_advertisements,
)
from selfconf.cli.live import add_connection_arguments, ask, connected, discover
from selfconf.errors import AuthorError, TurtleError
from selfconf.model.term import IRI
from selfconf.rdf import turtle
from selfconf.rdf.dataset import PREFIXES, Answer, Dataset

NAME = "query"
HELP = "ask the ecology something in SPARQL, over files or over everything that is alive"
EXAMPLE = """  selfconf query 'SELECT ?c WHERE { ?c a rob:PositionSensor }' --ads examples/peis-home"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    parser.add_argument(
        "sparql", metavar="SPARQL|-|FILE.rq", nargs="?", help="a query, a file that holds one, or - for stdin"
    )
    add_ads_argument(parser)
    add_ontology_argument(parser)
    parser.add_argument(
        "--format",
        choices=["table", "json", "csv", "tsv", "turtle"],
        default="table",
        help="default: %(default)s",
    )
    add_connection_arguments(parser)


def run(given: argparse.Namespace) -> int:
    """0 with an answer, be it empty."""
    text = _text(str(leading(given, "sparql")))
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
    prefixes = {name: base for name, base in prefixes.items() if name and name not in PREFIXES}
    print(shown(dataset.query(text, prefixes), given.format, words.Names({**prefixes, **PREFIXES})))
    return 0


def _text(given: str) -> str:
    if given == "-":
        return sys.stdin.read()
    if given.endswith(".rq") or (len(given) < 255 and "\n" not in given and Path(given).is_file()):
        try:
            return existing(Path(given)).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
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


def shown(answer: Answer, form: str, names: words.Names) -> str:
    """The answer in a format; raises AuthorError where the format does not fit the kind of query."""
    if isinstance(answer, ox.QueryTriples):
        return _triples(answer, form)
    if form == "turtle":
        raise AuthorError("--format turtle is for CONSTRUCT and DESCRIBE; for this query use table, json, csv or tsv")
    if isinstance(answer, ox.QueryBoolean):
        if form == "json":
            return json.dumps({"head": {}, "boolean": bool(answer)})
        return "true" if answer else "false"
    formats = {
        "json": ox.QueryResultsFormat.JSON,
        "csv": ox.QueryResultsFormat.CSV,
        "tsv": ox.QueryResultsFormat.TSV,
    }
    if form in formats:
        return (answer.serialize(format=formats[form]) or b"").decode().rstrip("\r\n")
    variables = [variable.value for variable in answer.variables]
    rows = [
        [names(turtle.term(value)) if (value := solution[name]) is not None else "" for name in variables]
        for solution in answer
    ]
    return words.table(variables, rows) if variables else f"{len(rows)} solutions"


def _triples(answer: ox.QueryTriples, form: str) -> str:
    if form == "json":
        return (answer.serialize(format=ox.RdfFormat.JSON_LD) or b"").decode().rstrip()
    if form in ("csv", "tsv"):
        raise AuthorError(f"--format {form} is for SELECT; for this query use turtle or json")
    return (ox.serialize(answer, format=ox.RdfFormat.TURTLE, prefixes=PREFIXES) or b"").decode().rstrip()

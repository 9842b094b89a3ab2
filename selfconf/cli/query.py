"""`query`: SPARQL over files, at an endpoint, or over the discovered ecology and what is deployed in it."""

from __future__ import annotations

import argparse
import stat
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from selfconf import files
from selfconf.cli.options import (
    add_ads_argument,
    add_answer_seconds_argument,
    add_ecology_arguments,
    add_endpoint_argument,
    add_ontology_argument,
    complain_of,
    count_option,
    given_ecology,
    one_stdin,
)
from selfconf.cli.terminal import complain, display
from selfconf.errors import AuthorError
from selfconf.model.wording import counted

if TYPE_CHECKING:
    from selfconf.query import Shown
    from selfconf.rdf.sparql import Dataset

EXAMPLE = """  selfconf query 'SELECT ?c WHERE { ?c a rob:PositionSensor }' --ads examples/peis-home
  selfconf query 'SELECT ?c WHERE { ?c a rob:PositionSensor }' --endpoint http://127.0.0.1:7878/query
  selfconf query 'SELECT ?when { ?c prov:generatedAtTime ?when }' --history history"""
ANSWER_FORMATS = ("table", "json", "csv", "tsv", "turtle")
SECONDS, ROWS = 60.0, 100_000
# All three are the library's (`selfconf.query`), which is not loaded to parse arguments; a test compares them.


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    parser.add_argument("sparql", metavar="SPARQL|-|FILE.rq", help="a query, a file that holds one, or - for stdin")
    add_ads_argument(parser)
    add_endpoint_argument(parser)
    add_ontology_argument(parser)
    parser.add_argument(
        "--history",
        metavar="DIR",
        type=Path,
        help="what `selfconf serve --history DIR` has kept: every configuration as a graph of its own, with its"
        " provenance; alone, or together with --ads",
    )
    parser.add_argument("--format", choices=ANSWER_FORMATS, default=ANSWER_FORMATS[0], help="default: %(default)s")
    add_answer_seconds_argument(parser, "the answer", SECONDS)
    parser.add_argument(
        "--rows",
        metavar="N",
        type=partial(count_option, what="rows"),
        default=ROWS,
        help="how many rows are shown at most (default: %(default)s)",
    )
    add_ecology_arguments(parser)


def run(given: argparse.Namespace) -> int:
    """0 with an answer, be it empty."""
    from selfconf.api.ontologies import with_ontologies
    from selfconf.api.unknown_terms import unknown_in_query
    from selfconf.query import Question, answer
    from selfconf.rdf.sparql import Dataset

    one_stdin(Path(given.sparql), *(given.ads or ()), *given.ontology)
    text = _text(given.sparql)
    if given.endpoint is not None and given.ontology and "ontology" not in given.from_project:
        raise AuthorError("an endpoint holds what it holds; --ontology is for files and the living ecology")
    for unknown in unknown_in_query(text):
        complain(unknown)
    question = Question(text, given.format, given.rows, seconds=given.answer_seconds)
    of_project = bool({"ads", "endpoint"} & given.from_project)
    if given.history is not None and given.endpoint is not None and not of_project:
        raise AuthorError(
            "an endpoint holds what it holds; --history is for the past of a living ecology, and for files"
        )
    if given.history is not None and (given.ads is None or of_project):
        dataset = Dataset()
    else:
        with closing(given_ecology(given)) as ecology:
            if ecology.remote:
                return _told(ecology.asked(question), given.rows)
            dataset = ecology.dataset()
            if given.ads is None:
                complain_of(ecology)
    if given.history is not None:
        _add_past(dataset, given.history)
    return _told(answer(*with_ontologies(dataset, question, given.ontology)), given.rows)


def _add_past(dataset: Dataset, folder: Path) -> None:
    from selfconf.api.living.past import past_graphs

    for name, triples in past_graphs(folder).items():
        dataset.replace(name, triples)


def _told(shown: Shown, rows: int) -> int:
    display(shown.text)
    if shown.cut:
        complain(f"there are more than {counted(rows, 'row')}; ask for less, or for more by --rows")
    if shown.remark:
        complain(shown.remark)
    return 0


def _text(given: str) -> str:
    if given == "-":
        try:
            return files.standard_input().decode("utf-8-sig")
        except UnicodeDecodeError as error:
            raise AuthorError(f"cannot read stdin: {error}") from None
    if given.endswith(".rq") or ("\n" not in given and _can_be_read(Path(given))):
        if not Path(given).exists():
            raise AuthorError(f"there is no file or folder {given}")
        try:
            return files.octets(Path(given)).decode("utf-8-sig")
        except UnicodeDecodeError as error:
            raise AuthorError(f"cannot read {given}: {error}") from None
    return given


def _can_be_read(path: Path) -> bool:
    """Return whether a file or a pipe is there; what is too long or too odd to be a path is none."""
    try:
        return not stat.S_ISDIR(path.stat().st_mode)
    except (OSError, ValueError):
        return False

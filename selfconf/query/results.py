"""The answer to a SPARQL query as text, in each of the formats, with no more rows than asked for."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable, Iterator, Sequence
from itertools import islice
from typing import Any, NamedTuple

import pyoxigraph as ox

from selfconf.errors import AuthorError
from selfconf.model.setting_names import setting
from selfconf.model.wording import counted
from selfconf.rdf import turtle
from selfconf.rdf.sparql import QUERY_PREFIXES, QueryAnswer
from selfconf.rdf.vocabulary import XSD
from selfconf.render import Names, table

RESULT_FORMATS = ("table", "json", "csv", "tsv", "turtle")
Cell = ox.NamedNode | ox.BlankNode | ox.Literal | ox.Triple | None


def shown(answer: QueryAnswer | Iterator[ox.Triple], form: str, names: Names, rows: int) -> tuple[str, bool]:
    """The answer in a format, and whether it had more than `rows` rows or triples, which are left out.

    Raises AuthorError where the format does not fit the kind of query.
    """
    if isinstance(answer, ox.QuerySolutions | ox.QueryBoolean) and form == "turtle":
        wanted = setting("format", "turtle")
        raise AuthorError(f"{wanted} is for CONSTRUCT and DESCRIBE; for this query use table, json, csv or tsv")
    if isinstance(answer, ox.QueryBoolean):
        return json.dumps({"head": {}, "boolean": bool(answer)}) if form == "json" else str(bool(answer)).lower(), False
    if isinstance(answer, ox.QuerySolutions):
        variables = [variable.value for variable in answer.variables]
        found = [[solution[name] for name in variables] for solution in islice(answer, rows + 1)]
        return _solutions(variables, found[:rows], form, names), len(found) > rows
    triples = list(islice(answer, rows + 1))
    return _triples(triples[:rows], form), len(triples) > rows


def _solutions(variables: Sequence[str], rows: Sequence[Sequence[Cell]], form: str, names: Names) -> str:
    """SPARQL 1.1 Query Results JSON, CSV or TSV, or a table for people."""
    if form == "json":
        return _json_results(variables, rows)
    if form == "csv":
        return _csv_results(variables, rows)
    if form == "tsv":
        return _tsv_results(variables, rows)
    if not variables:
        return counted(len(rows), "solution")
    return table(variables, [["" if cell is None else names(turtle.term(cell)) for cell in row] for row in rows])


def _json_results(variables: Sequence[str], rows: Sequence[Sequence[Cell]]) -> str:
    bindings = [
        {name: _json(cell) for name, cell in zip(variables, row, strict=True) if cell is not None} for row in rows
    ]
    return json.dumps({"head": {"vars": list(variables)}, "results": {"bindings": bindings}}, ensure_ascii=False)


def _csv_results(variables: Sequence[str], rows: Sequence[Sequence[Cell]]) -> str:
    # By lines that end with \r\n, else a lone \r stands without quotation marks; shown with \n, as all other text is.
    lines: list[str] = []
    writer = csv.writer(_Lines(lines.append), lineterminator="\r\n")
    writer.writerow(variables)
    writer.writerows([_plain(cell) for cell in row] for row in rows)
    return "\n".join(line.removesuffix("\r\n") for line in lines)


class _Lines(NamedTuple):
    """Takes each line as it is written."""

    write: Callable[[str], object]


def _tsv_results(variables: Sequence[str], rows: Sequence[Sequence[Cell]]) -> str:
    lines = ["\t".join(f"?{name}" for name in variables)]
    return "\n".join((*lines, *("\t".join("" if cell is None else str(cell) for cell in row) for row in rows)))


def _json(cell: Cell) -> dict[str, Any]:
    if isinstance(cell, ox.NamedNode):
        return {"type": "uri", "value": cell.value}
    if isinstance(cell, ox.BlankNode):
        return {"type": "bnode", "value": cell.value}
    if isinstance(cell, ox.Literal):
        body = {"type": "literal", "value": cell.value}
        if cell.language:
            return {**body, "xml:lang": cell.language}
        return body if cell.datatype.value == XSD.string else {**body, "datatype": cell.datatype.value}
    return {"type": "literal", "value": str(cell)}


def _plain(cell: Cell) -> str:
    if isinstance(cell, ox.NamedNode | ox.Literal):
        return cell.value
    return "" if cell is None else str(cell)


def _triples(triples: Sequence[ox.Triple], form: str) -> str:
    if form in ("csv", "tsv"):
        raise AuthorError(f"{setting('format', form)} is for SELECT; for this query use turtle or json")
    if form == "json":
        return (ox.serialize(triples, format=ox.RdfFormat.JSON_LD) or b"").decode().rstrip()
    return (ox.serialize(triples, format=ox.RdfFormat.TURTLE, prefixes=QUERY_PREFIXES) or b"").decode().rstrip()

"""The check of one file: everything that can be found in it, each with its place."""

from __future__ import annotations

from codecs import BOM_UTF8
from functools import lru_cache

from rdflib import Graph

from selfconf.model.diagnostic import Diagnostic
from selfconf.rdf.deadline import TimeUp, processor_limit
from selfconf.rdf.positions import NotTurtleError, Positions, parse_with_positions
from selfconf.rdf.validation.checking import UnclearedFile
from selfconf.rdf.validation.described_elsewhere import descriptions
from selfconf.rdf.validation.diagnostics import at
from selfconf.rdf.validation.input_shapes import unaccepted_shapes
from selfconf.rdf.validation.lints.all_lints import lint
from selfconf.rdf.validation.lints.linted_file import LintedFile
from selfconf.rdf.validation.shape_violations import AnswerJudge, Shapes, shape_violations
from selfconf.rdf.validation.term_index import TermIndex
from selfconf.rdf.validation.unfit_values import unfit_values
from selfconf.rdf.validation.well_formedness import endless_lists, malformed_roles

FILE_SECONDS = 120.0
"""Processor time that the check of one file may take: the last resort, for what its size does not show."""

_OF_SHAPES = frozenset(("SC-A20", "SC-T03", "SC-T09", "SC-T13"))
"""The codes of what may keep parameters, and shapes beside them, from being shapes by which values can be judged."""


@lru_cache(maxsize=2)
def shapes_of(*texts: str) -> Shapes:
    """The shapes in some Turtle texts, read once."""
    graph = Graph()
    for text in texts:
        graph.parse(data=text, format="turtle")
    return Shapes.of(graph)


def problems_of(uncleared: UnclearedFile, shapes: Shapes, index: TermIndex) -> list[Diagnostic]:
    """The problems of one file, in no particular order, by what every file keeps to and the terms that are known."""
    source = uncleared.source
    beside = descriptions(
        (other.octets.removeprefix(BOM_UTF8), other.name, other.base, things) for other, things in uncleared.beside
    )
    try:
        with processor_limit(FILE_SECONDS):
            return _problems_of(uncleared, beside, shapes, index)
    except NotTurtleError as error:
        offset, code, message = error.offset, "SC-S01", f"This is not Turtle 1.1: {error.message.rstrip('.')}."
    except RecursionError:
        offset, code = 0, "SC-S05"
        message = "This file nests too deeply, or holds too long a list, to be checked."
    except TimeUp:
        offset, code = 0, "SC-S05"
        message = f"This file takes more than {FILE_SECONDS:g} seconds of processor time to check: it asks too much."
    return [at(Positions(source.name, source.text()), offset, code, message)]


def _problems_of(uncleared: UnclearedFile, beside: Graph, shapes: Shapes, index: TermIndex) -> list[Diagnostic]:
    """The problems of a file; `beside` is what others say of its configurations."""
    source = uncleared.source
    graph, positions = parse_with_positions(source.text(), source.name, source.base)
    violations = list(endless_lists(graph, positions))
    if not violations:  # pySHACL does not come back from a list without an end
        violations = [
            *shape_violations(graph, positions, shapes, AnswerJudge(beside, index)),
            *malformed_roles(graph, positions),
            *unaccepted_shapes(graph, positions),
        ]
        if _OF_SHAPES.isdisjoint(each.code for each in violations):
            violations += unfit_values(graph, positions)
    file = LintedFile(graph, positions, index, uncleared.elsewhere, shapes.all)
    return violations + lint(file, conforms=not violations)

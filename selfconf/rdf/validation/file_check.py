"""The check of one file: everything that can be found in it, each with its place."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache

from rdflib import Graph

from selfconf.model.diagnostic import Diagnostic, Severity
from selfconf.model.immutable import immutable
from selfconf.rdf.deadline import TimeUp, processor_limit
from selfconf.rdf.positions import NotTurtleError, Positions, parse_with_positions
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


@lru_cache(maxsize=2)
def shapes_of(*texts: str) -> Shapes:
    """The shapes in some Turtle texts, read once."""
    graph = Graph()
    for text in texts:
        graph.parse(data=text, format="turtle")
    return Shapes.of(graph)


@immutable
class FileCheck:
    """What the check of a file needs, for any number of files."""

    shapes: Shapes
    index: TermIndex

    def of(
        self, text: str, name: str, base: str, elsewhere: Mapping[str, str], beside: Graph | None = None
    ) -> list[Diagnostic]:
        """The problems of one file, in no particular order; `beside` is what others say of its configurations."""
        try:
            with processor_limit(FILE_SECONDS):
                return self._of(text, name, base, elsewhere, Graph() if beside is None else beside)
        except NotTurtleError as error:
            message = f"This is not Turtle 1.1: {error.message.rstrip('.')}."
            return [at(Positions(name, text), error.offset, "SC-S01", message)]
        except RecursionError:
            message = "This file nests too deeply, or holds too long a list, to be checked."
            return [at(Positions(name, text), 0, "SC-S05", message)]
        except TimeUp:
            message = (
                f"This file takes more than {FILE_SECONDS:g} seconds of processor time to check: it asks too much."
            )
            return [at(Positions(name, text), 0, "SC-S05", message)]

    def _of(self, text: str, name: str, base: str, elsewhere: Mapping[str, str], beside: Graph) -> list[Diagnostic]:
        graph, positions = parse_with_positions(text, name, base)
        violations = list(endless_lists(graph, positions))
        if not violations:  # pySHACL does not come back from a list without an end
            violations = [
                *shape_violations(graph, positions, self.shapes, AnswerJudge(beside, self.index)),
                *malformed_roles(graph, positions),
                *unaccepted_shapes(graph, positions),
            ]
            if not any(each.severity is Severity.ERROR for each in violations):  # else a parameter may be no shape
                violations += unfit_values(graph, positions)
        file = LintedFile(graph, positions, self.index, elsewhere, self.shapes.all)
        return violations + lint(file, conforms=not violations)

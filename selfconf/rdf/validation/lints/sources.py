"""Inputs that no output in sight can feed: units of other dimensions, shapes that no output of the type conforms to.

Only what stands in one file is in sight, and what a component issues is not what it is fed by. Where there is no output
of a type, nothing is said of the inputs that want it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from rdflib import RDF, SH, Graph, Literal, URIRef
from rdflib.term import Node

from selfconf.errors import AuthorError
from selfconf.model.diagnostic import Diagnostic
from selfconf.model.obstacle import NotJudged
from selfconf.model.term import IRI
from selfconf.model.term import Literal as TypedLiteral
from selfconf.model.unit_dimension import differ_in_dimension, meant_unit
from selfconf.rdf.conformance import violations
from selfconf.rdf.permitted_fields import OF_COMPONENT
from selfconf.rdf.rdflib_terms import from_rdflib
from selfconf.rdf.validation.lints.linted_file import LintedFile
from selfconf.rdf.validation.lints.normal_form import NormalForm
from selfconf.rdf.vocabulary import SC, UNIT

_INPUT, _OUTPUT, _UNIT, _SIGNAL = (URIRef(one) for one in (SC.hasInput, SC.hasOutput, SC.unit, SC.signalType))
_ACCEPTS = URIRef(SC.accepts)
_ASKED = IRI("urn:selfconf:lint:accepted")
MOST_SHAPES, MOST_OUTPUTS = 50, 100
"""How many shapes of a file are judged, and of how many outputs at most: a lint is not to take long."""


def incommensurable_units(file: LintedFile) -> Iterator[Diagnostic]:
    """Units of inputs, where each output of the same signal type that states a unit has one of another dimension."""
    outputs = _Outputs(file)
    for port, wanted in sorted(file.graph.subject_objects(_UNIT), key=lambda pair: file.offset(pair[0])):
        if (None, _INPUT, port) not in file.graph:
            continue
        units = sorted({str(unit) for output in outputs.of(port) for unit in file.graph.objects(output, _UNIT)})
        if units and all(differ_in_dimension(IRI.unchecked(unit), IRI.unchecked(str(wanted))) for unit in units):
            message = (
                f"{file.short(str(wanted))} is of another dimension than {file.short(units[0])}, which an output of "
                "this signal type in this file has."
            )
            yield file.at(file.positions.triples[port, _UNIT, wanted].object, "SC-L21", message)


def misnamed_units(file: LintedFile) -> Iterator[Diagnostic]:
    """Units whose names are spelt out, which QUDT calls otherwise: nothing is known of them."""
    for port, unit in sorted(file.graph.subject_objects(_UNIT), key=lambda pair: file.offset(pair[0])):
        meant = meant_unit(IRI.unchecked(unit)) if isinstance(unit, URIRef) and unit in UNIT else None
        if meant is not None:
            message = f"QUDT has no unit {file.short(str(unit))}; did you mean {file.short(UNIT[meant])}?"
            yield file.at(file.positions.triples[port, _UNIT, unit].object, "SC-L23", message)


def units_by_other_words(file: LintedFile) -> Iterator[Diagnostic]:
    """Units that a port without `sc:unit` states by the word of another vocabulary."""
    ports = {port for link in (SC.hasInput, SC.hasOutput) for port in file.graph.objects(None, URIRef(link))}
    for port in ports:
        for predicate, unit in file.graph.predicate_objects(port):
            if unit in UNIT and isinstance(unit, URIRef) and (port, _UNIT, None) not in file.graph:
                word = file.short(str(predicate))
                message = f"A port has its unit by sc:unit; what it says by {word} keeps no two ports apart."
                offset = file.positions.triples[port, predicate, unit].predicate
                yield file.at(offset, "SC-L23", message, hint=f"Write sc:unit {file.short(str(unit))}.")


def paths_from_outputs(file: LintedFile) -> Iterator[Diagnostic]:
    """Paths of what inputs accept that begin with what components say, and outputs do not: they lead nowhere."""
    for shape in sorted(set(file.graph.objects(None, _ACCEPTS)), key=file.offset):
        for path, values in NormalForm(file.source, (shape,)).values.items():
            step = str(next((one for one in path if one != RDF.first), ""))
            for asking in values.shapes if step in OF_COMPONENT else ():
                for said in file.graph.objects(asking, SH.path):
                    short, link = file.short(step), file.short(str(_OUTPUT))
                    message = f"{short} is said of a component, so no output has one."
                    rest = "" if step == str(_OUTPUT) else f" {short}"
                    hint = f"The component of an output is [ sh:inversePath {link} ]{rest}."
                    yield file.at(file.positions.triples[asking, SH.path, said].object, "SC-L25", message, hint=hint)


def unmet_shapes(file: LintedFile) -> Iterator[Diagnostic]:
    """Shapes of inputs to which no output of the same signal type in the file conforms."""
    outputs = _Outputs(file)
    shapes = sorted(file.graph.subject_objects(_ACCEPTS), key=lambda pair: file.offset(pair[0]))
    for port, shape in shapes[:MOST_SHAPES]:
        near = outputs.of(port)
        if 0 < len(near) <= MOST_OUTPUTS and not _met(file, shape, near):
            message = "No output of this signal type in this file conforms to this shape."
            yield file.at(file.positions.triples[port, _ACCEPTS, shape].predicate, "SC-L22", message)


class _Outputs:
    """The outputs of a file by their signal types."""

    def __init__(self, file: LintedFile) -> None:
        self._file = file
        self._by_type: dict[str, list[Node]] = {}
        self._serving: dict[str, list[Node]] = {}
        for output in sorted(set(file.graph.objects(None, _OUTPUT)), key=file.offset):
            for offered in () if isinstance(output, Literal) else file.graph.objects(output, _SIGNAL):
                self._by_type.setdefault(str(offered), []).append(output)

    def of(self, port: Node) -> list[Node]:
        """The outputs of others that serve a signal type of an input, in the widest sense, each once."""
        graph = self._file.graph
        owners = set(graph.subjects(_INPUT, port))
        own = {output for owner in owners for output in graph.objects(owner, _OUTPUT)}
        wanted = [str(signal) for signal in graph.objects(port, _SIGNAL)]
        return [
            one for one in dict.fromkeys(one for signal in wanted for one in self._of_type(signal)) if one not in own
        ]

    def _of_type(self, wanted: str) -> list[Node]:
        if wanted not in self._serving:
            some = (outputs for offered, outputs in self._by_type.items() if self._file.index.serves(offered, wanted))
            self._serving[wanted] = [output for outputs in some for output in outputs]
        return self._serving[wanted]


def _met(file: LintedFile, shape: Node, outputs: Sequence[Node]) -> bool:
    """Whether an output conforms to a shape, or that cannot be judged."""
    shapes = Graph()
    for triple in file.graph:
        shapes.add(triple)
    shapes.add((URIRef(_ASKED), SH.node, shape))
    nodes = [term for term in map(from_rdflib, outputs) if not isinstance(term, TypedLiteral)]
    try:
        wrong = violations(file.graph, shapes, _ASKED, nodes, "sc:accepts")
    except AuthorError:
        return True
    return len(wrong) < len(nodes) or any(isinstance(one, NotJudged) for some in wrong.values() for one in some)

"""Whether values can stand for the parameters that they are given to, judged as where a task is configured."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from rdflib import RDF, SH, Graph, URIRef
from rdflib.term import Node

from selfconf.errors import TemplateError
from selfconf.model.diagnostic import Diagnostic
from selfconf.model.template import Parameter
from selfconf.model.term import IRI
from selfconf.rdf.positions import Positions
from selfconf.rdf.rdflib_terms import from_rdflib, to_document
from selfconf.rdf.tasks import misfits
from selfconf.rdf.validation.diagnostics import at
from selfconf.rdf.vocabulary import SC


class _GivenValue(NamedTuple):
    """A value that a parameter is given, with the statement that gives it and the code of a wrong one."""

    subject: Node
    predicate: URIRef
    value: Node
    code: str


def unfit_values(graph: Graph, positions: Positions) -> Iterator[Diagnostic]:
    """Defaults of parameters, and values in bindings of tasks and composites, that their parameters do not allow.

    Only parameters of this file are looked at, in which all shapes are well-formed, and each parameter has one name.
    """
    by_parameter = _given(graph)
    document = to_document(graph if by_parameter else (), positions.file)
    for parameter, given in by_parameter.items():
        name = str(graph.value(parameter, URIRef(SC.name)))
        values = [from_rdflib(one.value) for one in given]
        try:
            reasons = misfits(Parameter(IRI.unchecked(str(parameter)), name), values, document)
        except TemplateError as error:  # the parameter is no shape that could be asked
            reasons = dict.fromkeys(values, error.message)
        for one, value in zip(given, values, strict=True):
            if value in reasons:
                message = f"This cannot stand for the parameter {name!r}: {reasons[value].rstrip('.')}."
                offset = positions.triples[one.subject, one.predicate, one.value].object
                yield at(positions, offset, one.code, message)


def _given(graph: Graph) -> dict[Node, list[_GivenValue]]:
    """What the parameters of a file are given."""
    found: dict[Node, list[_GivenValue]] = {}
    binding, bound, default = URIRef(SC.parameter), URIRef(SC.value), SH.defaultValue
    for parameter in graph.subjects(RDF.type, URIRef(SC.Parameter)):
        given = [_GivenValue(parameter, default, value, "SC-T09") for value in graph.objects(parameter, default)]
        for node in graph.subjects(binding, parameter):
            values, parameters = list(graph.objects(node, bound)), list(graph.objects(node, binding))
            if (None, URIRef(SC.binding), node) in graph and len(values) == len(parameters) == 1:
                given.append(_GivenValue(node, bound, values[0], "SC-K02"))
        if given:
            found[parameter] = given
    return found

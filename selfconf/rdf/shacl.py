"""pySHACL behind one function: which of these nodes conform to that shape, and what the others lack.

pySHACL is always handed graphs in rdflib's memory store, never text: a shapes text that does not parse would leave
rdflib with literal normalisation off for the whole process, and any other store is fifty times slower.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

import rdflib
from pyparsing import ParseException
from pyshacl import validate
from pyshacl.errors import ConstraintLoadError, ReportableRuntimeError, ShapeLoadError, ValidationFailure

from selfconf.errors import TemplateError
from selfconf.model.term import IRI
from selfconf.rdf.deadline import TimeUp, deadline
from selfconf.rdf.queries import faults

SECONDS = 30.0
"""How long one shape may be judged: what a pattern or query of it is matched against is untrusted."""
_SH = rdflib.Namespace("http://www.w3.org/ns/shacl#")
_TARGETS = frozenset(
    (_SH.targetClass, _SH.targetNode, _SH.targetSubjectsOf, _SH.targetObjectsOf, _SH.target, _SH.targetWhere)
)
_CLASSES = frozenset((rdflib.RDFS.Class, rdflib.OWL.Class))
"""A shape that is a class has its instances as targets (SHACL, 2.1.3.3)."""
_ILL_FORMED = (
    ShapeLoadError,
    ConstraintLoadError,
    ReportableRuntimeError,
    ParseException,
    re.error,
    AssertionError,
    AttributeError,
    LookupError,
    RecursionError,
    TypeError,
    ValueError,
)
"""What pySHACL and the libraries behind it raise on a shape that is ill-formed, also in ways they do not look for."""


def violations(
    subjects: rdflib.Graph, shapes: rdflib.Graph, shape: IRI, focus: Sequence[IRI], source: str
) -> dict[IRI, str]:
    """The nodes of `focus` that do not conform to `shape`, each with the message of its first violation.

    Conformance is that of SHACL, section 3.4: a result of any severity counts. Raises TemplateError, blaming
    `source`, where the shape itself is not well-formed.
    """
    if not focus:
        return {}
    for reason in faults(shapes).values():
        raise TemplateError(f"the shape {shape!r} is not evaluated: {reason}", file=source)
    try:
        with deadline(SECONDS):
            _, report, text = validate(
                subjects, shacl_graph=aimed(shapes, shape, focus), inference="none", advanced=False
            )
    except TimeUp:
        raise TemplateError(
            f"judging {len(focus)} components by the shape {shape!r} takes more than {SECONDS:g} s; "
            "look for a sh:pattern that repeats what is repeated already, such as ^(a+)+$",
            file=source,
        ) from None
    except _ILL_FORMED as error:
        raise TemplateError(
            f"the shape {shape!r} is not well-formed: {_first_line(str(error))}", file=source
        ) from error
    if isinstance(report, ValidationFailure) or not isinstance(report, rdflib.Graph):
        raise TemplateError(f"the shape {shape!r} cannot be judged: {_first_line(text)}", file=source)
    wanted = set(focus)
    found: dict[IRI, str] = {}
    for result in report.objects(predicate=_SH.result):
        node = IRI(str(report.value(result, _SH.focusNode)))
        if node in wanted:
            message = str(report.value(result, _SH.resultMessage) or "does not conform")
            found[node] = min(message, found.get(node, message))
    return found


def aimed(shapes: rdflib.Graph, shape: IRI, focus: Sequence[IRI]) -> rdflib.Graph:
    """The shapes with one target: `focus`, for `shape`.

    Not `focus_nodes` and `use_shapes`: under the latter pySHACL 0.40 takes every other shape that has an IRI for
    absent, so that `sh:property :named` asks for nothing.
    """
    found = rdflib.Graph()
    for subject, predicate, value in shapes:
        if predicate not in _TARGETS and not (predicate == rdflib.RDF.type and value in _CLASSES):
            found.add((subject, predicate, value))
    aim = rdflib.URIRef(shape)
    found.add((aim, rdflib.RDF.type, _SH.NodeShape))
    for node in focus:
        found.add((aim, _SH.targetNode, rdflib.URIRef(node)))
    return found


def _first_line(text: str) -> str:
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    return lines[0] if lines else "no reason given"

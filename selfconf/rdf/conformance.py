"""pySHACL behind one function: which of these nodes conform to that shape, and what the others lack.

pySHACL is always handed graphs in rdflib's memory store, never text: a shapes text that does not parse would leave
rdflib with literal normalisation off for the whole process, and any other store is fifty times slower.
"""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterable, Sequence

import rdflib
from pyparsing import ParseException
from pyshacl import validate
from pyshacl.errors import (
    ConstraintLoadError,
    ReportableRuntimeError,
    ShapeLoadError,
    ShapeRecursionWarning,
    ValidationFailure,
)

from selfconf.errors import TemplateError
from selfconf.model.obstacle import ShapeViolated
from selfconf.model.term import IRI
from selfconf.rdf.deadline import TimeUp, processor_limit
from selfconf.rdf.literal_comparison import UNORDERED
from selfconf.rdf.sparql import fault

SHAPE_SECONDS = 30.0
"""Processor time that judging by one shape may take: what a pattern or query is matched against is untrusted."""
_SH = rdflib.Namespace("http://www.w3.org/ns/shacl#")
_ASKING = rdflib.URIRef("urn:selfconf:asking")
_DEEPEST = 16
"""How many shapes within shapes pySHACL follows: its 15, and the one that asks."""
_TARGETS = frozenset(
    (_SH.targetClass, _SH.targetNode, _SH.targetSubjectsOf, _SH.targetObjectsOf, _SH.target, _SH.targetWhere)
)
_CLASSES = frozenset((rdflib.RDFS.Class, rdflib.OWL.Class))
"""A shape that is a class has its instances as targets (SHACL, 2.1.3.3)."""
_NOTHING = IRI("urn:selfconf:nothing")
"""A node about which nothing is said."""
_NO_ORDER = (*UNORDERED, ReportableRuntimeError)
"""What comes through pySHACL where two values have no order; the last is its own, for blank nodes."""
_ILL_FORMED = (
    *UNORDERED,
    ShapeLoadError,
    ConstraintLoadError,
    ReportableRuntimeError,
    ParseException,
    re.error,
    AssertionError,
    AttributeError,
    LookupError,
    RecursionError,
    ValueError,
)
"""What pySHACL and the libraries behind it raise on a shape that is ill-formed, also in ways they do not look for."""


def violations(
    subjects: rdflib.Graph, shapes: rdflib.Graph, shape: IRI, focus: Sequence[IRI], source: str
) -> dict[IRI, list[ShapeViolated]]:
    """The nodes of `focus` that do not conform to `shape`, each with its violations, one for each property shape.

    Conformance is that of SHACL, section 3.4: a result of any severity counts. So does a value that cannot be compared
    with another (4.3, 4.5.3). Raises TemplateError, blaming `source`, where the shape itself is not well-formed.
    """
    if not focus:
        return {}
    for reason in faults(shapes).values():
        raise TemplateError(f"the shape {shape!r} is not evaluated: {reason}", file=source)
    try:
        with processor_limit(SHAPE_SECONDS):
            try:
                return _found(subjects, shapes, shape, focus, source)
            except _NO_ORDER:
                _found(subjects, shapes, shape, [_NOTHING], source)  # the shape may be at fault: it then is here too
                return _bisected(subjects, shapes, shape, focus, source)
    except TimeUp:
        raise TemplateError(
            f"judging {len(focus)} components by the shape {shape!r} takes more than {SHAPE_SECONDS:g} s of processor "
            "time; look for a sh:pattern that repeats what is repeated already, such as ^(a+)+$",
            file=source,
        ) from None
    except _ILL_FORMED as error:
        raise TemplateError(f"the shape {shape!r} is not well-formed: {reason_of(error)}", file=source) from error


def _bisected(
    subjects: rdflib.Graph, shapes: rdflib.Graph, shape: IRI, focus: Sequence[IRI], source: str
) -> dict[IRI, list[ShapeViolated]]:
    """The violations of each node where pySHACL stops at some, as they have values without an order."""
    try:
        return _found(subjects, shapes, shape, focus, source)
    except _NO_ORDER:
        if len(focus) == 1:
            return {focus[0]: [ShapeViolated("Value cannot be compared")]}
    half = len(focus) // 2
    parts = [_bisected(subjects, shapes, shape, part, source) for part in (focus[:half], focus[half:])]
    return parts[0] | parts[1]


def _found(
    subjects: rdflib.Graph, shapes: rdflib.Graph, shape: IRI, focus: Sequence[IRI], source: str
) -> dict[IRI, list[ShapeViolated]]:
    report, text = judged(subjects, aimed(shapes, (shape,), focus))
    if isinstance(report, ValidationFailure) or not isinstance(report, rdflib.Graph):
        raise TemplateError(f"the shape {shape!r} cannot be judged: {first_line(text)}", file=source)
    found: dict[IRI, list[ShapeViolated]] = {}
    for result in report.objects(predicate=_SH.result):
        found[IRI(str(report.value(result, _SH.focusNode)))] = _details(report, result)
    return found


def _details(report: rdflib.Graph, result: rdflib.term.Node) -> list[ShapeViolated]:
    """What a node lacks, sorted: of each property shape, and of each constraint on the node itself, one violation."""
    least: dict[tuple[object, ...], ShapeViolated] = {}
    for detail in report.objects(result, _SH.detail):
        path = report.value(detail, _SH.resultPath)
        message = str(report.value(detail, _SH.resultMessage) or "does not conform")
        one = ShapeViolated(message, IRI(str(path)) if isinstance(path, rdflib.URIRef) else None)
        constraint = (report.value(detail, _SH.sourceConstraintComponent), message) if path is None else ()
        thing = report.value(detail, _SH.sourceShape), *constraint
        least[thing] = min(one, least.get(thing, one), key=lambda violation: violation.message)
    return sorted(least.values(), key=lambda violation: violation.message) or [ShapeViolated("does not conform")]


def judged(subjects: rdflib.Graph, shapes: rdflib.Graph) -> tuple[object, str]:
    """The report of pySHACL and its text.

    That a shape comes back to itself, it would tell on stderr; SHACL leaves open what such a shape means (3.4.3), and
    pySHACL takes it to hold where it comes back.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ShapeRecursionWarning)
        _, report, text = validate(
            subjects, shacl_graph=shapes, inference="none", advanced=False, max_validation_depth=_DEEPEST
        )
    return report, text


def aimed(shapes: rdflib.Graph, wanted: Iterable[IRI], focus: Sequence[IRI]) -> rdflib.Graph:
    """The shapes with one target: each node of `focus`, for a shape that asks by `sh:node` for those that are wanted.

    So each result is about a node that does not conform to one of them, what it lacks being details. Their own results
    would not tell: those of a property shape within a property shape name the value as their focus node. And not
    `focus_nodes` and `use_shapes`: under the latter pySHACL 0.40 takes every other shape that has an IRI for absent, so
    that `sh:property :named` asks for nothing.
    """
    found = rdflib.Graph()
    for subject, predicate, value in shapes:
        if predicate not in _TARGETS and not (predicate == rdflib.RDF.type and value in _CLASSES):
            found.add((subject, predicate, value))
    found.add((_ASKING, rdflib.RDF.type, _SH.NodeShape))
    found.add((_ASKING, _SH.message, rdflib.Literal("does not conform")))  # else each result lists all that are wanted
    for aim in map(rdflib.URIRef, wanted):
        found.add((aim, rdflib.RDF.type, _SH.NodeShape))
        found.add((_ASKING, _SH.node, aim))
    for node in focus:
        found.add((_ASKING, _SH.targetNode, rdflib.URIRef(node)))
    return found


def reason_of(error: Exception) -> str:
    """What an error says, or at least what kind of error it is."""
    return first_line(str(error)) or f"pySHACL meets a {type(error).__name__}"


def first_line(text: str) -> str:
    """The first line of a text that is not blank, or nothing."""
    return next((line.strip() for line in text.splitlines() if line.strip()), "")


def faults(shapes: rdflib.Graph) -> dict[tuple[rdflib.term.Node, ...], str]:
    """Every query in some shapes that is not evaluated, as the triple that holds it, and why."""
    return {
        (subject, predicate, query): reason
        for predicate in (_SH.select, _SH.ask, _SH.construct, _SH.update)
        for subject, query in shapes.subject_objects(predicate)
        if (reason := fault(str(query))) is not None
    }

"""Whether the shape of a role is well-formed SHACL, so that it can be asked about a component at all.

The shape that W3C gives for shapes (SHACL, appendix C; pySHACL brings it along) finds most of what can be
wrong, and knows where. Patterns have to be regular expressions and queries SPARQL, which it does not look
at; nor at how deep shapes nest. What is left shows in a trial run: each role is asked about a component of no
properties.

A parameter stands where its value will stand, so both look at the template with a sample in its place:
one of the parameter's datatype. What a parameter of no particular datatype does in a shape is not known
beforehand.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator
from functools import cache
from graphlib import CycleError, TopologicalSorter
from importlib.resources import files
from itertools import chain

from pyshacl.errors import ReportableRuntimeError, ValidationFailure
from rdflib import RDF, SH, XSD, Graph, Literal, URIRef
from rdflib.term import Node

from selfconf.model.diagnostic import Diagnostic
from selfconf.model.literal_values import in_lexical_space, natural_number
from selfconf.model.term import IRI
from selfconf.rdf.conformance import aimed, first_line, judged, reason_of
from selfconf.rdf.permitted_fields import DEEPEST_SHAPE, LISTS_OF_SHAPES, SHAPE_VALUED
from selfconf.rdf.positions import Positions
from selfconf.rdf.rdflib_terms import from_rdflib
from selfconf.rdf.read_shapes import ReadShapes
from selfconf.rdf.shacl import (
    BESIDES,
    COUNTS,
    DESCRIBED,
    ILL_FORMED,
    LISTS,
    ONLY_WITH_A_PATH,
    PATH_FORMS,
    STATED_ONCE,
    MatchTooCostly,
    no_pattern,
    of_values,
    pattern_fault,
    refused_queries,
    said_alone,
    said_twice,
    unfit,
)
from selfconf.rdf.validation.diagnostics import at
from selfconf.rdf.validation.lints.normal_form import ShapeSource
from selfconf.rdf.validation.placed_document import PlacedDocument
from selfconf.rdf.vocabulary import SC

_SAMPLES: dict[Node, Literal] = {
    XSD.string: Literal("sample"),
    XSD.boolean: Literal(True),
    XSD.integer: Literal(1),
    XSD.decimal: Literal("1.0", datatype=XSD.decimal),
    XSD.double: Literal(1.0),
    XSD.date: Literal("2000-01-01", datatype=XSD.date),
    XSD.dateTime: Literal("2000-01-01T00:00:00Z", datatype=XSD.dateTime),
}
_STAND_IN = URIRef("urn:-")  # short, so that no pattern takes long
_RECRUITED = "urn:selfconf:recruited:"
"""What the shapes of what is recruited are called in a trial, with numbers behind it."""
_LANGUAGE = Literal("en")
_COUNTS: dict[Node, Node] = dict.fromkeys((SH.qualifiedMinCount, SH.qualifiedMaxCount), Literal(1))
"""Samples for what stands beside sh:qualifiedValueShape, which says nothing alone."""
_OF_PROPERTIES: dict[Node, Node] = {
    **dict.fromkeys((SH.minCount, SH.maxCount), Literal(1)),
    **dict.fromkeys((SH.lessThan, SH.lessThanOrEquals), _STAND_IN),
    SH.uniqueLang: Literal(True),
}
"""Samples for what a shape without a path may not say, with whatever value."""


def endless_lists(graph: Graph, positions: Positions) -> Iterator[Diagnostic]:
    """Lists that come back to one of their own cells; each is reported once."""
    finished: set[Node] = set()
    for start in set(graph.subjects(RDF.rest)):
        passed: set[Node] = set()
        cell: Node | None = start
        while cell is not None and cell not in finished and cell not in passed:
            passed.add(cell)
            cell = graph.value(cell, RDF.rest)
        if cell in passed and cell is not None:
            yield at(positions, positions.offset(cell), "SC-S06", "This list has no end.")
        finished |= passed


def malformed_roles(graph: Graph, positions: Positions) -> Iterator[Diagnostic]:
    """What keeps the roles of a file from being shapes."""
    roles = sorted({str(role) for role in graph.subjects(RDF.type, URIRef(SC.Role)) if isinstance(role, URIRef)})
    if not roles:
        return
    shapes = _with_samples(graph)
    for role in roles:
        shapes.add((URIRef(role), RDF.type, SH.NodeShape))
    recruited = [one for one in graph.objects(None, URIRef(SC.recruits)) if not isinstance(one, Literal)]
    for shape in recruited:
        shapes.add((shape, RDF.type, SH.PropertyShape if (shape, SH.path, None) in graph else SH.NodeShape))
    faults = [*_with_own_path(shapes, graph, positions), *_literals(shapes, positions)]
    faults += _faults(shapes, graph, positions)
    faults += [
        fault for look in (_alone, _constraints, _languages, _patterns, _queries) for fault in look(graph, positions)
    ]
    faults += _too_deep(shapes, roles, positions)
    plain = [fault for fault in faults if fault.message != ILL_FORMED]
    yield from plain or faults
    if not faults:
        yield from _trials(shapes, roles, recruited, positions)


def _trials(
    shapes: Graph, roles: Iterable[str], recruited: Iterable[Node], positions: Positions
) -> Iterator[Diagnostic]:
    """The roles, and what they recruit, that cannot be evaluated, each tried by itself if not all together can be."""
    tried: dict[str, tuple[Node, str]] = {role: (URIRef(role), "The shape of this role") for role in roles}
    for number, shape in enumerate(recruited):
        name = f"{_RECRUITED}{number}"  # in brackets it has none
        for predicate, value in list(shapes.predicate_objects(shape)):
            shapes.add((URIRef(name), predicate, value))
        tried[name] = shape, "The shape of what is recruited"
    for name, (shape, words) in tried.items() if _trial(shapes, *tried) is not None else ():
        reason = _trial(shapes, name)
        if reason:
            yield at(positions, positions.offset(shape), "SC-T13", f"{words} cannot be evaluated: {reason}")


def _samples(graph: Graph) -> dict[Node, Node | None]:
    """A sample for each parameter, by what it says of its values; None where it says too little."""
    samples: dict[Node, Node | None] = {}
    for parameter in graph.subjects(RDF.type, URIRef(SC.Parameter)):
        datatype = graph.value(parameter, SH.datatype)
        kind = graph.value(parameter, SH.nodeKind)
        samples[parameter] = parameter if kind == SH.IRI else _SAMPLES.get(datatype) if datatype else None
    return samples


def _by_place(graph: Graph, subject: Node, predicate: Node, languages: Container[Node | None]) -> Node | None:
    """A sample for a parameter that says too little of its values, by the place where it stands."""
    if subject in languages and predicate == RDF.first:
        return _LANGUAGE
    if str(predicate) in PATH_FORMS | {str(SH.path)}:
        return _STAND_IN
    with_path = (subject, SH.path, None) in graph
    return _COUNTS.get(predicate) or (None if with_path else _OF_PROPERTIES.get(predicate))


def _with_samples(graph: Graph) -> Graph:
    """The graph with samples for parameters, without what says nothing before the parameter is bound."""
    samples = _samples(graph)
    shapes, of_any_term = Graph(), ShapeSource(graph).constraints | {RDF.first, SH.hasValue}
    languages = {
        cell for head in graph.objects(None, SH.languageIn) for cell in graph.transitive_objects(head, RDF.rest)
    }
    for subject, predicate, value in graph:
        sample = samples.get(value, value)
        if sample is None:
            sample = _by_place(graph, subject, predicate, languages)
        if str(predicate) in LISTS | DESCRIBED or (sample is None and predicate in of_any_term):
            sample = value  # no parameter will do for a list or a constraint, and any term where a term is asked for
        if sample is not None:
            shapes.add((subject, predicate, sample))
    for prefix, namespace in graph.namespaces():
        shapes.bind(prefix, namespace, replace=True)
    return shapes


@cache
def shape_of_shapes() -> Graph:
    """The shape to which every shapes graph has to conform."""
    return Graph().parse(data=(files("pyshacl") / "assets" / "shacl-shacl.ttl").read_text("utf-8"))


@cache
def read_shape_of_shapes() -> ReadShapes:
    """The shape to which every shapes graph has to conform, read by pySHACL."""
    return ReadShapes(shape_of_shapes())


def _faults(shapes: Graph, graph: Graph, positions: Positions) -> Iterator[Diagnostic]:
    """What the shape of shapes finds in a graph with samples for parameters, told of the graph that has these."""
    try:
        results = list(read_shape_of_shapes().results(shapes))
    except ValidationFailure:
        return
    told: set[tuple[Node, Node]] = set()
    for result in results:
        focus, path, value = result[SH.focusNode], result.get(SH.resultPath), result.get(SH.value)
        if isinstance(path, URIRef) and (loose := _without_parentheses(shapes, positions, focus, path)):
            if (focus, path) not in told:  # members with commas between are one mistake
                yield at(positions, min(loose), "SC-T13", unfit(IRI.unchecked(path)))
            told.add((focus, path))
            continue
        offsets = positions.triples.get((focus, path, value)) if path is not None and value is not None else None
        if offsets is not None and isinstance(path, URIRef):
            yield at(positions, offsets.object, "SC-T13", unfit(IRI.unchecked(path)))
        elif value is not None and (parameter := _sampled(graph, focus, path)) and isinstance(path, URIRef):
            message = f"{unfit(IRI.unchecked(path)).rstrip('.')}, and this parameter stands for another value."
            place = positions.triples[focus, path, parameter].object
            yield at(
                positions, place, "SC-T13", message, hint="See the sh:datatype and the sh:nodeKind of the parameter."
            )
        else:
            offset, message = _malformed(shapes, graph, positions, focus)
            yield at(positions, offset, "SC-T13", message)


def _without_parentheses(shapes: Graph, positions: Positions, shape: Node, predicate: URIRef) -> list[int]:
    """Where several values stand that are no lists, of a predicate whose one value is a list."""
    values = list(shapes.objects(shape, predicate)) if str(predicate) in LISTS else []
    loose = [one for one in values if one != RDF.nil and (one, RDF.first, None) not in shapes]
    found = [positions.triples.get((shape, predicate, one)) for one in loose if len(values) > 1]
    return [one.object for one in found if one]


def _sampled(graph: Graph, shape: Node, predicate: Node | None) -> Node | None:
    """The parameter that is a value of a shape."""
    values = graph.objects(shape, predicate) if predicate is not None else ()
    return next((value for value in values if (value, RDF.type, URIRef(SC.Parameter)) in graph), None)


def _with_own_path(shapes: Graph, graph: Graph, positions: Positions) -> Iterator[Diagnostic]:
    """Node shapes, as roles are, with a path: beside one pySHACL evaluates none of the others either."""
    for shape in set(graph.subjects(SH.path)) & set(shapes.subjects(RDF.type, SH.NodeShape)):
        for path in graph.objects(shape, SH.path):
            offsets = positions.triples.get((shape, SH.path, path))
            message = "A role is about its component itself, so it has no sh:path: write sh:property [ sh:path ... ]."
            yield at(positions, offsets.object if offsets else positions.offset(shape), "SC-T13", message)


def _malformed(shapes: Graph, graph: Graph, positions: Positions, focus: Node) -> tuple[int, str]:
    """What is wrong with a shape as a whole, and where."""
    offset = positions.offset(focus)
    if (None, SH.property, focus) in shapes and len(set(shapes.objects(focus, SH.path))) != 1:
        return offset, "A property shape has exactly one sh:path, the property that it is about."
    for once in sorted(STATED_ONCE):
        stated = [positions.triples.get((focus, URIRef(once), one)) for one in shapes.objects(focus, URIRef(once))]
        if len(stated) > 1:
            return max((one.object for one in stated if one), default=offset), f"{said_twice(once)}."
    if (focus, SH.path, None) in shapes:
        return _malformed_with_path(shapes, positions, focus)
    for predicate, value in graph.predicate_objects(focus):
        statement = positions.triples.get((focus, predicate, value))
        if statement and isinstance(predicate, URIRef) and IRI.unchecked(predicate) in ONLY_WITH_A_PATH:
            word = predicate.removeprefix(str(SH))
            message = of_values(IRI.unchecked(predicate))
            instead = f"; how many play a role is sc:{word}" if word in ("minCount", "maxCount") else ""
            return statement.predicate, f"{message}{instead}."
    return offset, ILL_FORMED


def _malformed_with_path(shapes: Graph, positions: Positions, shape: Node) -> tuple[int, str]:
    """What is wrong with a shape that has a path, and where: that it stands behind sh:node, as far as is known."""
    asking = [positions.triples.get((one, SH.node, shape)) for one in shapes.subjects(SH.node, shape)]
    places = [one.object for one in asking if one]
    return (min(places), unfit(IRI.unchecked(SH.node))) if places else (positions.offset(shape), ILL_FORMED)


def _literals(shapes: Graph, positions: Positions) -> Iterator[Diagnostic]:
    """Literals where a shape has to stand, and numbers that count nothing, which the shape of shapes overlooks."""
    for predicate in map(URIRef, sorted(COUNTS)):
        for shape, value in shapes.subject_objects(predicate):
            offsets = positions.triples.get((shape, predicate, value))
            if isinstance(value, Literal) and offsets is not None and natural_number(from_rdflib(value)) is None:
                yield at(positions, offsets.object, "SC-T13", unfit(IRI.unchecked(predicate)))
    for predicate in (SH.node, SH["not"], SH.qualifiedValueShape):
        for shape, value in shapes.subject_objects(predicate):
            offsets = positions.triples.get((shape, predicate, value))
            if isinstance(value, Literal) and offsets is not None:
                yield at(positions, offsets.object, "SC-T13", unfit(IRI.unchecked(predicate)))


def _constraints(graph: Graph, positions: Positions) -> Iterator[Diagnostic]:
    """Values of sh:sparql without a query to ask, and lists of no shapes, which the shape of shapes overlooks."""
    for shape, constraint in graph.subject_objects(SH.sparql):
        if len(set(graph.objects(constraint, SH.select))) != 1:
            offset = positions.triples[shape, SH.sparql, constraint].object
            yield at(positions, offset, "SC-T13", unfit(IRI.unchecked(SH.sparql)))
    for predicate in map(URIRef, sorted(LISTS_OF_SHAPES)):
        for shape in graph.subjects(predicate, RDF.nil):
            offset = positions.triples[shape, predicate, RDF.nil].object
            yield at(positions, offset, "SC-T13", unfit(IRI.unchecked(predicate)))


def _languages(graph: Graph, positions: Positions) -> Iterator[Diagnostic]:
    """Languages that are no tags, as with an underscore, which the shape of shapes overlooks."""
    for shape, head in graph.subject_objects(SH.languageIn):
        cells = graph.transitive_objects(head, RDF.rest)
        tags = [str(tag) for cell in cells for tag in graph.objects(cell, RDF.first) if isinstance(tag, Literal)]
        if not all(in_lexical_space(tag, str(XSD.language)) for tag in tags):
            offset = positions.triples[shape, SH.languageIn, head].object
            yield at(positions, offset, "SC-T13", unfit(IRI.unchecked(SH.languageIn)))


def _alone(graph: Graph, positions: Positions) -> Iterator[Diagnostic]:
    """What says nothing without another property, which is not there; a trial tells it of shapes for no values only."""
    for predicate, besides in BESIDES.items():
        for shape, value in graph.subject_objects(URIRef(predicate)):
            if not any((shape, URIRef(one), None) in graph for one in besides):
                offset = positions.triples[shape, URIRef(predicate), value].predicate
                yield at(positions, offset, "SC-T13", f"{said_alone(predicate)}.")


def _patterns(graph: Graph, positions: Positions) -> Iterator[Diagnostic]:
    """Values of sh:pattern that are no regular expressions."""
    for shape, pattern in graph.subject_objects(SH.pattern):
        flags = str(graph.value(shape, SH.flags) or "")
        fault = pattern_fault(str(pattern) if isinstance(pattern, Literal) else "", flags)
        if fault is not None:
            offset = positions.triples[shape, SH.pattern, pattern].object
            yield at(positions, offset, "SC-T13", f"{no_pattern(fault)}.")


def _queries(graph: Graph, positions: Positions) -> Iterator[Diagnostic]:
    """Queries of roles that are no SPARQL, that would leave this machine, or that find nothing by mistake."""
    if (None, SH.select, None) not in graph and (None, SH.ask, None) not in graph:
        return
    placed = PlacedDocument.of(positions)
    refused = dict(chain.from_iterable(refused_queries(placed.document, one) for one in placed.document.statements))
    for statement, reason in refused.items():
        yield at(positions, placed.places[statement].object, "SC-T13", reason)


def _too_deep(shapes: Graph, roles: Iterable[str], positions: Positions) -> Iterator[Diagnostic]:
    """The roles that nest shapes deeper than pySHACL follows; in a trial only those would show that need no values."""
    for role in map(URIRef, roles):
        if _height(shapes, role) > DEEPEST_SHAPE:
            message = f"The shape of this role nests shapes more than {DEEPEST_SHAPE} deep."
            yield at(positions, positions.offset(role), "SC-T13", message)


def _height(shapes: Graph, role: Node) -> int:
    """How deep a shape nests others, itself included; 0 if one of them comes back to itself: values decide how far."""
    inside: dict[Node, frozenset[Node]] = {}
    waiting = [role]
    while waiting:
        shape = waiting.pop()
        if shape not in inside:
            inside[shape] = frozenset(_within(shapes, shape))
            waiting += inside[shape]
    heights: dict[Node, int] = {}
    try:
        for shape in TopologicalSorter(inside).static_order():
            heights[shape] = 1 + max((heights[inner] for inner in inside[shape]), default=0)
    except CycleError:
        return 0
    return heights[role]


def _within(shapes: Graph, shape: Node) -> Iterator[Node]:
    """The shapes that a shape names or holds."""
    for predicate in SHAPE_VALUED:
        for value in shapes.objects(shape, URIRef(predicate)):
            if predicate in LISTS_OF_SHAPES:
                yield from shapes.items(value)
            else:
                yield value


def _trial(shapes: Graph, *roles: str) -> str | None:
    """Why some roles cannot be evaluated, or None if they can."""
    stage = Graph()
    stage.add((_STAND_IN, RDF.type, URIRef(SC.Component)))
    try:
        report, text = judged(stage, aimed(shapes, map(IRI.unchecked, roles), [IRI(_STAND_IN)]))
    except (ReportableRuntimeError, AssertionError, ValueError, TypeError, KeyError) as error:
        return _sentence(reason_of(error))
    except MatchTooCostly as error:
        return _sentence(str(error))
    return _sentence(first_line(text)) if isinstance(report, ValidationFailure) else None


def _sentence(text: str) -> str:
    return text if text.endswith(".") else f"{text}."

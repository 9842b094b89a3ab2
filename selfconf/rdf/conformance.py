"""pySHACL behind one function: which of these nodes conform to that shape, and what the others lack.

pySHACL is always handed graphs in rdflib's memory store, never text: a shapes text that does not parse would leave
rdflib with literal normalisation off for the whole process, and any other store is fifty times slower.
"""

from __future__ import annotations

import math
import re
import time
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, TypeVar

import rdflib
from pyparsing import ParseException
from pyshacl import validate
from pyshacl.errors import (
    ConstraintLoadError,
    ReportableRuntimeError,
    ShapeLoadError,
    ValidationFailure,
)
from pyshacl.graph_abstraction import DataGraph
from pyshacl.rdfutil.load import load_from_source
from pyshacl.validator import Validator

from selfconf.errors import TemplateError
from selfconf.model.obstacle import NotJudged, ShapeViolated
from selfconf.model.term import IRI
from selfconf.rdf.deadline import ProcessorTimeUp, TimeUp, processor_limit
from selfconf.rdf.literal_comparison import UNORDERED
from selfconf.rdf.permitted_fields import DEEPEST_SHAPE
from selfconf.rdf.pyshacl_corrections import corrected
from selfconf.rdf.rdflib_terms import rdflib_term
from selfconf.rdf.shacl import MatchTooCostly
from selfconf.rdf.sparql import fault
from selfconf.rdf.turtle import Node
from selfconf.rdf.violation_words import violation_words

Focus = TypeVar("Focus", bound=Node)
_PyshaclResults = Sequence[tuple[str, rdflib.term.Node, Iterable[tuple[Any, Any, Any]]]]
"""Results as pySHACL hands them on: a text, the node of the result, and the triples about it and its details."""
SHAPE_SECONDS = 120.0
"""Processor time that judging by one shape may take."""
FAILURE_SECONDS = 0.12
"""Processor time that may be lost with components that are given up: what they say is untrusted."""
SLOW_SECONDS = 1.0
"""Processor time that components may take in all beyond the share of each."""
SHARE_SECONDS, MOST_SHARE_SECONDS = 0.004, 0.04
"""Processor time that each component may take, as long as none conforms, and at most if some do (see `_Shares`)."""
LEAST_SECONDS = 0.03
"""Processor time for one more try; clocks of processor time go by milliseconds."""
_SH = rdflib.Namespace("http://www.w3.org/ns/shacl#")
_ASKING = rdflib.URIRef("urn:selfconf:asking")
_DEEPEST_TRIAL = DEEPEST_SHAPE + 1
"""How many shapes within shapes pySHACL follows in a trial run, where one more asks for them."""
_TARGETS = frozenset(
    (_SH.targetClass, _SH.targetNode, _SH.targetSubjectsOf, _SH.targetObjectsOf, _SH.target, _SH.targetWhere)
)
_CLASSES = frozenset((rdflib.RDFS.Class, rdflib.OWL.Class))
"""A shape that is a class has its instances as targets (SHACL, 2.1.3.3)."""
_NOTHING = IRI("urn:-")
"""A node about which nothing is said; its name is short, so that no pattern takes long."""
_NO_ORDER = (*UNORDERED, ReportableRuntimeError)
"""What comes through pySHACL where two values have no order; the last is its own, for blank nodes."""
_TOO_DEEP = re.compile("Validation path too deep|Path traversal depth is too much")
"""What pySHACL says where shapes within shapes, or the steps of a path, are more than it follows."""
_SHAPE_AT_FAULT = (ShapeLoadError, ConstraintLoadError, ParseException)
"""What pySHACL raises where nothing but the shape can be at fault."""
_ILL_FORMED = (
    *UNORDERED,
    *_SHAPE_AT_FAULT,
    ReportableRuntimeError,
    re.error,
    AssertionError,
    AttributeError,
    LookupError,
    RecursionError,
    ValueError,
)
"""What pySHACL and the libraries behind it raise on a shape that is ill-formed, also in ways they do not look for."""


def violations(
    subjects: rdflib.Graph,
    shapes: rdflib.Graph,
    shape: IRI,
    focus: Sequence[Focus],
    source: str,
    called: str | None = None,
    sizes: Mapping[Focus, int] | None = None,
) -> dict[Focus, list[ShapeViolated | NotJudged]]:
    """The nodes of `focus` that do not conform to `shape`, each with its violations, one for each property shape.

    Conformance is that of SHACL, section 3.4: a result of any severity counts. So does a value that cannot be compared
    with another (4.3, 4.5.3). A node whose statements take too long to judge, or that pySHACL cannot judge, is
    `NotJudged`; the others do not suffer from it. `sizes` bounds how many values a node has of one property, which is
    counted where it is not given. Raises TemplateError, blaming `source` and the shape as it is `called`, where the
    shape itself is not well-formed.
    """
    if not focus:
        return {}
    called = called or f"the shape {shape!r}"
    for reason in faults(shapes).values():
        raise TemplateError(f"{called} is not evaluated: {reason}", file=source)
    try:
        # The limit last: the processor time of a thread that judges meanwhile, and is waited for, would count.
        with corrected(), processor_limit(SHAPE_SECONDS):
            judge = _Judge(subjects, shapes, shape)
            sized = ((judge.size(node) if sizes is None else sizes[node], node) for node in focus)
            found = {node: judge.wrong(node, size) for size, node in sorted(sized)}
    except TimeUp:
        raise TemplateError(f"{called} takes more than {SHAPE_SECONDS:g} s of processor time", file=source) from None
    except MatchTooCostly as error:  # with nothing said, so that the text is the shape's own
        raise TemplateError(f"{called} cannot be judged: {error}", file=source) from None
    except ValidationFailure as error:
        raise TemplateError(f"{called} cannot be judged: {first_line(str(error.message))}", file=source) from error
    except _ILL_FORMED as error:
        raise TemplateError(f"{called} is not well-formed: {reason_of(error)}", file=source) from error
    # Worded here, where an error of the wording is not taken for one of the shape or of pySHACL.
    return {
        node: [wrong] if isinstance(wrong, ShapeViolated | NotJudged) else [*_details(wrong, rdflib_term(node))]
        for node, wrong in found.items()
        if wrong is not None
    }


class _Judge:
    """pySHACL, asked about one node after another, so that each answers for its own statements alone."""

    def __init__(self, subjects: rdflib.Graph, shapes: rdflib.Graph, shape: IRI) -> None:
        dataset = load_from_source(subjects, multigraph=True)
        dataset.default_union = True  # pySHACL looks at all of its graphs
        data = DataGraph.from_rdflib(dataset)
        loaded = load_from_source(aimed(shapes, (shape,), ()), multigraph=True)
        validator = Validator(data, shacl_graph=loaded, options={"max_validation_depth": _DEEPEST_TRIAL})
        assert validator.shacl_graph.shapes  # looks at all of them: what is ill-formed shows
        self._graph, self._data, self._executor = subjects, data, validator.make_executor()
        self._shape = validator.shacl_graph.lookup_shape_from_node(rdflib.URIRef(shape))
        self._results(_NOTHING)  # what is at fault with nothing said is the shape; and queries are read here
        began = time.process_time()
        self._results(_NOTHING)
        self._shares = _Shares(time.process_time() - began)

    def size(self, node: Node) -> int:
        """How many values a node has of the property of which it has most: what a query may have to combine."""
        return max(
            Counter(predicate for _, predicate, _ in self._graph.triples((rdflib_term(node), None, None))).values(),
            default=0,
        )

    def wrong(self, node: Node, size: int) -> _PyshaclResults | ShapeViolated | NotJudged | None:
        """What keeps a node of some size from conforming, or from being judged; None if it conforms."""
        try:
            return self._shares.judged(size, lambda: self._results(node))
        except MatchTooCostly as error:
            return NotJudged(str(error))
        except ProcessorTimeUp:
            return NotJudged("what it says takes too long to be judged by the shape")
        except _SHAPE_AT_FAULT:
            raise
        except _ILL_FORMED as error:
            if _TOO_DEEP.match(str(error)):  # only where there are values so deep; a shape may come back to itself
                return NotJudged("the shape leads deeper into what it says than pySHACL follows")
            if isinstance(error, _NO_ORDER):
                return ShapeViolated("Value cannot be compared")
            return NotJudged(f"pySHACL stops at what it says ({reason_of(error)})")

    def _results(self, node: Node) -> _PyshaclResults | None:
        conforms, results = self._shape.validate(self._executor, self._data, focus=rdflib_term(node))
        return None if conforms and not results else results


class _Shares:
    """How much processor time each node may take: a share of its own, and some may take more, but not for long.

    The share is twice what the slowest node takes that conforms: what cannot play is not to hold up what can. Once the
    time beyond the shares is used up, a node is not tried if it says more than any that kept to its share, and as much
    as one that took too long. So nodes are judged in the order of their size, and one that says little is judged
    whatever others say.
    """

    def __init__(self, least: float) -> None:
        """`least` is the processor time that judging takes where nothing is said, on this machine."""
        self._share = max(SHARE_SECONDS, 4 * least)
        slowness = self._share / SHARE_SECONDS
        self._failures, self._slow = slowness * FAILURE_SECONDS, slowness * SLOW_SECONDS
        self._fine, self._too_large = 0, math.inf

    def judged(self, size: int, judge: Callable[[], _PyshaclResults | None]) -> _PyshaclResults | None:
        """What is wrong with a node of some size, or None. Raises ProcessorTimeUp where that takes too long."""
        spent = self._failures < LEAST_SECONDS or not self._slow
        if spent and size > self._fine and size >= self._too_large:
            raise ProcessorTimeUp
        began = time.process_time()
        try:
            with processor_limit(self._share + min(self._failures, self._slow) / 2):
                wrong = judge()
        except ProcessorTimeUp:
            self._failures = max(self._failures - (time.process_time() - began), 0.0)
            self._too_large = min(self._too_large, size)
            raise
        taken = time.process_time() - began
        if wrong is None:
            self._share = max(self._share, min(2 * taken, MOST_SHARE_SECONDS))
        if taken <= self._share:
            self._fine = max(self._fine, size)
        else:
            self._slow = max(self._slow - (taken - self._share), 0.0)
            self._too_large = self._too_large if self._slow else min(self._too_large, size)
        return wrong


def _details(results: _PyshaclResults, asked: rdflib.term.Node) -> list[ShapeViolated]:
    """What a node lacks, sorted: of each property shape, and of each constraint on the node itself, one violation."""
    least: dict[tuple[object, ...], ShapeViolated] = {}
    for _, result, triples in results:
        said: dict[Any, dict[Any, list[Any]]] = {}
        for subject, predicate, value in triples:
            placed = value if isinstance(value, tuple) else (None, value)
            said.setdefault(subject, {}).setdefault(predicate, []).append(placed)
        own = said.pop(result)
        path = next((path for _, path in own.get(_SH.resultPath, ())), None)
        message = violation_words(own, list(said.values()), asked)
        one = ShapeViolated(message, IRI.unchecked(str(path)) if isinstance(path, rdflib.URIRef) else None)
        (_, shape), (_, kind) = own[_SH.sourceShape][0], own[_SH.sourceConstraintComponent][0]
        thing = (shape, kind, message) if path is None else (shape,)
        least[thing] = min(one, least.get(thing, one), key=lambda violation: violation.message)
    return sorted(least.values(), key=lambda violation: violation.message) or [ShapeViolated("does not conform")]


def judged(subjects: rdflib.Graph, shapes: rdflib.Graph) -> tuple[object, str]:
    """The report of pySHACL and its text."""
    with corrected():
        _, report, text = validate(
            subjects, shacl_graph=shapes, inference="none", advanced=False, max_validation_depth=_DEEPEST_TRIAL
        )
    return report, text


def aimed(shapes: rdflib.Graph, wanted: Iterable[IRI], focus: Sequence[IRI]) -> rdflib.Graph:
    """The shapes with one target: each node of `focus`, for a shape that asks by `sh:node` for those that are wanted,
    or by `sh:property` where these are property shapes.

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
        if (aim, _SH.path, None) in shapes:
            found.add((_ASKING, _SH.property, aim))
        else:
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

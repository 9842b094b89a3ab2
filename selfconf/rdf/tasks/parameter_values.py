"""Which values a parameter of a template can have: the parameter is a shape for its value."""

from __future__ import annotations

from collections.abc import Iterable

from selfconf.model.obstacle import NotJudged, ShapeViolated
from selfconf.model.template import Parameter
from selfconf.model.term import IRI, Term
from selfconf.rdf.shacl import MatchTooCostly, ValueTest, compiled, component_parameters
from selfconf.rdf.turtle import Document
from selfconf.rdf.vocabulary import SH, TYPE


def misfits(parameter: Parameter, values: Iterable[Term], document: Document) -> dict[Term, str]:
    """Those of some values that cannot stand for a parameter, each with the reason.

    A parameter is a shape for its value (`sh:nodeKind`, `sh:datatype`, `sh:in` ...). Values that pass the compiled
    tests of all its constraints conform; the others are judged, and the reason is worded, by pySHACL.
    """
    constraints = _constraints(parameter.iri, document)
    tests, covered = compiled(constraints)
    left = [value for value in values if covered != constraints.keys() or not _passes(tests, value)]
    return _judged(parameter, left, document) if constraints and left else {}


def suitable(parameter: Parameter, values: frozenset[Term], document: Document) -> frozenset[Term]:
    """The values of a set that can stand for a parameter; pySHACL judges only what the compiled tests do not cover."""
    constraints = _constraints(parameter.iri, document)
    tests, covered = compiled(constraints)
    if covered == constraints.keys():
        return frozenset([value for value in values if _passes(tests, value)])
    return values - _judged(parameter, values, document).keys()


def _passes(tests: Iterable[ValueTest], value: Term) -> bool:
    """Whether a value passes all tests, and that can be told in time."""
    try:
        return all(test.passes(value) for test in tests)
    except MatchTooCostly:
        return False


def _constraints(parameter: IRI, document: Document) -> dict[IRI, list[Term]]:
    """What a parameter asks of its value: the SHACL parameters that it states, each with its values."""
    found: dict[IRI, list[Term]] = {}
    own = component_parameters(document)
    for predicate, value in document.statements.get(parameter, ()):
        if predicate in own or (predicate in SH and predicate != SH.defaultValue):
            found.setdefault(predicate, []).append(value)
    return found


def _judged(parameter: Parameter, values: Iterable[Term], document: Document) -> dict[Term, str]:
    """The values that pySHACL finds not to conform, each with its message."""
    # Loading rdflib and pySHACL takes longer than most configurations, and most values never get here.
    import rdflib

    from selfconf.rdf.conformance import violations
    from selfconf.rdf.rdflib_terms import rdflib_term, to_rdflib

    probes = {IRI(f"urn:selfconf:probe:{number}"): value for number, value in enumerate(values)}
    probe, probe_shape = IRI("urn:selfconf:probe"), IRI("urn:selfconf:probe-shape")
    shapes = to_rdflib(document.triples())
    node, path = rdflib.URIRef(probe_shape), rdflib.BNode()
    shapes.add((node, rdflib.URIRef(TYPE), rdflib.URIRef(SH.NodeShape)))
    shapes.add((node, rdflib.URIRef(SH.property), path))
    shapes.add((path, rdflib.URIRef(SH.path), rdflib.URIRef(probe)))
    for predicate, constraints in _constraints(parameter.iri, document).items():
        for constraint in constraints:
            shapes.add((path, rdflib.URIRef(predicate), rdflib_term(constraint)))
    subjects = rdflib.Graph()
    for one, value in probes.items():
        subjects.add((rdflib.URIRef(one), rdflib.URIRef(probe), rdflib_term(value)))
    called = f"the parameter {parameter.name!r}"
    found = violations(subjects, shapes, probe_shape, list(probes), document.source, called)
    return {value: _reason(found[one][0]) for one, value in probes.items() if one in found}


def _reason(obstacle: ShapeViolated | NotJudged) -> str:
    return obstacle.message if isinstance(obstacle, ShapeViolated) else obstacle.reason

"""pySHACL looks its constraint parameters up by hash, and finds the same ones."""

from __future__ import annotations

import pyshacl
from pyshacl import shape
from pyshacl.constraints import ALL_CONSTRAINT_PARAMETERS, CONSTRAINT_PARAMETERS_MAP
from rdflib import Graph, URIRef

from selfconf.rdf.pyshacl_corrections.constraint_lookup import index_constraints
from selfconf.rdf.rdflib_terms import to_rdflib
from selfconf.rdf.turtle import document as turtle
from tests.lab import PREFIXES


def graph(text: str) -> Graph:
    """The triples of a Turtle text."""
    return to_rdflib(turtle.parse(PREFIXES + text, "a.ttl").triples())


def test_pyshacl_sees_the_same_parameters_with_an_index() -> None:
    index_constraints()
    parameters, components = vars(shape)["CONSTRAINT_PARAMS"]
    assert list(parameters) == ALL_CONSTRAINT_PARAMETERS
    assert components is CONSTRAINT_PARAMETERS_MAP
    assert all(one in parameters for one in ALL_CONSTRAINT_PARAMETERS)
    assert URIRef("urn:x") not in parameters
    assert type(parameters.copy()) is list  # which pySHACL adds to in its advanced mode


def test_pyshacl_asks_of_no_parameter_whether_it_is_another() -> None:
    """What it compares is the cost: without an index it grows with the number of parameters that there are."""
    index_constraints()
    shapes = graph(
        ":s a sh:NodeShape ; sh:targetClass :C ; sh:property [ sh:path :p ; sh:maxCount 1 ; sh:nodeKind sh:IRI ] ."
    )
    data = graph("".join(f":c{n} a :C ; :p :x . " for n in range(20)))
    compared = 0

    class Counting(URIRef):
        def __eq__(self, other: object) -> bool:
            nonlocal compared
            compared += 1
            return super().__eq__(other)

        __hash__ = URIRef.__hash__

    parameters, components = vars(shape)["CONSTRAINT_PARAMS"]
    counted = type(parameters)([Counting(one) for one in parameters])
    vars(shape)["CONSTRAINT_PARAMS"] = (counted, components)
    try:
        for advanced in (False, True):
            conforms, _, _ = pyshacl.validate(data, shacl_graph=shapes, advanced=advanced)
            assert conforms
            assert compared < 100 or advanced
    finally:
        vars(shape)["CONSTRAINT_PARAMS"] = (parameters, components)

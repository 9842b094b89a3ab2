"""The alternatives in the shape of a role, and what they leave to a component to add."""

from __future__ import annotations

import pytest

from selfconf.rdf.eligibility.partitioner import Partitioner
from selfconf.rdf.tasks import templates
from selfconf.rdf.turtle import document as turtle
from tests.lab import PREFIXES

PARAMETER = " ; sc:parameter :v . :v a sc:Parameter ; sc:name 'v'"

B_OR_C = "sh:or ( [ sh:property [ sh:path :p ; sh:hasValue :b ] ] [ sh:property [ sh:path :p ; sh:hasValue :c ] ] )"


def addable(shape: str, parameter: str = "") -> bool:
    """Whether a component can be proposed for a role of that shape."""
    text = f"{PREFIXES} :t a sc:Template ; sc:roles ( :r ){parameter} . :r a sc:Role ; {shape} ."
    task = templates.read_task(turtle.parse(text, "t.ttl"))
    return not Partitioner(task).partition({}).unaddable


@pytest.mark.parametrize(
    "shape",
    [
        "sh:property [ sh:path :p ; sh:hasValue :a ] ; sh:not [ sh:property [ sh:path :p ; sh:minCount 1 ] ]",
        f"sh:property [ sh:path :p ; sh:in ( :a ) ] ; {B_OR_C}",
        f"sh:property [ sh:path :p ; sh:maxCount 0 ] ; {B_OR_C}",
        "sh:property [ sh:path :p ; sh:minCount 3 ] ; sh:not [ sh:property [ sh:path :p ; sh:minCount 3 ] ]",
    ],
)
def test_no_component_is_added_where_none_passes_the_alternatives_beside_the_rest(shape: str) -> None:
    assert not addable(shape)


@pytest.mark.parametrize(
    "shape",
    [
        "sh:property [ sh:path :p ; sh:hasValue :a ] ; sh:not [ sh:property [ sh:path :q ; sh:minCount 1 ] ]",
        f"sh:property [ sh:path :p ; sh:minCount 2 ] ; {B_OR_C}",
        "sh:property [ sh:path :p ; sh:minCount 2 ] ; sh:not [ sh:property [ sh:path :p ; sh:hasValue :a ] ]",
        "sh:not [ sh:property [ sh:path :p ; sh:maxCount 2 ] ]",
        f"sh:property [ sh:path :p ; sh:hasValue :a ] , [ sh:path :p ; sh:hasValue :d ] ; {B_OR_C}",
        # Of the class, of datatypes, and of very many values nothing is said.
        "sh:class :C ; sh:not [ sh:class :C ]",
        "sh:property [ sh:path :p ; sh:minCount 99 ] ; sh:not [ sh:property [ sh:path :p ; sh:minCount 99 ] ]",
        "sh:property [ sh:path :p ; sh:datatype xsd:integer ] ; sh:not [ sh:property [ sh:path :p ; sh:maxCount 0 ] ]",
    ],
)
def test_a_component_is_added_where_one_passes_or_that_is_not_known(shape: str) -> None:
    assert addable(shape)


@pytest.mark.parametrize(
    ("shape", "known"),
    [
        ("sh:property [ sh:path :p ; sh:in ( :v ) ]", True),
        ("sh:property [ sh:path :p ; sh:in ( :v ) ] ; sh:not [ sh:property [ sh:path :q ; sh:minCount 1 ] ]", True),
        ("sh:property [ sh:path :p ; sh:in ( :v ) ] ; sh:not [ sh:property [ sh:path :p ; sh:minCount 1 ] ]", False),
    ],
)
def test_no_component_is_added_where_an_alternative_looks_at_what_the_parameter_may_be(shape: str, known: bool) -> None:
    assert addable(shape, PARAMETER) == known

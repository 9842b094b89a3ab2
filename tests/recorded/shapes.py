"""What random ecologies are made of: terms, and property shapes with what satisfies each and what does not."""

from __future__ import annotations

from dataclasses import dataclass

HEAD = """\
@prefix sc: <https://w3id.org/selfconf#> .
@prefix rob: <https://w3id.org/selfconf/robotics#> .
@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix xsd: <http://www.w3.org/2001/XMLSchema#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
@prefix owl: <http://www.w3.org/2002/07/owl#> .
@prefix : <https://example.org/recorded#> .
"""
ONTOLOGY = (
    HEAD
    + "".join(
        f":Better{kind} rdfs:subClassOf :{kind} . :Best{kind} rdfs:subClassOf :Better{kind} .\n"
        f":Fine{signal} rdfs:subClassOf :{signal} . :{signal}Too owl:equivalentClass :{signal} .\n"
        for kind, signal in zip(("K0", "K1", "K2", "K3", "K4", "K5"), ("S0", "S1", "S2", "S3", "S4", "S5"), strict=True)
    )
    + ":mountedOn rdfs:subPropertyOf :support . :standsIn rdfs:subPropertyOf :place .\n"
)
"""Subclasses of every kind of component and of every signal, and properties below those that shapes ask for."""


@dataclass(frozen=True)
class Shape:
    """A part of a role, what a component says to conform to it, and what one says that does not ("" for nothing)."""

    turtle: str
    good: tuple[str, ...]
    bad: tuple[str, ...]


def of_one(constraints: str, good: str, bad: str) -> Shape:
    """A shape of one property that is named first in all three."""
    path = good.split(" ", 1)[0]
    return Shape(f"sh:property [ sh:path {path} ; {constraints} ]", (good,), (bad,))


QUALITIES = {
    "support": (
        of_one("sh:in ( :robot )", ":support {robot}", ":support {robot}"),
        of_one("sh:in ( :robot ) ; sh:minCount 1", ":support {robot}", ":support {robot}"),
        of_one("sh:hasValue :robot", ":support {robot}", ":support :Ludwig"),
    )
}
"""Shapes that mention a parameter of the template."""
SHAPES = (
    of_one("sh:in ( :kitchen )", ":place :kitchen", ":place :bedroom"),
    of_one("sh:in ( :kitchen :hall ) ; sh:minCount 1", ":place :kitchen", ""),
    of_one("sh:minInclusive 2 ; sh:maxInclusive 8.5", ":range 5", ":range 9"),
    of_one("sh:datatype xsd:integer ; sh:minCount 1", ":channels 4", ":channels 4.0"),
    of_one('sh:pattern "^v[0-9]" ; sh:maxCount 1', ':version "v2"', ':version "2"'),
    of_one("sh:nodeKind sh:IRI ; sh:minCount 1", ":maker :acme", ':maker "acme"'),
    of_one("sh:minLength 3", ':colour "red"', ':colour "r"'),
    of_one("sh:hasValue 1", ":mode 1", ":mode 2"),
    Shape(
        "sh:or ( [ sh:property [ sh:path :weight ; sh:maxExclusive 3 ] ]"
        " [ sh:property [ sh:path :frame ; sh:minCount 1 ] ] )",
        (":weight 2",),
        (":weight 3",),
    ),
    Shape("sh:not [ sh:property [ sh:path :broken ; sh:hasValue true ] ]", (":broken false",), (":broken true",)),
)
"""Shapes that are compiled to tests."""
NEEDS_PYSHACL = (
    Shape(
        'sh:sparql [ sh:message "no floor" ; sh:select "SELECT $this WHERE {{ '
        'FILTER NOT EXISTS {{ $this <https://example.org/recorded#floor> ?floor }} }}" ]'.replace("{{", "{").replace(
            "}}", "}"
        ),
        (":floor 1",),
        ("",),
    ),
    Shape(
        "sh:property [ sh:path ( :near :size ) ; sh:maxInclusive 3 ]", (":near [ :size 2 ]",), (":near [ :size 4 ]",)
    ),
    Shape(
        "sh:property [ sh:path :eye ; sh:qualifiedValueShape [ sh:nodeKind sh:IRI ] ; sh:qualifiedMinCount 1 ]",
        (":eye :left",),
        (':eye "left"',),
    ),
)
"""Shapes that are left to pySHACL."""

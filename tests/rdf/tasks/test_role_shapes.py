"""The statements that make up the shape of a role."""

from __future__ import annotations

from selfconf.rdf.tasks.role_shapes import mentions, shape_statements, shape_triples, substituted
from selfconf.rdf.turtle import parse
from selfconf.rdf.vocabulary import FIRST, SC, SH
from tests.lab import PREFIXES, iri

DOCUMENT = parse(
    PREFIXES
    + ":r a sc:Role ; sc:feeds :s ; sh:class :A ; sh:node :Named ; sh:property [ sh:path :p ; sh:in ( :robot ) ] ."
    " :Named sh:nodeKind sh:IRI ; sh:node :Named . :s a sc:Role ; sh:class :B .",
    "t.ttl",
)


def test_nested_and_named_shapes_belong_to_the_shape_and_other_roles_do_not() -> None:
    said = list(shape_statements(DOCUMENT, iri("r")))
    assert {(SH["class"], iri("A")), (SH.nodeKind, SH.IRI), (SH.path, iri("p"))} <= set(said)
    assert (SH["class"], iri("B")) not in said
    assert len(list(shape_triples(DOCUMENT, iri("r")))) == len(said)


def test_a_parameter_in_a_list_is_mentioned() -> None:
    assert mentions(DOCUMENT, iri("r"), frozenset((iri("robot"), iri("goal")))) == {iri("robot")}
    assert mentions(DOCUMENT, iri("s"), frozenset((iri("robot"),))) == set()


def test_a_parameter_is_replaced_in_shapes_and_nowhere_else() -> None:
    found = substituted(DOCUMENT, {iri("robot"): iri("Astrid"), iri("p"): iri("q"), iri("s"): iri("other")})
    said = set(shape_statements(found, iri("r")))
    assert {(FIRST, iri("Astrid")), (SH.path, iri("q"))} <= said
    assert not {(FIRST, iri("robot")), (SH.path, iri("p"))} & said
    assert found.values(iri("r"), SC.feeds) == [iri("s")]
    assert mentions(DOCUMENT, iri("r"), frozenset((iri("robot"),))), "the template itself stays as it is"

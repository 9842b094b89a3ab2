"""The ontology's word is the code's word, both ways."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

from selfconf import library
from selfconf.model.term import IRI
from selfconf.rdf.turtle import document as turtle
from selfconf.rdf.turtle.document import Document
from selfconf.rdf.vocabulary import LABEL, OWL, RDF, ROB, SC, TYPE, Namespace

ROOT = Path(__file__).resolve().parents[2]
NOT_IN_CODE = {
    "Port": "what inputs and outputs have in common, for ontologists",
}
"""Terms of the ontology that no code names, and why."""
KINDS = (RDF.Property, OWL.Class, OWL.ObjectProperty, OWL.DatatypeProperty, OWL.NamedIndividual)


def ontology(name: str) -> Document:
    """One of the ontologies that ship."""
    (path,) = [path for path in library.ontologies() if path.name == f"{name}.ttl"]
    return turtle.parse(path.read_bytes(), str(path))


def declared(document: Document, namespace: Namespace) -> set[str]:
    """The terms of a namespace that an ontology declares."""
    return {
        subject.removeprefix(namespace.base)
        for subject, statements in document.statements.items()
        if isinstance(subject, IRI) and subject in namespace and any((TYPE, kind) in statements for kind in KINDS)
    }


def used(namespace: str, *tops: str) -> Iterator[tuple[str, Path]]:
    """The members of a namespace that code names, with the file."""
    for top in tops:
        for path in sorted((ROOT / top).rglob("*.py")):
            text = path.read_text()
            for node in ast.walk(ast.parse(text)) if namespace in text else ():
                owner = getattr(node, "value", None)
                if not isinstance(owner, ast.Name) or owner.id != namespace:
                    continue
                if isinstance(node, ast.Attribute) and node.attr != "base":
                    yield node.attr, path
                elif isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Constant):
                    yield str(node.slice.value), path


@pytest.mark.parametrize(
    ("name", "namespace", "python"), [("selfconf", SC, "SC"), ("robotics", ROB, "ROB")], ids=["SC", "ROB"]
)
def test_every_term_that_code_names_is_in_the_ontology(name: str, namespace: Namespace, python: str) -> None:
    terms = declared(ontology(name), namespace)
    unknown = {
        f"{term} in {path.relative_to(ROOT)}" for term, path in used(python, "selfconf", "sim") if term not in terms
    }
    assert unknown == set()


def test_every_term_of_the_ontology_is_named_by_code_or_listed_here() -> None:
    terms = declared(ontology("selfconf"), SC)
    named = {term for term, _ in used("SC", "selfconf")}
    assert terms - named == set(NOT_IN_CODE)


def test_the_terms_that_authors_rely_on_are_there() -> None:
    promised = (
        "Component Input Output Template Role Interaction Parameter Task Configuration Connection Failure hasInput"
        " hasOutput hasParameter name signalType parameterType preference grounding parameter roles feeds from to"
        " output input sets value minCount maxCount"
    )
    assert set(promised.split()) <= declared(ontology("selfconf"), SC)


@pytest.mark.parametrize(("name", "namespace"), [("selfconf", SC), ("robotics", ROB)], ids=["SC", "ROB"])
def test_every_term_has_a_label(name: str, namespace: Namespace) -> None:
    document = ontology(name)
    without = {term for term in declared(document, namespace) if not document.values(namespace[term], LABEL)}
    assert without == set()


def test_a_namespace_makes_and_knows_its_members() -> None:
    assert SC.Role == SC["Role"] == IRI("https://w3id.org/selfconf#Role")
    assert SC.Role in SC
    assert ROB.support not in SC
    assert 7 not in SC

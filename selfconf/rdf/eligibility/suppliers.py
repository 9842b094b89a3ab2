"""Which components may supply the players of a role that recruits (`sc:recruits`): all, or those of a shape."""

from __future__ import annotations

from dataclasses import replace

from selfconf.model.term import IRI, BlankNode, Literal, Term
from selfconf.rdf.eligibility.compiler import compile_role
from selfconf.rdf.eligibility.role_tests import CompiledRole
from selfconf.rdf.turtle import Document, Node
from selfconf.rdf.vocabulary import SC

_SUPPLIERS = "urn:selfconf:suppliers:"


def with_named_suppliers(document: Document) -> Document:
    """A template in which the shapes of suppliers have names: pySHACL is asked about a shape by its IRI."""
    names = {
        value: IRI.unchecked(f"{_SUPPLIERS}{subject}")
        for subject, said in document.statements.items()
        for predicate, value in said
        if predicate == SC.recruits and isinstance(value, BlankNode)
    }
    if not names:
        return document
    statements: dict[Node, list[tuple[IRI, Term]]] = {}
    for subject, said in document.statements.items():
        about = names.get(subject, subject) if isinstance(subject, BlankNode) else subject
        statements[about] = [(p, names.get(o, o) if isinstance(o, BlankNode) else o) for p, o in said]
    return replace(document, statements=statements)


def suppliers_of(document: Document, role: IRI) -> CompiledRole:
    """The tests that a supplier has to pass; none where a role recruits any component.

    The parameters in its shape have values, by which they are replaced. Raises TemplateError where it is no shape.
    """
    shape = document.value(role, SC.recruits)
    if shape is None or isinstance(shape, Literal) or not isinstance(shape, IRI):
        return CompiledRole(role, (), complete=True)
    return compile_role(document, shape, (), frozenset())

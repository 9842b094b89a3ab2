"""A graph that takes up what a component says when something asks about that component."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
import rdflib

from selfconf.model.term import IRI
from selfconf.rdf.advertisements import read_advertisements
from selfconf.rdf.eligibility import lazy_graph
from selfconf.rdf.eligibility.lazy_graph import LazyStore
from selfconf.rdf.eligibility.partitioner import Partitioner
from selfconf.rdf.tasks import bindings, templates
from selfconf.rdf.turtle import Triple
from selfconf.rdf.turtle import document as turtle
from tests.lab import PREFIXES

NEAR = IRI("urn:x:near")
P = rdflib.URIRef(NEAR)
A, B = IRI("urn:x:a"), IRI("urn:x:b")


@pytest.fixture
def asked() -> list[IRI]:
    """The components of which something was taken up."""
    return []


@pytest.fixture
def store(asked: list[IRI]) -> LazyStore:
    """A store for which two components wait."""

    def said(component: IRI, other: IRI) -> Iterator[Triple]:
        asked.append(component)
        yield component, NEAR, other

    store = LazyStore()
    store.defer(A, lambda: said(A, B))
    store.defer(B, lambda: said(B, A))
    return store


def test_what_is_said_of_a_subject_is_taken_up_once_when_it_is_asked_about(store: LazyStore, asked: list[IRI]) -> None:
    graph = store.graph
    assert not list(graph.objects(rdflib.URIRef("urn:x:other"), P))
    assert not asked
    for _ in range(2):
        assert list(graph.objects(rdflib.URIRef(A), P)) == [rdflib.URIRef(B)]
    assert asked == [A]


def test_without_a_subject_all_is_taken_up(store: LazyStore, asked: list[IRI]) -> None:
    assert list(store.graph.subjects(P, rdflib.URIRef(A))) == [rdflib.URIRef(B)]
    assert asked == [A, B]
    assert len(list(store.graph)) == 2


def test_a_graph_knows_whether_it_is_empty_without_taking_anything_up(store: LazyStore, asked: list[IRI]) -> None:
    assert store.graph
    assert not LazyStore().graph
    assert not asked


def test_what_was_interrupted_is_taken_up_again(
    store: LazyStore, asked: list[IRI], monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(triple: Triple) -> object:
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(lazy_graph, "rdflib_triple", interrupted)
        with pytest.raises(KeyboardInterrupt):
            list(store.graph.objects(rdflib.URIRef(A), P))
    assert list(store.graph.objects(rdflib.URIRef(A), P)) == [rdflib.URIRef(B)]
    assert asked == [A]


def test_what_no_role_looks_at_is_never_taken_up(monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[str] = []
    take = LazyStore._take

    def counting(self: LazyStore, subject: rdflib.URIRef) -> None:
        made.append(str(subject).rpartition("#")[2])
        take(self, subject)

    monkeypatch.setattr(LazyStore, "_take", counting)
    task = bindings.complete(
        templates.read_task(
            turtle.parse(
                PREFIXES + ":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class :Ear ; "
                "sh:sparql [ sh:select 'SELECT $this { $this <urn:x:near> <urn:x:a> }' ] .",
                "t.ttl",
            )
        )
    )
    text = PREFIXES + ":ear a sc:Component, :Ear . :near a sc:Component, :Ear ; <urn:x:near> <urn:x:a> ."
    others = "".join(f":c{n} a sc:Component, :Camera ; <urn:x:near> <urn:x:a> . " for n in range(9))
    found, _ = read_advertisements((text + others).encode(), "a.ttl")
    (eligible,) = Partitioner(task).partition(found).candidates
    assert [one.profile.component.short for one in eligible] == ["ear"]
    assert sorted(made) == ["ear", "near"]

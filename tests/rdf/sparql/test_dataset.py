"""The ecology as an RDF dataset: a graph each, and questions that reach nothing else."""

from __future__ import annotations

import pyoxigraph as ox
import pytest

from selfconf.errors import QueryError
from selfconf.model.term import Literal
from selfconf.rdf.advertisements import reader as advertisements
from selfconf.rdf.sparql.dataset import Dataset
from selfconf.rdf.turtle import document as turtle
from selfconf.termination import resident_memory
from tests.harness.effort import thorough
from tests.lab import ADVERTISEMENTS, PREFIXES, iri


@pytest.fixture
def dataset() -> Dataset:
    """The paper's ecology."""
    dataset = Dataset()
    document = turtle.parse(PREFIXES + " ".join(ADVERTISEMENTS.values()), "ads")
    dataset.add_advertisements(advertisements.read_document(document)[0])
    return dataset


def values(dataset: Dataset, text: str) -> list[str]:
    """The first value of each solution."""
    answer = dataset.query(text)
    assert isinstance(answer, ox.QuerySolutions)
    return [str(solution[0].value) if solution[0] is not None else "" for solution in answer]


def test_the_default_graph_is_the_union_of_all_advertisements(dataset: Dataset) -> None:
    assert len(values(dataset, "SELECT ?c WHERE { ?c a sc:Component }")) == len(ADVERTISEMENTS)


def test_what_several_advertisements_say_is_in_the_union_once() -> None:
    dataset = Dataset()
    for name in ("a", "b"):
        document = turtle.parse(f"{PREFIXES} :{name} a sc:Component, :K ; :on :base . :base :place :hall .", name)
        dataset.add_advertisements(advertisements.read_document(document)[0])
    place = f"SELECT ?place WHERE {{ <{iri('base')}> <{iri('place')}> ?place }}"
    joined = f"SELECT ?place WHERE {{ ?c <{iri('on')}>/<{iri('place')}> ?place }}"
    assert (len(values(dataset, place)), len(values(dataset, joined))) == (1, 2)
    loaded = Dataset()
    loaded.load(dataset.dump())
    assert len(values(loaded, place)) == 1
    for name, left in (("a", 1), ("b", 0)):
        dataset.replace(iri(name), f"<{iri(name)}> <{iri('on')}> <{iri('base')}> .\n".encode())
        assert len(values(dataset, place)) == left
    assert len(values(dataset, f"SELECT ?c WHERE {{ ?c <{iri('on')}> ?base }}")) == 2


@thorough
def test_what_is_replaced_again_and_again_takes_no_memory() -> None:
    """A server replaces what is deployed for months; without a new store this took 30 MB, and longer each time."""
    dataset = Dataset()
    dataset.replace(iri("kept"), b"".join(b"<urn:kept%d> <urn:p> _:b .\n" % number for number in range(1000)))
    before = resident_memory()
    for number in range(1500):
        said = (b'<urn:now> <urn:p%d> "what was said in the turn %d of %d" .\n' % (n, number, n) for n in range(20))
        dataset.replace(iri("now"), b"".join(said))
    assert resident_memory() - before < 15e6
    assert values(dataset, "SELECT (COUNT(*) AS ?n) { <urn:now> ?p ?said }") == ["20"]
    assert values(dataset, "SELECT (COUNT(*) AS ?n) { GRAPH ?g { ?kept ?p ?b } }") == ["1020"]
    assert values(dataset, "SELECT (COUNT(DISTINCT ?b) AS ?n) { ?kept <urn:p> ?b }") == ["1"]


def test_each_graph_holds_what_one_component_says(dataset: Dataset) -> None:
    text = f"SELECT ?o WHERE {{ GRAPH <{iri('astrid-drive')}> {{ ?s rob:support ?o }} }}"
    assert values(dataset, text) == [iri("Astrid")]


def test_from_chooses_among_the_graphs_that_are_there(dataset: Dataset) -> None:
    text = f"SELECT ?c FROM <{iri('pippi-drive')}> WHERE {{ ?c a sc:Component }}"
    assert values(dataset, text) == [iri("pippi-drive")]


def test_what_several_chosen_graphs_say_is_found_once() -> None:
    dataset = Dataset()
    for name in ("a", "b", "c"):
        said = f"<urn:x> <urn:p> <urn:y> .\n<urn:x> <urn:p> <urn:{name}> .\n"
        dataset.replace(iri(name), said.encode())
    chosen = f"FROM <{iri('a')}> FROM <{iri('b')}>"
    assert len(values(dataset, f"SELECT ?o {chosen} {{ <urn:x> <urn:p> ?o }}")) == 3
    answer = dataset.query("SELECT ?o { <urn:x> <urn:p> ?o }", default_graphs=(iri("a"), iri("b")))
    assert isinstance(answer, ox.QuerySolutions)
    assert len(list(answer)) == 3
    assert values(dataset, f"SELECT ?g {chosen} FROM NAMED <{iri('c')}> {{ GRAPH ?g {{ ?s ?p <urn:y> }} }}") == [
        iri("c")
    ]
    assert values(dataset, f"SELECT ?o FROM NAMED <{iri('c')}> {{ <urn:x> <urn:p> ?o }}") == []


def test_graphs_that_are_given_count_instead_of_those_that_the_query_chooses(dataset: Dataset) -> None:
    drive = iri("astrid-drive")
    asked = f"SELECT ?g FROM <{iri('pippi-drive')}> {{ GRAPH ?g {{ ?c a sc:Component }} }}"
    answer = dataset.query(asked, named_graphs=(drive,))
    assert isinstance(answer, ox.QuerySolutions)
    assert [solution[0].value for solution in answer] == [drive]
    answer = dataset.query("ASK { ?c a sc:Component }", named_graphs=(drive,))
    assert not answer, "the default graph is empty"


def test_what_was_replaced_has_left_the_union_though_others_came_meanwhile() -> None:
    dataset = Dataset()
    for turn, name in enumerate(("a", "b", "a")):
        dataset.add(iri(name), [(iri(name), iri("turn"), Literal(str(turn)))])
        dataset.replace(iri("now"), f'<urn:now> <urn:turn> "{turn}" .'.encode())
        assert values(dataset, "SELECT ?turn { <urn:now> <urn:turn> ?turn }") == [str(turn)]


def test_prefixes_of_ones_own_may_be_given(dataset: Dataset) -> None:
    answer = dataset.query("ASK { my:astrid-drive a rob:MotorDrive }", {"my": "https://example.org/peis-home#"})
    assert bool(answer)


@pytest.mark.parametrize(
    "text",
    [
        "SELECT * WHERE { SERVICE <http://127.0.0.1:1/> { ?s ?p ?o } }",
        "SELECT * WHERE { service <http://127.0.0.1:1/> { ?s ?p ?o } }",
        "SELECT * WHERE { SERVICE SILENT ?x { ?s ?p ?o } }",
        "SELECT * WHERE { { SELECT * WHERE { SERVICE\n<http://127.0.0.1:1/> { ?s ?p ?o } } } }",
        "SELECT * WHERE { ?s ?p 'it\\'s' . SERVICE <http://127.0.0.1:1/> { ?s ?p ?o } }",
        "SELECT * WHERE { ?s ?p ?o } # \nVALUES ?x { 1 } SERVICE <http://127.0.0.1:1/> {}",
        "SELECT * WHERE { \\u0053ERVICE <http://127.0.0.1:1/> { ?s ?p ?o } }",
        "INSERT DATA { <urn:a> <urn:b> <urn:c> }",
        "LOAD <file:///etc/passwd>",
        "DROP ALL",
        "SELECT",
    ],
)
def test_nothing_but_reading_this_dataset_is_a_query(dataset: Dataset, text: str) -> None:
    with pytest.raises(QueryError):
        dataset.query(text)


@pytest.mark.parametrize(
    "text",
    [
        'SELECT ?s WHERE { ?s rdfs:label "SERVICE <http://x/>" }',
        "SELECT ?service WHERE { ?service a sc:Component }",
        "SELECT ?s WHERE { ?s <urn:SERVICE> ?o } # SERVICE",
        'SELECT ?s WHERE { ?s rdfs:label """a "SERVICE" in quotes""" }',
    ],
)
def test_the_word_alone_is_no_crime(dataset: Dataset, text: str) -> None:
    dataset.query(text)

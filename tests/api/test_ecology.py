"""An ecology shows its components, is asked in SPARQL, and prints as a table."""

from __future__ import annotations

import json
import pickle
from collections.abc import Sequence
from dataclasses import FrozenInstanceError
from typing import Any

import pytest

import selfconf as sc
from selfconf import read
from selfconf.api.ecology import Components, EndpointEcology, LoadedEcology, Solutions
from selfconf.api.tables import LONGEST_TABLE
from selfconf.errors import NetworkError, ProgrammerError, QueryError
from selfconf.model.term import IRI, XSD_NAMESPACE, BlankNode, Literal
from selfconf.query import Question
from selfconf.rdf.vocabulary import RDF, XSD
from tests.api.navigation import EVERYTHING
from tests.cli.endpoints import Scripted, http
from tests.lab import ADVERTISEMENTS, NAVIGATE, PREFIXES, iri

pytestmark = pytest.mark.usefixtures("asked_here")


def test_components_are_found_by_iri_with_their_profiles(home: sc.Ecology) -> None:
    assert len(home) == len(home.components) == 6
    tracker = sc.IRI("https://w3id.org/selfconf/peis-home#person-tracker")
    assert [port.name for port in home.components[tracker].outputs] == ["pose"]
    assert "x:nowhere" not in home.components
    assert bool(sc.read("@prefix : <x:> ."))


def test_an_ecology_and_what_is_said_of_it_cannot_be_changed(home: sc.Ecology) -> None:
    for name in ("left_out", "complaints", "components", "names", "note"):
        with pytest.raises(AttributeError):
            setattr(home, name, ())
    solutions = home.query("SELECT ?c { ?c a rob:PositionSensor }")
    assert isinstance(solutions, Solutions)
    for value, name in (
        (home.components, "_advertisements"),
        (solutions, "cut"),
        (EndpointEcology("http://x/"), "url"),
    ):
        with pytest.raises(FrozenInstanceError):
            setattr(value, name, ())
    with pytest.raises(TypeError):
        solutions[0]["c"] = iri("other")


def test_ecologies_components_and_solutions_are_pickled(home: sc.Ecology) -> None:
    solutions = home.query("SELECT ?c { ?c a rob:PositionSensor } ORDER BY ?c")
    sc.partition(sc.template(NAVIGATE).bind(robot=":Astrid", goal="x"), home)  # which groups what is alike
    for value in (home.components, solutions):
        assert pickle.loads(pickle.dumps(value)) == value
    again = pickle.loads(pickle.dumps(home))
    assert (repr(again), again.components, hash(again) == hash(home)) == (repr(home), home.components, False)


def test_what_a_question_cannot_judge_is_left_out_and_named() -> None:
    shape = '[ sh:property [ sh:path sc:name ; sh:pattern "(" ] ]'
    home = sc.read(
        f'{PREFIXES}:k a sc:Component, :K ; sc:hasInput [ sc:name "i" ; sc:signalType :S ; sc:accepts {shape} ] .\n'
        ':s a sc:Component, :S ; sc:hasOutput [ sc:name "o" ; sc:signalType :S ] .'
    )
    roles = ":t a sc:Template ; sc:roles ( :a :b ) . :a a sc:Role ; sh:class :S ; sc:feeds :b . :b a sc:Role ; sh:class"
    refusal = sc.configure(sc.template(f"{PREFIXES}{roles} :K ."), home)
    assert not refusal
    (left_out,) = refusal.left_out
    assert left_out.component == iri("k")
    assert left_out.reason.startswith("what its input accepts cannot be judged: ")
    table = sc.partition(sc.template(f"{PREFIXES}{roles} :K ."), home)
    (obstacle,) = table["b"].obstacles(iri("k"))
    assert str(obstacle) == f"is not judged: {left_out.reason}"
    assert table.left_out == (left_out,)
    assert sc.partition(sc.template(f"{PREFIXES}{roles} :S ."), home).left_out == ()  # does not look at that
    assert home.left_out == ()  # what a question finds is said by its answer, as others may ask at once


def test_components_print_as_a_table(home: sc.Ecology) -> None:
    assert repr(home) == "<ecology of 6 components from examples/peis-home>"
    head, line, *rows = repr(home.components).splitlines()
    assert head.split() == ["component", "types", "inputs", "outputs"]
    assert set(line) == {"-", " "}
    assert [row.split()[0] for row in rows] == sorted(row.split()[0] for row in rows)
    assert home._repr_html_() == home.components._repr_html_()
    assert "<td style='text-align:left'>localize, position, sonar</td>" in home._repr_html_()


def test_the_solutions_of_a_query_are_terms_by_variable(home: sc.Ecology) -> None:
    found = home.query("SELECT ?c ?place { ?c a rob:PositionSensor OPTIONAL { ?c rob:place ?place } } ORDER BY ?c")
    assert isinstance(found, Solutions)
    assert isinstance(found, Sequence)
    assert found.variables == ("c", "place")
    assert [set(row) for row in found] == [{"c"}, {"c", "place"}]
    assert found[1]["place"].short == "living-room"
    assert repr(found).splitlines()[-1].split() == ["person-tracker", "living-room"]


def test_a_query_that_is_no_text_is_a_mistake_of_the_program(home: sc.Ecology) -> None:
    with pytest.raises(ProgrammerError, match=r"^a query is the text of one, not int$"):
        home.query(5)  # type: ignore[arg-type]  # refused when it runs, too


def test_every_kind_of_term_comes_back(home: sc.Ecology) -> None:
    (row,) = home.query('SELECT * { VALUES (?a ?b ?c ?d) { (<x:y> "text" "Wort"@de 1.5) } BIND(BNODE() AS ?e) }')
    assert row["a"] == sc.IRI("x:y")
    assert row["b"] == sc.Literal("text")
    assert row["c"] == sc.Literal("Wort", RDF.langString, "de")
    assert row["d"] == sc.Literal("1.5", XSD.decimal)
    assert row["e"].startswith("_:")


def test_ask_is_a_truth_value_and_construct_is_turtle(home: sc.Ecology) -> None:
    assert home.query("ASK { ?c a rob:SonarArray }") is True
    assert home.query("ASK { ?c a rob:Submarine }") is False
    turtle = home.query("CONSTRUCT WHERE { ?c a rob:SonarArray }")
    assert isinstance(turtle, str)
    assert len(sc.read(turtle.replace("a rob:", "a sc:Component, rob:"))) == 1
    assert home.query("SELECT * {}") is not None
    assert repr(home.query("SELECT * {}")) == "1 solution"


def test_more_rows_than_asked_for_are_cut_and_more_than_a_screen_are_counted(home: sc.Ecology) -> None:
    few = home.query("SELECT * { ?s ?p ?o }", rows=2)
    assert isinstance(few, Solutions)
    assert (len(few), few.cut) == (2, True)
    many = home.query("SELECT * { VALUES ?a { 1 2 3 4 5 6 7 8 9 } VALUES ?b { 1 2 3 4 5 6 7 8 9 } }")
    assert len(many) == 81
    assert len(repr(many).splitlines()) == LONGEST_TABLE + 3
    assert repr(many).endswith(f"... only the first {LONGEST_TABLE} are shown")
    assert many._repr_html_().count("<tr>") == LONGEST_TABLE + 1


@pytest.mark.parametrize("query", ["SELEC", "DELETE WHERE { ?s ?p ?o }", "SELECT ?c WHERE {", ""])
def test_what_is_no_query_is_refused_in_a_sentence(query: str, home: sc.Ecology) -> None:
    with pytest.raises(QueryError):
        home.query(query)


@pytest.fixture(scope="module")
def paper() -> LoadedEcology:
    """The ecology of the paper."""
    found = read(EVERYTHING)
    assert isinstance(found, LoadedEcology)
    return found


def test_components_are_found_by_their_iri(paper: LoadedEcology) -> None:
    components = paper.components
    assert isinstance(components, Components)
    assert len(components) == len(ADVERTISEMENTS) == len(paper)
    assert [port.name for port in components[iri("thinking-cap")].inputs] == ["localize", "position", "sonar"]
    assert iri("nobody") not in components
    with pytest.raises(KeyError):
        components[iri("nobody")]


def test_components_are_shown_as_a_table_in_order(paper: LoadedEcology) -> None:
    head, _, *rows = repr(paper.components).splitlines()
    assert head.split() == ["component", "types", "inputs", "outputs"]
    assert [row.split()[0] for row in rows] == sorted(component.short for component in paper.components)
    assert "PositionSensor" in paper.components._repr_html_()
    assert "sc:Component" not in repr(paper.components)


def test_an_ecology_is_true_even_where_it_is_empty() -> None:
    empty = read(PREFIXES)
    assert empty
    assert len(empty) == 0
    assert "0 components" in repr(empty)


def test_a_select_gives_solutions_with_terms_of_every_kind() -> None:
    home = read(PREFIXES + ':a a sc:Component, :T ; :p 5, "x", "y"@en, "z"^^:own, [ :q true ], :b .')
    found = home.query("SELECT ?v WHERE { <https://example.org/peis-home#a> <https://example.org/peis-home#p> ?v }")
    assert isinstance(found, Solutions)
    assert found.variables == ("v",)
    values = {row["v"] for row in found}
    assert {
        Literal("5", IRI(XSD_NAMESPACE + "integer")),
        Literal("x"),
        Literal("y", IRI("http://www.w3.org/1999/02/22-rdf-syntax-ns#langString"), "en"),
        Literal("z", iri("own")),
        iri("b"),
    } < values
    assert sum(isinstance(value, BlankNode) for value in values) == 1
    assert repr(found).splitlines()[0].strip() == "v"


def test_triples_are_turtle(paper: LoadedEcology) -> None:
    found = paper.query("CONSTRUCT { ?c a rob:Found } WHERE { ?c a rob:MotorDrive }")
    assert isinstance(found, str)
    assert len(read(found.replace("rob:Found", "rob:Found, sc:Component"))) == 2


def test_each_advertisement_is_a_graph(paper: LoadedEcology) -> None:
    found = paper.query("SELECT ?g { GRAPH ?g { ?c a rob:MotorDrive } } ORDER BY ?g")
    assert isinstance(found, Solutions)
    assert [row["g"] for row in found] == [iri("astrid-drive"), iri("pippi-drive")]


@pytest.mark.parametrize(
    ("sparql", "words"),
    [("SELECT WHERE", "not a SPARQL query"), ("SELECT * { SERVICE <http://127.0.0.1:9/> { ?s ?p ?o } }", "SERVICE")],
)
def test_a_query_that_cannot_be_asked_is_an_error(paper: LoadedEcology, sparql: str, words: str) -> None:
    with pytest.raises(QueryError, match=words):
        paper.query(sparql)


@pytest.mark.parametrize("limits", [{"rows": 0}, {"rows": None}, {"seconds": float("nan")}, {"seconds": None}])
def test_a_query_has_limits(paper: LoadedEcology, limits: Any) -> None:
    with pytest.raises(ProgrammerError, match="number above zero"):
        paper.query("ASK {}", **limits)


@pytest.mark.process
def test_a_query_ends_in_time(paper: LoadedEcology, asked_here: pytest.MonkeyPatch) -> None:
    asked_here.undo()  # it is the process that is ended
    join = " ".join(f"?a{number} ?b{number} ?c{number} ." for number in range(30))
    with pytest.raises(QueryError, match=r"more than 0\.5 s"):
        paper.query(f"SELECT (COUNT(*) AS ?n) {{ {join} }}", seconds=0.5)


def test_solutions_without_a_variable_are_counted() -> None:
    assert repr(Solutions((), ({}, {}))) == "2 solutions"
    assert Solutions(("x",), ({"x": iri("a")}, {}))[0] == {"x": iri("a")}
    assert "<td" in Solutions(("x",), ({"x": Literal("<b>")}, {}))._repr_html_()
    assert "<b>" not in Solutions(("x",), ({"x": Literal("<b>")},))._repr_html_()


def test_an_endpoint_is_never_loaded_as_a_whole() -> None:
    ecology = EndpointEcology("http://127.0.0.1:9/query")
    assert ecology
    assert ecology.remote
    with pytest.raises(ProgrammerError, match=r"ask it by query\(\)"):
        ecology.advertisements()
    with pytest.raises(ProgrammerError):
        list(ecology.components)
    with pytest.raises(TypeError, match="http://127"):
        len(ecology)
    assert "http://127.0.0.1:9/query" in repr(ecology)
    assert "http://127.0.0.1:9/query" in ecology._repr_html_()


def test_an_endpoint_answers_a_query_itself() -> None:
    body: dict[str, Any] = {
        "head": {"vars": ["c"]},
        "results": {"bindings": [{"c": {"type": "uri", "value": "urn:a"}}]},
    }
    with Scripted(http(json.dumps(body))) as server:
        ecology = EndpointEcology(server.url)
        found = ecology.query("SELECT ?c { GRAPH ?g { ?c a ?t } }")
        assert "urn:a" in ecology.asked(Question("SELECT ?c { GRAPH ?g { ?c a ?t } }", "csv")).text
    assert isinstance(found, Solutions)
    assert [row["c"] for row in found] == [IRI("urn:a")]
    with pytest.raises(NetworkError, match="Connection refused"):
        EndpointEcology("http://127.0.0.1:9/query").query("ASK { ?s ?p ?o }")

"""An ecology shows its components, is asked in SPARQL, and prints as a table."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

import selfconf as sc
from selfconf.api.ecology import Solutions
from selfconf.api.tables import LONGEST_TABLE
from selfconf.errors import QueryError
from selfconf.rdf.vocabulary import RDF, XSD


def test_components_are_found_by_iri_with_their_profiles(home: sc.Ecology) -> None:
    assert len(home) == len(home.components) == 6
    tracker = sc.IRI("https://w3id.org/selfconf/peis-home#person-tracker")
    assert [port.name for port in home.components[tracker].outputs] == ["pose"]
    assert "x:nowhere" not in home.components
    assert bool(sc.read("@prefix : <x:> ."))


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

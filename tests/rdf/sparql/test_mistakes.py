"""What is wrong with a SPARQL query: the likely cause, and never a list of what the parser would have liked."""

from __future__ import annotations

import pytest

from selfconf.errors import QueryError
from selfconf.rdf.sparql.dataset import Dataset
from selfconf.rdf.sparql.mistakes import why_not_asked


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "it is empty"),
        ("  # nothing but this\n", "it is empty"),
        ("SELECT ?c { ?c a wh:Arm }", "the prefix wh: is not declared; begin with PREFIX wh: <...>"),
        ("SELECT ?c { ?c a :Arm }", "the prefix : is not declared"),
        ("PREFIX a: <urn:a> SELECT ?c { ?c a:b 'x:y', <b:c> ; ^wh:is _:b } # d:e", "the prefix wh: is not declared"),
        ("SELECT ?c { ?c rob:place http://e.org/kitchen }", "an IRI stands in angle brackets: <http:...>"),
        ("SELECT ?c FROM urn:x:kitchen { ?c a ?t }", "an IRI stands in angle brackets: <urn:...>"),
        ("PREFIX ex: https://e.org/ ASK { ?c a ex:Arm }", "an IRI stands in angle brackets: <https:...>"),
        ("PREFIX urn: <urn:x> ASK { ?c a urn:y, }", "it ends too soon"),
        ('ASK { ?x <urn:a> "a"^^wh:b }', "the prefix wh: is not declared"),
        (
            "INSERT DATA { <a:a> <a:b> <a:c> }",
            "begins with 'INSERT'; a query only asks, by SELECT, ASK, CONSTRUCT or DESCRIBE",
        ),
        ("prefix x: <urn:x#> DELETE WHERE { ?s ?p ?o }", "begins with 'DELETE'"),
        ("SELEC ?c {}", "begins with 'SELEC'"),
        ("PREFIX wh <urn:x> ASK {}", "at 1:10 something is wrong before"),
        ("{ ?s ?p ?o }", "begins with '{'"),
        ("rob:Arm", "begins with 'rob:Arm'"),
        ("SELECT ?c { ?c a", "at 1:17 it ends too soon"),
        ("SELECT ?c\n{ ?c a '}' }} # }", "at 2:13 the '}' closes what is not open"),
        ("SELECT ?c { ?c a ?t FILTER(?t = 1 }", "at 1:35 the '}' closes what is not open"),
        ("SELECT ?c { ?c ?p [ a ?t ) }", "at 1:26 the ')' closes what is not open"),
        ("SELECT ?c { ?c ?p ?t }} LIMIT 3", "at 1:23 the '}' closes what is not open"),
        ("SELECT ?c { { ?c a '}' } LIMIT 3", "it ends too soon"),
        ("SELECT ?c WHERE ?c a ?t }", "at 1:17 something is wrong before '?c'"),
        ("SELECT ?c\n{ ?c a ?t } LIMIT x", "at 2:19 something is wrong before 'x'"),
        ("SELECT ?x { ?s ?p ?o } GROUP BY ?s", "The SELECT contains a variable that is unbound"),
        ("SELECT * { ?s ?p ?o } GROUP BY ?s", "SELECT * is not authorized with GROUP BY"),
        ("ASK { ?s a <http://x y> }", "IRI parsing failed"),
    ],
)
def test_the_cause_is_told_in_a_few_words(text: str, words: str) -> None:
    with pytest.raises(QueryError) as told:
        Dataset().query(text)
    assert words in str(told.value)
    assert len(str(told.value)) < 120


def test_prefixes_that_are_lent_need_no_declaration() -> None:
    with pytest.raises(QueryError, match="it ends too soon"):
        Dataset().query("SELECT ?c { ?c a rob:Arm ; my:is 1", {"my": "urn:my#"})


def test_a_function_that_is_not_there_is_named() -> None:
    calls = "SELECT $this { $this <urn:load> ?load FILTER(<urn:heavy>(?load)) }"
    assert (
        why_not_asked(calls, {}) == "This query cannot be answered: The custom function <urn:heavy> is not supported."
    )
    with pytest.raises(QueryError, match="cannot be answered: The custom function <urn:heavy> is not supported"):
        Dataset().query(calls)


@pytest.mark.parametrize("part", ["MINUS { $this ?p 2 }", "values ?q { 1 2 }"])
def test_what_shacl_has_no_place_for_in_a_query_is_named_with_what_to_write(part: str) -> None:
    said = why_not_asked(f"SELECT $this {{ $this ?p ?q {part} }}", {})
    assert said is not None
    assert said.startswith(f"The query of a shape has no {part.split()[0].upper()} (SHACL, 5.3.1); write FILTER ")
    assert why_not_asked("SELECT $this { $this <urn:values> ?minus # MINUS { }\n}", {}) is None

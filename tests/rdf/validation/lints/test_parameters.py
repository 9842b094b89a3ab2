"""Lints about the parameters of templates."""

from __future__ import annotations

import pytest

from tests.rdf.validation.lints.linted_text import TEMPLATE, lints, only


def test_a_query_may_name_things_that_no_ontology_declares() -> None:
    prefix = "PREFIX rob: <https://w3id.org/selfconf/robotics#>"
    query = f"{prefix} SELECT $this {{ $this rob:place rob:SomewhereElse }}"
    assert not lints(TEMPLATE + f":r sh:sparql [ sh:select '{query}' ] .")


def test_a_parameter_that_no_template_lists_is_noticed() -> None:
    text = TEMPLATE + ":r sh:property [ sh:path rob:place ; sh:in ( :p ) ] . :p a sc:Parameter ; sc:name 'p' ."
    assert only(text).code == "SC-L15"
    assert not lints(text + ":t sc:parameter :p .")


BORROWED = (
    TEMPLATE
    + ":t sc:parameter :p . :r sh:property [ sh:path rob:place ; sh:in ( :p ) ] . :p a sc:Parameter ; sc:name 'p' .\n"
    + ":u a sc:Template ; sc:roles ( :s ) . :s a sc:Role ; sh:class rob:Lamp ; "
)


@pytest.mark.parametrize(
    "said",
    [
        "sh:property [ sh:path rob:place ; sh:in ( :hall :p ) ] .",
        "sh:node :There . :There sh:property [ sh:path rob:place ; sh:hasValue :p ] .",
        "sc:sets [ sc:parameterType :Place ; sc:value :p ] .",
    ],
)
def test_a_parameter_of_another_template_is_noticed_where_a_role_mentions_it(said: str) -> None:
    found = only(BORROWED + said)
    assert (found.code, found.hint) == ("SC-L15", "Say sc:parameter :p of :u as well.")
    assert found.source[found.column - found.source_column :].startswith(":p")
    assert not lints(BORROWED + said + " :u sc:parameter :p .")


@pytest.mark.parametrize(
    ("condition", "noticed"),
    [
        ("$this rob:place home:p", True),
        ("$this rob:place <https://example.org/home#p>", True),
        ("$this rob:place home:place, ?p, 'home:p' # home:p", False),
    ],
)
def test_a_parameter_in_the_text_of_a_query_is_noticed(condition: str, noticed: bool) -> None:
    prefixes = " ".join(
        f"[ sh:prefix '{name}' ; sh:namespace '{iri}'^^<http://www.w3.org/2001/XMLSchema#anyURI> ]"
        for name, iri in (("home", "https://example.org/home#"), ("rob", "https://w3id.org/selfconf/robotics#"))
    ).replace("] [", "] , [")
    text = (
        f"{TEMPLATE} :t sc:parameter :p . :p a sc:Parameter ; sc:name 'p' . :prefixes sh:declare {prefixes} .\n"
        ":r sh:property [ sh:path rob:place ; sh:in ( :p ) ] ; sh:sparql [ sh:prefixes :prefixes ;\n"
        f'sh:select """SELECT $this WHERE {{ FILTER NOT EXISTS {{ {condition}\n}} }}""" ] .'
    )
    assert [found.code for found in lints(text)] == ["SC-L16"] * noticed

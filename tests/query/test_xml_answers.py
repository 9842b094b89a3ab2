"""Answers in XML are well-formed, and have the values that were found; what XML cannot write is refused and named."""

from __future__ import annotations

import re
from xml.etree import ElementTree

import pyoxigraph as ox
import pytest

from selfconf.errors import NotAcceptableError
from selfconf.query.xml_answers import xml_answer


def answered(query: str) -> bytes:
    """The answer of an empty dataset to a query, as XML."""
    return xml_answer(ox.Store().query(query))


def test_a_value_comes_back_as_it_is() -> None:
    (value,) = ElementTree.fromstring(answered(r'SELECT (" a\r\n\t<é&\u0085\U0001F916 " AS ?y) {}')).iter(
        "{http://www.w3.org/2005/sparql-results#}literal"
    )
    assert value.text == " a\r\n\t<é&\u0085\U0001f916 "
    written = answered(r'CONSTRUCT { <urn:s> <http://x/p> "a\rb" } {}')
    assert [str(triple) for triple in ox.parse(written, format=ox.RdfFormat.RDF_XML)] == [
        r'<urn:s> <http://x/p> "a\rb"'
    ]
    assert b"<boolean>true</boolean>" in answered("ASK {}")


@pytest.mark.parametrize("character", [r"\u0001", r"\u000B", r"\u001F", r"\uFFFE", r"\uFFFF"])
@pytest.mark.parametrize("query", ['SELECT ("a%s<" AS ?y) {}', 'CONSTRUCT { <urn:s> <http://x/p> "a%s<" } {}'])
def test_a_value_with_a_character_that_xml_lacks_is_named(character: str, query: str) -> None:
    spelled = ascii(f"a{chr(int(character[2:], 16))}<")
    with pytest.raises(NotAcceptableError) as error:
        answered(query % character)
    assert str(error.value).startswith(f"XML 1.0 cannot write the value {spelled};")


@pytest.mark.parametrize("predicate", ["http://x/1", "urn:x:1", "http://x/", "http://www.w3.org/2000/xmlns/a"])
def test_a_predicate_that_ends_in_no_name_of_xml_is_named(predicate: str) -> None:
    with pytest.raises(NotAcceptableError, match=f"cannot write the predicate <{predicate}>"):
        answered(f'CONSTRUCT {{ <urn:s> <http://x/p> 1 ; <{predicate}> "v" }} {{}}')


def test_a_predicate_of_the_syntax_of_rdf_xml_is_named() -> None:
    with pytest.raises(NotAcceptableError, match="rdf-syntax-ns#li>"):
        answered('CONSTRUCT { <urn:s> <http://www.w3.org/1999/02/22-rdf-syntax-ns#li> "v" } {}')


SNOMED = "a <http://x/C>, <http://snomed.info/id/138875005>, <urn:x:1>"


@pytest.mark.parametrize(
    "said",
    [
        f'{SNOMED} ; <http://x/p> "v"',
        f'<http://x/p> "v" ; {SNOMED}',
        SNOMED,
        f'{SNOMED} ; <http://www.w3.org/1999/02/22-rdf-syntax-ns#type-> "<rdf:type- "',
        "<http://x/says> <<( <urn:o> a <urn:x:1> )>>",
        'a "no class, and not as it may be", _:b',
    ],
)
def test_a_class_is_written_whatever_it_ends_in_and_wherever_it_is_said(said: str) -> None:
    query = f"CONSTRUCT {{ <urn:s> {said} }} {{}}"
    found = {str(triple) for triple in ox.parse(answered(query), format=ox.RdfFormat.RDF_XML)}
    blank = re.compile("_:[0-9a-z]+")
    assert {blank.sub("_:b", triple) for triple in found} == {
        blank.sub("_:b", str(triple)) for triple in ox.Store().query(query)
    }


def test_a_predicate_is_named_also_within_a_triple_that_another_is_about() -> None:
    with pytest.raises(NotAcceptableError, match="cannot write the predicate <urn:x:1>"):
        answered("CONSTRUCT { <urn:s> <http://x/says> <<( <urn:o> <urn:x:1> <urn:p> )>> } {}")

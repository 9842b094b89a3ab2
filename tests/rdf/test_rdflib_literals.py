"""Literals as rdflib has them, without surprises."""

from __future__ import annotations

import pytest
from rdflib import RDF, XSD, URIRef

from selfconf.rdf.rdflib_literals import literal


@pytest.mark.parametrize(
    ("text", "datatype", "ill_typed"),
    [
        ("maybe", XSD.boolean, True),
        ("1", XSD.boolean, False),
        ("9" * 5_000, XSD.integer, True),
        ("NaN", XSD.decimal, True),
        ("9223372036854775807", XSD.long, False),
        ("9223372036854775808", XSD.long, True),
        ("-9223372036854775809", XSD.long, True),
        ("18446744073709551615", XSD.unsignedLong, False),
        ("18446744073709551616", XSD.unsignedLong, True),
        ("007", XSD.integer, False),
        ("<b>", RDF.XMLLiteral, True),
        ("<b>x</b>", RDF.XMLLiteral, False),
        ("<b>" * 50_000, RDF.HTML, False),
    ],
)
def test_it_keeps_its_text_and_is_ill_typed_in_silence(
    text: str, datatype: URIRef, ill_typed: bool, capfd: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture
) -> None:
    found = literal(text, datatype)  # a warning would be an error
    assert (str(found), found.datatype, found.ill_typed) == (text, datatype, ill_typed)
    assert caplog.records == []
    assert capfd.readouterr() == ("", "")


def test_it_may_have_a_language() -> None:
    assert literal("a", None, "en").language == "en"

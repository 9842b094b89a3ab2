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
        ("1_0", XSD.integer, True),
        ("\u0663", XSD.integer, True),
        (" 1", XSD.integer, True),
        ("1e3", XSD.decimal, True),
        ("1_0", XSD.double, True),
        ("inf", XSD.double, False),
        ("inf", XSD.decimal, True),
        ("-INF", XSD.double, False),
        ("NaN", XSD.float, False),
        ("1E3", XSD.double, False),
        ("2020-01-01", XSD.dateTime, True),
        ("2020-01-01 10:00:00", XSD.dateTime, True),
        ("2020-01-01T10:00:00.5Z", XSD.dateTime, False),
        ("10:00", XSD.time, True),
        ("P1Y", XSD.dayTimeDuration, True),
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

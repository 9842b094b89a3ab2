"""Literals as rdflib has them, with their text as it is written, and without surprises for what judges them.

rdflib makes a value of each literal as soon as there is one. What strangers write must not cost much thereby, nor be
commented on stderr: selfconf itself reports a literal that is none of its datatype, where it matters. So

* markup stays text, as its value would be a document that nothing compares;
* what Python reads as a number or a date and XML Schema does not, such as 1_0, or an xsd:decimal that is infinite
  or not a number, is none;
* what 64 bits do not hold is no xsd:long and no xsd:unsignedLong, whose ranges rdflib does not know;
* what is no boolean is false, without a warning.
"""

from __future__ import annotations

import logging
from xml.parsers import expat

from rdflib import RDF, XSD, Literal, URIRef

from selfconf.model.literal_values import FLOATING, TRUTH, in_lexical_space, number_of

_MARKUP = frozenset((RDF.HTML, RDF.XMLLiteral))
_AS_RDFLIB_WRITES = frozenset(("inf", "-inf", "nan"))
"""What rdflib makes of INF, -INF and NaN in the graphs that it parses itself, as the shapes are."""
_IN_64_BITS = frozenset((XSD.long, XSD.unsignedLong))


def _worth_logging(record: logging.LogRecord) -> bool:
    return not str(record.msg).startswith("Failed to convert Literal lexical form")


logging.getLogger("rdflib.term").addFilter(_worth_logging)


def literal(text: str, datatype: URIRef | None, language: str | None = None) -> Literal:
    """A literal of a datatype or in a language."""
    if datatype in _MARKUP:
        return _literal(text, datatype, text, ill_typed=datatype == RDF.XMLLiteral and not _is_xml(text))
    if datatype == XSD.boolean and text not in TRUTH:
        return _literal(text, datatype, False, ill_typed=True)
    found = Literal(text, lang=language, datatype=datatype, normalize=False)
    if datatype is not None and not _is_written(text, str(datatype)):
        return _literal(text, datatype, None, ill_typed=True)
    if datatype in _IN_64_BITS and number_of(text, str(datatype)) is None:
        return _literal(text, datatype, found.value, ill_typed=True)
    return found


def _literal(text: str, datatype: URIRef | None, value: object, ill_typed: bool) -> Literal:
    """A literal whose value is given; rdflib has no other way to say so than by what it keeps to itself."""
    found = Literal(text)
    found._datatype, found._value, found._ill_typed = datatype, value, ill_typed
    return found


def _is_written(text: str, datatype: str) -> bool:
    return in_lexical_space(text, datatype) or (datatype in FLOATING and text in _AS_RDFLIB_WRITES)


def _is_xml(text: str) -> bool:
    try:
        expat.ParserCreate().Parse(f"<x>{text}</x>".encode(), True)
    except (expat.ExpatError, ValueError):
        return False
    return True

"""An answer in XML, or why it cannot be one: XML 1.0 lacks characters, and RDF/XML writes predicates as element names.

Oxigraph writes such values and predicates all the same, so what it has written is read once, by Expat. A carriage
return is written as a reference: a reader takes the character itself for a line feed (XML 1.0, section 2.11).

A type that comes first of its subject Oxigraph writes as the name of an element, which many classes do not end in
(`http://snomed.info/id/138875005`). So it is handed another predicate for rdf:type, of which the name is replaced in
what it has written: each class is an attribute then, and all of them can be written.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from html import unescape
from xml.parsers.expat import ExpatError, ParserCreate

import pyoxigraph as ox

from selfconf.errors import NotAcceptableError
from selfconf.rdf.sparql import QueryAnswer
from selfconf.rdf.vocabulary import TYPE

XML_TYPES = frozenset(("application/sparql-results+xml", "application/rdf+xml"))
"""The media types of answers in XML."""
_SHOWN = 80
"""How many characters of a value a sentence shows."""
_SOME = ox.NamedNode("urn:x")
_TYPE = ox.NamedNode(TYPE)
_RDF = TYPE.removesuffix("type")


def xml_answer(found: QueryAnswer) -> bytes:
    """An answer as XML, which is read from it. Raises NotAcceptableError for a value or predicate that cannot be."""
    if isinstance(found, ox.QueryTriples):
        triples = list(found)
        predicates = dict.fromkeys(predicate for triple in triples for predicate in _predicates(triple))
        for predicate in predicates:
            if _mistake(_as_xml([ox.Triple(_SOME, predicate, _SOME)])) is not None:
                raise NotAcceptableError(
                    f"RDF/XML cannot write the predicate {predicate}, which does not end in a name of XML,"
                    f" or is of the syntax of RDF/XML; ask for text/turtle"
                )
        name = "type-"  # a name of XML that no predicate of the answer has
        while (stand_in := ox.NamedNode(f"{_RDF}{name}")) in predicates:
            name += "-"
        written = _as_xml(_without_types(triple, stand_in) for triple in triples)
        for begin, end in ((b"<", b" "), (b"<", b">"), (b"</", b">")):  # in values these signs are references
            written = written.replace(b"%brdf:%b%b" % (begin, name.encode(), end), b"%brdf:type%b" % (begin, end))
    else:
        written = found.serialize(format=ox.QueryResultsFormat.XML) or b""
    written = written.replace(b"\r", b"&#13;")
    mistake = _mistake(written)
    if mistake is not None:
        raise NotAcceptableError(
            f"XML 1.0 cannot write the value {_value_at(written, mistake)}; ask for another format, as JSON or Turtle"
        )
    return written


def _predicates(triple: ox.Triple) -> Iterator[ox.NamedNode]:
    """The predicate of a triple, and those of the triples that it is about."""
    yield triple.predicate
    if isinstance(triple.object, ox.Triple):
        yield from _predicates(triple.object)


def _without_types(triple: ox.Triple, stand_in: ox.NamedNode) -> ox.Triple:
    """A triple with another predicate for rdf:type, also in the triples that it is about."""
    predicate, value = triple.predicate, triple.object
    if isinstance(value, ox.Triple):
        value = _without_types(value, stand_in)
    elif predicate != _TYPE:
        return triple
    return ox.Triple(triple.subject, stand_in if predicate == _TYPE else predicate, value)


def _as_xml(triples: Iterable[ox.Triple]) -> bytes:
    """Triples as RDF/XML; nothing where the serializer itself refuses one."""
    try:
        return ox.serialize(triples, format=ox.RdfFormat.RDF_XML) or b""
    except OSError:  # so it refuses words of its own syntax, such as rdf:li
        return b""


def _mistake(written: bytes) -> int | None:
    """The place of the first byte that is not well-formed XML; None where all is."""
    reader = ParserCreate(namespace_separator=" ")
    try:
        reader.Parse(written, True)
    except ExpatError:
        return reader.ErrorByteIndex
    return None


def _value_at(written: bytes, place: int) -> str:
    """The value around a place of an answer, quoted, with its characters spelled out."""
    before, after = written[:place], written[place:]
    begin = max(before.rfind(b">"), before.rfind(b'"')) + 1
    end = min((found for mark in (b"<", b'"') if (found := after.find(mark)) >= 0), default=len(after))
    value = unescape((before[begin:] + after[:end]).decode(errors="replace"))
    return ascii(value if len(value) <= _SHOWN else f"{value[:_SHOWN]}...")

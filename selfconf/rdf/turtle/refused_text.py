"""What is refused of a text before Oxigraph parses it, at its place: bytes that are not UTF-8, and what is Turtle 1.2.

*Encoding.* A text is UTF-8 in every format that is read here. Oxigraph passes over other bytes in comments, and
names no place of others; so they are looked for before.

*Version.* Turtle 1.1 is read. Oxigraph reads Turtle 1.2, in which a statement can speak of another one, and a text has
a direction besides its language. Nothing in the model stands for these, nor does SHACL see them; `validate` refuses
them, as rdflib does not read them. Without this check a stranger's advertisement with a triple in a triple would be
read everywhere else, and break each query of the ecology that it is part of.
"""

from __future__ import annotations

import re

import pyoxigraph as ox

from selfconf.errors import TurtleError
from selfconf.rdf.turtle.tokens import COMMENT, QUOTED


def first_not_utf_8(octets: bytes) -> tuple[int, int, str] | None:
    """Of a text that is not UTF-8 the line and column of the first such byte, from one, and the sentence about it."""
    if octets.isascii():  # fifty times as fast as decoding, and no copy
        return None
    try:
        octets.decode()
    except UnicodeDecodeError as error:
        before = octets[: error.start].decode("utf-8-sig")
        said = f"this is not UTF-8: the byte 0x{octets[error.start]:02X} cannot stand here"
        return before.count("\n") + 1, len(before) - before.rfind("\n"), said
    return None


def check_utf_8(octets: bytes, source: str) -> None:
    """Raises TurtleError for a text that is not UTF-8, with the place."""
    found = first_not_utf_8(octets)
    if found is not None:
        line, column, said = found
        raise TurtleError(f"{said}; save the file in the encoding UTF-8", file=source, line=line, column=column)


TAKES_RDF_1_2 = (
    "this takes RDF 1.2, a statement about a statement, a text with a direction or a version; RDF 1.1 is read"
)
_SIGNS = (b"<<", b"{|", b"~", b"--ltr", b"--rtl", b"@version", b"VERSION")
"""One of these is in every text that takes Turtle 1.2; they may also be in a comment, a string or an IRI."""
_TOKEN = re.compile(
    rf"{QUOTED}|{COMMENT}".encode() + rb'|<(?:[^<>"{}|^`\\\s]|\\[uU])*>'
    rb"|\\."
    rb"|(?P<newer><<|\{\||~|@[A-Za-z]+(?:-[A-Za-z0-9]+)*--(?:ltr|rtl)\b"
    rb"|@version\b|(?<![\w:.-])VERSION\b(?![:.-]))",
    re.DOTALL,
)
"""What may hide one of the signs, and the signs where nothing hides them."""


def check_turtle_1_1(text: bytes, source: str, syntax: ox.RdfFormat = ox.RdfFormat.TURTLE) -> None:
    """Raises TurtleError, with the place, for what is Turtle 1.2 and not 1.1; other mistakes are left to the parser."""
    if not any(sign in text for sign in _SIGNS):
        return
    newer = next((token for token in _TOKEN.finditer(text) if token["newer"]), None)
    if newer is None or not _is_well_formed(text, syntax):
        return
    before = text[: newer.start()].decode(errors="replace")
    line, column = before.count("\n") + 1, len(before) - before.rfind("\n")
    raise TurtleError(f"not Turtle 1.1: {TAKES_RDF_1_2}", file=source, line=line, column=column)


def _is_well_formed(text: bytes, syntax: ox.RdfFormat) -> bool:
    try:
        for _ in ox.parse(text, format=syntax, base_iri="file:///"):
            pass
    except (SyntaxError, MemoryError):
        return False
    return True

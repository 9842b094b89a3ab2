"""Turtle 1.1 is read, and what only Turtle 1.2 has is refused, at its place.

Oxigraph reads Turtle 1.2, in which a statement can speak of another one, and a text has a direction besides its
language. Nothing in the model stands for these, nor does SHACL see them; `validate` refuses them, as rdflib does not
read them. Without this check a stranger's advertisement with a triple in a triple would be read everywhere else, and
break each query of the ecology that it is part of.
"""

from __future__ import annotations

import re

import pyoxigraph as ox

from selfconf.errors import TurtleError

TAKES_RDF_1_2 = "this takes RDF 1.2, a statement about a statement or a text with a direction; RDF 1.1 is read"
_SIGNS = (b"<<", b"{|", b"~", b"--ltr", b"--rtl")
"""One of these is in every text that takes Turtle 1.2; they may also be in a comment, a string or an IRI."""
_TOKEN = re.compile(
    rb'"""(?:[^"\\]|\\.|"(?!""))*"""'
    rb"|'''(?:[^'\\]|\\.|'(?!''))*'''"
    rb'|"(?:[^"\\\n]|\\.)*"'
    rb"|'(?:[^'\\\n]|\\.)*'"
    rb'|<(?:[^<>"{}|^`\\\s]|\\[uU])*>'
    rb"|#[^\n]*"
    rb"|\\."
    rb"|(?P<newer><<|\{\||~|@[A-Za-z]+(?:-[A-Za-z0-9]+)*--(?:ltr|rtl)\b)",
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

"""What to try when a text is not Turtle: the parser says what it met, which is seldom what the author forgot."""

from __future__ import annotations

import re

from selfconf.rdf.vocabulary import OWL, RDF, RDFS, ROB, SC, SH, UNIT, XSD

USUAL = {"sc": SC, "rob": ROB, "rdf": RDF, "rdfs": RDFS, "owl": OWL, "sh": SH, "xsd": XSD, "unit": UNIT}
"""The usual prefixes, with what they stand for."""
_UNDECLARED = re.compile(r"The prefix (?P<prefix>[^:\s]*): has not been declared")
_ADVICE = (
    ("A dot is expected", "Perhaps a semicolon is missing before this."),
    ("is not a valid predicate", "A predicate is an IRI or a; perhaps the dot before this should be a semicolon."),
    ("property lists should end", "Perhaps a semicolon or the closing ] is missing before this."),
    ("Invalid IRI code point ' '", "In an IRI a blank is written %20."),
    ("Line jumps are not allowed", "Perhaps the closing quotation mark is missing."),
    (", is not a valid RDF object", "The members of a list stand side by side, without commas."),
    ("‘", 'Quotation marks are straight: ".'),
    ("“", 'Quotation marks are straight: ".'),
    ("Unexpected end", "Perhaps the dot after the last statement is missing."),
)


def undeclared_prefix(message: str) -> str | None:
    """The prefix that is used without a declaration, if that is what a message of the parser says."""
    undeclared = _UNDECLARED.search(message)
    return None if undeclared is None else undeclared["prefix"]


def advice(message: str) -> str | None:
    """What to try after a message of the parser, in a sentence, if that is known."""
    prefix = undeclared_prefix(message)
    if prefix is not None:
        stands_for = USUAL[prefix].base if prefix in USUAL else "..."
        return f"Write @prefix {prefix}: <{stands_for}> . at the head of the file."
    return next((said for words, said in _ADVICE if words in message), None)


def with_advice(message: str) -> str:
    """A message of the parser, followed by what to try, if that is known."""
    said = advice(message)
    return message if said is None else f"{message.rstrip('.')}. {said}"

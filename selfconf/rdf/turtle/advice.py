"""What to try when a text is not Turtle: the parser says what it met, which is seldom what the author forgot."""

from __future__ import annotations

import re

from selfconf.model.curie import SCHEMES
from selfconf.rdf.vocabulary import OWL, RDF, RDFS, ROB, SC, SH, UNIT, XSD

USUAL = {"sc": SC, "rob": ROB, "rdf": RDF, "rdfs": RDFS, "owl": OWL, "sh": SH, "xsd": XSD, "unit": UNIT}
"""The usual prefixes, with what they stand for."""
_UNDECLARED = re.compile(r"The prefix (?P<prefix>[^:\s]*): has not been declared")
_ADVICE = (
    ("A dot is expected", "Perhaps a semicolon is missing before this, or a dot behind @prefix."),
    ("is not a valid predicate", "A predicate is an IRI or a; perhaps the dot before this should be a semicolon."),
    ("property lists should end", "Perhaps a semicolon or the closing ] is missing before this."),
    ("Invalid IRI code point ' '", "In an IRI a blank is written %20."),
    ("Line jumps are not allowed", "Perhaps the closing quotation mark is missing."),
    (r"^\{ is not a valid", "Brackets are square: [ ... ]."),
    ("^, is not a valid RDF object", "The members of a list stand side by side, without commas."),
    (r"^[].;] is not a valid RDF object", "Perhaps an object or the closing ) is missing before this."),
    (r"^\. is not a valid subject", "Perhaps a dot is too many; behind PREFIX, unlike @prefix, there is none."),
    (r"^[])] is not a valid subject", "Perhaps it is too many, or what it closes is not opened."),
    (r"^(True|False|TRUE|FALSE) is not", "Truth values are written true and false."),
    (r"^[?$]\w* is not", "Variables belong to SPARQL; a parameter stands as its IRI, such as :room."),
    (r"^[^\W\d_]\w* is not", 'A name has a prefix, as in :lamp; a text stands in quotation marks, as in "lamp".'),
    (
        r"^[-+.\d\"']\S* is not a valid subject",
        "A literal is no subject. Between values stand commas, and around a date quotation marks.",
    ),
    ("[\u2018\u2019\u201c-\u201e\u00ab\u00bb]", 'Quotation marks are straight: ".'),
    ("'[\u2010-\u2015\u2212]' is not allowed", "A minus is written -."),
    (r"'[\s\u200b]' is not allowed", "This is a special blank, such as the no-break space; write a plain one."),
    ("'/' is not allowed", r"A comment begins with #; in a name behind a prefix / is written \/."),
    (r"^\^\^ is not", "A text has a language or a datatype, not both."),
    ("without a language tag", 'Write the language in place of the datatype, as in "Tor"@de.'),
    ("language code should", 'Behind @ stands a language, as in "Tor"@de.'),
    (
        r"^Unexpected character '\w'",
        'A blank node is written _:name, and a language that has two parts with a hyphen, as in "Tor"@de-AT.',
    ),
    ("Unexpected escape character", r"A backslash in a string is written \\."),
    ("declaration should be followed by a prefix and its value", "An IRI stands in angle brackets: <https:...>."),
    ("Unexpected end of file", "Perhaps a closing quotation mark or a > is missing."),
    ("Unexpected end", "Perhaps the dot after the last statement is missing."),
)
"""Regular expressions for what the parser says, each with what to try; the first that matches counts."""


def undeclared_prefix(message: str) -> str | None:
    """The prefix that is used without a declaration, if that is what a message of the parser says."""
    undeclared = _UNDECLARED.search(message)
    return None if undeclared is None else undeclared["prefix"]


def advice(message: str) -> str | None:
    """What to try after a message of the parser, in a sentence, if that is known."""
    prefix = undeclared_prefix(message)
    if prefix is not None:
        if prefix in SCHEMES:
            return f"An IRI stands in angle brackets: <{prefix}:...>."
        stands_for = USUAL[prefix].base if prefix in USUAL else "..."
        return f"Write @prefix {prefix}: <{stands_for}> . at the head of the file."
    return next((said for words, said in _ADVICE if re.search(words, message)), None)


def with_advice(message: str) -> str:
    """A message of the parser, followed by what to try, if that is known."""
    said = advice(message)
    return message if said is None else f"{message.rstrip('.')}. {said}"

"""What to try when a file is not Turtle: the parser says what it met, which is seldom what the author forgot."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from selfconf.rdf.validation.prefilter import SyntaxProblem
from selfconf.rdf.vocabulary import OWL, RDF, RDFS, ROB, SC, SH, UNIT, XSD

USUAL = {"sc": SC, "rob": ROB, "rdf": RDF, "rdfs": RDFS, "owl": OWL, "sh": SH, "xsd": XSD, "unit": UNIT}
"""The usual prefixes, with what they stand for."""
_UNDECLARED = re.compile(r"The prefix (?P<prefix>[^:\s]*): has not been declared")
_HINTS = (
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
_TO_THE_END = "Line jumps are not allowed"
"""After a string without an end nothing is what it seems."""


def hint(message: str) -> str | None:
    """What to try after a message of the parser, if that is known."""
    undeclared = _UNDECLARED.search(message)
    if undeclared is not None:
        prefix = undeclared["prefix"]
        stands_for = USUAL[prefix].base if prefix in USUAL else "..."
        return f"Write @prefix {prefix}: <{stands_for}> . at the head of the file."
    return next((advice for words, advice in _HINTS if words in message), None)


def telling(problems: Sequence[SyntaxProblem]) -> Iterator[SyntaxProblem]:
    """The problems, among some, that do not come of another: one for each prefix, and else the first of each line."""
    said: set[str] = set()
    lines: set[int] = set()
    for problem in problems:
        prefix = _UNDECLARED.search(problem.message)
        if problem.message in said if prefix else problem.line in lines:
            continue  # one missing declaration is one mistake, however often the prefix is used
        said.add(problem.message)
        yield problem
        if not prefix:
            lines.add(problem.line)
        if problem.message.startswith(_TO_THE_END):
            return

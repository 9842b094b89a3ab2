"""Which of the problems that a parser meets in a file its author has to hear of."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from selfconf.rdf.turtle import undeclared_prefix
from selfconf.rdf.validation.prefilter import SyntaxProblem

_TO_THE_END = "Line jumps are not allowed"
"""After a string without an end nothing is what it seems."""


def telling(problems: Sequence[SyntaxProblem]) -> Iterator[SyntaxProblem]:
    """The problems, among some, that do not come of another: one for each prefix, and else the first of each line."""
    said: set[str] = set()
    lines: set[int] = set()
    for problem in problems:
        prefix = undeclared_prefix(problem.message) is not None
        if problem.message in said if prefix else problem.line in lines:
            continue  # one missing declaration is one mistake, however often the prefix is used
        said.add(problem.message)
        yield problem
        if not prefix:
            lines.add(problem.line)
        if problem.message.startswith(_TO_THE_END):
            return

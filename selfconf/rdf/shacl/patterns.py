"""Whether a regular expression is found in a text of a stranger, at a cost that the text cannot choose.

Most expressions meet most texts at a cost that is known beforehand: then `re` is asked. Where its backtracking could go
on for long, an automaton is (`selfconf.rdf.shacl.automaton`), which says the same in linear time. What is left are
expressions beyond regular languages, texts of megabytes, and those that lead an automaton to ever more states: `re` may
try them for a moment of processor time, which becomes shorter the more such texts there are, and then they are not
decided.
"""

from __future__ import annotations

import math
import re
import time
import warnings
from functools import lru_cache
from typing import Any

from selfconf.rdf.deadline import ProcessorTimeUp, processor_limit
from selfconf.rdf.shacl.automaton import Automaton, NotRegular, TooManySteps, parsed

CHEAP = 10_000
"""Steps of backtracking that `re` may always take: a tenth of a millisecond."""
CHEAP_ENOUGH = 1_000_000
"""Steps of backtracking that `re` may take where there is no automaton: ten milliseconds."""
LONGEST_TEXT = 100_000
"""Characters that an automaton reads."""
PATTERN_SECONDS = 0.1
"""Processor time that `re` may try one expression in vain where nothing is known of the cost."""
LONGEST_TRY = 0.03
"""How much of it may go into one text."""


class MatchTooCostly(BaseException):
    """Whether a text is like a pattern takes too long to find out; no `Exception`, as the libraries catch those."""

    def __init__(self, pattern: str, text: str) -> None:
        super().__init__(pattern)
        self.pattern, self.text = pattern, text

    def __str__(self) -> str:
        shown = self.text if len(self.text) <= 40 else f"{self.text[:40]}..."
        return f"matching the pattern {self.pattern!r} against {shown!r} takes too long"


class Pattern:
    """A regular expression, and the cheapest way to find it in a text."""

    def __init__(self, pattern: str, flags: int) -> None:
        """Raises re.error."""
        self.pattern, self.flags = pattern, flags
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", FutureWarning)  # that `[[a]` may mean something else one day
                self._expression, self._tree = re.compile(pattern, flags), parsed(pattern, flags)
            self._short = self._length_for(CHEAP)
        except (OverflowError, RecursionError):
            raise re.error("it repeats something too often, or nests too deeply") from None
        self._automaton: Automaton | None = None
        self._regular = True
        self._left = PATTERN_SECONDS

    def _length_for(self, steps: int) -> int:
        """The length of the texts, to a power of two, that cannot cost more steps of backtracking; -1 if all may."""
        anchored = _anchored(self._tree) and not self._tree.state.flags & re.MULTILINE
        lengths = (0, *(1 << power for power in range(21)))
        return max((n for n in lengths if (n or 1) ** (not anchored) * _ways(self._tree, n) <= steps), default=-1)

    def finds(self, text: str) -> bool:
        """Whether the pattern is found in a text. Raises MatchTooCostly."""
        if len(text) <= self._short:
            return self._expression.search(text) is not None
        automaton = self._made() if len(text) <= LONGEST_TEXT else None
        if automaton is not None:
            try:
                return automaton.finds(text)
            except TooManySteps:
                pass
        return self._tried(text)

    def _made(self) -> Automaton | None:
        if self._automaton is None and self._regular:
            try:
                self._automaton = Automaton(self.pattern, self.flags)
            except (NotRegular, RecursionError):
                self._regular = False
                self._short = self._length_for(CHEAP_ENOUGH)
        return self._automaton

    def _tried(self, text: str) -> bool:
        if len(text) <= self._short:
            return self._expression.search(text) is not None
        if self._left <= 0:
            raise MatchTooCostly(self.pattern, text)
        began = time.process_time()
        try:
            with processor_limit(LONGEST_TRY):
                return self._expression.search(text) is not None
        except ProcessorTimeUp:
            self._left -= time.process_time() - began
            raise MatchTooCostly(self.pattern, text) from None


@lru_cache(maxsize=1024)
def pattern(expression: str, flags: int = 0) -> Pattern:
    """A pattern by its expression and the flags of `re`. Raises re.error."""
    return Pattern(expression, flags)


_INSTEAD_OF_CATEGORIES = r"pySHACL knows no categories of Unicode; a letter of any language is [^\W\d_]"
_HOLDS_SPACE = re.compile(r"(\\.|\[(?:\\.|[^\]\\])*\])|[ \t\r\n]+", re.DOTALL)
"""White space in an expression, or what holds white space that counts: an escaped character, a class of characters."""
_HOLDS_DOLLAR = re.compile(r"(\\.|\[\^?\]?(?:\\.|[^\]\\])*\])|\$", re.DOTALL)
"""`$` in an expression, or what holds one that stands for itself."""


def sparql_expression(expression: str, flags: int) -> str:
    """An expression of REGEX in SPARQL for `re`, where `$` would also stand before a line feed that ends the text.

    Raises re.error for one that subtracts a class of characters, as `[a-z-[aeiou]]`, which `re` reads otherwise.
    """

    def rewritten(found: re.Match[str]) -> str:
        if found[1] and found[1].startswith("[") and "-[" in re.sub(r"\\.", "", found[1]):
            raise re.error("it subtracts a class of characters from another, which pySHACL cannot")
        return found[1] or "\\Z"

    text = _HOLDS_DOLLAR.sub(rewritten, expression)
    return expression if flags & re.MULTILINE else text


def shacl_pattern(expression: str, flags: str) -> Pattern:
    """A `sh:pattern` with its `sh:flags`, which are those of REGEX in SPARQL: i, m, s, x and q. Raises re.error.

    x drops white space, but in classes of characters, and knows no comments, so it is not `re.VERBOSE`.
    """
    asked = flags.lower()  # as pySHACL reads them
    options = re.RegexFlag(0)
    for letter, option in (("i", re.IGNORECASE), ("m", re.MULTILINE), ("s", re.DOTALL)):
        if letter in asked:
            options |= option
    if "q" in asked:
        expression = re.escape(expression)
    elif "x" in asked:
        expression = _HOLDS_SPACE.sub(lambda found: found[1] or "", expression)
    return pattern(sparql_expression(expression, options), int(options))


def pattern_fault(expression: str, flags: str) -> str | None:
    """Why a text, with its `sh:flags`, is no regular expression, without a full stop; None if it is one."""
    try:
        shacl_pattern(expression, flags)
    except re.error as error:
        return f"{error}. {_INSTEAD_OF_CATEGORIES}" if re.match(r"bad escape \\[pP]", error.msg) else str(error)
    return None


def _anchored(tree: Any) -> bool:
    """Whether a match can only begin where the text does."""
    first = (str(tree[0][0]), str(tree[0][1])) if len(tree) else ("", "")
    return first in (("AT", "AT_BEGINNING"), ("AT", "AT_BEGINNING_STRING"))


def _ways(items: Any, length: int) -> float:
    """A bound on the number of ways in which a sequence can meet a text of some length."""
    return math.prod((_ways_of(str(operator), argument, length) for operator, argument in items), start=1.0)


def _ways_of(operator: str, argument: Any, length: int) -> float:
    """A bound on the number of ways in which one part can meet it; what is not known here is taken to be worst."""
    if operator in ("LITERAL", "NOT_LITERAL", "ANY", "IN", "AT"):
        return 1.0
    if operator == "BRANCH":
        return math.fsum(_ways(one, length) for one in argument[1])
    if operator == "SUBPATTERN":
        return _ways(argument[3], length)
    if operator in ("MAX_REPEAT", "MIN_REPEAT"):
        least, most, inner = argument
        ways = _repeated(int(least), min(int(most), length + 1), _ways(inner, length), length)
        # The text bounds how often something is repeated that takes a character of it, and `()` takes none.
        return ways if inner.getwidth()[0] else max(ways, float(least))
    if operator in ("ASSERT", "ASSERT_NOT"):
        return _ways(argument[1], length)
    return math.inf


def _repeated(least: int, most: int, ways: float, length: int) -> float:
    """The number of ways of something repeated."""
    counts = max(most - least, 0) + 1.0
    if ways == 1.0:
        return counts
    try:
        return counts * ways ** max(least, most)
    except OverflowError:
        return math.inf

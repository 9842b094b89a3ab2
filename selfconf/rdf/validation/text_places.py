"""Places in a text that is not read as RDF, for diagnostics that need no parser.

rdflib's parser knows the place of every term, and takes a thousand times as long as a search. What is searched for here
is looked for outside strings and comments, with prefixes expanded; a name with escapes is not found.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from codecs import BOM_UTF8
from collections.abc import Collection, Iterable
from functools import cached_property

from selfconf.model.codes import BY_CODE
from selfconf.model.diagnostic import Diagnostic, excerpt, shortened
from selfconf.rdf.turtle import COMMENT, QUOTED

_IRI = r"<(?P<iri>[^<>\s]*)>"
_NAME_BEGINS = r"(?<![^\s<>\"'()\[\]{};,^])"
_NAME_END = r"[^\s<>\"'()\[\]{};,\#]*"
_DECLARATION = re.compile(r"(?i:@?\bprefix|@?\bbase)\s+[^\s:<]*:?\s*$")
_LONGEST_DECLARATION = 80


class TextPlaces:
    """A text, as far as it is UTF-8, and the places of its lines."""

    def __init__(self, name: str, octets: bytes) -> None:
        self.name, self.text = name, octets.removeprefix(BOM_UTF8).decode("utf-8", "replace")

    def at(self, offset: int, code: str, message: str, hint: str | None = None) -> Diagnostic:
        """A diagnostic at an offset."""
        line = bisect_right(self._begins, offset)
        return self.on(line, offset - self._begins[line - 1] + 1, code, message, hint)

    def on(
        self, line: int, column: int, code: str, message: str, hint: str | None = None, width: int = 1
    ) -> Diagnostic:
        """A diagnostic at a line and column."""
        begin, end = ([*self._begins[line - 1 : line + 1], len(self.text), len(self.text)])[:2]
        source, start = excerpt(self.text, begin, end, column)
        said = shortened(message), BY_CODE[code].severity, width, hint and shortened(hint)
        return Diagnostic(self.name, line, column, code, *said, source=source, source_column=start)

    def first_use(self, iris: Collection[str], prefixes: Iterable[tuple[str, str]]) -> int | None:
        """The offset of the first of some IRIs in a Turtle text with some prefixes; None where none is found."""
        homes = {prefix: base for prefix, base in prefixes if any(iri.startswith(base) for iri in iris)}
        names = "|".join(map(re.escape, homes))
        name = rf"|{_NAME_BEGINS}(?P<prefix>{names}):(?P<local>{_NAME_END})" if homes else ""
        for found in re.finditer("|".join((QUOTED, COMMENT, _IRI + name)), self.text, re.DOTALL):
            iri = found["iri"]
            if homes and found["prefix"] is not None:
                iri = homes[found["prefix"]] + found["local"].rstrip(".")
            before = max(0, found.start() - _LONGEST_DECLARATION)
            if iri in iris and not _DECLARATION.search(self.text, before, found.start()):
                return found.start()
        return None

    def largest_token(self) -> int:
        """The offset of the longest string or IRI, or 0."""
        tokens = re.finditer("|".join((QUOTED, COMMENT, _IRI)), self.text, re.DOTALL)
        return max(((found.end() - found.start(), found.start()) for found in tokens), default=(0, 0))[1]

    @cached_property
    def _begins(self) -> list[int]:
        """The offsets at which lines begin."""
        return [0, *(match.end() for match in re.finditer("\n", self.text))]

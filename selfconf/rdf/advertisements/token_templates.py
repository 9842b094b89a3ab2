"""Token templates: what segments of Turtle have in common that differ in nothing but their strings and digits.

A segment without its strings and digits is its *pattern*. Once several segments of a pattern have been met, one of them
is read with marks in these places. The statements that it makes, with holes where the marks are found again, are the
*templates* of all of them: to know what another segment says, no parser is needed.

That is sound because a string or a run of digits means itself wherever it stands, and may be replaced by any other. In
an IRI that holds for what follows the last `#` or `/`, as no term that matters here has digits there. Patterns are left
alone where that does not hold: prefixes and language tags with digits, ports and the like in IRIs, escapes in names,
strings in single quotes. A pattern that has none of that shows that its segments were cut between tokens. A datatype
does not matter: no literal is looked at here, and none is refused by the parser.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Sequence

from selfconf.model.immutable import immutable
from selfconf.model.profile import is_port_name
from selfconf.rdf.advertisements.recognition import port_of
from selfconf.rdf.advertisements.statement_table import Statement, StatementTable
from selfconf.rdf.permitted_fields import RATE
from selfconf.rdf.vocabulary import SC

OCCURRENCES = 4
"""After how many segments of a pattern its templates are made."""
MOST_PATTERNS = 10_000
"""How many patterns are remembered that have no templates yet."""
_ESCAPE = rb"\\(?:[tbnrf\"'\\]|u(?!0000)[0-9A-Ca-c][0-9A-Fa-f]{3})"
_TEXT = rb'"(?!"")[^"\\\n\r\0]*(?:%b[^"\\\n\r\0]*)*"|"""[^"\\\0]*(?:(?:%b|""?(?!"))[^"\\\0]*)*"""' % (_ESCAPE, _ESCAPE)
_RUN = rb"[0-9]+(?![^<>\s\"#/]{0,250}[#/][^<>\s\"]{0,250}>)"  # no term that matters is longer
_STRING, _DIGITS, _HOLE = re.compile(_TEXT), re.compile(_RUN), re.compile(_TEXT + b"|" + _RUN)
_REGULAR = re.compile(rb"(?:[^<>\"'#\\%@\0]|\"(?!\")|@[A-Za-z]|<[^<>\"'\\%@\s\[\]]*>|#[^\n\r\"'\\]*[\n\r])*")
_RIGID = re.compile(rb"\x01[^\s,;\[\]()<>\"/]{0,250}:|:\x01[^<>\s]{0,250}>|@[A-Za-z0-9-]*\x01")
"""Digits before a colon, or just after one in an IRI, or in a language tag."""
_HOLES = re.compile(rb'"|\x01')
_NAME = re.compile(r"s731([0-9]{4})")
_RATE = re.compile(RATE[SC.value].kind.turtle.encode())
_MARK = re.compile(r'"s731([0-9]{4})"|731([0-9]{4})')


def patterns_of(segments: Sequence[bytes]) -> list[bytes]:
    """The pattern of each segment. Raises UnicodeDecodeError where one is not UTF-8."""
    text = b"\0".join(segments)
    text.decode()
    if b"\1" in text:
        return [b""] * len(segments)
    patterns = _DIGITS.sub(b"\1", _STRING.sub(b'"', text)).split(b"\0")
    return patterns if len(patterns) == len(segments) else [b""] * len(segments)


@immutable
class TokenTemplate:
    """One statement that the segments of a pattern make, with holes."""

    predicate: str
    text_template: bytes
    holes: tuple[int, ...]
    """Which of the strings and digits of a segment belong into the holes."""
    bracketed: bool
    links: bool
    name: int | None
    """Of a port, between which quotation marks its name stands, counted from zero."""
    rate: tuple[int, ...]
    """Of a port, which of the digits are those of its rate."""
    free: bool
    """Whether such a statement is treated alike whatever is in its holes."""

    def text(self, segment: bytes) -> str:
        """The statement that a segment makes."""
        values = _HOLE.findall(segment)
        text: bytes = self.text_template % tuple([values[hole] for hole in self.holes])
        return text.decode()


class TemplatedStatement(Statement):
    """A statement whose text is made when it is asked for."""

    __slots__ = ("_segment", "_template")

    def __init__(self, template: TokenTemplate, segment: bytes) -> None:
        self._template, self._segment = template, segment
        self.predicate, self.bracketed = template.predicate, template.bracketed
        self.part, self.keyed, self.slot = None, (), self

    @property
    def text(self) -> str:
        """All of it."""
        return self._template.text(self._segment)

    @property
    def links(self) -> Sequence[str]:
        """The names of ports, or of a grounding, that are described elsewhere."""
        return self.text[len(self._template.predicate) + 1 :].split(" , ") if self._template.links else ()


class TokenTemplates:
    """The templates of the patterns that have been met often enough."""

    def __init__(self) -> None:
        self._met: Counter[bytes] = Counter()
        self._templates: dict[bytes, tuple[TokenTemplate, ...]] = {}

    def wanted(self, patterns: Sequence[bytes]) -> dict[bytes, bytes]:
        """Of each pattern whose templates are to be made, a segment with marks."""
        found = {}
        if len(self._met) > MOST_PATTERNS:
            self._met.clear()
        unknown = set(patterns).difference(self._templates)
        if unknown:
            self._met.update(pattern for pattern in patterns if pattern in unknown)
        for pattern in unknown:
            if self._met[pattern] >= OCCURRENCES:
                del self._met[pattern]
                self._templates[pattern] = ()
                if _HOLES.search(pattern) and _REGULAR.fullmatch(pattern) and not _RIGID.search(pattern):
                    found[pattern] = _marked(pattern)
        return found

    def learn(self, pattern: bytes, statements: Sequence[Statement], known: StatementTable) -> None:
        """Make the templates of a pattern from what its segment with marks says."""
        marks = [mark for statement in statements for mark in _marks(statement.text)]
        if sorted(marks) == list(range(len(_HOLES.findall(pattern)))):
            self._templates[pattern] = tuple([_template(pattern, statement, known) for statement in statements])

    def fill(
        self,
        segments: Sequence[bytes],
        patterns: Sequence[bytes],
        said: dict[bytes, tuple[Statement, ...]],
        known: StatementTable,
    ) -> list[bytes]:
        """Note what the segments say whose patterns have templates, and return the other segments."""
        odd: list[bytes] = []
        templates_of = self._templates.get
        for segment, pattern in zip(segments, patterns, strict=True):
            templates = templates_of(pattern)
            if not templates:
                odd.append(segment)
            else:
                said[segment] = tuple(
                    [TemplatedStatement(f, segment) if f.free else _filled(f, segment, known) for f in templates]
                )
        return odd


def _filled(template: TokenTemplate, segment: bytes, known: StatementTable) -> Statement:
    """The statement of a segment, where it matters what is in the holes."""
    statement = TemplatedStatement(template, segment)
    if template.links:
        known.suspects.add(statement)
        return statement
    if (
        template.name is None
        or b"\\" in segment
        or b'""' in segment
        or (template.rate and not _common(template.rate, segment))
    ):
        return known[statement.text]
    name = segment.split(b'"', template.name + 1)[template.name].decode()
    if not is_port_name(name):
        return known[statement.text]
    statement.slot = known.slot(template.predicate, name)
    return statement


def _common(rate: Iterable[int], segment: bytes) -> bool:
    """Whether the digits of a rate make a number that is recognised as one."""
    values = _HOLE.findall(segment)
    return _RATE.fullmatch(b".".join([values[hole] for hole in rate])) is not None


def _marks(text: str) -> tuple[int, ...]:
    """Which marks stand in a text, one after the other."""
    return tuple([int(mark[1] or mark[2]) for mark in _MARK.finditer(text)])


def _template(pattern: bytes, statement: Statement, known: StatementTable) -> TokenTemplate:
    """The template of a statement with marks."""
    text = statement.text
    port, name = port_of(statement.predicate, text), None
    if port is not None and port.depth is None and (mark := _NAME.fullmatch(port.name)):
        strings = [number for number, hole in enumerate(_HOLES.findall(pattern)) if hole == b'"']
        name = 2 * strings.index(int(mark[1])) + 1
    return TokenTemplate(
        statement.predicate,
        _MARK.sub("%b", text.replace("%", "%%")).encode(),
        _marks(text),
        statement.bracketed,
        port is None and len(statement.links) > 0,
        name,
        () if port is None else _marks(port.rate or ""),
        statement.slot is statement and statement not in known.suspects and not _MARK.search(statement.predicate),
    )


def _marked(pattern: bytes) -> bytes:
    """A segment of a pattern, with marks for strings and digits."""
    marks = iter(range(len(pattern)))
    return _HOLES.sub(lambda at: b'"s731%04d"' % next(marks) if at[0] == b'"' else b"731%04d" % next(marks), pattern)

"""Forms: what pieces of Turtle have in common that differ in nothing but their strings and digits.

A piece without its strings and digits is its *shape*. Once several pieces of a shape have been met, one of them is read
with marks in these places. What it says, with holes where the marks are found again, is the *form* of all of them: to
know what another piece says, no parser is needed.

That is sound because a string or a run of digits means itself wherever it stands, and may be replaced by any other.
In an IRI that holds for what follows the last `#` or `/`, as no term that matters here has digits there.
Shapes are left alone where it is not so: prefixes and language tags with digits, ports and the like in IRIs, escapes in
names, strings in single quotes. A shape that has none of that shows that its pieces were taken apart between tokens.
A datatype does not matter: no literal is looked at here, and none is refused by the parser.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from selfconf.rdf.clauses import Clause, Clauses, port_of

ENOUGH = 4
"""Of how many pieces of a shape its form is made."""
MOST = 10_000
"""How many shapes are remembered that have no form yet."""
_ESCAPE = rb"\\(?:[tbnrf\"'\\]|u(?!0000)[0-9A-Ca-c][0-9A-Fa-f]{3})"
_TEXT = rb'"(?!"")[^"\\\n\r\0]*(?:%b[^"\\\n\r\0]*)*"|"""[^"\\\0]*(?:(?:%b|""?(?!"))[^"\\\0]*)*"""' % (_ESCAPE, _ESCAPE)
_RUN = rb"[0-9]+(?![^<>\s\"#/]{0,250}[#/][^<>\s\"]{0,250}>)"  # no term that matters is longer
_STRING, _DIGITS, _HOLE = re.compile(_TEXT), re.compile(_RUN), re.compile(_TEXT + b"|" + _RUN)
_REGULAR = re.compile(rb"(?:[^<>\"'#\\%@\0]|\"(?!\")|@[A-Za-z]|<[^<>\"'\\%@\s\[\]]*>|#[^\n\r\"'\\]*[\n\r])*")
_RIGID = re.compile(rb"\x01[^\s,;\[\]()<>\"/]{0,250}:|:\x01[^<>\s]{0,250}>|@[A-Za-z0-9-]*\x01")
"""Digits before a colon, or just after one in an IRI, or in a language tag."""
_HOLES = re.compile(rb'"|\x01')
_NAME = re.compile(r"s731([0-9]{4})")
_MARK = re.compile(r'"s731([0-9]{4})"|731([0-9]{4})')


def shaped(pieces: Sequence[bytes]) -> list[bytes]:
    """The shape of each piece. Raises UnicodeDecodeError where one is not UTF-8."""
    text = b"\0".join(pieces)
    text.decode()
    if b"\1" in text:
        return [b""] * len(pieces)
    shapes = _DIGITS.sub(b"\1", _STRING.sub(b'"', text)).split(b"\0")
    return shapes if len(shapes) == len(pieces) else [b""] * len(pieces)


@dataclass(frozen=True, slots=True)
class Form:
    """One clause that the pieces of a shape say, with holes."""

    predicate: str
    template: bytes
    holes: tuple[int, ...]
    """Which of the strings and digits of a piece belong into the holes."""
    bracketed: bool
    links: bool
    name: int | None
    """Of a port, between which quotation marks its name stands, counted from nought."""
    rate: tuple[int, ...]
    """Of a port, which of the digits are those of its rate."""
    free: bool
    """Whether what is in the holes does not matter to what such a clause is."""

    def text(self, piece: bytes) -> str:
        """The clause that a piece says."""
        values = _HOLE.findall(piece)
        text: bytes = self.template % tuple([values[hole] for hole in self.holes])
        return text.decode()


class Filled(Clause):
    """A clause that is written out when somebody asks."""

    __slots__ = ("_form", "_piece")

    def __init__(self, form: Form, piece: bytes) -> None:
        self._form, self._piece = form, piece
        self.predicate, self.bracketed = form.predicate, form.bracketed
        self.part, self.keyed, self.slot = None, (), self

    @property
    def text(self) -> str:
        """All of it."""
        return self._form.text(self._piece)

    @property
    def links(self) -> Sequence[str]:
        """The names of ports, or of a grounding, that are described elsewhere."""
        return self.text[len(self._form.predicate) + 1 :].split(" , ") if self._form.links else ()


class Forms:
    """The forms of the shapes that have been met often enough."""

    def __init__(self) -> None:
        self._met: Counter[bytes] = Counter()
        self._forms: dict[bytes, tuple[Form, ...]] = {}

    def wanted(self, shapes: Sequence[bytes]) -> dict[bytes, bytes]:
        """Of the shapes whose form is to be made, a piece with marks."""
        found = {}
        if len(self._met) > MOST:
            self._met.clear()
        unknown = set(shapes).difference(self._forms)
        if unknown:
            self._met.update(shape for shape in shapes if shape in unknown)
        for shape in unknown:
            if self._met[shape] >= ENOUGH:
                del self._met[shape]
                self._forms[shape] = ()
                if _HOLES.search(shape) and _REGULAR.fullmatch(shape) and not _RIGID.search(shape):
                    found[shape] = _marked(shape)
        return found

    def learn(self, shape: bytes, clauses: Sequence[Clause], known: Clauses) -> None:
        """Make the form of a shape from what its piece with marks says."""
        marks = [mark for clause in clauses for mark in _marks(clause.text)]
        if sorted(marks) == list(range(len(_HOLES.findall(shape)))):
            self._forms[shape] = tuple([_form(shape, clause, known) for clause in clauses])

    def fill(
        self, pieces: Sequence[bytes], shapes: Sequence[bytes], said: dict[bytes, tuple[Clause, ...]], known: Clauses
    ) -> list[bytes]:
        """Note down what pieces say whose shapes have forms; the other pieces are returned."""
        odd: list[bytes] = []
        forms_of = self._forms.get
        for piece, shape in zip(pieces, shapes, strict=True):
            forms = forms_of(shape)
            if not forms:
                odd.append(piece)
            else:
                said[piece] = tuple([Filled(f, piece) if f.free else _filled(f, piece, known) for f in forms])
        return odd


def _filled(form: Form, piece: bytes, known: Clauses) -> Clause:
    """The clause of a piece, where it matters what is in the holes."""
    clause = Filled(form, piece)
    if form.links:
        known.suspects.add(clause)
        return clause
    if form.name is None or b"\\" in piece or b'""' in piece or (form.rate and not _common(form.rate, piece)):
        return known[clause.text]
    clause.slot = known.slot(form.predicate, piece.split(b'"', form.name + 1)[form.name].decode())
    return clause


def _common(rate: Iterable[int], piece: bytes) -> bool:
    """Whether the digits of a rate make a number of a common size above zero."""
    values = _HOLE.findall(piece)
    digits = [values[hole] for hole in rate]
    return max(map(len, digits)) < 10 and any(each.strip(b"0") for each in digits)


def _marks(text: str) -> tuple[int, ...]:
    """Which marks stand in a text, one after the other."""
    return tuple([int(mark[1] or mark[2]) for mark in _MARK.finditer(text)])


def _form(shape: bytes, clause: Clause, known: Clauses) -> Form:
    """The form of a clause with marks."""
    text = clause.text
    port, name = port_of(text), None
    if port is not None and (mark := _NAME.fullmatch(port["name"])):
        strings = [number for number, hole in enumerate(_HOLES.findall(shape)) if hole == b'"']
        name = 2 * strings.index(int(mark[1])) + 1
    return Form(
        clause.predicate,
        _MARK.sub("%b", text.replace("%", "%%")).encode(),
        _marks(text),
        clause.bracketed,
        port is None and len(clause.links) > 0,
        name,
        () if port is None else _marks(port["rate"] or ""),
        clause.slot is clause and clause not in known.suspects and not _MARK.search(clause.predicate),
    )


def _marked(shape: bytes) -> bytes:
    """A piece of a shape, with marks for strings and digits."""
    marks = iter(range(len(shape)))
    return _HOLES.sub(lambda at: b'"s731%04d"' % next(marks) if at[0] == b'"' else b"731%04d" % next(marks), shape)

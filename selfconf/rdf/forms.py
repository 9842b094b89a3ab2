"""Forms: what pieces of Turtle have in common that differ in nothing but their strings and digits.

A piece without its strings and digits is its *shape*. Once several pieces of a shape have been met, one of them is read
with marks in these places. What it says, with holes where the marks are found again, is the *form* of all of them: to
know what another piece says, no parser is needed.

That is sound because a string or a run of digits means itself wherever it stands, and may be replaced by any other.
In an IRI that holds for what follows the last `#` or `/`, as no term that matters here has digits there.
Shapes are left alone where it is not so: escapes, prefixes and language tags with digits, ports and the like in IRIs,
and strings of other kinds than "..." on one line. A shape that has none of that shows that its pieces were taken apart
between tokens. A datatype does not matter: no literal is looked at here, and none is refused by the parser.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from selfconf.rdf.clauses import Clause, Clauses, port_of

ENOUGH = 4
"""Of how many pieces of a shape its form is made."""
MOST = 10_000
"""How many shapes are remembered that have no form yet."""
_RUN = rb"[0-9]+(?![^<>\s\"]*[#/][^<>\s\"]*>)"
_STRING, _DIGITS = re.compile(rb'"[^"\\\n\r\0]*"'), re.compile(_RUN)
_HOLE = re.compile(rb'"[^"\\\n\r]*"|' + _RUN)
_REGULAR = re.compile(rb"(?:[^<>\"'#\\%@\0]|\"(?!\")|@[A-Za-z]|<[^<>\"'\\%@\s\[\]]*>)*")
_RIGID = re.compile(rb"\x01[^\s,;\[\]()<>\"/]*:|:\x01[^<>\s]*>|@[A-Za-z0-9-]*\x01")
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
    rate: bool
    """Whether it is a port with a rate."""
    written: bool
    """Whether what such a clause means depends on what is in the holes."""

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
        self.part, self.keyed, self.slot = None, (), self

    @property
    def predicate(self) -> str:
        """Its predicate."""
        return self._form.predicate

    @property
    def text(self) -> str:
        """All of it."""
        return self._form.text(self._piece)

    @property
    def bracketed(self) -> bool:
        """Whether its object is a blank node of its own."""
        return self._form.bracketed

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
        self._met.update(shape for shape in shapes if shape not in self._forms)
        for shape in set(shapes).intersection(self._met):
            if self._met[shape] >= ENOUGH:
                del self._met[shape]
                self._forms[shape] = ()
                if _HOLES.search(shape) and _REGULAR.fullmatch(shape) and not _RIGID.search(shape):
                    found[shape] = _marked(shape)
        return found

    def learn(self, shape: bytes, clauses: Sequence[Clause], known: Clauses) -> None:
        """Make the form of a shape from what its piece with marks says."""
        marks = [int(mark[1] or mark[2]) for clause in clauses for mark in _MARK.finditer(clause.text)]
        if sorted(marks) == list(range(len(_HOLES.findall(shape)))):
            self._forms[shape] = tuple([_form(shape, clause, known) for clause in clauses])

    def fill(self, shape: bytes, piece: bytes, known: Clauses) -> tuple[Clause, ...]:
        """The clauses that a piece says; none if its shape has no form."""
        return tuple([_filled(form, piece, known) for form in self._forms.get(shape, ())])


def _filled(form: Form, piece: bytes, known: Clauses) -> Clause:
    clause = Filled(form, piece)
    if form.links:
        known.suspects.add(clause)
    elif form.name is not None:
        name = piece.split(b'"', form.name + 1)[form.name]
        if not name or (form.rate and port_of(clause.text) is None):
            return known[clause.text]
        clause.slot = known.slot(form.predicate, name.decode())
    elif form.written:
        return known[clause.text]
    return clause


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
        tuple([int(mark[1] or mark[2]) for mark in _MARK.finditer(text)]),
        clause.bracketed,
        port is None and len(clause.links) > 0,
        name,
        port is not None and port["rate"] is not None,
        _MARK.search(clause.predicate) is not None
        or (name is None and not clause.links and (clause.slot is not clause or clause in known.suspects)),
    )


def _marked(shape: bytes) -> bytes:
    """A piece of a shape, with marks for strings and digits."""
    marks = iter(range(len(shape)))
    return _HOLES.sub(lambda at: b'"s731%04d"' % next(marks) if at[0] == b'"' else b"731%04d" % next(marks), shape)

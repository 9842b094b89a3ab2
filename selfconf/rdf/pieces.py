"""Documents as pieces of text, each of which is parsed once, however many components say it.

Recognising text that has been read before takes a hundredth of the time of reading it. So a document is cut, by one
regular expression, behind each subject and at the semicolons and full stops between its clauses; only the pieces that
are new are read, each under a subject of its own, all in one call (`selfconf.rdf.clauses.fold`).

Cutting must know which semicolons and full stops separate, so it knows strings, IRIs, comments and brackets: each
piece consists of whole tokens, with balanced brackets. Therefore the pieces, one by one, say what the document says,
and none can reach into the next; if one is no clause, then the document is no Turtle. Whatever the expression does not
follow (directives further down, escapes in names, deep brackets), and whatever turns out to be wrong, is left
to `fold`, which reads the whole document and knows the lines and columns. So is a document in which most is new.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import pyoxigraph as ox

from selfconf.errors import TurtleError
from selfconf.rdf.clauses import Clause, Clauses, fold

WINDOW = 1 << 17
"""Octets that are cut in one call: their pieces stay in the processor's cache."""
ENOUGH = 2_000
"""New pieces after which documents in which most is new are read the other way."""
DEPTH = 3
"""How deep brackets may lie in brackets."""
PIECE = "urn:selfconf:piece:"
"""What the subjects are called under which pieces are read."""
_TOKEN = (
    rb'"""[^"\\]*(?:(?:\\.|""?(?!"))[^"\\]*)*"""|"(?!"")[^"\\\n\r]*(?:\\.[^"\\\n\r]*)*"'
    rb"|'''[^'\\]*(?:(?:\\.|''?(?!'))[^'\\]*)*'''|'(?!'')[^'\\\n\r]*(?:\\.[^'\\\n\r]*)*'"
    rb'|<[^<>"{}|^`\\\s]*>|#[^\n\r]*(?=[\n\r])'
)
_INNER = rb"[^\[\]\"'#<>\\]*"
"""What means nothing in brackets, and what means nothing outside."""
_OUTER = rb"[^;.\[\]\"'#<>\\]*"


def _nested(depth: int) -> bytes:
    return _TOKEN if depth == 0 else _TOKEN + rb"|\[%b(?:(?:%b)%b)*\]" % (_INNER, _nested(depth - 1), _INNER)


_SPACE = rb"(?:\s|#[^\n\r]*[\n\r])*"
_SUBJECT = rb"\s" + _SPACE + rb"(?:[^\s#<>\"'\[\]();,\\]+|<[^<>\"{}|^`\\\s]*>)(?=\s)"
# A subject stands where a statement has just ended. The last alternative takes all that is left, so that the whole
# expression never fails: without failure there is no looking back, and time grows as the text.
_CUT = re.compile(
    rb"(?<=\.)%b|%b(?:(?:\.(?=[\w:%%-])|%b)%b)*(?:;(?:\s*;)*(?:\s*\.(?=\s))?|\.(?=\s)|[\s\S]+)"
    % (_SUBJECT, _OUTER, _nested(DEPTH), _OUTER)
)
_BEGIN = re.compile(_SPACE + rb"(?:[^\s#<>\"'\[\]();,\\]+|<[^<>\"{}|^`\\\s]*>)(?=\s)")
_NAMED = re.compile(rb"%b((?:[A-Za-z][\w-]*)?):((?:\w[\w-]*)?)" % _SPACE)
_ABSOLUTE = re.compile(rb"%b(<https?://[A-Za-z][\w-]*(?:\.[A-Za-z][\w-]*)*(?:/(?:\w[\w.-]*)?)*(?:#[\w.-]*)?>)" % _SPACE)
_DIRECTIVE = rb"@(?:prefix\s+[^\s:<>#]*:|base)\s*<[^<>\s\\]*>\s*\.|(?i:prefix\s+[^\s:<>#]*:|base)\s*<[^<>\s\\]*>"
_HEAD = re.compile(rb"(?:%b(?:%b))*" % (_SPACE, _DIRECTIVE))
_HEAD_PARTS = re.compile(rb"#[^\n\r]*|(%b)" % _DIRECTIVE)
_RELATIVE = re.compile(rb"<(?![A-Za-z][A-Za-z0-9+.-]*:)")
_BLANK = re.compile(rb"(?:\s+|#[^\n\r]*[\n\r])*")
_END, _SEMICOLON = b".;"


@dataclass(slots=True)
class Context:
    """What goes before the statements of a document, and what pieces mean after it."""

    head: bytes
    prefixes: dict[bytes, str]
    known: dict[bytes, tuple[Clause, ...]] = field(default_factory=dict)
    """Of each piece that has been read, what it says."""


class Pieces(Clauses):
    """Every clause of one or more documents, and the pieces of text that have been found to say them."""

    def __init__(self) -> None:
        super().__init__()
        self._contexts: dict[tuple[bytes, ...], Context] = {}
        self.seen = self.new = 0
        """How many pieces have been met, and how many for the first time."""

    @property
    def pays(self) -> bool:
        """Whether enough of what has been met had been met before."""
        return self.new < ENOUGH or 2 * self.new < self.seen

    def context(self, head: bytes, base: str | None) -> Context:
        """What pieces mean after some directives; `base` matters where IRIs are relative. Raises SyntaxError."""
        directives = tuple(filter(None, _HEAD_PARTS.findall(head)))
        key = (*directives, b"" if base is None else base.encode())
        if key not in self._contexts:
            text = b"\n".join((*directives, b""))
            reader = ox.parse(text, format=ox.RdfFormat.TURTLE, base_iri=base)
            list(reader)
            self._contexts[key] = Context(text, {name.encode(): iri for name, iri in reader.prefixes.items()})
        return self._contexts[key]

    def learn(self, cut: Sequence[bytes], context: Context, source: str, base: str | None) -> bool:
        """Read the pieces that are new. False if there is one that cannot be read by itself."""
        unknown = set(cut).difference(context.known)
        new = [piece for piece in unknown if piece[-1] in (_END, _SEMICOLON)]
        self.seen += len(cut) - len(unknown) + len(new)  # the others are subjects
        self.new += len(new)
        if not new or not self.pays:
            return self.pays
        lines = [b"<%b%d>%b%b" % (PIECE.encode(), k, p, b"\n" if p[-1] == _END else b".\n") for k, p in enumerate(new)]
        try:
            said = fold(context.head + b"".join(lines), source, base, self)
        except TurtleError:
            return False
        if said is None or len(said) != len(new):
            return False
        for number, piece in enumerate(new):
            found = said.get(f"<{PIECE}{number}>")
            if found is None:
                return False
            self.typed(found)
            context.known[piece] = tuple(found)
        return True


def folded(text: bytes, source: str, base: str | None, pieces: Pieces) -> dict[str, list[Clause]] | None:
    """What `fold` makes of a document, sooner where much of it is known. Raises TurtleError."""
    if b"_:" in text:
        return None
    found = _assembled(text, source, base, pieces) if pieces.pays and PIECE.encode() not in text else None
    return fold(text, source, base, pieces) if found is None else found


def _assembled(text: bytes, source: str, base: str | None, pieces: Pieces) -> dict[str, list[Clause]] | None:
    """The same from its pieces; None where that cannot be done."""
    text = text if text.endswith(b"\n") else text + b"\n"
    head = _HEAD.match(text)
    assert head is not None
    if _RELATIVE.search(text) is None:
        base = None
    try:
        context = pieces.context(head.group(), base)
    except SyntaxError:
        return None
    subjects: dict[str, list[Clause]] = {}
    said: list[Clause] = []
    known, ended = context.known.get, True
    for cut in _windows(text, head.end()):
        if cut is None or not pieces.learn(cut, context, source, base):
            return None
        for piece in cut:
            clauses = known(piece)
            if clauses is None:
                subject = _subject(piece, context, base)
                if subject is None:
                    return None
                said = subjects[subject] if subject in subjects else subjects.setdefault(subject, [])
                ended = False
            elif ended:  # a clause where a subject has to stand
                return None
            else:
                said += clauses
                ended = piece[-1] == _END
    return subjects


def _windows(text: bytes, position: int) -> Iterator[list[bytes] | None]:
    """The pieces of whole statements, some thousands at a time; None where the document cannot be cut."""
    size = WINDOW
    while True:
        begin = _BEGIN.match(text, position)
        if begin is None:
            break
        end = min(position + size, len(text))
        cut = _CUT.findall(text, begin.end(), end)
        if cut:
            cut.pop()  # it reached the end, and would go on beyond it
        while cut and cut[-1][-1] != _END:
            cut.pop()
        if not cut:
            if end == len(text):
                break
            size *= 2
            continue
        cut.insert(0, begin.group())
        position += sum(map(len, cut))
        yield cut
    if _BLANK.fullmatch(text, position) is None:
        yield None


def _subject(piece: bytes, context: Context, base: str | None) -> str | None:
    """The subject that a piece names, as Oxigraph writes it."""
    found = _NAMED.fullmatch(piece)
    if found is not None:
        namespace = context.prefixes.get(found[1])
        return None if namespace is None else f"<{namespace}{found[2].decode()}>"
    found = _ABSOLUTE.fullmatch(piece)
    if found is not None:
        return found[1].decode()
    text = b"%b%b a %b." % (context.head, piece, b"<urn:a>")
    try:
        (triple,) = ox.parse(text, format=ox.RdfFormat.TURTLE, base_iri=base)
    except (SyntaxError, ValueError):
        return None
    return str(triple.subject) if isinstance(triple.subject, ox.NamedNode) else None

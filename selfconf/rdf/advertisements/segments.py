"""Documents as segments of text, each of which is parsed once, however many components say the same.

Recognising text that has been read before takes a hundredth of the time of reading it. So a document is cut, by one
regular expression, behind each subject and at the semicolons and full stops between its statements; only the segments
that are new are read, each under a subject of its own, all in one call (`inlining`). Of these, many differ from others
in nothing but strings and digits: labels, serial numbers, coordinates, names of ports. What they have in common is read
once, and filled in for each (`token_templates`).

Cutting must know which semicolons and full stops separate, so it knows strings, IRIs, comments and brackets: each
segment consists of whole tokens, with balanced brackets. Therefore the segments, one by one, say what the document
says, and none can reach into the next; if one is no statement, then the document is no Turtle. Labels of blank nodes
hold in the whole document: they become names that no other document has (RDF 1.1 Concepts, section 3.5). Whatever the
expression does not follow (directives further down, escapes in names, deep brackets), and whatever turns out to be
wrong, is left to `inlined`, which reads the whole document and knows the lines and columns. So is a document in which
most is new.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import pyoxigraph as ox

from selfconf.errors import TurtleError
from selfconf.rdf.advertisements.inlining import inlined, labelled
from selfconf.rdf.advertisements.statement_table import NotInlinableError, Statement, StatementTable
from selfconf.rdf.advertisements.token_templates import TokenTemplates, patterns_of
from selfconf.rdf.turtle import SKOLEM

WINDOW = 1 << 17
"""Octets that are cut in one call: their segments stay in the processor's cache."""
LONGEST = 1 << 20
"""Octets of a sentence in which an end is looked for: a document with a longer one is not cut."""
NEW_SEGMENTS = 2_000
"""New segments after which documents in which most is new are read as a whole."""
BRACKET_DEPTH = 3
"""How deep brackets may lie in brackets."""
SEGMENT = "urn:selfconf:segment:"
"""What the subjects are called under which segments are read."""
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


# One character at a time: of `\s+` a run could be taken in 2**n ways, all of which are tried where something follows.
_SPACE = rb"(?:\s|#[^\n\r]*[\n\r])*"
_SUBJECT = rb"\s" + _SPACE + rb"(?:[^\s#<>\"'\[\]();,\\]+|<[^<>\"{}|^`\\\s]*>)(?=\s)"
# A subject stands where a statement has just ended. The last alternative takes all that is left, so that the whole
# expression never fails: without failure there is no looking back, and time grows as the text.
_CUT = re.compile(
    rb"(?<=\.)%b|%b(?:(?:\.(?=[\w:%%-])|%b)%b)*(?:;(?:\s*;)*(?:\s*\.(?=\s))?|\.(?=\s)|[\s\S]+)"
    % (_SUBJECT, _OUTER, _nested(BRACKET_DEPTH), _OUTER)
)
_BEGIN = re.compile(_SPACE + rb"(?:[^\s#<>\"'\[\]();,\\]+|<[^<>\"{}|^`\\\s]*>)(?=\s)")
_NAMED = re.compile(rb"%b((?:[A-Za-z][\w-]*)?):((?:\w[\w-]*)?)" % _SPACE)
_ABSOLUTE = re.compile(
    rb"%b(<(?:https?://[A-Za-z][\w-]*(?:\.[A-Za-z][\w-]*)*(?:/(?:\w[\w.-]*)?)*(?:#[\w.-]*)?|%b[\w.-]*)>)"
    % (_SPACE, SKOLEM.encode())
)
_NEAR = re.compile(rb"%b<(#?)(\w[\w-]*)>" % _SPACE)
"""A name in the same folder, or in the same document."""
_DIRECTIVE = rb"@(?:prefix\s+[^\s:<>#]*:|base)\s*<[^<>\s\\]*>\s*\.|(?i:prefix\s+[^\s:<>#]*:|base)\s*<[^<>\s\\]*>"
_HEAD = re.compile(rb"(?:%b(?:%b))*" % (_SPACE, _DIRECTIVE))
_HEAD_PARTS = re.compile(rb"#[^\n\r]*|(%b)" % _DIRECTIVE)
_RELATIVE = re.compile(rb"<(?![A-Za-z][A-Za-z0-9+.-]*:)")
_BLANK = re.compile(_SPACE)
_LABEL = re.compile(
    rb"%b|(?<![^\s,(\0])_:(?P<label>\w(?:[\w.-]*[\w-])?)(?=[\s;,.)\]\0]|\Z)|_(?P<other>:)" % _TOKEN, re.ASCII
)
"""A label where an object or a subject may stand; or the sign of one, elsewhere."""
_MISPLACED = re.compile(rb"(?:[;\[\0]|\^\^)\s*<%b[^>]*>(?!\Z|\0)" % SKOLEM.encode())
"""A blank node as a predicate or a datatype."""
_LETTERS = str.maketrans("0123456789", "ghijklmnop")
"""Letters for digits, which would all become holes of templates."""
_END, _SEMICOLON = b".;"


@dataclass(slots=True)
class Context:
    """What goes before the statements of a document, and what segments mean after it."""

    head: bytes
    prefixes: dict[bytes, str]
    known: dict[bytes, tuple[Statement, ...]] = field(default_factory=dict)
    """Of each segment that has been read, what it says."""
    near: dict[bytes, str] = field(default_factory=dict)
    """What goes before names in the same folder, and behind `#` in the same document."""
    templates: TokenTemplates = field(default_factory=TokenTemplates)
    """What segments have in common that differ in strings and digits."""


class SegmentCache(StatementTable):
    """Every statement of one or more documents, and the segments of text that have been found to make them."""

    def __init__(self) -> None:
        super().__init__()
        self._contexts: dict[tuple[bytes, ...], Context] = {}
        self.seen = self.new = 0
        """How many segments have been met, and how many for the first time."""

    @property
    def pays(self) -> bool:
        """Whether enough of what has been met had been met before."""
        return self.new < NEW_SEGMENTS or 2 * self.new < self.seen

    def context(self, head: bytes, base: str | None) -> Context:
        """What segments mean after some directives; `base` matters where IRIs are relative. Raises SyntaxError."""
        directives = tuple(filter(None, _HEAD_PARTS.findall(head)))
        key = (*directives, b"" if base is None else base.encode())
        if key not in self._contexts:
            text = b"\n".join((*directives, b""))
            reader = ox.parse(text, format=ox.RdfFormat.TURTLE, base_iri=base)
            list(reader)
            self._contexts[key] = Context(text, {name.encode(): iri for name, iri in reader.prefixes.items()})
        return self._contexts[key]

    def learn(self, cut: Sequence[bytes], context: Context, source: str, base: str | None) -> bool:
        """Read the segments that are new. False if there is one that cannot be read by itself."""
        unknown = set(cut).difference(context.known)
        new = [segment for segment in unknown if segment[-1] in (_END, _SEMICOLON)]
        self.seen += len(cut) - len(unknown) + len(new)  # the others are subjects
        if not new:
            return self.pays
        try:
            patterns = patterns_of(new)
            samples = context.templates.wanted(patterns)
            said = self._read(list(samples.values()), context, source, base)
            for pattern, sample in samples.items():
                context.templates.learn(pattern, said[sample], self)
            odd = context.templates.fill(new, patterns, context.known, self)
            self.new += len(odd)
            if self.pays:
                for segment, found in self._read(odd, context, source, base).items():
                    context.known[segment] = tuple(found)
        except (TurtleError, UnicodeDecodeError, NotInlinableError):
            return False
        return self.pays

    def _read(
        self, segments: Sequence[bytes], context: Context, source: str, base: str | None
    ) -> Mapping[bytes, list[Statement]]:
        """What segments say, each read by itself. Raises TurtleError or NotInlinableError."""
        if not segments:
            return {}
        text = [
            b"<%b%d>%b%b" % (SEGMENT.encode(), k, p, b"\n" if p[-1] == _END else b".\n") for k, p in enumerate(segments)
        ]
        said = inlined(context.head + b"".join(text), source, base, self)
        if said is None or len(said) != len(segments):
            raise NotInlinableError
        found = {}
        for number, segment in enumerate(segments):
            found[segment] = said.get(f"<{SEGMENT}{number}>") or []
            if not found[segment]:
                raise NotInlinableError
            self.typed(found[segment])
        return found


def inlined_document(
    text: bytes, source: str, base: str | None, segments: SegmentCache
) -> dict[str, list[Statement]] | None:
    """What a document says of each named subject, from its segments where much is known.

    None where that cannot be found without the careful reader.

    Blank nodes with labels have the names of `selfconf.rdf.turtle.SKOLEM`. Raises TurtleError.
    """
    found = labelled(text, base, segments) if b"_:" in text else None
    if found is not None:
        return found
    cuttable = SEGMENT.encode() not in text and SKOLEM.encode() not in text
    found = _assembled(text, source, base, segments) if segments.pays and cuttable else None
    if found is None and b"_:" not in text:
        found = inlined(text, source, base, segments)
    return found


def _unlabelled(cut: list[bytes], name: bytes) -> list[bytes] | None:
    """Segments with names for the labels of blank nodes; None if one has a label where none may stand."""
    labelled = [number for number, segment in enumerate(cut) if b"_:" in segment]
    elsewhere: list[bytes] = []

    def named(at: re.Match[bytes]) -> bytes:
        if at["label"] is not None:
            return b"<%b%b>" % (name, at["label"])
        if at["other"] is not None:
            elsewhere.append(at[0])
        return b" " if at[0].startswith(b"#") else at[0]

    text = b"\0".join([b"", *[cut[number] for number in labelled]])
    text = _LABEL.sub(named, text)
    segments = text.split(b"\0")[1:]
    if elsewhere or _MISPLACED.search(text) or len(segments) != len(labelled):
        return None
    for number, segment in zip(labelled, segments, strict=True):
        cut[number] = segment
    return cut


# complexity: the loop over all segments; calls in it would double what it costs
def _assembled(text: bytes, source: str, base: str | None, segments: SegmentCache) -> dict[str, list[Statement]] | None:
    """What a document says of each named subject, from its segments; None where that cannot be done."""
    text = text if text.endswith(b"\n") else text + b"\n"
    head = _HEAD.match(text)
    assert head is not None
    if _RELATIVE.search(text) is None:
        base = None
    try:
        context = segments.context(head.group(), base)
    except SyntaxError:
        return None
    subjects: dict[str, list[Statement]] = {}
    said: list[Statement] = []
    last = b""
    known, ended = context.known.get, True
    name = f"{SKOLEM}{ox.BlankNode().value.translate(_LETTERS)}.".encode() if b"_:" in text else b""
    for cut in _windows(text, head.end()):
        if cut is not None and name:
            cut = _unlabelled(cut, name)
        if cut is None or not segments.learn(cut, context, source, base):
            return None
        for segment in cut:
            statements = known(segment)
            if statements is None:
                if segment != last:  # many a document says one thing after the other of the same subject
                    subject = _subject(segment, context, base)
                    if subject is None:
                        return None
                    said, last = subjects[subject] if subject in subjects else subjects.setdefault(subject, []), segment
                ended = False
            elif ended:  # a statement where a subject has to stand
                return None
            else:
                said += statements
                ended = segment[-1] == _END
    return subjects


def _windows(text: bytes, position: int) -> Iterator[list[bytes] | None]:
    """The segments of whole sentences of Turtle, some thousands at a time; None where the document cannot be cut."""
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
            if size > LONGEST:  # what has no end would be looked at again and again
                yield None
                return
            size *= 2
            continue
        cut.insert(0, begin.group())
        position += sum(map(len, cut))
        yield cut
    if _BLANK.fullmatch(text, position) is None:
        yield None


def _subject(segment: bytes, context: Context, base: str | None) -> str | None:
    """The subject that a segment names, as Oxigraph writes it."""
    found = _NAMED.fullmatch(segment)
    if found is not None:
        namespace = context.prefixes.get(found[1])
        return None if namespace is None else f"<{namespace}{found[2].decode()}>"
    found = _ABSOLUTE.fullmatch(segment)
    if found is not None:
        return found[1].decode()
    found = _NEAR.fullmatch(segment)
    if found is None:
        return _resolved(segment, context, base)
    kind = found[1]
    if kind not in context.near:
        context.near[kind] = (_resolved(b"<%bx>" % kind, context, base) or "")[: -len("x>")]
    return f"{context.near[kind]}{found[2].decode()}>" if context.near[kind] else None


def _resolved(segment: bytes, context: Context, base: str | None) -> str | None:
    """The subject that a segment names, as Oxigraph reads it."""
    text = b"%b%b a %b." % (context.head, segment, b"<urn:a>")
    try:
        (triple,) = ox.parse(text, format=ox.RdfFormat.TURTLE, base_iri=base)
    except (SyntaxError, ValueError):
        return None
    return str(triple.subject) if isinstance(triple.subject, ox.NamedNode) else None

"""Formats of RDF other than Turtle: telling which one a file is in, and what to do with it.

Ontologies come in any of them, so `read_ontology` reads all that Oxigraph's parsers do. Advertisements, templates and
tasks are Turtle: their lines are shown to their authors, and their text is what the fast loader works on. So a file of
these in another format is refused, with the command that converts it.

Nothing is fetched: the parser of JSON-LD has no loader for remote contexts, and that of RDF/XML takes no external
entities. Entities of XML within entities, and such as stand for much text in many places, are refused: what they stand
for may grow beyond all memory.
"""

from __future__ import annotations

import re
import shlex
from codecs import BOM_UTF8
from collections.abc import Iterable

import pyoxigraph as ox

from selfconf.errors import TurtleError
from selfconf.model.immutable import immutable
from selfconf.model.term import IRI
from selfconf.rdf.turtle.advice import with_advice
from selfconf.rdf.turtle.document import Document, document_of
from selfconf.rdf.turtle.refused_text import check_turtle_1_1, check_utf_8
from selfconf.rdf.turtle.serialization import to_turtle

_HEAD = 1 << 16
"""Bytes at the head of a file by which its format is recognised, where the ending of its name does not say it."""


@immutable
class RdfFormat:
    """A format of RDF: its name, Oxigraph's parser, the endings of file names, and what rdfpipe calls it."""

    name: str
    parser: ox.RdfFormat
    endings: tuple[str, ...]
    rdfpipe: str


_TURTLE = RdfFormat("Turtle", ox.RdfFormat.TURTLE, ("ttl", "turtle"), "turtle")
N_TRIPLES = RdfFormat("N-Triples", ox.RdfFormat.N_TRIPLES, ("nt",), "nt")
RDF_XML = RdfFormat("RDF/XML", ox.RdfFormat.RDF_XML, ("rdf", "xml"), "xml")
JSON_LD = RdfFormat("JSON-LD", ox.RdfFormat.JSON_LD, ("jsonld", "json"), "json-ld")
TRIG = RdfFormat("TriG", ox.RdfFormat.TRIG, ("trig",), "trig")
N_QUADS = RdfFormat("N-Quads", ox.RdfFormat.N_QUADS, ("nq",), "nquads")
FORMATS = (_TURTLE, N_TRIPLES, RDF_XML, JSON_LD, TRIG, N_QUADS)
_BY_ENDING = {ending: each for each in FORMATS for ending in each.endings}
_NODE = rb"(?:<[^<>\s]*>|_:\S+)"
_COMMENTS = rb"(?:#[^\n]*\n\s*)*"
_LOOKS = (
    (re.compile(rb"<(?:\?xml|!DOCTYPE|!--|(?:[A-Za-z_][\w.-]*:)?RDF[\s>])"), RDF_XML),
    (re.compile(rb'\{\s*["}]|\[\s*\{'), JSON_LD),
    (
        re.compile(_COMMENTS + rb'%b\s+<[^<>\s]*>\s+(?:%b|"(?:[^"\\\n]|\\.)*"\S*)\s+%b\s*\.' % (_NODE, _NODE, _NODE)),
        N_QUADS,
    ),
    (re.compile(rb"(?:.*\n)*?[^\S\n]*(?:(?i:GRAPH\s+)?(?:<[^<>\s]*>|[\w-]*:[\w-]*)\s*)?\{"), TRIG),
)
"""How files in other formats than Turtle begin; TriG shows where its first graph begins.

No white space stands where two parts of a pattern could take it: a stranger's text of blank lines, or of a comment of
many `#`, would be tried in all ways.
"""
_BEGINS_TURTLE = re.compile(_COMMENTS + rb"(?i:@?prefix|@?base)\s")
"""How Turtle begins, for certain: anything that looks like no other format may be Turtle."""
_ENTITY = re.compile(rb"""<!ENTITY\s+(?:%\s+)?([^\s"'<>]+)\s+(?:"([^"]*)"?|'([^']*)'?)""")
"""An entity of XML: its name, and its text up to the quote that it begins with."""
_REFERENCE = re.compile(rb"&(?!#|(?:amp|lt|gt|quot|apos);)([^\s;&<]*)")
LARGEST_GROWTH = 1 << 26
"""Octets that all references to entities in a text may stand for."""


def format_of(name: str, octets: bytes) -> RdfFormat:
    """The format of a file, by the ending of its name, or else by its content."""
    return _BY_ENDING.get(_ending(name)) or _by_content(octets)


def other_format(name: str, octets: bytes) -> RdfFormat | None:
    """Which format a text is probably in that is not Turtle; its content counts for more than its name."""
    found = _by_content(octets)
    found = _BY_ENDING.get(_ending(name), _TURTLE) if found is _TURTLE else found
    return None if found in (_TURTLE, N_TRIPLES) else found  # N-Triples is Turtle too


def conversion(name: str, found: RdfFormat) -> str:
    """The command that makes Turtle of a file; rdfpipe comes with rdflib, which selfconf needs."""
    if name.startswith("<"):  # the text came by a pipe: it is in no file
        return f"rdfpipe -i {found.rdfpipe} -o turtle -"
    stem = _stem(name)
    # A shell empties the file that it writes to before the command reads it.
    target = f"{stem}-turtle.ttl" if f"{stem}.ttl" == name else f"{stem}.ttl"
    return f"rdfpipe -i {found.rdfpipe} -o turtle {shlex.quote(name)} > {shlex.quote(target)}"


def read_ontology(
    octets: bytes, source: str, base: str | None = None, predicates: Iterable[IRI] | None = None
) -> Document:
    """Read an ontology in any of the formats, or of it the triples with some predicates; of all named graphs alike.

    Raises TurtleError with the line, and the column where it is known, for what is not in the format that it seems,
    and without for what is called after one format and written in another.
    """
    octets = octets.removeprefix(BOM_UTF8)
    check_utf_8(octets, source)
    found = format_of(source, octets)
    if found is RDF_XML:
        _check_entities(octets, source)
    if found not in (RDF_XML, JSON_LD):
        check_turtle_1_1(octets, source, found.parser)
    lines = _Lines(octets)
    reader = ox.parse(
        lines if found is RDF_XML else octets,  # type: ignore[arg-type]  # of a file it calls `read` alone
        format=found.parser,
        base_iri=base,
        rename_blank_nodes=True,
    )
    try:
        return document_of(reader, source, base, predicates)
    except SyntaxError as error:
        raise _misnamed(octets, source, found) or _refused(error, source, found, lines) from None
    except MemoryError:
        raise TurtleError("a literal in it is larger than can be read", file=source) from None


def _check_entities(octets: bytes, source: str) -> None:
    """Raises TurtleError for entities of XML that refer to entities, or stand for more text than fits into memory."""
    lengths: dict[bytes, int] = {}
    for entity in _ENTITY.finditer(octets):
        name, text = entity[1], entity[2] or entity[3] or b""
        if _REFERENCE.search(text):
            raise TurtleError("an entity within an entity is not expanded; write it out", file=source)
        lengths[name] = max(len(text), lengths.get(name, 0))
    if lengths and sum(lengths.get(one[1], 0) for one in _REFERENCE.finditer(octets)) > LARGEST_GROWTH:
        raise TurtleError(
            f"its entities stand for over {LARGEST_GROWTH >> 20} MiB of text, which is more than can be read",
            file=source,
        )


def _misnamed(octets: bytes, source: str, named: RdfFormat) -> TurtleError | None:
    """What is wrong with a text in another format than its name says; None where that is not the mistake."""
    written = _by_content(octets)
    if written is named or (written is _TURTLE and (named is TRIG or not _BEGINS_TURTLE.match(_head(octets)))):
        return None  # Turtle is TriG too
    message = f"this is {written.name}, and its name ends as that of {named.name}"
    return TurtleError(f"{message}; rename it, as to {_stem(source)}.{written.endings[0]}", file=source)


def _refused(error: SyntaxError, source: str, found: RdfFormat, lines: _Lines) -> TurtleError:
    """Oxigraph's complaint about a text of a format as selfconf's; of RDF/XML it names no line."""
    head, colon, tail = str(error.msg).partition(": ")
    message = tail if colon and head.startswith("Parser error") else str(error.msg)
    if "LoadDocumentCallback" in message:
        message = "its @context is on the web, and is not fetched; write it into the file"
    line = error.lineno or (lines.number if found is RDF_XML else None)
    message = " ".join(message.split())  # it may quote some lines of the file
    message = with_advice(message) if found is _TURTLE else message
    return TurtleError(f"not {found.name}: {message}", file=source, line=line, column=error.offset)


def in_turtle(octets: bytes, source: str, base: str | None = None) -> str:
    """An ontology as Turtle that says the same under any name and in any place. Raises TurtleError as its reader does.

    What is Turtle already is not read.
    """
    if format_of(source, octets) is not _TURTLE:
        return to_turtle(read_ontology(octets, source, base).triples())
    text = octets.removeprefix(BOM_UTF8).decode()
    return text if base is None else f"@base <{base}> . {text}"


class _Lines:
    """A text that is handed out line by line, so that where reading stops is known: errors in RDF/XML have no line."""

    def __init__(self, octets: bytes) -> None:
        self._lines = iter(octets.splitlines(keepends=True))
        self._rest = b""
        self.number = 0

    def read(self, size: int = -1) -> bytes:
        if not self._rest:
            self._rest = next(self._lines, b"")
            self.number += bool(self._rest)
        size = len(self._rest) if size < 0 else size
        found, self._rest = self._rest[:size], self._rest[size:]
        return found


def _ending(name: str) -> str:
    _, dot, ending = name.replace("\\", "/").rpartition("/")[2].rpartition(".")
    return ending.lower() if dot else ""


def _stem(name: str) -> str:
    """The name of a file without its ending."""
    return name[: -len(_ending(name)) - 1] if _ending(name) else name


def _head(octets: bytes) -> bytes:
    return octets[:_HEAD].removeprefix(BOM_UTF8).lstrip()


def _by_content(octets: bytes) -> RdfFormat:
    head = _head(octets)
    found = next((found for pattern, found in _LOOKS if pattern.match(head)), _TURTLE)
    return _TURTLE if found is TRIG and not _is_trig(octets) else found


def _is_trig(octets: bytes) -> bool:
    """Whether a text is TriG; one that looks like it may be Turtle with a brace for a bracket."""
    try:
        for _ in ox.parse(octets, format=ox.RdfFormat.TRIG, base_iri="urn:selfconf:base"):
            pass
    except (SyntaxError, MemoryError):
        return False
    return True

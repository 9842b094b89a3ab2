"""What documents are made of: the text of a file, of standard input or of an argument, or that of an rdflib graph."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple, Protocol, TypeGuard, runtime_checkable

from selfconf import files
from selfconf.api.arguments import checked_path
from selfconf.errors import AuthorError, ProgrammerError, TurtleError

NO_FILE, PIPED, GRAPH = "<text>", "<stdin>", "<graph>"
"""The names of documents that are no files."""
KEPT_TEXTS = (NO_FILE, PIPED)
"""The names of documents whose lines can be looked up later only if the text is kept."""


class DocumentText(NamedTuple):
    """The octets of a document, its name, and the IRI against which its relative IRIs are resolved."""

    octets: bytes
    name: str
    base: str | None

    @property
    def in_no_file(self) -> tuple[str, ...]:
        """The text, if it is in no file that could be read again; else none."""
        return (self.octets.decode(),) if self.name in KEPT_TEXTS else ()


@runtime_checkable
class _Graph(Protocol):
    """An rdflib graph, as far as it matters here."""

    def serialize(self, *, format: str) -> str: ...

    def namespaces(self) -> Iterable[tuple[str, str]]: ...


@runtime_checkable
class _Dataset(Protocol):
    """An rdflib dataset, as far as it matters here."""

    def graphs(self) -> Iterable[_Graph]: ...


_BEGINS_TURTLE = re.compile(r"\s*(@prefix\b|@base\b|prefix\s|base\s*<|<|\[)", re.IGNORECASE)


def is_turtle(source: object) -> bool:
    """Whether a string is Turtle text and not a path."""
    return isinstance(source, str) and ("\n" in source or _BEGINS_TURTLE.match(source) is not None)


def texts_of(sources: Iterable[object]) -> Iterator[DocumentText]:
    """Yield the documents that are no files as they come, then those of all files and folders, sorted."""
    paths: list[Path] = []
    for source in sources:
        if _is_path(source):
            paths.append(_path(source))
        else:
            yield text_of(source)
    yield from map(file_text, files.listed_files(paths))


def text_of(source: object) -> DocumentText:
    """One document: a file, Turtle text, or an rdflib graph. Raises AuthorError, and ProgrammerError for all else."""
    if _is_path(source):
        return file_text(_path(source))
    if isinstance(source, str):
        return DocumentText(_encoded(source), NO_FILE, None)
    if not is_graph(source):
        raise ProgrammerError(f"a source is a path, Turtle text, an rdflib graph or an endpoint, not {source!r}")
    return DocumentText(_serialized(source).encode(), GRAPH, None)


def _encoded(text: str) -> bytes:
    """A text in UTF-8. Raises TurtleError where it has half of a character, as of bytes in another encoding."""
    try:
        return text.encode()
    except UnicodeEncodeError as error:
        before = text[: error.start]
        line, column = before.count("\n") + 1, error.start - before.rfind("\n")
        wrong = f"not Turtle: {text[error.start]!r} is no character; in which encoding was it read?"
        raise TurtleError(wrong, file=NO_FILE, line=line, column=column) from None


def _serialized(graph: _Graph) -> str:
    """Turtle with the prefixes of a graph, by which its terms can be named; of a dataset all of its graphs."""
    prefixes = (f"@prefix {prefix}: <{base}> ." for prefix, base in graph.namespaces())
    parts = graph.graphs() if isinstance(graph, _Dataset) else [graph]
    return "\n".join([*prefixes, *(part.serialize(format="nt") for part in parts)])


def is_graph(source: object) -> TypeGuard[_Graph]:
    """Whether a source is an rdflib graph, told without loading rdflib."""
    return isinstance(source, _Graph)


def _is_path(source: object) -> TypeGuard[str | Path]:
    return isinstance(source, Path) or (isinstance(source, str) and not is_turtle(source))


def _path(source: str | Path) -> Path:
    if not str(source):
        raise AuthorError("an empty text is no path and no Turtle; the current folder is '.'")
    return checked_path(source)


def file_text(path: Path) -> DocumentText:
    """What is in a file, or in standard input. Raises AuthorError."""
    octets = files.standard_input() if path == files.STDIN else files.octets(path)
    return DocumentText(files.text(octets, _file_name(path)), _file_name(path), files.base(path))


def _file_name(path: Path) -> str:
    """How a file is spoken of."""
    return PIPED if path == files.STDIN else str(path)


def source_name(source: object) -> str:
    """How a source is spoken of, which may be a folder."""
    return str(source) if _is_path(source) else NO_FILE if isinstance(source, str) else GRAPH

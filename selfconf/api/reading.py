"""`read`: an ecology from files, folders, Turtle text, rdflib graphs or a SPARQL endpoint."""

from __future__ import annotations

import re
import time
from collections.abc import Iterable, Iterator, Mapping
from io import IOBase
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, TypeAlias, TypeGuard, runtime_checkable

from selfconf import files
from selfconf.api.arguments import checked_path
from selfconf.api.collector import collector_at_rest
from selfconf.api.ecology import Ecology, EndpointEcology, LoadedEcology
from selfconf.errors import AuthorError, ProgrammerError
from selfconf.model.left_out import LeftOut
from selfconf.model.profile import Place
from selfconf.model.term import IRI
from selfconf.rdf import turtle
from selfconf.rdf.advertisements import Advertisement, SegmentCache, read_advertisements
from selfconf.rdf.eligibility import AdvertisementIndex
from selfconf.rdf.turtle import Document

if TYPE_CHECKING:
    import rdflib


@runtime_checkable
class _Graph(Protocol):
    """An rdflib graph, as far as it matters here."""

    def serialize(self, *, format: str) -> str: ...

    def namespaces(self) -> Iterable[tuple[str, str]]: ...


@runtime_checkable
class _Dataset(Protocol):
    """An rdflib dataset, as far as it matters here."""

    def graphs(self) -> Iterable[_Graph]: ...


Source: TypeAlias = "str | Path | rdflib.Graph"


def read(*sources: Source | Iterable[Source]) -> Ecology:
    """The ecology that files, folders, Turtle text, rdflib graphs, or one SPARQL endpoint describe, or lists of them.

    A string that is the URL of an endpoint is asked when a task needs its advertisements; a string with a line break,
    or that begins as only Turtle does (`@prefix`, `<`, `[`), is Turtle; any other string is a path. A folder stands for
    all *.ttl below it, but for hidden folders. `left_out` of the ecology names the advertisements that do not count.

    Raises AuthorError for what is not there, cannot be read or is not Turtle; ProgrammerError for what is no source.

    >>> home = read("examples/clock")
    >>> len(home.components)
    2
    """
    given = [one for source in sources for one in (source if _are_several(source) else [source])]
    endpoints = [str(source) for source in given if is_endpoint(source)]
    if endpoints:
        if len(given) > 1:
            raise AuthorError("a SPARQL endpoint is an ecology by itself; read the other sources by themselves")
        return EndpointEcology(endpoints[0])
    began = time.perf_counter()
    kept: list[str] = []
    index, left_out = gathered(_keeping(kept, _texts(given)))
    return LoadedEcology(index, left_out, tuple(map(_name, given)), time.perf_counter() - began, tuple(kept))


def _are_several(source: Source | Iterable[Source]) -> TypeGuard[Iterable[Source]]:
    """Whether there are several sources; text, an open file and a graph, of letters, lines and triples, are one."""
    return isinstance(source, Iterable) and not isinstance(source, str | bytes | Mapping | IOBase | _Graph)


def is_endpoint(source: object) -> bool:
    """Whether a source is the URL of a SPARQL endpoint."""
    return isinstance(source, str) and source.startswith(("http://", "https://")) and len(source.split()) == 1


_BEGINS_TURTLE = re.compile(r"\s*(@prefix\b|@base\b|prefix\s|base\s*<|<|\[)", re.IGNORECASE)


def is_turtle(source: object) -> bool:
    """Whether a string is Turtle text and not a path."""
    return isinstance(source, str) and ("\n" in source or _BEGINS_TURTLE.match(source) is not None)


Text = tuple[bytes, str, "str | None"]
"""The octets of a document, its name, and the IRI against which its relative IRIs are resolved."""


NO_FILE, PIPED, GRAPH = "<text>", "<stdin>", "<graph>"
"""The names of documents that are no files."""
KEPT_TEXTS = (NO_FILE, PIPED)
"""Those of them whose lines can be looked up later only if the text is kept."""


def kept_text(document: Text) -> str | None:
    """The text of a document, where it is in no file that could be read again."""
    octets, name, _ = document
    return octets.decode() if name in KEPT_TEXTS else None


def _keeping(kept: list[str], documents: Iterable[Text]) -> Iterator[Text]:
    """Yield documents, and keep the texts of those that are in no file."""
    for document in documents:
        text = kept_text(document)
        if text is not None:
            kept.append(text)
        yield document


def _texts(sources: Iterable[object]) -> Iterator[Text]:
    paths: list[Path] = []
    for source in sources:
        if _is_path(source):
            paths.append(_path(source))
        else:
            yield text_of(source)
    yield from map(file_text, files.listed_files(paths))


def text_of(source: object) -> Text:
    """One document: a file, Turtle text, or an rdflib graph. Raises AuthorError, and ProgrammerError for all else."""
    if _is_path(source):
        return file_text(_path(source))
    if isinstance(source, str):
        return source.encode(), NO_FILE, None
    if not isinstance(source, _Graph):
        raise ProgrammerError(f"a source is a path, Turtle text, an rdflib graph or an endpoint, not {source!r}")
    return _serialized(source).encode(), GRAPH, None


def _serialized(graph: _Graph) -> str:
    """Turtle with the prefixes of a graph, by which its terms can be named; of a dataset all of its graphs."""
    prefixes = (f"@prefix {prefix}: <{base}> ." for prefix, base in graph.namespaces())
    parts = graph.graphs() if isinstance(graph, _Dataset) else [graph]
    return "\n".join([*prefixes, *(part.serialize(format="nt") for part in parts)])


def _is_path(source: object) -> TypeGuard[str | Path]:
    return isinstance(source, Path) or (isinstance(source, str) and not is_turtle(source))


def _path(source: str | Path) -> Path:
    if not str(source):
        raise AuthorError("an empty text is no path and no Turtle; the current folder is '.'")
    return checked_path(source)


def file_text(path: Path) -> Text:
    """What is in a file, or in standard input. Raises AuthorError."""
    octets = files.standard_input() if path == files.STDIN else files.octets(path)
    return files.text(octets, file_name(path)), file_name(path), files.base(path)


def file_name(path: Path) -> str:
    """How a file is spoken of."""
    return PIPED if path == files.STDIN else str(path)


def _name(source: object) -> str:
    return str(source) if _is_path(source) else NO_FILE if isinstance(source, str) else GRAPH


def gathered(texts: Iterable[Text]) -> tuple[AdvertisementIndex, tuple[LeftOut, ...]]:
    """The advertisements of some documents, and what was left out: malformed ones, and second ones of a component.

    A file that is given by two paths is read twice, and advertises its components once.
    """
    found: dict[IRI, Advertisement] = {}
    left_out: list[LeftOut] = []
    segments = SegmentCache()
    with collector_at_rest():
        for text, name, base in texts:
            good, bad = read_advertisements(text, name, base, segments)
            left_out += [LeftOut(malformed.place, malformed.component, malformed.problems[0]) for malformed in bad]
            for advertisement in good:
                if found.setdefault(advertisement.component, advertisement) is not advertisement:
                    other = found[advertisement.component].profile.place
                    place = advertisement.profile.place or Place(name)
                    if other is None or not files.is_same(other.source, place.source):
                        left_out.append(LeftOut(place, advertisement.component, f"it is advertised in {other} already"))
        return AdvertisementIndex(found), tuple(left_out)


def described_in(advertisement: Advertisement) -> Document:
    """The document in which a component is advertised. Raises AuthorError, also where that is not known."""
    if advertisement.place is None:
        raise AuthorError(f"it is not known which document advertises {advertisement.component}")
    return turtle.parse(*text_of(Path(advertisement.place.source)))

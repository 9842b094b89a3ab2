"""`read`: an ecology from files, folders, Turtle text, rdflib graphs or a SPARQL endpoint."""

from __future__ import annotations

import gc
import sys
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from selfconf import files
from selfconf.api.ecology import Ecology, EndpointEcology, LoadedEcology
from selfconf.errors import AuthorError
from selfconf.model.left_out import LeftOut
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement, SegmentCache
from selfconf.rdf.advertisements import read as read_advertisements
from selfconf.rdf.eligibility import AdvertisementIndex

if TYPE_CHECKING:
    import rdflib


class _Graph(Protocol):
    """An rdflib graph, as far as it matters here."""

    def serialize(self, *, format: str) -> str: ...


def read(*sources: str | Path | rdflib.Graph) -> Ecology:
    """The ecology that files, folders, Turtle text, rdflib graphs, or one SPARQL endpoint describe.

    A string that is the URL of an endpoint is asked when a task needs its advertisements; a string with a line break,
    or that begins with a prefix, is Turtle; any other string is a path. A folder stands for all *.ttl below it.
    `left_out` of the ecology names the advertisements that do not count.

    Raises AuthorError for what is not there, cannot be read or is not Turtle.

    >>> home = read("examples/clock")
    >>> len(home.components)
    2
    """
    endpoints = [str(source) for source in sources if is_endpoint(source)]
    if endpoints:
        if len(sources) > 1:
            raise AuthorError("a SPARQL endpoint is an ecology by itself; read the other sources by themselves")
        return EndpointEcology(endpoints[0])
    return LoadedEcology(*gathered(_texts(sources)), names=tuple(map(_name, sources)))


def is_endpoint(source: object) -> bool:
    """Whether a source is the URL of a SPARQL endpoint."""
    return isinstance(source, str) and source.startswith(("http://", "https://")) and len(source.split()) == 1


def is_turtle(source: object) -> bool:
    """Whether a string is Turtle text and not a path."""
    return isinstance(source, str) and (
        "\n" in source or source.lstrip()[:7].lower() in ("@prefix", "prefix ", "@base <")
    )


Text = tuple[bytes, str, "str | None"]
"""The octets of a document, its name, and the IRI against which its relative IRIs are resolved."""


def _texts(sources: Iterable[object]) -> Iterator[Text]:
    paths: list[Path] = []
    for source in sources:
        if isinstance(source, Path) or (isinstance(source, str) and not is_turtle(source)):
            paths.append(Path(source))
        else:
            yield text_of(source)
    yield from map(file_text, listed_files(paths))


def text_of(source: object) -> Text:
    """One document: a file, Turtle text, or an rdflib graph."""
    if isinstance(source, Path) or (isinstance(source, str) and not is_turtle(source)):
        return file_text(Path(source))
    if isinstance(source, str):
        return source.encode(), "<text>", None
    graph: _Graph = source  # type: ignore[assignment]  # what else has a `serialize`, is told by the call itself
    if not hasattr(source, "serialize"):
        raise AuthorError(f"a source is a path, Turtle text, an rdflib graph or an endpoint, not {source!r}")
    return graph.serialize(format="nt").encode(), "<graph>", None


def file_text(path: Path) -> Text:
    """What is in a file, or in standard input. Raises AuthorError."""
    octets = sys.stdin.buffer.read() if path == files.STDIN else files.octets(path)
    return files.text(octets, file_name(path)), file_name(path), files.base(path)


def file_name(path: Path) -> str:
    """How a file is spoken of."""
    return "<stdin>" if path == files.STDIN else str(path)


def _name(source: object) -> str:
    return str(source) if isinstance(source, Path) or not is_turtle(source) else "<text>"


def gathered(texts: Iterable[Text]) -> tuple[AdvertisementIndex, tuple[LeftOut, ...]]:
    """The advertisements of some documents, and what was left out: malformed ones, and second ones of a component."""
    found: dict[IRI, Advertisement] = {}
    left_out: list[LeftOut] = []
    segments = SegmentCache()
    with collector_at_rest():
        for text, name, base in texts:
            good, bad = read_advertisements(text, name, base, segments)
            left_out += [LeftOut(name, malformed.component, malformed.problems[0]) for malformed in bad]
            for advertisement in good:
                if found.setdefault(advertisement.component, advertisement) is not advertisement:
                    other = found[advertisement.component].profile.place
                    left_out.append(LeftOut(name, advertisement.component, f"it is advertised in {other} already"))
        return AdvertisementIndex(found), tuple(left_out)


@contextmanager
def collector_at_rest() -> Iterator[None]:
    """No garbage collection while much is read that will stay; afterwards the collector leaves it alone.

    Values are not garbage, but looking at a million of them again and again takes as long as making them.
    """
    collecting = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        gc.freeze()
        if collecting:
            gc.enable()


def listed_files(paths: Sequence[Path], endings: tuple[str, ...] = files.TURTLE) -> list[Path]:
    """The files, and all below the folders that end so, each once, sorted. Raises AuthorError for what is not there."""
    found: set[Path] = set()
    for path in paths:
        if path != files.STDIN:
            existing(path)
        found.update(files.within(path, endings=endings))
    return sorted(found, key=Path.absolute)


def existing(path: Path) -> Path:
    """The path, if there is something; raises AuthorError."""
    if not path.exists():
        raise AuthorError(f"there is no file or folder {path}")
    return path

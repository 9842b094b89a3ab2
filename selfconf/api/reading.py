"""`read`: an ecology from files, folders, Turtle text, rdflib graphs or a SPARQL endpoint."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator, Mapping
from io import IOBase
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias, TypeGuard

from selfconf import files
from selfconf.api.document_texts import DocumentText, is_graph, source_name, text_of, texts_of
from selfconf.api.ecology import Ecology, EndpointEcology, LoadedEcology
from selfconf.api.garbage_collection import collector_at_rest
from selfconf.errors import AuthorError
from selfconf.model.left_out import LeftOut
from selfconf.model.profile import Place
from selfconf.model.term import IRI
from selfconf.rdf import turtle
from selfconf.rdf.advertisements import Advertisement, SegmentCache, read_advertisements
from selfconf.rdf.eligibility import AdvertisementIndex
from selfconf.rdf.turtle import Document

if TYPE_CHECKING:
    import rdflib


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
    index, left_out = gathered(_keeping(kept, texts_of(given)))
    return LoadedEcology(index, left_out, tuple(map(source_name, given)), time.perf_counter() - began, tuple(kept))


def _are_several(source: Source | Iterable[Source]) -> TypeGuard[Iterable[Source]]:
    """Whether there are several sources; text, an open file and a graph, of letters, lines and triples, are one."""
    return isinstance(source, Iterable) and not (is_graph(source) or isinstance(source, str | bytes | Mapping | IOBase))


def is_endpoint(source: object) -> bool:
    """Whether a source is the URL of a SPARQL endpoint."""
    return isinstance(source, str) and source.startswith(("http://", "https://")) and len(source.split()) == 1


def _keeping(kept: list[str], documents: Iterable[DocumentText]) -> Iterator[DocumentText]:
    """Yield documents, and keep the texts of those that are in no file."""
    for document in documents:
        kept.extend(document.in_no_file)
        yield document


def gathered(texts: Iterable[DocumentText]) -> tuple[AdvertisementIndex, tuple[LeftOut, ...]]:
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

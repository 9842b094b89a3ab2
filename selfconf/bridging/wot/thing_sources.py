"""The sources of descriptions of things that a bridge is given: files, folders and URLs, and the things in each."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple
from urllib.parse import urlsplit

from selfconf.errors import AuthorError
from selfconf.http_origin import check_without_user, http_origin
from selfconf.importing import NO_THINGS, DescribedThing, ImportLedger, SourceDocument, described_things, gather
from selfconf.model.immutable import replace

DESCRIPTIONS = (".json", ".jsonld")
"""The endings of files in a folder that are descriptions."""
NAMESPACE = "urn:selfconf:wot:"
"""What the IRIs of things begin with to which their descriptions give none."""


class SourceThings(NamedTuple):
    """What a source holds: things, what cannot be read, and where something stands in place of a thing."""

    things: list[DescribedThing]
    unreadable: list[AuthorError]
    without_things: tuple[str, ...]


def things_in(source: str, fetched: list[SourceDocument]) -> SourceThings:
    """The things in what was fetched, else in a path."""
    unreadable: list[AuthorError] = []
    ledger = ImportLedger(NAMESPACE, unreadable.append)
    documents = fetched or gather([source], DESCRIPTIONS, unreadable.append)
    found = list(described_things(documents, ledger))
    # An import calls the second of two of one name otherwise, as each gets a file; here they are one thing, if they
    # say that name themselves: two files may be called alike but for letters that no name has.
    was = {one.component: one.was for one in ledger.names.renamed if not one.was.startswith(NAMESPACE)}
    names = [was.get(thing.component.iri, thing.component.iri) for thing in found]
    things = [
        replace(thing, component=replace(thing.component, iri=name)) for thing, name in zip(found, names, strict=True)
    ]
    without = [place for left_out in ledger.omissions() if left_out.what == NO_THINGS for place in left_out.sources]
    return SourceThings(things, unreadable, tuple(without))


def places(shown: str) -> list[str]:
    """Where a document comes from: its file, and the folders in which that lies; or its URL alone."""
    return [shown] if is_url(shown) else [shown, *map(str, Path(shown).parents)]


def unreadable_file(source: str) -> AuthorError | None:
    """Why no thing is described in a source that is one file; None for any other source, which may fill later."""
    if is_url(source) or not Path(source).is_file():
        return None
    found = things_in(source, [])
    return None if found.things or not found.unreadable else found.unreadable[0]


def is_url(source: str) -> bool:
    """Whether a source is fetched, and no path."""
    return source.lower().startswith(("http://", "https://"))


def host_of(url: str) -> str:
    """The host to which a URL leads. Raises AuthorError for what is none, and for one with a password in it."""
    check_without_user(url)
    try:
        http_origin(url)
    except ValueError:
        raise AuthorError(f"{url} is no http or https URL") from None
    return urlsplit(url).hostname or ""

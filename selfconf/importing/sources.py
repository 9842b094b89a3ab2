"""What is to be imported: files, the files below folders, and what a URL that the user has named answers.

Nothing is fetched but such a URL and the pages that follow it on the same server, over http or https, without
redirects, with a limit of bytes and of time. What is made of a source is named after its path below the folder that was
given, so that it does not depend on the machine.
"""

from __future__ import annotations

import os
import re
from codecs import BOM_UTF8
from collections.abc import Callable, Iterator, Sequence
from http.client import HTTPException, HTTPResponse
from pathlib import Path
from time import monotonic
from urllib.error import HTTPError
from urllib.parse import urlsplit
from urllib.request import Request

from selfconf import files
from selfconf.errors import AuthorError
from selfconf.http_opener import http_opener
from selfconf.http_origin import check_without_user
from selfconf.importing.pages import Pages
from selfconf.importing.turtle_text import MARK
from selfconf.model.immutable import immutable
from selfconf.rdf.turtle import check_utf_8

LARGEST_SOURCE = 16 << 20
"""A document of more bytes is not read; the largest Thing Descriptions that are known have a few hundred kilobytes."""
FETCH_SECONDS = 20.0
"""How long a URL may take to answer in full."""
ACCEPTED = "application/td+json, application/tm+json, application/ld+json, application/json, text/turtle, */*;q=0.1"
_URL = re.compile(r"https?://", re.IGNORECASE)
Unreadable = Callable[[AuthorError], None]
"""Receives what is wrong with a source that cannot be read; the others are imported all the same."""


@immutable
class SourceDocument:
    """A document: what messages call it, its name below the folder that was given, and its bytes."""

    shown: str
    name: str
    octets: bytes
    first_page: SourceDocument | None = None
    """The first page of the list of which it is a further one."""

    @property
    def whole(self) -> SourceDocument:
        """What stands for the document, or for the list of which it is a page."""
        return self.first_page or self

    def text(self) -> str:
        """The text of the document, which is UTF-8, without a mark of the byte order. Raises AuthorError."""
        check_utf_8(self.octets, self.shown)
        return self.octets.removeprefix(BOM_UTF8).decode()

    def mistake(self, message: str, offset: int) -> AuthorError:
        """An error at a character of the text, counted from 0, with its line and column."""
        before = self.text()[:offset]
        return AuthorError(message, file=self.shown, line=before.count("\n") + 1, column=offset - before.rfind("\n"))


def gather(given: Sequence[str], endings: tuple[str, ...], unreadable: Unreadable) -> Iterator[SourceDocument]:
    """The documents that some paths and URLs stand for: of a folder, all files below it that end so, sorted by name.

    What is given twice, as a file and in its folder or by a link, is one document, under its first name. What an import
    has written is no source, so that the folder it goes to may lie in the folder that it comes from.
    """
    taken: set[str] = set()
    for one in dict.fromkeys(given):
        if _URL.match(one):
            try:
                yield from _fetched(one)
            except AuthorError as error:
                unreadable(error)
            continue
        if not one:  # `Path` takes it for the current folder
            unreadable(AuthorError("an empty text is no source; the current folder is '.'"))
            continue
        for path in files.within(Path(one), unreadable, endings):
            name = path.relative_to(one).as_posix() if path != Path(one) else path.name
            place = os.path.realpath(path)
            if place in taken:
                continue
            taken.add(place)
            try:
                found = _read(path, name)
            except AuthorError as error:
                unreadable(error)
                continue
            if path == Path(one) or not found.octets.startswith(MARK.encode()):
                yield found


def _read(path: Path, name: str) -> SourceDocument:
    try:
        size = path.stat().st_size
    except OSError:
        size = 0  # reading it says what is wrong
    if size > LARGEST_SOURCE:
        raise _too_large(str(path))
    return SourceDocument(str(path), name, files.octets(path))


def _too_large(shown: str) -> AuthorError:
    return AuthorError(f"it is over {LARGEST_SOURCE >> 20} MiB, which is more than is read", file=shown)


def _fetched(url: str) -> Iterator[SourceDocument]:
    """What a URL answers, page by page. Raises AuthorError, also for a URL with a user name or a password in it."""
    check_without_user(url)
    pages, first = Pages(url), None
    while pages.url is not None:
        octets, links = _answer(pages.url)
        page = document_at(pages.url, octets, pages.number, first)
        first = page.whole
        yield page
        pages.go_on(links, octets)


def _answer(url: str) -> tuple[bytes, list[str]]:
    """The body of what a URL answers, and its `Link` headers. Raises AuthorError."""
    deadline = monotonic() + FETCH_SECONDS
    try:
        with http_opener().open(Request(url, headers={"Accept": ACCEPTED}), timeout=FETCH_SECONDS) as reply:
            return _body(url, reply, deadline), reply.headers.get_all("Link", [])
    except HTTPError as error:
        error.close()
        where = error.headers.get("Location")
        moved = f", go to {where!r}; no redirect is followed, give the URL that is meant" if where else ""
        raise AuthorError(f"{url} answers {error.code}{moved}") from None
    except (OSError, HTTPException, ValueError) as error:
        raise AuthorError(f"cannot fetch {url}: {getattr(error, 'reason', None) or error}") from None


def document_at(url: str, octets: bytes, page: int = 1, first_page: SourceDocument | None = None) -> SourceDocument:
    """What a URL has answered, named after the end of its path; further pages of one list have a number as well."""
    parts = urlsplit(url)
    name = parts.path.rstrip("/").rpartition("/")[2] or parts.hostname or "thing"
    return SourceDocument(url, name if page == 1 else f"{name}-{page}", octets, first_page)


def _body(url: str, reply: HTTPResponse, deadline: float) -> bytes:
    """The body of a reply, piece by piece, so that neither a long nor a slow one is waited for without end."""
    if reply.headers.get("Content-Encoding", "identity") != "identity":
        raise AuthorError(f"{url} answers in a compressed form, though it was asked not to")
    pieces, size = [], 0
    while piece := reply.read1(1 << 16):
        size += len(piece)
        if size > LARGEST_SOURCE:
            raise _too_large(url)
        if monotonic() > deadline:
            raise AuthorError(f"{url} has not answered in full within {FETCH_SECONDS:.0f} s")
        pieces.append(piece)
    if reply.length:  # the library says so of no piece, and half a model may read well
        raise AuthorError(f"the answer of {url} breaks off {reply.length} bytes before its end")
    return b"".join(pieces)

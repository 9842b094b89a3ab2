"""The pages of a list that a URL answers: a directory of things may answer the first one, and say where it goes on.

The answer has a `Link` header with the relation `next` (RFC 8288), or is a `ThingCollection` with a member `next` (WoT
Discovery, section 7.3.2.1.5). Pages are read from the server alone that was named.
"""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from urllib.parse import urldefrag, urljoin

from selfconf.errors import AuthorError
from selfconf.http_origin import http_origin

MOST_PAGES = 1000
LONGEST_URL = 2000
"""A page whose URL has more characters is not read."""
COLLECTION = "ThingCollection"
"""The type of a list of things that has them as its `members`."""
_PARAMETER = r'\s*;\s*([^\s=",;]+)\s*(?:=\s*(?:"((?:[^"\\]|\\.)*)"|([^\s",;]*)))?'
_LINK = re.compile(rf"<([^<>]*)>((?:{_PARAMETER})*)")


class Pages:
    """Which page of a list is to be read, and which ones were."""

    def __init__(self, url: str) -> None:
        self._read = {url}
        self.url: str | None = url
        """The page that is to be read; None: all were."""

    @property
    def number(self) -> int:
        """The number of the page that is to be read, from 1 on; of the last one once all were."""
        return len(self._read)

    def go_on(self, links: Sequence[str], octets: bytes) -> None:
        """Go on to the page that follows, by the `Link` headers of an answer and its body.

        Raises AuthorError, and has no page left, where that is on another server, was read before, or is one too many.
        """
        here, self.url = self.url, None
        assert here is not None
        following = _next(links, octets)
        if following is None:
            return
        try:
            if len(following) > LONGEST_URL or not following.isprintable() or " " in following:
                raise ValueError  # as a stranger says it, it could also write on a terminal
            there = urldefrag(urljoin(here, following)).url
            elsewhere = http_origin(there) != http_origin(here)
        except ValueError:
            raise AuthorError(f"{here} goes on at {following[:200]!r}, which is no URL") from None
        if elsewhere:
            raise AuthorError(f"{here} goes on at {there}, which is another server; name that as well to have it read")
        if there in self._read:
            raise AuthorError(f"{here} goes on at {there}, which was read before")
        if len(self._read) == MOST_PAGES:
            raise AuthorError(f"{here} goes on, and {MOST_PAGES} pages were read; a list has so many at most")
        self._read.add(there)
        self.url = there


def _next(links: Sequence[str], octets: bytes) -> str | None:
    """Where the page after this one is; None: this is the last one."""
    # With each space alone the expression takes time in proportion to its text.
    for link in _LINK.finditer(" ".join(", ".join(links).split())):
        relations = [one[2] or one[3] or "" for one in re.finditer(_PARAMETER, link[2]) if one[1].lower() == "rel"]
        if relations and "next" in relations[0].lower().split():  # the first one counts (RFC 8288, section 3.3)
            return link[1]
    if COLLECTION.encode() not in octets:
        return None
    try:
        found = json.loads(octets)
    except (ValueError, RecursionError):
        return None  # who reads the page says what is wrong
    if not isinstance(found, dict):
        return None
    kinds, following = found.get("@type"), found.get("next")
    is_collection = COLLECTION in (kinds if isinstance(kinds, list) else [kinds])
    return following if is_collection and isinstance(following, str) else None

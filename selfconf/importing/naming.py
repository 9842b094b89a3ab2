"""Names that stay: of components that have none, of those whose name is taken, and of files.

A name comes from what the source says, or else from the path of the source, never from the order of a set, a random
number or a time. So an import that is repeated gives each component and each file its name again.
"""

from __future__ import annotations

import re

from selfconf.importing.imported import Renaming
from selfconf.importing.sources import SourceDocument
from selfconf.model.term import IRI
from selfconf.rdf.turtle import ox_term

_ABSOLUTE = re.compile(r"[A-Za-z][A-Za-z0-9+.-]*:[^\x00-\x20]")
_SAID_NOTHING = re.compile(r"[^A-Za-z0-9_.-]+")
_DESCRIBES = re.compile(r"(\.nodl)?\.[A-Za-z0-9]+$")


def absolute(text: str) -> IRI | None:
    """A text as an IRI, if it is an absolute one by RFC 3987, which is what Turtle can hold."""
    if not _ABSOLUTE.match(text):
        return None
    try:
        iri = IRI(text)
        ox_term(iri)
    except ValueError:
        return None
    return iri


def slug(text: str) -> str:
    """A text as one segment of a path or an IRI: ASCII letters, digits, hyphens, underscores and inner dots."""
    return _SAID_NOTHING.sub("-", text).strip("-.") or "unnamed"


def stem(source: SourceDocument) -> str:
    """The path of a source below the folder that was given, without the ending, each part as a slug."""
    *folders, last = source.name.split("/")
    return "/".join([*map(slug, folders), slug(_DESCRIBES.sub("", last) or last)])


class NumberedNames:
    """Gives each name out once, and then with a number; each costs the same, however often it is asked for."""

    def __init__(self) -> None:
        self._taken: set[str] = set()
        self._last: dict[str, int] = {}

    def free(self, name: str) -> str:
        """The name, or the name with the first number from two on that makes it another one than all before."""
        found, number = name, self._last.get(name, 1)
        while found in self._taken:
            number += 1
            found = f"{name}-{number}"
        self._last[name] = number
        self._taken.add(found)
        return found

    def __contains__(self, name: str) -> bool:
        return name in self._taken


class DistinctNames:
    """The names of components and files of one import: the second component of a name gets the stem of its source."""

    def __init__(self) -> None:
        self._components, self._files = NumberedNames(), NumberedNames()
        self.renamed: list[Renaming] = []

    def component(self, iri: IRI, source: SourceDocument) -> IRI:
        """The name of a component that its source calls by this IRI."""
        wanted = f"{iri}-{slug(stem(source))}" if iri in self._components else iri
        name = IRI(self._components.free(wanted))
        if name != iri:
            self.renamed.append(Renaming(name, iri, source.shown))
        return name

    def file(self, name: str) -> str:
        """The name of a file; on some systems upper and lower case are the same."""
        return name + self._files.free(name.lower())[len(name) :]

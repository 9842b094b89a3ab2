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
        ox_term(IRI(text))
    except ValueError:
        return None
    return IRI(text)


def slug(text: str) -> str:
    """A text as one segment of a path or an IRI: ASCII letters, digits, hyphens, underscores and inner dots."""
    return _SAID_NOTHING.sub("-", text).strip("-.") or "unnamed"


def stem(source: SourceDocument) -> str:
    """The path of a source below the folder that was given, without the ending, each part as a slug."""
    *folders, last = source.name.split("/")
    return "/".join([*map(slug, folders), slug(_DESCRIBES.sub("", last) or last)])


class DistinctNames:
    """Gives each name out once; the second one of a name gets the stem of its source, then a number."""

    def __init__(self) -> None:
        self._components: set[str] = set()
        self._files: set[str] = set()
        self.renamed: list[Renaming] = []

    def component(self, iri: IRI, source: SourceDocument) -> IRI:
        """The name of a component that its source calls by this IRI."""
        name = iri
        if iri in self._components:
            name = IRI(_free(f"{iri}-{slug(stem(source))}", self._components))
            self.renamed.append(Renaming(name, iri, source.shown))
        self._components.add(name)
        return name

    def file(self, name: str) -> str:
        """The name of a file; on some systems upper and lower case are the same."""
        found = _free(name, self._files)
        self._files.add(found.lower())
        return found


def _free(name: str, taken: set[str]) -> str:
    """A name that is not taken, with a number if it has to be."""
    candidates = (name, *(f"{name}-{number}" for number in range(2, len(taken) + 3)))
    return next(each for each in candidates if each not in taken and each.lower() not in taken)

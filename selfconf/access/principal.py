"""The principal of a certificate, by its common name: a site, a component, a configurator or a reader.

site.NAME   a site                       comp.KEY    a component; KEY is its chunk of the keys of the ecology
conf.NAME   who may run and stop tasks   read.NAME   who may discover, query and watch

The configurators of conf.NAME are called NAME-... in keys, so their NAME has no hyphen itself.
"""

from __future__ import annotations

import re
from enum import Enum

from selfconf.errors import AuthorError, PeerError
from selfconf.model.curie import is_local_name
from selfconf.model.immutable import immutable
from selfconf.model.term import IRI
from selfconf.protocol.keys import checked_name, component_chunk

LONGEST_NAME = 48
"""Characters of a name at most: with the kind before it, a common name has room for 64 (X.520, ub-common-name)."""
_CHUNK = re.compile(r"[a-z2-7]{16}")
_SCHEME = re.compile(r"[A-Za-z][A-Za-z0-9+.-]*")
"""The scheme of an IRI (RFC 3987, section 2.2)."""


class PrincipalKind(str, Enum):
    """What the holder of a certificate is, and so what it may do."""

    SITE = "site"
    """Serves advertisements, starts components, relays for its host."""
    COMPONENT = "comp"
    """Speaks on its own outputs and answers its own calls."""
    CONFIGURATOR = "conf"
    """Runs and stops tasks: calls components and sites."""
    READER = "read"
    """Discovers, queries and watches, and changes nothing."""


@immutable
class Principal:
    """The subject of a certificate."""

    kind: PrincipalKind
    name: str
    """A name as sites have it; of a component the chunk that stands for its IRI in keys."""

    @property
    def common_name(self) -> str:
        """The common name of its certificates."""
        return f"{self.kind.value}.{self.name}"

    def __str__(self) -> str:
        return self.common_name

    @classmethod
    def component(cls, component: IRI) -> Principal:
        """The principal that a component is."""
        return cls(PrincipalKind.COMPONENT, component_chunk(component))

    @classmethod
    def of(cls, common_name: str) -> Principal:
        """The principal of a common name. Raises PeerError for a name that none can have."""
        kind, dot, name = common_name.partition(".")
        try:
            found = cls(PrincipalKind(kind), checked_name(name, "the holder of a certificate"))
        except (ValueError, AuthorError):
            raise PeerError(f"{common_name!r} is no name of a site, component, configurator or reader") from None
        if (
            found.kind is PrincipalKind.CONFIGURATOR and "-" in name
        ):  # conf.a speaks for all a-..., so for an a-b as well
            raise PeerError(f"{common_name!r} has a hyphen: the programs of a configurator differ by what follows one")
        if not dot or len(name) > LONGEST_NAME or (kind == "comp" and not _CHUNK.fullmatch(name)):
            raise PeerError(f"{common_name!r} is no name of a site, component, configurator or reader")
        return found

    @classmethod
    def written(cls, text: str) -> Principal:
        """The principal that a person has written: a common name, or the IRI of a component. Raises AuthorError."""
        if ":" in text:
            return cls.component(written_component(text))
        try:
            return cls.of(text)
        except PeerError:
            raise AuthorError(
                f"{text!r} names no holder of a certificate; write site.NAME, conf.NAME, read.NAME, or the IRI"
                f" of a component; a NAME has at most {LONGEST_NAME} ASCII letters, digits, '.', '-' and '_', that of"
                " conf.NAME no hyphen"
            ) from None


def written_component(text: str) -> IRI:
    """The IRI of a component that a person has written in full. Raises AuthorError.

    A CURIE would be taken for the IRI of another component, and so would `comp.` before an IRI: a certificate would
    speak for no component, and one that is revoked would let its component in as before. So what looks like either
    counts only in brackets.
    """
    bare = text.removeprefix("<").removesuffix(">")
    scheme, _, rest = bare.partition(":")
    doubtful = (scheme != "urn" and is_local_name(rest)) or scheme.partition(".")[0] in {
        kind.value for kind in PrincipalKind
    }
    try:
        if rest and _SCHEME.fullmatch(scheme) and (bare != text or not doubtful):
            return IRI(bare)
    except ValueError:  # it has what no IRI has, a space for example
        pass
    example = "<https://example.org/home#clock>"
    raise AuthorError(f"{text!r} is no IRI of a component; write it in full, with nothing before it, such as {example}")

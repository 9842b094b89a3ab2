"""What a discovery has found: advertisements and sites, and what the sites are called in lists."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from selfconf.model.immutable import immutable
from selfconf.model.term import IRI
from selfconf.protocol.keys import life_of, owner_of
from selfconf.rdf.advertisements import Advertisement

SiteLife = tuple[str, str]
"""A site by its name and its life; the life is empty for a site of before that does not say it."""


@immutable
class FoundAdvertisement:
    """An advertisement of the living ecology: at which site, from which file, and whether the site can start it."""

    advertisement: Advertisement
    site: str
    source: str
    startable: bool
    site_life: str = ""
    """Which life of the site has answered."""
    unable: str = ""
    """Why the component, a composite, cannot act now, as its site says."""
    also_elsewhere: bool = False
    """Whether other sites advertise the component as well, and were left out for this one."""


@dataclass(slots=True)
class Discovery:
    """What a discovery has found: the advertisements by component, and the sites."""

    found: dict[IRI, FoundAdvertisement] = field(default_factory=dict)
    sites: tuple[str, ...] = ()
    """Every site that lives or has answered, sorted; one whose name another has as well is named with its life."""
    missing: tuple[str, ...] = ()
    """The sites that did not answer, or not in full: what they advertise may be missing from `found`. Sorted."""
    site_tokens: frozenset[str] = frozenset()
    """The liveliness keys of the sites at the roll-call: which life of which site was asked."""
    answered: frozenset[str] = frozenset()
    """The liveliness keys of the sites that have answered in full."""
    complaints: list[str] = field(default_factory=list)
    """What was left out, and why, in sentences."""

    def name_of_site(self, found: FoundAdvertisement) -> str:
        """What the site of an advertisement is called in `sites`: with its life, where another has its name as well."""
        named = name_with_life(found.site, found.site_life)
        return named if named in self.sites else found.site


@immutable
class KnownSite:
    """What a site has answered in full: at which revision, how many pages, and what was read in them."""

    revision: int
    total: int
    found: tuple[FoundAdvertisement, ...]
    complaints: tuple[str, ...]


def namesakes(lives: Iterable[str]) -> list[str]:
    """A sentence for each name that several sites have, by the liveliness keys of all sites."""
    return SiteNames(sorted((owner_of(key), life_of(key)) for key in lives)).complaints()


def name_with_life(name: str, life: str) -> str:
    """What a site is called whose name another has as well."""
    return f"{name} ({life or 'no life given'})"


class SiteNames:
    """What sites are called in lists: by their names, and by their lives where several have one name."""

    def __init__(self, sites: Sequence[SiteLife]) -> None:
        self._lives: dict[str, list[str]] = {}
        for name, life in sites:
            self._lives.setdefault(name, []).append(life)

    def of(self, site: SiteLife) -> str:
        """The name of a site that tells it from all others."""
        name, life = site
        return name if len(self._lives.get(name, ())) < 2 else name_with_life(name, life)

    def complaints(self) -> list[str]:
        """A sentence for each name that several sites have."""
        return [
            f"{len(lives)} sites are called {name}: {', '.join(self.of((name, life)) for life in lives)}"
            for name, lives in sorted(self._lives.items())
            if len(lives) > 1
        ]

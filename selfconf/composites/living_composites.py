"""Which composites of a site live.

A composite lives while its inside can be configured from the components of its site alone, itself left out: so each
level is small, and each site answers for its own. Composites that could be inside of each other in a circle never live.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from selfconf.bus.port import Bus
from selfconf.composites.inside_of_composite import InsideOfComposite
from selfconf.composites.lives_of_composite import LivesOfComposite
from selfconf.composition import DocumentOf, Inside, configurable
from selfconf.deployment import Aside, at_once
from selfconf.discovery import Beliefs
from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement

OF_ITS_SITE = " from what its site advertises"
"""Where the parts of a composite come from, in words: what fits better may be at another site."""


class Composites:
    """The composites of one site."""

    def __init__(
        self,
        bus: Bus,
        ecology: str,
        document_of: DocumentOf,
        complain: Callable[[str], None],
        aside: Aside = at_once,
        believed: Beliefs | None = None,
        hierarchy: Hierarchy = NOTHING_ABOVE,
        unable: Callable[[Mapping[IRI, str]], None] = lambda why: None,
    ) -> None:
        """`document_of` reads the document in which a composite is advertised, and raises SelfconfError.

        `complain` hears why a composite does not live, and `unable` of all of them that do not. With keys, `believed`
        says whose a component is. The roles of the insides see `hierarchy`.
        """
        self._bus, self._ecology, self._document_of = bus, ecology, document_of
        self._hierarchy, self._unable = hierarchy, unable
        self._complain, self._aside, self._believed = complain, aside, believed
        self._lives: dict[IRI, LivesOfComposite] = {}
        self._told: dict[IRI, str] = {}

    @property
    def living(self) -> dict[IRI, InsideOfComposite]:
        """What does what each of those that live is called for."""
        return {component: one.living for component, one in self._lives.items() if one.living is not None}

    def refresh(self, advertisements: Mapping[IRI, Advertisement]) -> None:
        """Let those live whose inside can be configured from these advertisements, and no others."""
        known = dict(advertisements)

        def work() -> None:
            found, why = configurable(known, self._document_of, self._hierarchy, OF_ITS_SITE)
            self._bus.wake_up(lambda: self._become(known, found, why))

        self._aside(work)

    def close(self) -> None:
        """Let none live."""
        for one in self._lives.values():
            one.close()

    def _become(self, known: Mapping[IRI, Advertisement], found: Mapping[IRI, Inside], why: Mapping[IRI, str]) -> None:
        for component in found:
            if component not in self._lives:
                one = LivesOfComposite(self._bus, self._ecology, component, self._aside, self._believed)
                self._lives[component] = one
        for component, one in self._lives.items():
            one.become(known, found.get(component))
        for component, sentence in why.items():
            if self._told.get(component) != sentence:
                self._complain(f"the composite {component} does not live: {sentence}")
        if self._told != why:
            self._unable(why)
        self._told = dict(why)

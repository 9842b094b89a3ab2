"""When the composites of a site live.

A composite lives while its inside can be configured from the components of its site alone, itself left out: so each
level is small, and each site answers for its own. One that has failed begins a new life once its inside can be
configured, from what other tasks do not hold and what is not lost: so tasks that have lost it hear that it may be had
again. Composites that could be inside of each other in a circle never live.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Set
from functools import partial

from selfconf.bus.port import Bus, Undo
from selfconf.composites.inside_of_composite import InsideOfComposite
from selfconf.composition import DocumentOf, Inside, configurable
from selfconf.deployment import Aside, RunRequest, at_once
from selfconf.discovery import Beliefs
from selfconf.model.configuration import Configuration
from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.immutable import replace
from selfconf.model.partition import Barred
from selfconf.model.refusal import Outcome
from selfconf.model.term import IRI, Term
from selfconf.protocol.keys import Keys, safe_name
from selfconf.rdf.advertisements import Advertisement

OF_ITS_SITE = " from what its site advertises"
"""Where the parts of a composite come from, in words: what fits better may be at another site."""
LOOK_AT_REFUSED = 10.0
"""After how many seconds it is checked again whether an inside that was refused can be configured. The pause doubles
with each life in which it does not run: perhaps the task that holds the composite holds what the inside lacks."""
LONGEST_LOOK = 320.0
"""The longest such pause, in seconds."""
NEXT_LIFE = 0.5
"""Seconds between two lives of a composite: one that still sees the last takes it for another process, and leaves."""
OTHER_LIFE = 3.0
"""Seconds between two looks whether another life of a composite is still seen: of two sites that advertise it, or of
one whose host was cut off before it began anew."""
OTHER_LIFE_CALL = 1.0
"""Seconds that such a look may take."""


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
        self._advertisements: Mapping[IRI, Advertisement] = {}
        self._able: Mapping[IRI, Inside] = {}
        """The composites whose inside can be configured from these advertisements."""
        self.living: dict[IRI, InsideOfComposite] = {}
        self._begun_as: dict[IRI, Advertisement] = {}
        """As what each composite was advertised when its life began."""
        self._told: dict[IRI, str] = {}
        self._between_lives: set[IRI] = set()
        self._looking: dict[IRI, Undo] = {}
        """What undoes the next look at those whose inside was refused."""
        self._pauses: dict[IRI, float] = {}
        """After how many seconds it is looked again at each of those that have begun a new life for that."""

    def refresh(self, advertisements: Mapping[IRI, Advertisement]) -> None:
        """Let those live whose inside can be configured from these advertisements, and no others."""
        known = dict(advertisements)

        def work() -> None:
            found, why = configurable(known, self._document_of, self._hierarchy, OF_ITS_SITE)
            self._bus.wake_up(lambda: self._become(known, found, why))

        self._aside(work)

    def close(self) -> None:
        """Let none live."""
        self._able = {}
        for composite in self.living.values():
            composite.close()
        self.living.clear()

    def _become(self, known: Mapping[IRI, Advertisement], found: Mapping[IRI, Inside], why: Mapping[IRI, str]) -> None:
        self._advertisements, self._able = known, found
        for component in [*self.living]:
            self._end_outdated(component)
            if component not in known:
                self._pauses.pop(component, None)
        for component in found:
            if component in self.living:
                self._look_again(component)
            elif component not in self._between_lives:
                self._between_lives.add(component)
                self._begin_life(component)
        for component, sentence in why.items():
            if self._told.get(component) != sentence:
                self._complain(f"the composite {component} does not live: {sentence}")
        if self._told != why:
            self._unable(why)
        self._told = dict(why)

    def _end_outdated(self, component: IRI) -> None:
        """Let a composite live no more, unless it acts, whose inside cannot be configured, or is another by now.

        One that acts finds out by itself what it lacks, and is what it was until it has come to rest, also where it is
        advertised no more: perhaps its file is being saved.
        """
        composite = self.living.get(component)
        if composite is None or composite.runner is not None:
            return
        if component not in self._able or self._advertisements[component] != self._begun_as[component]:
            self._end(component)

    def _end(self, component: IRI) -> None:
        """Let a composite live no more, and again after a while if its inside can be configured by then."""
        composite = self.living.pop(component)
        composite.close()
        self._between_lives.add(component)
        self._bus.later(NEXT_LIFE, partial(self._begin_life, component, composite))

    def _superseded(self, composite: InsideOfComposite) -> None:
        """A composite has left, as another life of it is seen: let it live again once that has ended."""
        if self.living.get(composite.profile.component) is composite:
            self._end(composite.profile.component)

    def _begin_life(self, component: IRI, last: InsideOfComposite | None = None) -> None:
        """Let a composite live, if its inside can be configured, once that of its last life has come to rest.

        And no other life of it is seen: of two that live it might be the one to leave, though it acts.
        """

        def seen(lives: tuple[str, ...]) -> None:
            if lives and component in self._able:
                self._bus.later(OTHER_LIFE, again)
            else:
                self._between_lives.discard(component)
                self._let_live(component)

        again = partial(self._begin_life, component, last)
        if last is not None and last.runner is not None:
            self._bus.later(NEXT_LIFE, again)
        else:
            self._bus.roll_call(Keys(self._ecology).lives(component), OTHER_LIFE_CALL, seen)

    def _let_live(self, component: IRI) -> None:
        """Let a composite live, unless its inside cannot be configured by now."""
        if component in self._able:
            advertisement = self._begun_as[component] = self._advertisements[component]
            request_with, rested = partial(self._request, self._able[component]), partial(self._acts_no_more, component)
            self.living[component] = InsideOfComposite(
                self._bus,
                self._ecology,
                advertisement.profile,
                request_with,
                rested,
                self._superseded,
            )

    def _acts_no_more(self, component: IRI) -> None:
        self._end_outdated(component)
        self._look_later(component)

    def _look_later(self, component: IRI) -> None:
        self._looking.pop(component, lambda: None)()
        composite = self.living.get(component)
        if composite is not None and composite.prospect is not None:
            self._looking[component] = self._bus.later(self._pause(composite), partial(self._look_again, component))

    def _pause(self, composite: InsideOfComposite) -> float:
        """After how many seconds it is checked again whether the inside of a composite can be configured."""
        return LOOK_AT_REFUSED if composite.has_run else self._pauses.get(composite.profile.component, LOOK_AT_REFUSED)

    def _look_again(self, component: IRI) -> None:
        """Let a composite begin a new life if its inside was refused and can be configured, as tasks count it as lost.

        One that a task holds by now begins it later: the tasks that have lost it do not hear what becomes of that.
        """
        self._look_later(component)
        composite = self.living.get(component)
        if composite is None or composite.prospect is None:
            return

        def able() -> None:
            if not composite.runtime.activation.holds and self.living.get(component) is composite:
                self._pauses[component] = min(2 * self._pause(composite), LONGEST_LOOK)
                self._end(component)

        composite.prospect.look(self._advertisements, able)

    def _request(self, inside: Inside, values: Mapping[str, Term], fed: Callable[[], Set[str]]) -> RunRequest:
        component, composer = inside.composite, inside.composer_with(values)

        def compose(
            found: Mapping[IRI, Advertisement], left_out: frozenset[Barred], running: Configuration | None
        ) -> Outcome:
            composer.leave_unfed(inside.optional - fed())
            local = {one: a for one, a in found.items() if one in self._advertisements and one != component}
            return composer.compose(local, left_out, running)

        request = RunRequest.of(composer, compose)
        return replace(request, name=safe_name(component.short), believed=self._believed, aside=self._aside)

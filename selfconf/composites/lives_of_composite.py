"""The lives of one composite, each after the last: when one begins, and when it ends.

A composite lives while its inside can be configured. One that has failed begins a new life once its inside can be
configured again, from what other tasks do not hold and what is not lost: so tasks that have lost it hear that it may be
had again.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Set
from functools import partial

from selfconf.bus.growing_pause import GrowingPause
from selfconf.bus.port import Bus
from selfconf.bus.timer import Timer
from selfconf.composites.inside_of_composite import InsideOfComposite
from selfconf.composition import Inside
from selfconf.deployment import Aside, RunRequest
from selfconf.discovery import Beliefs
from selfconf.model.configuration import Configuration
from selfconf.model.immutable import replace
from selfconf.model.partition import Barred
from selfconf.model.refusal import Outcome
from selfconf.model.term import IRI, Term
from selfconf.protocol.keys import Keys, safe_name
from selfconf.rdf.advertisements import Advertisement

LOOK_AT_REFUSED = 10.0
"""After how many seconds it is checked again whether an inside that was refused can be configured. The pause doubles
with each life that ends so soon: perhaps the task that holds the composite holds what the inside lacks."""
LONGEST_LOOK = 320.0
"""The longest such pause, in seconds."""
NEXT_LIFE = 0.5
"""Seconds between two lives of a composite: one that still sees the last takes it for another process, and leaves."""
OTHER_LIFE = 3.0
"""Seconds between two looks whether another life of a composite is still seen: of two sites that advertise it, or of
one whose host was cut off before it began anew."""
OTHER_LIFE_CALL = 1.0
"""Seconds that such a look may take."""


class LivesOfComposite:
    """One composite of a site, which lives, is about to begin a life, or cannot live."""

    def __init__(self, bus: Bus, ecology: str, component: IRI, aside: Aside, believed: Beliefs | None) -> None:
        self._bus, self._ecology, self._component = bus, ecology, component
        self._aside, self._believed = aside, believed
        self._advertised: Mapping[IRI, Advertisement] = {}
        self._able: Inside | None = None
        """Its inside, if that can be configured from what is advertised."""
        self.living: InsideOfComposite | None = None
        """What does what it is called for, while it lives."""
        self._begun_as: Advertisement | None = None
        """As what it was advertised when its life began."""
        self._begins = False
        """Whether it is about to begin a life."""
        self._next_look = Timer(bus, LOOK_AT_REFUSED, lambda: self._look_again(recovered=True))
        """The next look at an inside that was refused."""
        self._pause = GrowingPause(LOOK_AT_REFUSED, LONGEST_LOOK)
        """After how long it is looked again."""

    def become(self, advertised: Mapping[IRI, Advertisement], able: Inside | None) -> None:
        """Live, or live no more, by what is advertised, from which its inside can be configured or not."""
        self._advertised, self._able = advertised, able
        self._end_outdated()
        if self._component not in advertised:
            self._pause.begin_anew()
        if self.living is not None and able is not None:
            self._look_again(recovered=False)
        elif able is not None and not self._begins:
            self._begins = True
            self._begin()

    def close(self) -> None:
        """Live no more."""
        self._able = None
        if self.living is not None:
            self.living.close()
            self.living = None

    def _end_outdated(self) -> None:
        """Live no more, unless it acts, if its inside cannot be configured, or is another by now.

        One that acts finds out by itself what it lacks, and is what it was until it has come to rest, also where it is
        advertised no more: perhaps its file is being saved.
        """
        if self.living is None or self.living.runner is not None:
            return
        if self._able is None or self._advertised[self._component] != self._begun_as:
            self._end(self.living)

    def _end(self, living: InsideOfComposite) -> None:
        """Live no more, and again after a while if the inside can be configured by then."""
        living.close()
        self.living, self._begins = None, True
        self._bus.later(NEXT_LIFE, partial(self._begin, living))

    def _superseded(self, living: InsideOfComposite) -> None:
        """Live again after a life that has left, as another one is seen, once that has ended."""
        if self.living is living:
            self._end(living)

    def _begin(self, last: InsideOfComposite | None = None) -> None:
        """Begin a life, if the inside can be configured, once that of the last life has come to rest.

        And no other life is seen: of two that live this might be the one to leave, though it acts.
        """

        def seen(lives: tuple[str, ...]) -> None:
            if lives and self._able is not None:
                self._bus.later(OTHER_LIFE, again)
            else:
                self._begins = False
                self._live()

        again = partial(self._begin, last)
        if last is not None and last.runner is not None:
            self._bus.later(NEXT_LIFE, again)
        else:
            self._bus.roll_call(Keys(self._ecology).lives(self._component), OTHER_LIFE_CALL, seen)

    def _live(self) -> None:
        """Live, unless the inside cannot be configured by now."""
        if self._able is not None:
            self._begun_as = self._advertised[self._component]
            self.living = InsideOfComposite(
                self._bus,
                self._ecology,
                self._begun_as.profile,
                partial(self._request, self._able),
                self._rested,
                self._superseded,
            )

    def _rested(self) -> None:
        if self.living is not None:
            self._pause.failed_after(self.living.ran_for)
        self._end_outdated()
        self._look_later()

    def _look_later(self) -> None:
        self._next_look.stop()
        if self.living is not None and self.living.prospect is not None:
            self._next_look.set(self._pause.seconds)

    def _look_again(self, *, recovered: bool) -> None:
        """Begin a new life if the inside was refused and can be configured, as tasks count the composite as lost.

        With `recovered`, what has raised FAIL inside and lives on counts as able to act.

        One that a task holds by now begins it later: the tasks that have lost it do not hear what becomes of that.
        """
        self._look_later()
        living = self.living
        if living is None or living.prospect is None:
            return

        def able() -> None:
            if not living.runtime.activation.holds and self.living is living:
                self._pause.tried()
                self._end(living)

        living.prospect.look(self._advertised, able, recovered=recovered)

    def _request(self, inside: Inside, values: Mapping[str, Term], fed: Callable[[], Set[str]]) -> RunRequest:
        composer = inside.composer_with(values)

        def compose(
            found: Mapping[IRI, Advertisement], left_out: frozenset[Barred], running: Configuration | None
        ) -> Outcome:
            composer.leave_unfed(inside.optional - fed())
            local = {one: a for one, a in found.items() if one in self._advertised and one != self._component}
            return composer.compose(local, left_out, running)

        request = RunRequest.of(composer, compose)
        return replace(request, name=safe_name(self._component.short), believed=self._believed, aside=self._aside)

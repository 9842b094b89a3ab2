"""Who lives, as a configurator hears it: components come and go, sites too, and it may itself be cut off.

Whoever is cut off sees everybody die, and cannot tell. So a life that has ended is looked at a second time, and while
there is no link nothing is believed; what has become of the others is asked when there is one again.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from selfconf.configurator.events import Appeared, Event, Failed, Reconnected
from selfconf.configurator.machine import State
from selfconf.deployment.calls import Calls
from selfconf.deployment.request import Report
from selfconf.discovery import Discovery, EcologyView
from selfconf.model.run_event import EcologyReachable, EcologyUnreachable
from selfconf.model.term import IRI
from selfconf.protocol.keys import component_chunk, life_of, owner_of
from selfconf.protocol.messages import CallAnswer, Cause

SECOND_LOOK = 0.03
"""When to look again whether a life that has ended has: the network tells of it before it tells of a broken link."""
CUT_OFF = 0.25
"""How often a configurator that is cut off looks whether it still is."""
ASK_AGAIN = 5.0
"""When a site that lives, but has not answered, counts as news again."""
SETTLING = 1.0
"""How long others may take to be connected again after us; as long as components go on without a supervisor."""


class Liveness:
    """Follows the lives of an ecology for one configurator, and tells its machine what that means."""

    def __init__(
        self,
        ecology: EcologyView,
        state: Callable[[], State],
        step: Callable[[Event], None],
        report: Report,
        calls: Calls,
    ) -> None:
        self.bus, self.ecology = ecology.bus, ecology
        self._state, self._step, self._report, self._calls = state, step, report, calls
        self._sites: set[str] = set()
        self._unheard: dict[str, str] = {}
        self._link, self._cut_off = self.bus.link, False

    def discovered(self, discovery: Discovery) -> None:
        """From the first discovery on, lives are followed; a site that did not answer counts as news later."""
        self._sites.update(set(discovery.sites) - set(discovery.missing))
        if not self.ecology.followed:
            self._unheard = dict(self.ecology.lives)
            self.bus.later(SETTLING, self._end_unheard)
        self.ecology.follow(self._life_changed, self._site_changed)
        if discovery.missing:
            self.bus.later(ASK_AGAIN, lambda: self._step(Appeared({})))

    def _life_changed(self, key: str, alive: bool) -> None:
        chunk, life = owner_of(key), life_of(key)
        component = self._component(chunk)
        known = self.ecology.lives.get(chunk) == life
        self._unheard.pop(chunk, None)
        if alive and not known:
            self.ecology.lives[chunk] = life
            if component is not None:
                self._calls.woken(component)
            self._step(Appeared({component: life} if component is not None else {}))
        elif not alive:
            self._ended(chunk, life)

    def _ended(self, chunk: str, life: str) -> None:
        """A life has ended, or the way to it: who is connected to another router lives again in a moment."""
        component = self._component(chunk)
        known = self.ecology.lives.get(chunk) == life
        if known:
            del self.ecology.lives[chunk]

        def look_again() -> None:
            now = self.ecology.lives.get(chunk)
            if self.bus.link != self._link:
                self._await_link()
            elif component is not None and now != life:
                self._step(Failed(component, life, Cause.CRASH, "its life has ended"))
                if now is not None:
                    self._step(Appeared({component: now}))
            elif component is not None and self._held_life(component) == life:
                self._calls.look(component, partial(self._seen, component, life))

        if known or (component is not None and self._held_life(component) == life):
            self.bus.later(SECOND_LOOK, look_again)

    def _seen(self, component: IRI, life: str, answer: CallAnswer | None) -> None:
        """Who was cut off for a moment may have failed in it, unheard; or we were, and nobody supervised it."""
        held = self._state().held.get(component)
        if answer is None:
            self._step(Failed(component, life, Cause.CRASH, "it does not answer since it was cut off"))
        elif answer.supervisor == self._calls.supervisor:
            if not answer.active:
                self._step(Failed(component, life, Cause.FAIL, "it failed while it was cut off"))
        elif held is not None and held.confirmed and (answer.supervisor or not answer.active):
            self._reconnected()

    def _reconnected(self) -> None:
        """We were cut off, for so long that whatever we believe may be outdated; every connection counts as gone."""
        self._calls.forget_connections()
        self._report(EcologyReachable())
        self._step(Reconnected())

    def _end_unheard(self) -> None:
        """Who died between the roll-call and the beginning of the watch was called, but has never been heard."""
        for chunk, life in self._unheard.items():
            self._ended(chunk, life)
        self._unheard.clear()

    def _held_life(self, component: IRI) -> str | None:
        held = self._state().held.get(component)
        return held.life if held is not None else None

    def _site_changed(self, key: str, alive: bool) -> None:
        site = owner_of(key)
        if alive and site not in self._sites:
            self._sites.add(site)
            self._step(Appeared({}))
        elif not alive:
            self._sites.discard(site)

    def _await_link(self) -> None:
        """Who is cut off sees everybody die, and cannot tell; what has become of them is asked afterwards."""

        def look() -> None:
            if self.bus.link:
                self.bus.later(SETTLING, connected)
            else:
                self.bus.later(CUT_OFF, look)

        def connected() -> None:
            if not self.bus.link:
                look()
                return
            self._link, self._cut_off = self.bus.link, False
            self._reconnected()

        if not self._cut_off:
            self._cut_off = True
            self._report(EcologyUnreachable())
            look()

    def _component(self, chunk: str) -> IRI | None:
        for component in (*self._state().held, *self._state().owed, *self._state().lost, *self.ecology.discovery.found):
            if component_chunk(component) == chunk:
                return component
        return None

"""Which components live, and when one of them is believed to be dead.

When a life has ended, the network is asked which sites live, which takes one round trip: if it answers, and over the
link from before, the end is real. If a site has ended at the same moment, it may be that everything behind its router
has only lost the way, and is given `AWAY` seconds to come back. While this node may be cut off, no end is believed
(`selfconf.deployment.components.reachability`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import partial

from selfconf.bus.timer import Timer
from selfconf.configurator import Appeared, Failed, Phase
from selfconf.deployment.components.calls import Calls
from selfconf.deployment.components.living_sites import LivingSites
from selfconf.deployment.components.reachability import SETTLING, Reachability
from selfconf.deployment.components.waking import Waking
from selfconf.deployment.task_context import TaskContext
from selfconf.discovery import Discovery
from selfconf.model.term import IRI
from selfconf.protocol.keys import component_chunk, life_of, owner_of
from selfconf.protocol.messages import CallAnswer, Cause

SITES_CALL = 1.0
"""Seconds that the network may take to say which sites live."""
SECOND_LOOK = 0.03
"""Seconds until the second look at a life that has ended, where no site answers: a lost link may show later."""
NEWS_TOGETHER = 0.05
"""Seconds for which news of lives that no call waits for are collected: after a lost link there may be thousands."""


class Liveness:
    """Follows the lives of an ecology for one configurator, and feeds its machine with what they mean."""

    def __init__(
        self, context: TaskContext, calls: Calls, waking: Waking, sites: LivingSites, reachability: Reachability
    ) -> None:
        self.bus, self.ecology, self._calls, self._waking = context.ecology.bus, context.ecology, calls, waking
        self._sites, self._reachability = sites, reachability
        self._state, self._step, self._supervisor = context.state, context.step, context.supervisor
        self._news: dict[str, str] = {}
        """A life of each component that is not followed and has begun to live, by its chunk, until it is fed."""
        self._feed_soon = Timer(self.bus, NEWS_TOGETHER, self._feed_news)
        self._unseen: set[tuple[str, str]] = set()
        """The lives of a roll-call that the watch has not shown yet, with the component's chunk."""
        self._names: dict[str, IRI] = {}
        """Every component that was ever advertised or held, by its chunk: an event costs one look-up, however many
        live."""
        self._doubted: set[tuple[str, str]] = set()
        """The lives that seem to have ended since the network was last asked, with the component's chunk."""
        self._asking = False

    def discovered(self, discovery: Discovery) -> None:
        """Follow lives from the first discovery on; ask sites later that were not asked or did not answer in full.

        So is the life of a component that was adopted, and whose site is out of sight.
        """
        self._names.update((component_chunk(one), one) for one in (*discovery.found, *self._state().held))
        self._sites.answered(discovery)
        if not self.ecology.followed:
            self._called({(chunk, life) for chunk, lives in self.ecology.lives.items() for life in lives})
            self._sites.expect(discovery.answered, SETTLING)
        self.ecology.follow(self._life_changed, self._sites.changed)
        self._sites.ask_again(discovery)

    def select(self, components: Iterable[IRI], done: Callable[[], None]) -> None:
        """Know and follow the lives of components, where there are too many for all; at once where they are known."""

        def called(keys: Sequence[str]) -> None:
            if keys:
                self._called({(owner_of(key), life_of(key)) for key in keys})
            done()

        self.ecology.select(components, called)

    def _called(self, lives: set[tuple[str, str]]) -> None:
        """A life that ends between its call and the beginning of the watch is never shown: it has ended then."""
        self._unseen |= lives
        self.bus.later(SETTLING, partial(self._end_unseen, lives))

    def _end_unseen(self, called: Iterable[tuple[str, str]]) -> None:
        for chunk, life in sorted(self._unseen.intersection(called)):
            self._unseen.discard((chunk, life))
            self._ended(chunk, life)

    def _life_changed(self, key: str, alive: bool) -> None:
        chunk, life = owner_of(key), life_of(key)
        self._unseen.discard((chunk, life))
        if not self.ecology.knows(chunk):
            self._note_news(chunk, life)
        elif not alive:
            self._ended(chunk, life)
        elif life not in self.ecology.lives.get(chunk, ()):
            self.ecology.began(chunk, life)
            component = self._component(chunk)
            if component is not None:
                self._calls.woken(component, life)
                self._waking.woken(component, life)
            self._step(Appeared({component: life} if component is not None else {}))

    def _note_news(self, chunk: str, life: str) -> None:
        """A component lives that is not followed; thousands may come at once, so they are fed together."""
        self._news[chunk] = life
        self._feed_soon.set()

    def _feed_news(self) -> None:
        news, self._news = self._news, {}
        found = {self._component(chunk): life for chunk, life in news.items()}
        self._step(Appeared({component: life for component, life in found.items() if component is not None}))

    def _ended(self, chunk: str, life: str) -> None:
        """A life has ended, or only the way to it: a client that changes its router seems to end for a moment."""
        component = self._component(chunk)
        known = life in self.ecology.lives.get(chunk, ())
        self.ecology.ended(chunk, life)
        if known or (component is not None and self._held_life(component) == life):
            self._doubted.add((chunk, life))
            if not self._asking:
                self._ask_network()

    def _ask_network(self) -> None:
        """Ask which sites live, once for all lives that have ended before."""
        self._asking = True
        asked, self._doubted = sorted(self._doubted), set()
        self.bus.roll_call(self.ecology.keys.any_site_life(), SITES_CALL, partial(self._network_answered, asked))

    def _network_answered(self, asked: Sequence[tuple[str, str]], sites: tuple[str, ...]) -> None:
        self._asking = False
        away = self._sites.back_in(sites)
        if not sites:
            self.bus.later(SECOND_LOOK, partial(self._judge, asked))
        elif away > 0:
            self.bus.later(away, partial(self._judge, asked))
        else:
            self._judge(asked)
        if self._doubted and not self._asking:
            self._ask_network()

    def _judge(self, asked: Sequence[tuple[str, str]]) -> None:
        """Believe that lives have ended, unless they are back, or this node is or was cut off."""
        for chunk, life in asked:
            if not self._reachability.undisturbed:
                self._reachability.await_link()
                return
            component, now = self._component(chunk), self.ecology.lives.get(chunk, ())
            if component is None:
                continue
            if life not in now or self._was_silent(component, life):
                why = "its life has ended" if life not in now else "it was cut off for a moment"
                self._step(Failed(component, life, Cause.CRASH, why))
                if now:
                    self._step(Appeared({component: now[0]}))
            elif self._held_life(component) == life:
                self._calls.look(component, partial(self._seen, component, life, self._state().epoch))

    def _was_silent(self, component: IRI, life: str) -> bool:
        """Whether a component was lost as silent in a life that seemed to end: what it issued was cut off with it."""
        loss = self._state().lost.get(component)
        return loss is not None and loss.cause is Cause.SILENCE and loss.life == life

    def _seen(self, component: IRI, life: str, epoch: int, answer: CallAnswer | None) -> None:
        """Judge a component whose life seemed to end and goes on, by the answer to a question for its state.

        If the component was cut off for a moment, it may have failed meanwhile, unnoticed: one that has said that it
        acts, and does not. If this node was, then the component may have turned itself off, or obey another
        configurator. An answer that comes in another epoch than the question says nothing of what was called for since:
        that is looked at from time to time.
        """
        held, state = self._state().held.get(component), self._state()
        acted = held is not None and held.confirmed and state.phase is not Phase.DISMANTLING and state.epoch == epoch
        if answer is None:
            self._step(Failed(component, life, Cause.CRASH, "it does not answer since it was cut off"))
        elif answer.supervisor == self._supervisor:
            if answer.active:
                self._calls.heed_ends(component, answer)
            elif acted:
                self._step(Failed(component, life, Cause.FAIL, "it failed while it was cut off"))
        elif acted and (answer.supervisor or not answer.active):
            self._reachability.reconnected()

    def _held_life(self, component: IRI) -> str | None:
        held = self._state().held.get(component)
        return held.life if held is not None else None

    def _component(self, chunk: str) -> IRI | None:
        return self._names.get(chunk)

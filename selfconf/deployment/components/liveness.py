"""Which components and sites live, and when one of them is believed to be dead.

To a configurator that is cut off from the network all lives seem to end at once. So when a life has ended, the network
is asked which sites live, which takes one round trip: if it answers, and over the link from before, the end is real. If
a site has ended at the same moment, it may be that everything behind its router has only lost the way, and is given
`AWAY` seconds to come back. While there is no link, no end is believed; once there is one again, the ecology is asked
what has become of its components.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import partial

from selfconf.bus.port import Undo
from selfconf.configurator import Appeared, Failed, Phase, Reconnected
from selfconf.deployment.components.calls import Calls
from selfconf.deployment.components.waking import Waking
from selfconf.deployment.task_context import TaskContext
from selfconf.discovery import Discovery
from selfconf.model.run_event import EcologyReachable, EcologyUnreachable
from selfconf.model.term import IRI
from selfconf.protocol.keys import component_chunk, life_of, owner_of
from selfconf.protocol.messages import CallAnswer, Cause

SITES_CALL = 1.0
"""Seconds that the network may take to say which sites live."""
SECOND_LOOK = 0.03
"""Seconds until the second look at a life that has ended, where no site answers: a lost link may show later."""
AWAY = 0.3
"""Seconds that a component may take to find another router when its own is gone."""
CUT_OFF = 0.25
"""Seconds between two looks of a configurator that is cut off whether it still is."""
ASK_SITE_AGAIN = 5.0
"""Seconds after which a site that lives, but has not answered in full, is taken for news, and so is asked again."""
NEWS_TOGETHER = 0.05
"""Seconds for which news of lives that no call waits for are collected: after a lost link there may be thousands."""
AUDIT = 1.0
"""Seconds between two looks at what runs: a component may have let go of its task, failed or changed, unnoticed."""
AUDITED = 20
"""How many components are looked at in one of them; they take turns."""
SILENT_AUDITS = 3
"""How many audits in a row a component may leave unanswered; each waits for as long as a call."""
MOST_REOPENINGS, REOPENINGS_WITHIN = 6, 60.0
"""How often in how many seconds a site is believed that its hub is about to be opened anew: it is, as others join.
Those that this node has seen come true, as its own link was lost, do not count."""
SETTLING = 1.0
"""Seconds that other nodes may take to be connected again after this one.

It is the grace period of components (`GRACE` of `selfconf.sdk.runtime.supervision`): after it, each has turned itself
off or has seen its supervisor again.
"""


class Liveness:
    """Follows the lives of an ecology for one configurator, and feeds its machine with what they mean."""

    def __init__(
        self,
        task: TaskContext,
        calls: Calls,
        waking: Waking,
    ) -> None:
        self.bus, self.ecology, self._calls, self._waking = task.ecology.bus, task.ecology, calls, waking
        self._state, self._step, self._report = task.state, task.step, task.report
        self._sites: set[str] = set()
        """The liveliness keys of the sites that answered last, or are news: one that was started again has another."""
        self._shown_sites: set[str] = set()
        """The liveliness keys of the sites that the watch shows to live."""
        self._news: dict[str, str] = {}
        """A life of each component that is not followed and has begun to live, by its chunk, until it is fed."""
        self._unseen: set[tuple[str, str]] = set()
        """The lives of a roll-call that the watch has not shown yet, with the component's chunk."""
        self._unseen_sites: set[str] = set()
        """The liveliness keys of the sites that have answered, but that the watch has not shown yet."""
        self._ended_sites: set[str] = set()
        """The liveliness keys of the sites that have ended since the last discovery, whatever they answer to it."""
        self._names: dict[str, IRI] = {}
        """Every component that was ever advertised, by its chunk: an event costs one look-up, however many live."""
        self._doubted: set[tuple[str, str]] = set()
        """The lives that seem to have ended since the network was last asked, with the component's chunk."""
        self._asking = False
        self._site_ended = float("-inf")
        """When the life of a site ended the last time."""
        self._link = self.bus.link
        self.cut_off = False
        """Whether this node was found to be cut off, and has not been connected again for long enough since."""
        self.unsure = False
        """Whether it was cut off or suspended, and does not know yet what has become of its components meanwhile."""
        self._withheld: dict[tuple[IRI, str], Failed] = {}
        """The latest failure of each life of a component that was heard of while this node was unsure."""
        self._ask_again: Undo = lambda: None
        self._reopenings: dict[str, list[float]] = {}
        """When each site has last said that its hub is about to be opened anew."""
        self._audited = 0
        self._silences: dict[IRI, tuple[str, int]] = {}
        """How often in a row each component has not answered an audit, and in which life."""
        self.dropped: dict[IRI, int] = {}
        """How many signals each component has passed over because its code was too slow, when it was asked last."""

    def discovered(self, discovery: Discovery) -> None:
        """Follow lives from the first discovery on; ask sites later that were not asked or did not answer in full."""
        self._names.update((component_chunk(component), component) for component in discovery.found)
        self._sites = set(discovery.answered - self._ended_sites)
        self._ended_sites.clear()
        if not self.ecology.followed:
            self._called({(chunk, life) for chunk, lives in self.ecology.lives.items() for life in lives})
            self._unseen_sites = set(discovery.answered)
            self.bus.later(SETTLING, self._end_unseen_sites)
        self.ecology.follow(self._life_changed, self._site_changed)
        self._ask_again()  # one such timer at a time: each leads to a discovery, which comes here again
        if discovery.missing or not discovery.site_tokens.issuperset(self._shown_sites):
            self._ask_again = self.bus.later(ASK_SITE_AGAIN, lambda: self._step(Appeared({})))

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
        if not self._news:
            self.bus.later(NEWS_TOGETHER, self._feed_news)
        self._news[chunk] = life

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
        if sites and not self._sites.issubset(sites):
            self._site_ended = self.bus.now()  # which the watch has not shown yet
        away = self._site_ended + AWAY - self.bus.now()
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
            if self.cut_off or self.bus.link != self._link:
                self._await_link()
                return
            component, now = self._component(chunk), self.ecology.lives.get(chunk, ())
            if component is None:
                continue
            if life not in now:
                self._step(Failed(component, life, Cause.CRASH, "its life has ended"))
                if now:
                    self._step(Appeared({component: now[0]}))
            elif self._held_life(component) == life:
                self._calls.look(component, partial(self._seen, component, life))

    def _seen(self, component: IRI, life: str, answer: CallAnswer | None) -> None:
        """Judge a component whose life seemed to end and goes on, by the answer to a question for its state.

        If the component was cut off for a moment, it may have failed meanwhile, unnoticed. If this node was, then the
        component may have turned itself off, or obey another configurator.
        """
        held = self._state().held.get(component)
        acted = held is not None and held.confirmed and self._state().phase is not Phase.DISMANTLING
        if answer is None:
            self._step(Failed(component, life, Cause.CRASH, "it does not answer since it was cut off"))
        elif answer.supervisor == self._calls.supervisor:
            if not answer.active:
                self._step(Failed(component, life, Cause.FAIL, "it failed while it was cut off"))
            else:
                self._calls.heed_ends(component, answer)
        elif acted and (answer.supervisor or not answer.active):
            self._reconnected()

    def _reconnected(self) -> None:
        """This node was cut off for so long that all it knows may be outdated: every connection counts as gone."""
        self._calls.forget_connections()
        self._report(EcologyReachable())
        self._step(Reconnected())

    def audit(self) -> None:
        """Ask some of the components that run, in turns, whether they act for this task; again, until it has ended."""
        if self._state().ended:
            return
        self.bus.later(AUDIT, self.audit)
        held = [component for component, one in self._state().held.items() if one.confirmed]
        if not self._runs_undisturbed(self._state().epoch) or not held:
            return
        for number in range(self._audited, self._audited + min(AUDITED, len(held))):
            component = held[number % len(held)]
            self._calls.look(component, partial(self._audit, component, self._state().epoch), 1)
        self._audited = (self._audited + AUDITED) % len(held)

    def _audit(self, component: IRI, epoch: int, answer: CallAnswer | None) -> None:
        """Judge a component that should act: one that has failed is lost, one that has let go is applied to anew.

        To one behind which others stand than was known, the rest is connected anew.
        """
        held = self._state().held.get(component)
        if held is None or not self._runs_undisturbed(epoch):
            return
        if answer is None:
            life, before = self._silences.get(component, (held.life, 0))
            silences = before + 1 if life == held.life else 1
            self._silences[component] = held.life, silences
            if silences >= SILENT_AUDITS:
                self._step(Failed(component, held.life, Cause.HUNG, "it lives, but answers no question"))
            return
        self._silences.pop(component, None)
        if answer.life != held.life:
            return
        self.dropped[component] = answer.dropped
        if answer.task != self._calls.identity.task:
            self._calls.forget_connections()
            self._step(Reconnected())
        elif not answer.active:
            self._step(Failed(component, answer.life, Cause.FAIL, "it does not act any more"))
        else:
            self._calls.heed_ends(component, answer)  # its notice that others stand behind it may have been lost

    def _runs_undisturbed(self, epoch: int) -> bool:
        """Whether the configuration of an epoch runs, and this node is not, and was not just now, cut off."""
        state = self._state()
        connected = not self.cut_off and self.bus.link == self._link
        return connected and state.phase is Phase.RUNNING and state.epoch == epoch

    def _end_unseen_sites(self) -> None:
        for site in sorted(self._unseen_sites):
            self._site_changed(site, False)

    def _held_life(self, component: IRI) -> str | None:
        held = self._state().held.get(component)
        return held.life if held is not None else None

    def _site_changed(self, key: str, alive: bool) -> None:
        self._unseen_sites.discard(key)
        if alive:
            self._ended_sites.discard(key)
            self._shown_sites.add(key)
        else:
            self._ended_sites.add(key)
            self._shown_sites.discard(key)
        if alive and key not in self._sites:
            self._sites.add(key)
            self._waking.site_began(owner_of(key))
            self._step(Appeared({}))
        elif not alive:
            self._site_ended = self.bus.now()
            self._sites.discard(key)
            if not self._site_lives(owner_of(key)):
                self._waking.site_ended(owner_of(key))

    def _site_lives(self, site: str) -> bool:
        return site in map(owner_of, self._sites | self._shown_sites)

    def reopens(self, site: str) -> None:
        """A site's hub is about to be opened anew: lives seem to end, one after the other, and sites among the last.

        A site that says so again and again is not believed, nor one that does not live: no end would be any more.
        """
        now = self.bus.now()
        lately = {one: [at for at in said if now - at < REOPENINGS_WITHIN] for one, said in self._reopenings.items()}
        self._reopenings = {one: said for one, said in lately.items() if said}
        said = self._reopenings.get(site, [])
        if len(said) < MOST_REOPENINGS and self.ecology.followed and self._site_lives(site):
            self._reopenings[site] = [*said, now]
            self._await_link()

    def heed(self, failed: Failed) -> None:
        """Feed the machine with a failure that was heard of; while this node is unsure, that waits.

        A repair would find that nothing answers, and give up what another configurator may have repaired long since.
        """
        if self.bus.link != self._link:
            self._await_link()
        if self.unsure:
            self._withheld[failed.component, failed.life] = failed
        else:
            self._step(failed)

    def suspended(self) -> None:
        """This program stood still for a while, as if it had been cut off: so it was, or nearly."""
        if self.ecology.followed:
            self.unsure = True
            self._await_link()

    def _await_link(self) -> None:
        """Believe no end while this node is cut off; what has become of the components is asked afterwards."""

        def look() -> None:
            if self._state().ended:
                return
            if self.bus.link:
                self.bus.later(SETTLING, connected)
            else:
                self.unsure = True
                self.bus.later(CUT_OFF, look)

        def connected() -> None:
            if not self.bus.link or self._state().ended:
                look()
                return
            if self.bus.link != self._link:
                self._reopenings.clear()
            self._link, self.cut_off, self.unsure = self.bus.link, False, False
            self._reconnected()
            withheld, self._withheld = self._withheld, {}
            for failed in withheld.values():
                self._step(failed)

        if not self.cut_off:
            self.cut_off = True
            self._report(EcologyUnreachable())
            look()

    def _component(self, chunk: str) -> IRI | None:
        return self._names.get(chunk)

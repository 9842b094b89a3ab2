"""How the components of a task come to live: those that are dormant are started by their sites."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

from selfconf.bus.port import Replies, Undo
from selfconf.configurator import Answered, Call, Unanswered, WakeUp
from selfconf.deployment.components.held_lives import HeldLives
from selfconf.deployment.task_context import TaskContext
from selfconf.discovery import FoundAdvertisement
from selfconf.model.run_event import ComponentUnreachable, ComponentWoken
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Verdict, Wake

WAKE_CALL = 2.0
"""Seconds that a site may take to answer."""
WAKE_ATTEMPTS = 3
"""How often a site is asked that does not answer: a question is lost that meets a hub which is opened anew."""
WAKING = 15.0
"""Seconds that a component that a site starts may take to live."""
SITE_BACK = 3.0
"""Seconds that a site may be away before what it was starting is given up."""


@dataclass(slots=True, eq=False)
class _Start:
    """A component that is being started by a site."""

    effect: WakeUp
    """The newest that asks for it: a deployment that begins anew waits for what is being started."""
    site: str
    end: Undo = lambda: None
    """Undoes the end of its time."""


class Waking:
    """Has components started for one task, and feeds its machine with what becomes of that."""

    def __init__(
        self,
        context: TaskContext,
        lives: HeldLives,
    ) -> None:
        self._bus, self._ecology, self._lives = context.ecology.bus, context.ecology, lives
        self._step, self._report = context.step, context.report
        self._waiting: dict[IRI, _Start] = {}
        """The components that are being started."""

    def __contains__(self, component: IRI) -> bool:
        """Whether a component is being started."""
        return component in self._waiting

    def wake(self, effect: WakeUp) -> None:
        """Have a component live: one that is dormant is started by its site."""
        found = self._ecology.discovery.found.get(effect.component)
        self._lives.leave_behind_if_ended(effect.component)
        if self._ecology.life(effect.component) is not None:
            self._step(Answered(effect.component, Call.WAKE, effect.epoch, Verdict.DONE))
        elif found is not None and found.startable:
            waiting = self._waiting.get(effect.component)
            is_asked = waiting is not None and waiting.site == found.site
            if waiting is not None and is_asked and waiting.effect.epoch < effect.epoch:
                waiting.effect = effect  # one of the same epoch is to be asked for again
            else:
                if not is_asked:
                    self._report(ComponentWoken(effect.component, found.site))
                self._start_by_site(effect, found)
        else:
            self._lives.awaited(effect.component)
            detail = "it is advertised, but it does not run" if found is None or not found.unable else found.unable
            self._fail(effect, detail)

    def woken(self, component: IRI, life: str) -> None:
        """A component lives; perhaps it was started for this task."""
        self._lives.born(component)
        waiting = self._waiting.pop(component, None)
        if waiting is not None:
            waiting.end()
            self._lives.lost(component, life)
            self._step(Answered(component, Call.WAKE, waiting.effect.epoch, Verdict.DONE))

    def abandon(self, component: IRI) -> None:
        """A component was lost: it is not waited for any more if it was started for this task."""
        waiting = self._waiting.pop(component, None)
        if waiting is not None:
            waiting.end()

    def process_ended(self, component: IRI) -> None:
        """Its site has ended the process of a component, for a release: it is asked again for one that is waited for.

        It was asked before, and that was reported, while the process ran, which only this task did not see.
        """
        waiting, found = self._waiting.get(component), self._ecology.discovery.found.get(component)
        if waiting is not None and found is not None:
            self._start_by_site(waiting.effect, found)

    def site_began(self, site: str) -> None:
        """A site lives a new life: what it was starting in another one it is asked to start again."""
        for waiting in list(self._waiting.values()):
            found = self._ecology.discovery.found.get(waiting.effect.component)
            if found is not None and found.site == site:
                self._report(ComponentWoken(waiting.effect.component, site))
                self._start_by_site(waiting.effect, found)

    def site_ended(self, site: str) -> None:
        """The life of a site has ended: what it was starting is given up, unless the site is back in time."""
        for waiting in list(self._waiting.values()):
            found = self._ecology.discovery.found.get(waiting.effect.component)
            if found is not None and found.site == site:
                self._bus.later(
                    SITE_BACK, partial(self._give_up, waiting, "its site has ended", Unanswered.SITE_UNSEEN)
                )

    def _start_by_site(self, effect: WakeUp, found: FoundAdvertisement) -> None:
        """Have the site start the process; that is done when the component lives."""
        self.abandon(effect.component)
        self._lives.awaited(effect.component)
        too_late = f"it was started, but does not live after {WAKING:.0f} s"
        waiting = self._waiting[effect.component] = _Start(effect, found.site)
        waiting.end = self._bus.later(WAKING, lambda: self._give_up(waiting, too_late))
        self._ask_site(waiting, WAKE_ATTEMPTS)

    def _ask_site(self, waiting: _Start, attempts: int) -> None:
        """Ask a site to start a component, so many times until it answers; one that has started it does nothing."""
        component = waiting.effect.component

        def answered(replies: Replies) -> None:
            if replies.errors:
                self._lives.gone(component)  # its site can tell that no process of it runs
            if replies.samples or self._waiting.get(component) is not waiting:
                return
            if attempts > 1 and not (replies.errors or replies.complete):
                self._ask_site(waiting, attempts - 1)
            elif replies.errors:
                self._give_up(waiting, replies.errors[0])
            else:
                self._give_up(waiting, "its site does not answer", Unanswered.SITE_UNSEEN)

        wake = Wake(component, self._lives.lost_life(component))
        self._bus.ask(self._ecology.keys.wake(waiting.site), encode(wake), WAKE_CALL, answered)

    def _give_up(self, waiting: _Start, detail: str, why: Unanswered = Unanswered.NOT_STARTED) -> None:
        """Do without a component that was to be started, unless it lives by now or is being started anew."""
        component = waiting.effect.component
        if self._waiting.get(component) is waiting:
            self.abandon(component)
            self._fail(waiting.effect, detail, why)

    def _fail(self, effect: WakeUp, detail: str, why: Unanswered = Unanswered.NOT_STARTED) -> None:
        """Say soon that a component cannot be had, unless it lives by then: nothing would disprove that loss again."""

        def fail() -> None:
            if self._ecology.life(effect.component) is not None:
                self._step(Answered(effect.component, Call.WAKE, effect.epoch, Verdict.DONE))
                return
            self._report(ComponentUnreachable(effect.component, Call.WAKE.value, detail))
            component, epoch = effect.component, effect.epoch
            self._step(Answered(component, Call.WAKE, epoch, why, detail=detail))

        self._bus.wake_up(fail)

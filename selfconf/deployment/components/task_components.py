"""The components of one task, as its configurator deals with them: the parts of this room, and what each is asked."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from selfconf.bus.port import Urgency
from selfconf.configurator import (
    DEPLOYING,
    ApplyTo,
    AwaitRelease,
    Decline,
    Phase,
    QueueFor,
    ReleaseFrom,
    ReserveOf,
    Unwatch,
    WakeUp,
    Watch,
)
from selfconf.deployment.components.audits import Audits
from selfconf.deployment.components.calls import Calls
from selfconf.deployment.components.component_messages import ComponentMessages
from selfconf.deployment.components.held_lives import HeldLives
from selfconf.deployment.components.liveness import Liveness
from selfconf.deployment.components.living_sites import LivingSites
from selfconf.deployment.components.port_ends import PortEnds
from selfconf.deployment.components.reachability import Reachability
from selfconf.deployment.components.releases import GONE
from selfconf.deployment.components.waking import Waking
from selfconf.deployment.notices import AT_LEISURE
from selfconf.deployment.task_context import TaskContext
from selfconf.model.run_event import FailWatched
from selfconf.model.term import IRI
from selfconf.protocol.keys import site_of

ComponentEffect = Watch | Unwatch | WakeUp | ReserveOf | QueueFor | Decline | AwaitRelease | ApplyTo | ReleaseFrom
"""What the machine wants done about one component."""

REST_LOOK = 0.05
"""Seconds between two looks whether what has gone is known to be at rest, as its task ends."""


class TaskComponents:
    """Asks the components of one task what its machine wants, and feeds that with what they say and how they live."""

    def __init__(self, context: TaskContext) -> None:
        self._bus, self._state, self._report = context.ecology.bus, context.state, context.report
        self.lives = HeldLives(context.ecology)
        self.ends = PortEnds(context.ecology, context.request.outside)
        self._waking = Waking(context, self.lives)
        self.calls = Calls(context, self.lives, self._waking, self.ends)
        sites = LivingSites(context, self._waking)
        self.reachability = Reachability(context, self.calls, sites)
        self.liveness = Liveness(context, self.calls, self._waking, sites, self.reachability)
        self.audits = Audits(context, self.calls, self.reachability)
        self._messages = ComponentMessages(context, self.lives, self.ends, self.reachability.heed)
        self._unsubscribe = self._bus.subscribe(
            context.ecology.keys.reopens(),
            lambda sample: self.reachability.reopens(site_of(sample.key)),
            Urgency.EVENT,
        )

    def begin(self) -> None:
        """Look from time to time how they are, for as long as the task goes on."""
        self.audits.go_on()
        self.reachability.pulse()

    def await_rest(self, done: Callable[[], None]) -> None:
        """Call `done` once each component has obeyed its release, has gone for good, or is beyond reach.

        A site that ends in the same moment as the task tells soon that the processes of its components have ended.
        """
        for component in self.out_of_control():
            self.calls.expect_gone(component)
        self._look_whether_at_rest(self._bus.now() + GONE + REST_LOOK, done)

    def _look_whether_at_rest(self, until: float, done: Callable[[], None]) -> None:
        """Wait for what seems to have ended, unless this node is cut off: then it would hear nothing of it."""
        uncertain, may_hear = self.out_of_control(), self._bus.link and self._bus.now() < until
        if uncertain and may_hear and not any(map(self.lives.lives_on, uncertain)):
            self._bus.later(REST_LOOK, partial(self._look_whether_at_rest, until, done))
        else:
            done()

    def close(self) -> None:
        """Hear nothing of them any more."""
        self._messages.close()
        self._unsubscribe()

    # complexity: one case for each effect
    def carry_out(self, effect: ComponentEffect) -> None:
        """Do what the machine wants done about a component."""
        match effect:
            case Watch():
                self._report(FailWatched(effect.component))
                self._messages.watch(effect.component)
            case Unwatch():
                self._messages.unwatch(effect.component)
            case WakeUp():
                self._waking.wake(effect)
            case ReserveOf():
                self.calls.reserve(effect)
            case QueueFor():
                self.calls.queue(effect)
            case Decline():
                self.calls.decline(effect)
            case AwaitRelease():
                self.calls.await_release(effect)
            case ApplyTo():
                self._apply(effect)
            case ReleaseFrom():
                leisure = AT_LEISURE if self._state().phase in (Phase.COMPOSING, *DEPLOYING) else 0.0
                self._bus.later(leisure, partial(self.calls.release, effect))

    def _apply(self, effect: ApplyTo) -> None:
        """Apply to a component, unless what feeds it may act no more since a pause: all is applied to anew soon."""
        if effect.rests or not self.reachability.unsure:
            self.calls.apply(effect)

    def abandon(self, component: IRI) -> None:
        """Wait no more for a component that was lost, if it is being started for this task."""
        self._waking.abandon(component)

    def dropped(self) -> dict[str, int]:
        """How many signals those that are held have passed over, where it is any."""
        return {one: count for one, count in self.audits.dropped.items() if count and one in self._state().held}

    def out_of_control(self) -> tuple[IRI, ...]:
        """The components that have not obeyed their release and may still act, sorted."""
        return self.lives.out_of_control(self._state().owed)

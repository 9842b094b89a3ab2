"""Which losses of a task last: actuators have to rest while what runs is incomplete for more than a moment.

Most losses are repaired within a moment, and nothing need rest for them. So the machine is fed `LossLasts` a moment
after a loss, once for all that were lost of late, as these may be thousands; and once more when what runs has lacked
one or another component for so long that its actuators must not act on.
"""

from __future__ import annotations

from selfconf.bus.timer import Timer
from selfconf.configurator import LossLasts, Phase
from selfconf.deployment.task_context import TaskContext
from selfconf.model.term import IRI

LASTS = 0.05
"""Seconds after which a component that was lost is followed no more, if nothing has taken its place by then."""
LASTS_LONG = 1.0
"""Seconds for which actuators act on in a configuration that lacks a component: as long as without a configurator."""


class LastingLosses:
    """Looks, after what one task has lost, whether that lasts, and feeds its machine with `LossLasts`."""

    def __init__(self, context: TaskContext) -> None:
        self._ecology, self._state, self._step = context.ecology, context.state, context.step
        bus = context.ecology.bus
        self._incomplete = Timer(bus, LASTS_LONG, self._look_when_it_is_long)
        """The look at what runs when it has lacked a component for long, while it lacks one."""
        self._lost_of_late = Timer(bus, LASTS, self._look)
        """The look at what was lost."""
        self._lost_since = False
        """Whether more was lost since that look was planned."""

    def lost(self) -> None:
        """A component was lost: look a moment later, and when what runs has lacked one or another for long."""
        self._lost_since = self._lost_of_late.is_set
        self._lost_of_late.set()
        if not self._incomplete.is_set and any(held.active for held in self._state().held.values()):
            self._incomplete.set()

    def stepped(self) -> None:
        """Plan no look at what runs for long where it is complete now, or is taken down."""
        if self._state().phase in (Phase.RUNNING, Phase.DISMANTLING):
            self._incomplete.stop()

    def _look(self) -> None:
        """Look once for all that was lost of late, and once more if some was later."""
        if self._lost_since:
            self._lost_since = False
            self._lost_of_late.set()
        self._step(LossLasts())

    def _look_when_it_is_long(self) -> None:
        """Look once; what begins to act from now on may do so for as long if more is lost."""
        self._step(LossLasts(frozenset(filter(self._is_actuator, self._state().held))))

    def _is_actuator(self, component: IRI) -> bool:
        """Whether a component is an actuator; one whose operations the task uses acts on, for those that call it.

        One that is advertised no more, as its site has gone, counts as an actuator if the task uses no output of it.
        """
        found, plan = self._ecology.discovery.found.get(component), self._state().plan
        if plan is None or component not in plan.inputs:
            return found is not None and found.advertisement.profile.is_actuator
        is_last = component in plan.order.actuators
        return is_last and (found is None or found.advertisement.profile.is_actuator)

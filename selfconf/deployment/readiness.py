"""How a task that runs is ready for a failure: what may come next is listened to, and one failure is gone through.

The first failure is to be answered as quickly as those after it. The machine is a pure function of values, so it can be
asked what it would do. What Python makes ready the first time that it does so is made ready then, and not while a robot
waits.
"""

from __future__ import annotations

from selfconf.bus.timer import Timer
from selfconf.configurator import Failed, Phase, State, step
from selfconf.deployment.components import TaskComponents
from selfconf.deployment.task_context import TaskContext
from selfconf.model.run_event import ComponentLost
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.messages import Cause, Fail

APPEARED_TOGETHER = 0.3
"""Seconds for which what appears while a task runs is gathered, before it is found out what may come next."""
TIMES = 4
"""How often a failure is gone through: what has run a few times is compiled for what it was run with."""


class Readiness:
    """Keeps one task ready for a failure."""

    def __init__(self, context: TaskContext, components: TaskComponents) -> None:
        self._bus, self._state, self._request = context.ecology.bus, context.state, context.request
        self._components = components
        self.prepare_soon = Timer(context.ecology.bus, APPEARED_TOGETHER, self.prepare)
        """Makes it ready with all that has appeared for a while, as a process may hold many components."""

    def prepare(self) -> None:
        """Have the inputs of what runs listen to what may feed them next, and go through a failure."""
        state, configuration = self._state(), self._state().target
        if state.phase is not Phase.RUNNING or configuration is None:
            return

        def work() -> None:
            standby = self._request.composer.standby(configuration, frozenset(state.lost))

            def send() -> None:
                now = self._state()
                if now.epoch == state.epoch and now.phase is Phase.RUNNING and not self._components.reachability.unsure:
                    self._components.calls.stand_by(configuration, standby)
                    sources = {wire.component for some in standby.values() for wires in some.values() for wire in wires}
                    self._components.liveness.select(sources, lambda: None)

            self._bus.wake_up(send)
            warm_up_failure(state)

        self._request.aside(work)


def warm_up_failure(state: State) -> None:
    """Go through the failure of the first component that is held, as far as nothing is done about it."""
    for component, held in [*state.held.items()][:1] * TIMES:
        said = Fail(component, held.life, state.epoch, Cause.FAIL, "supposed")
        heard = decode(encode(said), Fail)
        step(state, Failed(heard.component, heard.life, heard.cause, heard.detail))
        ComponentLost(component, heard.cause.value, heard.detail)

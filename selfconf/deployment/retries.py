"""When lost components are tried again that may be able by now.

A task that waits tries all of them, and searches again where the time of a search was up: the program may have had much
else to do. Nothing tells that a component which has raised FAIL could go on by now, as a tracker that sees its person
again. So a task that changes for the better tries it from time to time, while what runs instead of it runs on.
"""

from __future__ import annotations

import math

from selfconf.bus.growing_pause import GrowingPause
from selfconf.bus.timer import Timer
from selfconf.configurator import Appeared, Loss, Phase
from selfconf.deployment.components import HeldLives
from selfconf.deployment.task_context import TaskContext
from selfconf.model.refusal import Undecided
from selfconf.model.term import IRI
from selfconf.protocol.messages import Cause

TRY_AGAIN = 5.0
"""After how many seconds lost components are tried again; the pause doubles each time."""
LONGEST_PAUSE = 60.0
"""The longest such pause, in seconds."""


class _Retries:
    """What one task tries again, at intervals that double."""

    def __init__(self, context: TaskContext, lives: HeldLives) -> None:
        self._bus, self._ecology, self._lives = context.ecology.bus, context.ecology, lives
        self._state, self._step = context.state, context.step
        self._pause = GrowingPause(TRY_AGAIN, LONGEST_PAUSE)

    def _may_be_able(self, component: IRI, loss: Loss) -> bool:
        """Whether a component lives, or its site can start it, and it obeys what it received last."""
        if component in self._lives.out_of_control(self._state().owed) and not loss.busy:
            return False
        found = self._ecology.discovery.found.get(component)
        return self._ecology.life(component) is not None or (found is not None and found.startable)


class RetriesWhileRefused(_Retries):
    """Tries again, for a task that waits, what it has lost."""

    def __init__(self, context: TaskContext, lives: HeldLives) -> None:
        super().__init__(context, lives)
        self._timer = Timer(self._bus, TRY_AGAIN, self._try_again)
        self._at: float | None = None
        """When it is tried again, which may be overdue; None: no time is set."""

    def appeared(self) -> None:
        """Try again soon, as something has appeared in the ecology; what is tried again has not come from outside."""
        if self._at is not None:
            self._pause.begin_anew()
            self._at = min(self._at, self._bus.now() + TRY_AGAIN)

    def runs(self) -> None:
        """Begin with a short pause when the task is refused next, as it runs now."""
        self._pause.begin_anew()
        self._at = None

    def plan(self) -> None:
        """Set the time; one that is set stays, as a site that is silent is asked often."""
        now = self._bus.now()
        if self._at is None:
            self._at = now + self._pause.seconds
        self._timer.reset(max(0.0, self._at - now))

    def _try_again(self) -> None:
        """While the task is refused, try what may act by now, and a search that time ended."""
        state = self._state()
        if state.phase is not Phase.REFUSED:
            return  # it is overdue when the task is refused again
        self._at = None
        if state.lost or (isinstance(state.refusal, Undecided) and state.refusal.seconds is not None):
            self._pause.tried()
            self._step(Appeared({one: "" for one, loss in state.lost.items() if self._may_be_able(one, loss)}))
        else:
            self.plan()


class RetriesWhileRunning(_Retries):
    """Tries again, for a task that runs and may change for the better, what has raised FAIL."""

    def __init__(self, context: TaskContext, lives: HeldLives) -> None:
        super().__init__(context, lives)
        self._timer = Timer(self._bus, TRY_AGAIN, self._try_again)
        self._tried_at = -math.inf
        """When that was done last, or was to be done."""

    def plan(self) -> None:
        """Set the time, if something has raised FAIL and none is set."""
        if self._timer.is_set or all(loss.cause is not Cause.FAIL for loss in self._state().lost.values()):
            return
        self._pause.failed_after(self._bus.now() - self._tried_at)
        self._timer.set(self._pause.seconds)

    def _try_again(self) -> None:
        """Count what has raised FAIL as able again; it takes the place of nothing before it delivers.

        What has not come to rest yet, or cannot be had otherwise, is looked at again after the next pause.
        """
        if self._state().phase is not Phase.RUNNING:
            return
        if able := self._failed():
            self._step(Appeared(able))
        self._pause.tried()
        self._tried_at = self._bus.now()
        self.plan()

    def _failed(self) -> dict[IRI, str]:
        """The components that have raised FAIL and live on, as those that appear: in whatever life.

        Of a composite its site tells by another life that it can be something inside again.
        """
        found = self._ecology.discovery.found
        return {
            component: ""
            for component, loss in self._state().lost.items()
            if loss.cause is Cause.FAIL and self._may_be_able(component, loss)
            if component in found and found[component].advertisement.profile.inside is None
        }

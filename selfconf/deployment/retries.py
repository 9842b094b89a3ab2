"""When a task looks again: one that waits, at lost components; one that runs, at what would be rather had."""

from __future__ import annotations

from functools import partial

from selfconf.bus.port import Undo
from selfconf.configurator import Appeared, Improvable, Loss, Phase
from selfconf.deployment.components import HeldLives
from selfconf.deployment.task_context import TaskContext
from selfconf.model.term import IRI

TRY_AGAIN = 5.0
"""After how many seconds a patient configurator that waits tries lost components again; the pause doubles each time."""
LONGEST_PAUSE = 60.0
"""The longest such pause, in seconds."""
LET_GO_OF = 10.0
"""After how many seconds a task that may change for the better looks again whether another has let go of something,
which tells only tasks that wait."""


class Retries:
    """The timers by which the configurator of one task looks again, which feed its machine."""

    def __init__(
        self,
        task: TaskContext,
        lives: HeldLives,
        upgrade: float | None,
    ) -> None:
        """`upgrade`: after how many seconds what has appeared may be rather had; None: what runs is kept."""
        self._bus, self._ecology, self._lives = task.ecology.bus, task.ecology, lives
        self._state, self._step, self._upgrade = task.state, task.step, upgrade
        self._look_again: Undo = lambda: None
        self._pause = TRY_AGAIN
        self._chance_at: float | None = None
        """When lost components are tried again, which may be overdue; None: no time is set."""
        self._improve: Undo = lambda: None
        self._improve_later: Undo = lambda: None

    def appeared(self) -> None:
        """Try lost components again soon, as something has appeared in the ecology."""
        self._pause = TRY_AGAIN
        if self._chance_at is not None:
            self._chance_at = min(self._chance_at, self._bus.now() + TRY_AGAIN)

    def runs(self) -> None:
        """Begin with a short pause when the task is refused next, as it runs now."""
        self._pause, self._chance_at = TRY_AGAIN, None

    def settle(self) -> None:
        """Look, after a while, whether what has appeared would be rather had; each time anew, so that it settles."""
        if self._upgrade is not None:
            self._improve()
            self._improve = self._bus.later(self._upgrade, partial(self._step, Improvable()))

    def look_whether_free(self) -> None:
        """Look again, after a while, for what would be rather had: only tasks that wait hear that it is free."""
        self._improve_later()
        if self._upgrade is not None:
            self._improve_later = self._bus.later(LET_GO_OF, partial(self._step, Improvable()))

    def await_another_chance(self) -> None:
        """Set the time to try lost components again; one that is set stays, as a site that is silent is asked often."""
        now = self._bus.now()
        if self._chance_at is None:
            self._chance_at = now + self._pause
            self._pause = min(2 * self._pause, LONGEST_PAUSE)
        self._look_again()
        self._look_again = self._bus.later(max(0.0, self._chance_at - now), self._forgive)

    def _forgive(self) -> None:
        """While the task is refused, try lost components again that may be able to act by now."""
        if self._state().phase is not Phase.REFUSED:
            return  # it is overdue when the task is refused again
        self._chance_at = None
        again = {component: "" for component, loss in self._state().lost.items() if self._may_be_able(component, loss)}
        if again or self._state().lost:
            pause = self._pause
            self._step(Appeared(again))
            self._pause = pause  # what has not come from outside is no reason to try again sooner
        else:
            self.await_another_chance()

    def _may_be_able(self, component: IRI, loss: Loss) -> bool:
        """Whether a component lives, or its site can start it, and it obeys what it received last."""
        if component in self._lives.out_of_control(self._state().owed) and not loss.busy:
            return False
        found = self._ecology.discovery.found.get(component)
        return self._ecology.life(component) is not None or (found is not None and found.startable)

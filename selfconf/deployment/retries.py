"""When a task looks again: one that waits, at lost components; one that runs, at what would be rather had.

A task that waits as the time of a search was up searches again: the program may have had much else to do.
Nothing tells that a component which has raised FAIL could go on by now, as a tracker that sees its person again. So a
task that changes for the better tries it again from time to time, while what runs instead of it runs on.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

from selfconf.bus.port import Undo
from selfconf.configurator import Appeared, Improvable, Loss, Phase
from selfconf.deployment.components import HeldLives
from selfconf.deployment.task_context import TaskContext
from selfconf.model.refusal import Undecided
from selfconf.model.term import IRI
from selfconf.protocol.messages import Cause

TRY_AGAIN = 5.0
"""After how many seconds lost components are tried again, by a task that waits or one that changes for the better; the
pause doubles each time."""
LONGEST_PAUSE = 60.0
"""The longest such pause, in seconds."""
MOST_UNREST = 4
"""How many times as long as that takes at most what has appeared has to settle, while something comes all the time."""
LET_GO_OF = 10.0
"""After how many seconds a task that may change for the better looks again whether another has let go of something,
which tells only tasks that wait."""


class Retries:
    """The timers by which the configurator of one task looks again, which feed its machine."""

    def __init__(
        self,
        context: TaskContext,
        lives: HeldLives,
        upgrade: float | None,
    ) -> None:
        """`upgrade`: after how many seconds what has appeared may be rather had; None: what runs is kept."""
        self._bus, self._ecology, self._lives = context.ecology.bus, context.ecology, lives
        self._state, self._step, self._upgrade = context.state, context.step, upgrade
        self._look_again: Undo = lambda: None
        self._pause = TRY_AGAIN
        self._chance_at: float | None = None
        """When lost components are tried again, which may be overdue; None: no time is set."""
        self._improve: Undo = lambda: None
        self._improve_by: float | None = None
        """When it is checked at the latest whether what has appeared would be rather had; None: it is not planned."""
        self._unsettled: dict[IRI, float] = {}
        """The components that have appeared of late, each with when it will have been there for long enough."""
        self._improve_later: Undo = lambda: None
        self._recovery_pause = TRY_AGAIN
        self._awaits_recovery = False
        """Whether it is set when what has raised FAIL is tried again."""
        self._tried_at = -math.inf
        """When that was done last, or was to be done."""

    def appeared(self) -> None:
        """Let a task that waits try lost components again soon, as something has appeared in the ecology."""
        self._pause = TRY_AGAIN
        if self._chance_at is not None:
            self._chance_at = min(self._chance_at, self._bus.now() + TRY_AGAIN)

    def runs(self) -> None:
        """Begin with a short pause when the task is refused next, as it runs now."""
        self._pause, self._chance_at = TRY_AGAIN, None

    def settle(self, appeared: Iterable[IRI] = ()) -> None:
        """Look, after a while, whether what has appeared would be rather had; each time anew, so that it settles.

        Not forever: in a large ecology there is always something that comes.
        """
        if self._upgrade is None:
            return
        now = self._bus.now()
        self._unsettled |= dict.fromkeys(appeared, now + self._upgrade)
        if self._improve_by is None:
            self._improve_by = now + MOST_UNREST * self._upgrade
        self._look_for_better_in(min(self._upgrade, self._improve_by - now))

    def _look_for_better_in(self, seconds: float) -> None:
        self._improve()
        self._improve = self._bus.later(max(0.0, seconds), self._look_for_better)

    def _look_for_better(self) -> None:
        """Look at what has been there for long enough, and at the rest once it has."""
        now, self._improve_by = self._bus.now(), None
        self._unsettled = {component: until for component, until in self._unsettled.items() if until > now}
        self._step(Improvable(frozenset(self._unsettled)))
        if self._unsettled:
            assert self._upgrade is not None
            self._improve_by = min(self._unsettled.values()) + (MOST_UNREST - 1) * self._upgrade
            self._look_for_better_in(max(self._unsettled.values()) - now)

    def look_whether_free(self) -> None:
        """Look again, after a while, for what would be rather had: only tasks that wait hear that it is free."""
        self._improve_later()
        if self._upgrade is not None:
            self._improve_later = self._bus.later(LET_GO_OF, self._look_for_better)

    def await_recovery(self) -> None:
        """While the task runs, set the time to try again what has raised FAIL, if it may change for the better."""
        if self._upgrade is None or self._awaits_recovery:
            return
        if not any(loss.cause is Cause.FAIL for loss in self._state().lost.values()):
            return
        if self._bus.now() - self._tried_at > LONGEST_PAUSE:  # all was well meanwhile
            self._recovery_pause = TRY_AGAIN
        self._awaits_recovery = True
        self._bus.later(self._recovery_pause, self._recovered)

    def _recovered(self) -> None:
        """Count what has raised FAIL as able again; it takes the place of nothing before it delivers.

        What has not come to rest yet, or cannot be had otherwise, is looked at again after the next pause.
        """
        self._awaits_recovery = False
        if self._state().phase is not Phase.RUNNING:
            return
        if able := self._failed():
            self._step(Appeared(able))
        self._recovery_pause, self._tried_at = min(2 * self._recovery_pause, LONGEST_PAUSE), self._bus.now()
        self.await_recovery()

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

    def await_another_chance(self) -> None:
        """Set the time to try lost components again; one that is set stays, as a site that is silent is asked often."""
        now = self._bus.now()
        if self._chance_at is None:
            self._chance_at = now + self._pause
            self._pause = min(2 * self._pause, LONGEST_PAUSE)
        self._look_again()
        self._look_again = self._bus.later(max(0.0, self._chance_at - now), self._forgive)

    def _forgive(self) -> None:
        """While the task is refused, try lost components again that may act by now, and a search that time ended."""
        if self._state().phase is not Phase.REFUSED:
            return  # it is overdue when the task is refused again
        self._chance_at = None
        again = {component: "" for component, loss in self._state().lost.items() if self._may_be_able(component, loss)}
        refusal = self._state().refusal
        hurried = isinstance(refusal, Undecided) and refusal.seconds is not None  # there may have been much else to do
        if again or self._state().lost or hurried:
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

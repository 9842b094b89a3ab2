"""Looks at what runs: a component may have let go of its task, failed or changed, unnoticed."""

from __future__ import annotations

from functools import partial

from selfconf.configurator import Failed, Phase, Reconnected
from selfconf.deployment.components.calls import Calls
from selfconf.deployment.components.reachability import Reachability
from selfconf.deployment.task_context import TaskContext
from selfconf.model.term import IRI
from selfconf.protocol.messages import CallAnswer, Cause

AUDIT = 1.0
"""Seconds between two audits."""
AUDITED = 20
"""How many components are asked in one audit; they take turns."""
SILENT_AUDITS = 3
"""How many audits in a row a component may leave unanswered; each waits for as long as a call."""


class Audits:
    """Looks again and again at the components that run for one task."""

    def __init__(self, context: TaskContext, calls: Calls, reachability: Reachability) -> None:
        self._bus, self._calls, self._reachability = context.ecology.bus, calls, reachability
        self._state, self._step, self._identity = context.state, context.step, context.identity
        self._audited = 0
        self._silences: dict[IRI, tuple[str, int]] = {}
        """How often in a row each component has not answered an audit, and in which life."""
        self.dropped: dict[IRI, int] = {}
        """How many signals each component has passed over because its code was too slow, when it was asked last."""

    def go_on(self) -> None:
        """Ask some of the components that run, in turns, whether they act for this task; again, until it has ended."""
        if self._state().ended:
            return
        self._bus.later(AUDIT, self.go_on)
        held = [component for component, one in self._state().held.items() if one.confirmed]
        if not self._runs_undisturbed(self._state().epoch) or not held:
            return
        for number in range(self._audited, self._audited + min(AUDITED, len(held))):
            component = held[number % len(held)]
            self._calls.look(component, partial(self._judge, component, self._state().epoch), 1)
        self._audited = (self._audited + AUDITED) % len(held)

    def _judge(self, component: IRI, epoch: int, answer: CallAnswer | None) -> None:
        """Judge a component that should act: one that has failed is lost, one that has let go is applied to anew.

        To one behind which others stand than was known, the rest is connected anew.
        """
        held = self._state().held.get(component)
        if held is None or not self._runs_undisturbed(epoch):
            return
        if answer is None or answer.life != held.life:  # what another process answers says nothing of the one that acts
            life, before = self._silences.get(component, (held.life, 0))
            silences = before + 1 if life == held.life else 1
            self._silences[component] = held.life, silences
            if silences >= SILENT_AUDITS:
                self._step(Failed(component, held.life, Cause.HUNG, "it lives, but answers no question"))
            return
        self._silences.pop(component, None)
        self.dropped[component] = answer.dropped
        if answer.task != self._identity().task:
            self._calls.forget_connections()
            self._step(Reconnected())
        elif not answer.active:
            self._step(Failed(component, answer.life, Cause.FAIL, "it does not act any more"))
        else:
            self._calls.heed_ends(component, answer)  # its notice that others stand behind it may have been lost

    def _runs_undisturbed(self, epoch: int) -> bool:
        """Whether the configuration of an epoch runs, and this node is not, and was not just now, cut off."""
        state = self._state()
        return self._reachability.undisturbed and state.phase is Phase.RUNNING and state.epoch == epoch

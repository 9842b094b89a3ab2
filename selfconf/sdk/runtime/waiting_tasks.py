"""The tasks that wait for a component which others hold: it is offered to them, and taken for them where it must be.

A component that has become free is kept for `OFFER` for the first that waits, then for the next. For a task of higher
priority those that hold it are asked to yield, and lose it where they have not let go of it within `YIELDING`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from selfconf.bus.port import Publisher, Undo, Urgency
from selfconf.bus.timer import Timer
from selfconf.protocol import activation as table
from selfconf.protocol.activation import Activation
from selfconf.protocol.codec import encode
from selfconf.protocol.keys import task_name
from selfconf.protocol.messages import Free
from selfconf.sdk.component_context import ComponentContext

OFFER = 0.2
"""Seconds for which a component that has become free is kept for the task that has waited for it first."""
YIELDING = 2.0
"""Seconds that a task has to let go of a component that a task of higher priority asks for."""


class WaitingTasks:
    """Deals with the tasks that an activation says wait for one life of a component."""

    def __init__(
        self,
        context: ComponentContext,
        become: Callable[[Activation], None],
        ask_holder: Callable[[str, str], None],
        let_go: Callable[[Sequence[str], str], None],
    ) -> None:
        """`become` has the component kept for a task.

        `ask_holder` asks a task that holds it to yield, and says why; `let_go` takes it from some tasks.
        """
        self._bus, self._keys = context.bus, context.keys
        self._component, self._life = context.profile.component, context.life
        self._activation, self._become, self._ask_holder, self._let_go = context.activation, become, ask_holder, let_go
        self._closed = False
        self._end_of_offer: Undo = lambda: None
        """Undoes the end of the last offer."""
        self._free: Publisher | None = None
        """What tells tasks that wait for the component that it is free, once one has waited."""
        self._preemption = Timer(context.bus, YIELDING, self._preempt)
        """Set while a task of higher priority waits for those that hold the component to yield."""

    def close(self) -> None:
        """Offer the component no more: it leaves the ecology."""
        self._closed = True
        if self._free is not None:
            self._free.undeclare()
            self._free = None

    def ask_to_yield(self) -> None:
        """Tell those that hold the component that a task of higher priority asks for it, each time that it does."""
        activation = self._activation()
        claim = activation.queue.first
        outranked = table.outranked(activation)
        if claim is None or not outranked:
            return
        for task in outranked:
            self._ask_holder(task, f"the task {task_name(claim.task)} of priority {claim.priority} asks for it")
        self._preemption.set()

    def _preempt(self) -> None:
        """Take the component from tasks that have not let go of it in time."""
        outranked = table.outranked(self._activation())
        if outranked:
            self._let_go(outranked, "a task of higher priority asked for it, and this one has not yielded in time")

    def holders_changed(self, activation: Activation) -> None:
        """Take the component from no task, if in that activation those of lower priority have let go of it."""
        if self._preemption.is_set and not table.outranked(activation):
            self._preemption.stop()

    def offer(self) -> None:
        """Keep the component, if it is free, for the first task that waits, and tell it."""
        activation, claim = table.offer(self._activation())
        self._become(activation)
        if claim is not None and not self._closed:
            self.tell(claim.task)
            self._end_of_offer()
            self._end_of_offer = self._bus.later(OFFER, partial(self._withdraw, claim.task))

    def _withdraw(self, task: str) -> None:
        if self._activation().queue.kept_for == task:
            self._become(table.withdraw(self._activation(), task))
            self.offer()

    def tell(self, task: str) -> None:
        """Say that the component is to be had by a task, or with "" by any that would share it."""
        if self._free is None:
            self._free = self._bus.publisher(self._keys.free(self._component), Urgency.EVENT)
        self._free.put(encode(Free(self._component, self._life, task)))

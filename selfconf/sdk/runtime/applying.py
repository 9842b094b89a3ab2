"""How the calls to act are carried out of one component, and what each is answered.

The code begins, or takes what has changed, while its inputs are connected. A call is answered once both is done: by
then the code has started and the inputs do as the call says, or it is known what has kept them from that.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from selfconf.protocol.activation import ActivationPhase
from selfconf.protocol.messages import Apply, Verdict
from selfconf.sdk.component_code import ComponentCode
from selfconf.sdk.component_context import ComponentContext
from selfconf.sdk.inputs import InputFollower
from selfconf.sdk.operations import NeededOperations
from selfconf.sdk.outputs import SIGNALS_FIRST
from selfconf.sdk.runtime.control_calls import CallAnswers, Reply

LIFE_ENDS = "it is leaving the ecology"
"""What a component says that cannot act any more in this life, but does not refuse to."""


@dataclass(slots=True, eq=False)
class _ApplyCall:
    """A call to act that is being carried out, and what answers it."""

    message: Apply
    reply: Reply
    turn: int | None = None
    """The turn of the code that it has begun, if it has: what comes of that is none of a start that has followed."""


class Applying:
    """Carries out the calls to act that one component obeys."""

    def __init__(
        self,
        context: ComponentContext,
        code: ComponentCode,
        inputs: InputFollower,
        needed_operations: NeededOperations,
        answers: CallAnswers,
        not_begun: Callable[[str], None],
    ) -> None:
        """`not_begun` hears of a task for which the component was to begin to act, and has not."""
        self._bus, self._activation = context.bus, context.activation
        self._code, self._inputs, self._needed_operations = code, inputs, needed_operations
        self._answers, self._not_begun = answers, not_begun
        self._closed = False
        self.failure = ""
        """Why the component has failed the last time."""
        self._after_start: list[Callable[[str | None], None]] = []
        """What waits for the code to have started."""

    def close(self) -> None:
        """Say from now on of what cannot be done that the component leaves the ecology."""
        self._closed = True

    def apply(self, message: Apply, reply: Reply, *, starts: bool) -> None:
        """Have the code start, or take what has changed, and connect the inputs meanwhile."""
        call = _ApplyCall(message, reply)
        if starts:
            self._after_start = [partial(self._settle, call)]
            self._code.start(message.values, partial(self._started, self._after_start))
            call.turn = self._code.turn
        elif self._after_start:  # it is still starting, for an earlier call
            self._after_start.append(partial(self._change, call))
        else:
            self._change(call, None)
        self.follow(message)

    def follow(self, message: Apply) -> None:
        """Follow and call what a call to act names."""
        self._inputs.follow(message)
        self._needed_operations.follow(message)

    def _started(self, waiting: list[Callable[[str | None], None]], trouble: str | None) -> None:
        if self._after_start is waiting:
            self._after_start = []
        for answer in waiting:
            answer(trouble)

    def _change(self, call: _ApplyCall, trouble: str | None) -> None:
        """Have the code that has started, unless there was trouble, take what has changed."""
        if trouble is None and self._activation().hold(call.message.task) is not None:
            self._code.change(call.message.values, partial(self._settle, call))
        else:
            self._settle(call, trouble)

    def _settle(self, call: _ApplyCall, trouble: str | None) -> None:
        """Answer a call once the inputs do as it says."""

        def settled() -> None:
            # Once more: what the call has said may have had the inside of a composite begin anew.
            self._bus.later(SIGNALS_FIRST, lambda: self._inputs.when_settled(partial(self._answer, call, trouble)))

        self._inputs.when_settled(settled)

    def _answer(self, call: _ApplyCall, trouble: str | None) -> None:
        """Answer a call by what has come of it; what was to begin for it and has not does so for no task."""
        task = call.message.task
        if trouble is None and self._activation().hold(task) is None:
            trouble = "it was turned off again"
        if trouble is None and not self._inputs.settled:  # the inside of a composite has been refused
            trouble = self.failure
        if trouble is None:
            call.reply(self._answers.answer(Verdict.DONE, task))
        elif self._closed:
            call.reply(self._answers.answer(Verdict.OTHER_LIFE, task, LIFE_ENDS))
        else:
            if call.turn == self._code.turn and self._activation().phase is not ActivationPhase.FAILED:
                self._not_begun(task)
            call.reply(self._answers.answer(Verdict.REFUSED, task, trouble))

"""The control calls of one component as they come over the bus: read, checked, handed on to be obeyed, and answered.

What strangers send is refused here, so that only a call that a configurator may make of this life of the component
reaches the table of `selfconf.protocol.activation`. Each answer says what comes of the call, and how things are with
the component.
"""

from __future__ import annotations

import logging
import os
import socket
from collections.abc import Callable

from selfconf.bus.port import Request
from selfconf.errors import PeerError
from selfconf.model.wording import sayable
from selfconf.protocol.activation import Hold
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import call_of, owner_of, task_name
from selfconf.protocol.messages import Apply, CallAnswer, Claim, Release, Reserve, StateOf, Verdict
from selfconf.sdk.component_code import ComponentCode
from selfconf.sdk.component_context import ComponentContext
from selfconf.sdk.inputs import InputFollower
from selfconf.sdk.outputs import Outputs
from selfconf.termination import resident_memory

log = logging.getLogger(__name__)

_MESSAGES: dict[str, type[Reserve] | type[Apply] | type[Release]] = {
    "reserve": Reserve,
    "apply": Apply,
    "release": Release,
}
"""The message that each call carries, apart from `state`, which may carry a `StateOf`."""
Reply = Callable[[CallAnswer], None]


class CallAnswers:
    """Makes the answers of one component from what its parts say at the moment; it changes none of them."""

    def __init__(
        self,
        context: ComponentContext,
        stopping: Callable[[], bool],
        code: ComponentCode,
        inputs: InputFollower,
        outputs: Outputs,
    ) -> None:
        """`stopping` tells whether the component comes to rest.

        Its age is counted from here on.
        """
        self._bus, self._component, self._life = context.bus, context.profile.component, context.life
        self._activation, self._stopping = context.activation, stopping
        self._code, self._inputs, self._outputs = code, inputs, outputs
        self._began = context.bus.now()

    def answer(
        self, verdict: Verdict, task: str, detail: str = "", *, measured: bool = False, by: Hold | None = None
    ) -> CallAnswer:
        """The answer with a verdict; it says how things are with the component for a task, else for its holder.

        `measured`: also how old the component is, what memory it takes, and how much it has issued. `by` is the hold
        that is in the way of a call.
        """
        activation = self._activation()
        own = activation.hold(task)
        hold = by if verdict is Verdict.BUSY else own or activation.first
        claim: Claim = hold.claim if hold is not None else Claim(0, "")
        return CallAnswer(
            verdict,
            self._component,
            self._life,
            activation.epoch_of(task),
            self._code.started and self._inputs.settled and hold is not None and hold.active,
            sayable(detail),
            claim.supervisor,
            claim.task,
            claim.priority,
            claim.beginning,
            f"process {os.getpid()} on {socket.gethostname()}",
            self._inputs.dropped,
            self._bus.now() - self._began if measured else 0.0,
            resident_memory() if measured else 0,
            self._outputs.issued if measured else {},
            outputs=self._inputs.issued,
            callers=self._inputs.callers,
            patience=self._inputs.patience,
            stopping=self._stopping(),
            shared=own is not None
            and own.active
            and (verdict is Verdict.BUSY or (measured and self._acts_beside(own))),
        )

    def _acts_beside(self, own: Hold) -> bool:
        """Whether the component acts for other tasks than that of a hold."""
        return any(hold.active and hold is not own for hold in self._activation().holds)

    def busy(self, call: Claim, by: Hold | None) -> CallAnswer:
        """The answer that another task is in the way: by that hold, or one for which the component is kept."""
        claim = by.claim if by is not None else self._activation().queue.kept
        if claim is None:
            return self.answer(Verdict.BUSY, call.task, "it is free, and tells so")
        who = f"the task {task_name(claim.task)} (priority {claim.priority}, configurator {owner_of(claim.supervisor)})"
        return self.answer(Verdict.BUSY, call.task, f"{who} holds it", by=by)


class ControlCalls:
    """Serves the control calls of a component, until it is closed."""

    def __init__(
        self,
        context: ComponentContext,
        answers: CallAnswers,
        obey: Callable[[Reserve | Apply | Release, Reply], None],
    ) -> None:
        """`obey` replies once a call is carried out. It raises PeerError where too many calls wait for that."""
        self._keys, self._profile, self._life = context.keys, context.profile, context.life
        self._answers, self._obey = answers, obey
        self.close = context.bus.serve(self._keys.call(self._profile.component), self.receive)

    def receive(self, request: Request) -> None:
        """Answer one request of the bus."""
        call = call_of(request.key)

        def reply(answer: CallAnswer) -> None:
            request.reply(self._keys.call(self._profile.component, call), encode(answer))
            request.finish()

        try:
            self.answer(call, request.payload, reply)
        except PeerError as error:
            log.warning("%s: refused a call: %s", self._profile.component.short, error)
            request.refuse(str(error))
            request.finish()

    def answer(self, call: str, payload: bytes, reply: Reply) -> None:
        """Have a call obeyed, if it can be, and reply when that is done. Raises PeerError for one that cannot be."""
        if call == "state":
            task = decode(payload, StateOf).task if payload else ""
            reply(self._answers.answer(Verdict.DONE, task, measured=True))
            return
        if call not in _MESSAGES:
            raise PeerError(f"there is no call {call!r}")
        message: Reserve | Apply | Release = decode(payload, _MESSAGES[call])
        if not message.task:
            raise PeerError(f"{call!r} names no task: the program that calls speaks an older protocol; update it")
        if not isinstance(message, Release):
            unknown = sorted(set(message.inputs) - {port.name for port in self._profile.inputs})
            if unknown:
                reply(self._answers.answer(Verdict.REFUSED, message.task, f"it has no input {unknown[0]!r}"))
                return
            if not self._keys.is_configurator_life(message.supervisor):
                raise PeerError(f"{message.supervisor!r} is no life of a configurator")
        if message.life not in ("", self._life):
            reply(self._answers.answer(Verdict.OTHER_LIFE, message.task))
        else:
            self._obey(message, reply)

"""The control calls of one component as they come over the bus: read, checked, and handed on to be obeyed.

What strangers send is refused here, so that only a call that a configurator may make of this life of the component
reaches the table of `selfconf.protocol.activation`.
"""

from __future__ import annotations

import logging
from collections.abc import Callable

from selfconf.bus.port import Bus, Request
from selfconf.errors import PeerError
from selfconf.model.profile import Profile
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import Keys, call_of
from selfconf.protocol.messages import Apply, CallAnswer, Release, Reserve, StateOf, Verdict
from selfconf.sdk.runtime.call_answers import CallAnswers

log = logging.getLogger(__name__)

_MESSAGES: dict[str, type[Reserve] | type[Apply] | type[Release]] = {
    "reserve": Reserve,
    "apply": Apply,
    "release": Release,
}
"""The message that each call carries, apart from `state`, which may carry a `StateOf`."""
Reply = Callable[[CallAnswer], None]


class ControlCalls:
    """Serves the control calls of a component, until it is closed."""

    def __init__(
        self,
        bus: Bus,
        keys: Keys,
        profile: Profile,
        life: str,
        answers: CallAnswers,
        obey: Callable[[Reserve | Apply | Release, Reply], None],
    ) -> None:
        """`obey` replies once a call is carried out. It raises PeerError where too many calls wait for that."""
        self._keys, self._profile, self._life, self._answers = keys, profile, life, answers
        self._obey = obey
        self.close = bus.serve(keys.call(profile.component), self.receive)

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

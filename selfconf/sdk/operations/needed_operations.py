"""The operations that a component needs: the component that is connected to each is called, once, by its key."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from numbers import Real
from typing import Any

from selfconf.bus.port import Replies
from selfconf.errors import PeerError, ProgrammerError
from selfconf.model.profile import CALL_MARK
from selfconf.model.term import IRI
from selfconf.protocol.messages import Apply, Wires
from selfconf.sdk.component import CallStatus, Response
from selfconf.sdk.component_code import ComponentCode
from selfconf.sdk.component_context import ComponentContext
from selfconf.sdk.operations.operation_signals import (
    LONGEST_PATIENCE,
    MOST_CALLS,
    MOST_PAYLOAD,
    NotOfItsTypeError,
    OperationSignals,
    operation_fields,
    read_signal,
)
from selfconf.sdk.payloads import UnsayableError


class NeededOperations:
    """The operations that one component needs in one life."""

    def __init__(self, context: ComponentContext, signals: OperationSignals, code: ComponentCode) -> None:
        self._bus, self._keys, self._thread, self._profile = context.bus, context.keys, context.thread, context.profile
        self._signals, self._code, self._malformed = signals, code, context.malformed
        self._needed = operation_fields(context.profile.needed_operations, context.fields)
        self._wires: Wires = {}
        self._calls = 0
        """How many calls wait for their answers."""

    def follow(self, message: Apply) -> None:
        """Call from now on what a call of the configurator names."""
        before, self._wires = (
            self._wires,
            {
                port.removesuffix(CALL_MARK): wires
                for port, wires in message.inputs.items()
                if port.endswith(CALL_MARK) and wires
            },
        )
        for name in sorted(before.keys() ^ self._wires.keys()):
            self._code.connection_changed(name, name in self._wires)

    def say_again(self) -> None:
        """Tell the component what is connected: its code has been started again."""
        for name in sorted(self._wires):
            self._code.connection_changed(name, True)

    def end(self) -> None:
        """Call nothing."""
        self._wires = {}

    def call(
        self, name: str, value: Any, seconds: float, answered: Callable[[Response], None], media: str = ""
    ) -> None:
        """Ask for an operation; may be called from any thread. The answer is heard on the thread of the code.

        Raises ProgrammerError for an operation that is not advertised, for what no request can carry, for a time in
        which no answer can come, and for what cannot be called with it.
        """
        who = self._profile.component.short
        if name not in self._needed:
            raise ProgrammerError(f"{who} advertises no need of an operation {name!r}")
        if not isinstance(seconds, Real) or not seconds > 0.0:
            raise ProgrammerError(f"`call` waits for more than zero seconds, not {seconds!r}")
        if not callable(answered):
            raise ProgrammerError(
                f"`answered` is a function that takes the answer, such as self.heard, not {answered!r}"
            )
        if not self._code.active:
            return
        try:
            request = self._signals.request(value, self._needed[name].request, media)
        except NotOfItsTypeError as error:
            self._malformed(f"what it sends along with {name!r} {error}")
            return
        except UnsayableError as error:
            raise ProgrammerError(f"{who} cannot send that along with {name!r}: it {error}") from None
        hear = partial(self._heard, self._code.stint, answered)
        self._code.run_on_bus(self._ask, name, request, min(seconds, LONGEST_PATIENCE), hear)

    def _ask(self, name: str, request: bytes, seconds: float, hear: Callable[[Response], None]) -> None:
        wire = next(iter(self._wires.get(name, ())), None)
        if wire is None:
            hear(Response(CallStatus.NOT_CONNECTED, detail=f"no component is connected to {name!r}"))
            return
        if self._calls >= MOST_CALLS:
            hear(Response(CallStatus.REFUSED, detail=f"{MOST_CALLS} calls wait for their answers already"))
            return
        self._calls += 1

        def done(replies: Replies) -> None:
            self._calls -= 1
            hear(_answer(wire.component, replies, seconds))

        key = self._keys.operation(wire.component, wire.output.removesuffix(CALL_MARK), self._profile.component)
        self._bus.ask(key, request, seconds, done, f"{seconds:g}".encode())

    def _heard(self, stint: tuple[int, int], answered: Callable[[Response], None], answer: Response) -> None:
        self._thread.signal(partial(self._code.answered, stint, partial(answered, answer)))


def _answer(component: IRI, replies: Replies, seconds: float) -> Response:
    """What has become of a call to a component."""
    for sample in replies.samples[:1]:
        if len(sample.payload) > MOST_PAYLOAD:
            detail = f"its answer has {len(sample.payload)} bytes, and {MOST_PAYLOAD} are allowed"
            return Response(CallStatus.REFUSED, source=component, detail=detail)
        try:
            _, signal = read_signal(sample.attachment, sample.payload)
        except (PeerError, ValueError, RecursionError) as error:
            return Response(CallStatus.REFUSED, source=component, detail=f"what it answers is no answer: {error}")
        if signal.source == component:
            return Response(CallStatus.ANSWERED, signal.value, component)
        detail = f"what it answers is no answer: it is one of {signal.source.short}"
        return Response(CallStatus.REFUSED, source=component, detail=detail)
    if replies.errors:
        return Response(CallStatus.REFUSED, source=component, detail=replies.errors[0])
    if not replies.complete:
        detail = f"{component.short} has not answered within {seconds:g} s"
        return Response(CallStatus.LATE, source=component, detail=detail)
    return Response(CallStatus.GONE, source=component, detail=f"{component.short} ended before it answered")

"""The operations of a component: those that others call, and those that it calls itself.

A call is a question on the key of the operation, and its answer the only reply. What is sent along travels as a signal
does, behind the stamp of the caller: the text of the stamp, a line feed, the payload. The answer is a signal of the
component that is called, with its stamp.

*Who may call* is what the configuration says: the components that it has connected to the operation, for the tasks
that the component acts for. Any other is refused. The caller stands in the key of the question as well as in
the stamp, since rules about keys can hold every component to its own name (`selfconf.access.rules`), and none can look
into a stamp.

*At most once.* A call is made once. If it comes to nothing, the caller may not know whether the component was about to
do what it was asked: so it receives what is known, and nothing is repeated on its behalf. A request that comes twice is
served once. One that no caller waits for any more when the code has time for it, or whose caller is connected no more,
is not served at all.

*Later.* The code of a component may return a future in the place of an answer: it then goes on with other things, and
the request is answered when the future comes to something. A future is cancelled when no caller waits for it any more:
the component is stopped, the caller is connected no more, or has waited for as long as it said beside its request.

*Bounds.* A request and an answer have at most `MOST_PAYLOAD` bytes; at most `MOST_CALLS` requests wait for the code of
a component, or for its futures, and at most as many of its own calls for their answers.
"""

from __future__ import annotations

import itertools
import math
import time
from collections import deque
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from dataclasses import dataclass
from functools import partial
from typing import Any

from selfconf.bus.port import Bus, Replies, Request
from selfconf.errors import PeerError, ProgrammerError
from selfconf.model.immutable import immutable, replace
from selfconf.model.profile import CALL_MARK, Input, Output, Profile
from selfconf.model.signal_fields import SignalFields
from selfconf.model.term import IRI
from selfconf.protocol.keys import Keys, component_chunk, operation_of
from selfconf.protocol.messages import Apply, Wire
from selfconf.protocol.stamps import PLAIN, StampReader, StampWriter
from selfconf.sdk.code_thread import CodeThread
from selfconf.sdk.component import CallStatus, Refused, Response, Signal
from selfconf.sdk.component_code import ComponentCode
from selfconf.sdk.payloads import UnsayableError, as_bytes, as_json, read_payload

MOST_PAYLOAD = 1 << 20
"""The most bytes that a request may have, and an answer."""
MOST_CALLS = 64
"""How many requests wait for the code of a component at most, and how many calls of one for their answers."""
LONGEST_PATIENCE = 1e6
"""For how many seconds a caller can say that it waits: more than eleven days."""
MOST_REMEMBERED = 4 * MOST_CALLS
"""Of how many requests it is remembered that they came."""
_END_OF_STAMP = b"\n"


@immutable
class OperationFields:
    """The fields of what an operation takes and of what it answers, as far as their types have some."""

    request: SignalFields | None = None
    response: SignalFields | None = None


@dataclass(slots=True, eq=False)
class _Promise:
    """A future that the code has returned in the place of an answer to one request; it may be that of others, too."""

    future: Future[Any]
    operation: str
    caller: IRI


class Operations:
    """The operations of one component in one life."""

    def __init__(
        self,
        bus: Bus,
        keys: Keys,
        thread: CodeThread,
        profile: Profile,
        life: str,
        code: ComponentCode,
        fields: Mapping[IRI, SignalFields],
        callers: Callable[[str], frozenset[IRI]],
        malformed: Callable[[str], None],
        read_value: Callable[[Any, str], Any],
    ) -> None:
        """`callers` says who may call an operation, by the name of its output.

        `fields` are those of the kinds of requests and responses; `malformed` hears what is wrong with one of them that
        this component has made. `read_value` makes of what is sent along, and its media type, what the code gets.
        """
        self._bus, self._keys, self._thread, self._profile, self._code = bus, keys, thread, profile, code
        self._callers, self._malformed, self._read_value = callers, malformed, read_value
        self._offered = {port.name.removesuffix(CALL_MARK): _fields(port, fields) for port in profile.operations}
        self._needed = {port.name.removesuffix(CALL_MARK): _fields(port, fields) for port in profile.needed_operations}
        self._stamp = StampWriter(profile.component, life)
        self._sequence = itertools.count(1)
        self._wires: Mapping[str, tuple[Wire, ...]] = {}
        self._seen: deque[tuple[IRI, str, int]] = deque(maxlen=MOST_REMEMBERED)
        """The latest requests, by caller, its life, and the number of the stamp: one that is doubled is not served."""
        self._requests = self._calls = 0
        """How many requests wait for the code, and how many calls for their answers."""
        self._promised: set[_Promise] = set()
        self._served = bus.serve(keys.operations(profile.component), self._asked) if self._offered else lambda: None

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

    def callers_changed(self) -> None:
        """Cancel what was promised to components that are connected no more."""
        for promise in list(self._promised):
            if promise.caller not in self._callers(promise.operation + CALL_MARK):
                self._abandon(promise)

    def end(self) -> None:
        """Call nothing, and wait for no answer that the code has promised."""
        self._wires = {}
        for promise in list(self._promised):
            promise.future.cancel()

    def close(self) -> None:
        """Serve nothing any more."""
        self._served()

    # What others ask for.

    def _asked(self, request: Request) -> None:
        """Let the code answer a request, unless there is a reason not to; on the bus's thread."""
        name, caller = operation_of(request.key)
        if name not in self._offered:
            self._refuse(request, f"{self._profile.component.short} offers no operation {name!r}")
            return
        try:
            life, signal = _read_request(request.payload)
            patience = _read_patience(request.attachment)
        except (PeerError, ValueError, RecursionError) as error:
            self._refuse(request, f"not a request: {error}")
            return
        if component_chunk(signal.source) != caller:
            self._refuse(
                request, f"not a request: it is stamped by {signal.source.short}, and asked by another component"
            )
        elif signal.source not in self._callers(name + CALL_MARK):
            self._refuse(request, self._not_connected(name, signal.source))
        elif self._requests >= MOST_CALLS:
            self._refuse(request, f"{self._profile.component.short} is busy: {MOST_CALLS} requests wait for it")
        else:
            self._take(request, name, signal, patience, (signal.source, life, signal.sequence))

    def _take(self, request: Request, name: str, signal: Signal, patience: float, number: tuple[IRI, str, int]) -> None:
        if number in self._seen:
            request.finish()
            return
        self._seen.append(number)
        self._requests += 1
        waits_until = self._bus.now() + (patience or math.inf)
        self._thread.signal(partial(self._serve, request, name, signal, waits_until))

    def _not_connected(self, name: str, caller: IRI) -> str:
        return f"{caller.short} is not connected to the operation {name!r} of {self._profile.component.short}"

    def _serve(self, request: Request, name: str, signal: Signal, waits_until: float) -> None:
        """Have the code answer a request, if it is still wanted; on its thread."""

        def served() -> Any:
            if signal.source not in self._callers(name + CALL_MARK):
                raise Refused(self._not_connected(name, signal.source))
            patience = waits_until - self._bus.now()
            if patience <= 0.0:
                who = self._profile.component.short
                raise Refused(f"{who} was busy for longer than {signal.source.short} waits for {name!r}")
            try:
                value = self._read_value(signal.value, signal.media)
            except ValueError as error:
                raise Refused(f"what is sent along {error}") from None
            turn = self._code.turn
            answer = self._code.serve(name, replace(signal, value=value))
            if isinstance(answer, Future):
                promise = _Promise(answer, name, signal.source)
                self._promised.add(promise)
                answer.add_done_callback(lambda _: self._kept(request, promise, turn))
                if patience < math.inf:
                    self._then(self._limit, promise, max(0.0, waits_until - self._bus.now()))
                if not self._code.active:  # it was stopped while it returned the future
                    answer.cancel()
            return answer

        self._answer(request, name, served)

    def _limit(self, promise: _Promise, seconds: float) -> None:
        """Wait for a future no longer than for a time."""
        undo = self._bus.later(seconds, partial(self._abandon, promise))
        promise.future.add_done_callback(lambda _: self._then(undo))

    def _abandon(self, promise: _Promise) -> None:
        """Wait for a future no more; it is cancelled, unless another request waits for it as well."""
        self._promised.discard(promise)
        if all(other.future is not promise.future for other in list(self._promised)):
            promise.future.cancel()

    def _kept(self, request: Request, promise: _Promise, turn: int) -> None:
        """Answer a request with what a future has come to; on whatever thread it does."""
        self._promised.discard(promise)
        outcome = partial(self._code.outcome, promise.operation, promise.future, turn)
        self._answer(request, promise.operation, outcome, kept=True)

    def _answer(self, request: Request, name: str, answered: Callable[[], Any], kept: bool = False) -> None:
        """Answer a request with a value, or refuse it as `answered` does; nothing yet if the value is a future.

        What a future has come to (`kept`) is the answer, and another future is none.
        """
        try:
            value = answered()
            if isinstance(value, Future) and not kept:
                return
            answer = self._packed(name, value)
        except Refused as refused:
            self._then(self._refuse, request, str(refused) or f"it refuses {name!r}", True)
        else:
            self._then(self._reply, request, *answer)

    def _packed(self, name: str, value: Any) -> tuple[bytes, bytes]:
        """The payload and the stamp of an answer; raises Refused, and FAIL, for what is none."""
        try:
            payload, stamp = self._signal(value, self._offered[name].response)
        except UnsayableError as error:
            self._malformed(f"what it answers to {name!r} {error}")
            raise Refused(f"its answer {error}") from None
        return payload, stamp

    def _reply(self, request: Request, payload: bytes, stamp: bytes) -> None:
        self._requests -= 1
        request.reply(request.key, payload, stamp)
        request.finish()

    def _refuse(self, request: Request, reason: str, waited: bool = False) -> None:
        self._requests -= waited
        request.refuse(reason)
        request.finish()

    def _then(self, action: Callable[..., None], *arguments: Any) -> None:
        """Do something on the bus's thread."""
        if self._thread.inline:
            action(*arguments)
        else:
            self._bus.wake_up(partial(action, *arguments))

    # What this component asks for.

    def call(
        self, name: str, value: Any, seconds: float, answered: Callable[[Response], None], media: str = ""
    ) -> None:
        """Ask for an operation; may be called from any thread. The answer is heard on the thread of the code.

        Raises ProgrammerError for an operation that is not advertised, for what no request can carry, and for a time in
        which no answer can come.
        """
        who = self._profile.component.short
        if name not in self._needed:
            raise ProgrammerError(f"{who} advertises no need of an operation {name!r}")
        if not seconds > 0.0:
            raise ProgrammerError(f"`call` waits for more than zero seconds, not {seconds!r}")
        if not self._code.active:
            return
        try:
            payload, stamp = self._signal(value, self._needed[name].request, media)
        except _NotOfItsTypeError as error:
            self._malformed(f"what it sends along with {name!r} {error}")
            return
        except UnsayableError as error:
            raise ProgrammerError(f"{who} cannot send that along with {name!r}: it {error}") from None
        hear = partial(self._heard, self._code.turn, answered)
        self._then(self._ask, name, stamp + _END_OF_STAMP + payload, min(seconds, LONGEST_PATIENCE), hear)

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

    def _heard(self, turn: int, answered: Callable[[Response], None], answer: Response) -> None:
        self._thread.signal(partial(self._code.answered, turn, partial(answered, answer)))

    def _signal(self, value: Any, fields: SignalFields | None, media: str = "") -> tuple[bytes, bytes]:
        """The payload and the stamp of a value. Raises UnsayableError for one that cannot be sent."""
        packed = as_bytes(value, media)
        problem = None if fields is None else fields.problem_of_bytes() if packed else fields.problem(value)
        if problem is not None:
            raise _NotOfItsTypeError(problem)
        payload, encoding = packed or (as_json(value), PLAIN)
        if len(payload) > MOST_PAYLOAD:
            raise UnsayableError(f"has {len(payload)} bytes, and {MOST_PAYLOAD} are allowed")
        return payload, self._stamp.write(next(self._sequence), time.time(), packed is not None, encoding)


class _NotOfItsTypeError(UnsayableError):
    """A value that is not what its type says."""


def _fields(port: Input | Output, known: Mapping[IRI, SignalFields]) -> OperationFields:
    request, response = (None if one is None else known.get(one) for one in (port.request, port.response))
    return OperationFields(request, response)


def _read_request(text: bytes) -> tuple[str, Signal]:
    """The life of the caller, and what it sends along. Raises PeerError and ValueError for what is no request."""
    stamp, _, payload = text.partition(_END_OF_STAMP)
    if len(payload) > MOST_PAYLOAD:
        raise PeerError(f"a request of {len(payload)} bytes is too large; {MOST_PAYLOAD} are allowed")
    return _read_signal(stamp, payload)


def _read_patience(attachment: bytes) -> float:
    """For how many seconds the caller of a request waits; 0 if it does not say so. Raises ValueError for other text."""
    seconds = float(attachment[:32]) if attachment else 0.0
    if not 0.0 <= seconds <= LONGEST_PATIENCE:
        raise ValueError(f"no caller waits for {seconds:g} s")
    return seconds


def _read_signal(attachment: bytes, payload: bytes) -> tuple[str, Signal]:
    raw, stamp = StampReader().read(attachment)
    value = read_payload(payload, raw, stamp.encoding)
    return stamp.life, Signal(value, stamp.component, stamp.time, stamp.sequence, stamp.encoding.media)


def _answer(component: IRI, replies: Replies, seconds: float) -> Response:
    """What has become of a call to a component."""
    for sample in replies.samples[:1]:
        if len(sample.payload) > MOST_PAYLOAD:
            detail = f"its answer has {len(sample.payload)} bytes, and {MOST_PAYLOAD} are allowed"
            return Response(CallStatus.REFUSED, source=component, detail=detail)
        try:
            _, signal = _read_signal(sample.attachment, sample.payload)
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

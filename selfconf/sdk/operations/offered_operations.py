"""The operations that a component offers to others: who is served, when, and what becomes of a promised answer.

*Who may call* is what the configuration says: the components that it has connected to the operation, for the tasks
that the component acts for. Any other is refused. The caller stands in the key of the question as well as in
the stamp, since rules about keys can hold every component to its own name (`selfconf.access.rules`), and none can look
into a stamp.

*At most once.* A request that comes twice is served once. One that no caller waits for any more when the code has time
for it, or whose caller is connected no more, is not served at all.

*Later.* The code of a component may return a future in the place of an answer: it then goes on with other things, and
the request is answered when the future comes to something. A future is cancelled when no caller waits for it any more:
the component is stopped, the caller is connected no more, or has waited for as long as it said beside its request.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass
from functools import partial
from typing import Any

from selfconf.bus.port import Request
from selfconf.errors import PeerError
from selfconf.model.immutable import replace
from selfconf.model.profile import CALL_MARK
from selfconf.model.term import IRI
from selfconf.protocol.keys import component_chunk, operation_of
from selfconf.sdk.component import Refused, Signal
from selfconf.sdk.component_code import ComponentCode
from selfconf.sdk.component_context import ComponentContext
from selfconf.sdk.operations.operation_signals import (
    LONGEST_PATIENCE,
    MOST_CALLS,
    OperationSignals,
    operation_fields,
    read_request,
)
from selfconf.sdk.payloads import UnsayableError

MOST_REMEMBERED = 4 * MOST_CALLS
"""Of how many requests it is remembered that they came."""


@dataclass(slots=True, eq=False)
class _Promise:
    """A future that the code has returned in the place of an answer to one request; it may be that of others, too."""

    future: Future[Any]
    request: Request
    operation: str
    caller: IRI


class OfferedOperations:
    """The operations that one component offers in one life."""

    def __init__(
        self,
        context: ComponentContext,
        signals: OperationSignals,
        code: ComponentCode,
        callers: Callable[[str], frozenset[IRI]],
    ) -> None:
        """`callers` says who may call an operation, by the name of its output."""
        self._bus, self._thread, self._profile, self._code = context.bus, context.thread, context.profile, code
        self._signals, self._callers, self._malformed = signals, callers, context.malformed
        self._offered = operation_fields(self._profile.operations, context.fields)
        self._seen: deque[tuple[IRI, str, int]] = deque(maxlen=MOST_REMEMBERED)
        """The latest requests, by caller, its life, and the number of the stamp: one that is doubled is not served."""
        self._requests = 0
        """How many requests wait for the code."""
        self._promised: set[_Promise] = set()
        key = context.keys.operations(self._profile.component)
        self._served = self._bus.serve(key, self._asked) if self._offered else lambda: None

    def callers_changed(self) -> None:
        """Cancel what was promised to components that are connected no more."""
        for promise in list(self._promised):
            if promise.caller not in self._callers(promise.operation + CALL_MARK):
                self._abandon(promise)

    def end(self) -> None:
        """Wait for no answer that the code has promised; may be called from any thread."""
        for promise in list(self._promised):
            promise.future.cancel()

    def close(self) -> None:
        """Serve nothing any more."""
        self._served()

    def _asked(self, request: Request) -> None:
        """Let the code answer a request, unless there is a reason not to; on the bus's thread."""
        name, caller = operation_of(request.key)
        if name not in self._offered:
            self._refuse(request, f"{self._profile.component.short} offers no operation {name!r}")
            return
        try:
            life, signal = read_request(request.payload)
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
                value = self._code.read_value(signal.value, signal.media)
            except ValueError as error:
                raise Refused(f"what is sent along {error}") from None
            stint = self._code.stint
            answer = self._code.serve(name, replace(signal, value=value))
            if isinstance(answer, Future):
                promise = _Promise(answer, request, name, signal.source)
                self._promised.add(promise)
                answer.add_done_callback(lambda _: self._kept(promise, stint))
                if patience < math.inf:
                    self._code.run_on_bus(self._limit, promise, max(0.0, waits_until - self._bus.now()))
                if not self._code.active:  # it was stopped while it returned the future
                    answer.cancel()
            return answer

        self._answer(request, name, served)

    def _limit(self, promise: _Promise, seconds: float) -> None:
        """Wait for a future no longer than for a time."""
        undo = self._bus.later(seconds, partial(self._abandon, promise))
        promise.future.add_done_callback(lambda _: self._code.run_on_bus(undo))

    def _abandon(self, promise: _Promise) -> None:
        """Wait for a future no more; it is cancelled, unless another request waits for it as well.

        Then the request is refused at once: until the future came to something, it would count as one that waits.
        """
        if all(other is promise or other.future is not promise.future for other in list(self._promised)):
            promise.future.cancel()
        elif self._takes_back(promise):
            self._refuse(promise.request, f"{self._profile.component.short} ended the call before it answered", True)

    def _kept(self, promise: _Promise, stint: tuple[int, int]) -> None:
        """Answer a request with what a future has come to; on whatever thread it does."""
        if self._takes_back(promise):
            outcome = partial(self._code.outcome, promise.operation, promise.future, stint)
            self._answer(promise.request, promise.operation, outcome, kept=True)

    def _takes_back(self, promise: _Promise) -> bool:
        """Whether a promise stands no more from now on, and did until now: its request is answered once."""
        try:
            self._promised.remove(promise)
        except KeyError:
            return False
        return True

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
            self._code.run_on_bus(self._refuse, request, str(refused) or f"it refuses {name!r}", True)
        else:
            self._code.run_on_bus(self._reply, request, *answer)

    def _packed(self, name: str, value: Any) -> tuple[bytes, bytes]:
        """The payload and the stamp of an answer; raises Refused, and FAIL, for what is none."""
        try:
            payload, stamp = self._signals.write(value, self._offered[name].response)
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


def _read_patience(attachment: bytes) -> float:
    """For how many seconds the caller of a request waits; 0 if it does not say so. Raises ValueError for other text."""
    seconds = float(attachment[:32]) if attachment else 0.0
    if not 0.0 <= seconds <= LONGEST_PATIENCE:
        raise ValueError(f"no caller waits for {seconds:g} s")
    return seconds

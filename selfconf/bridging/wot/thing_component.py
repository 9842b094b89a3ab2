"""The component that stands for a thing: it reads, follows, writes and calls while it is active.

The code of the component itself only hands over: requests are made on the event loop of the world, so that a thing that
takes its time holds up no other. A request that goes wrong is FAIL, with its sentence as the reason. A call that the
thing answers with an error of HTTP is refused, and no more: the thing is there, and does what its description says. Nor
is it to blame for what cannot be sent to it, as where a form takes bytes and an object was received.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Awaitable, Callable
from concurrent.futures import Future
from typing import Any

from selfconf.bridging.wot.forms import ThingForm
from selfconf.bridging.wot.interactions import ThingInput, ThingInteractions, ThingOperation, ThingOutput
from selfconf.bridging.wot.thing_client import (
    BrokenAnswerError,
    ThingAnswer,
    ThingClient,
    ThingError,
    ThingRefusal,
    UnsendableValueError,
)
from selfconf.sdk import Component, Refused, Signal

log = logging.getLogger(__name__)

MOST_COMMANDS = 16
"""How many calls of an action wait for the ones before; of what is written to a property only the newest does."""
AGAIN = 0.2
"""Seconds from one request by which a thing is followed to the next, where the first has brought nothing."""
POLL_ARRIVED = 0.1
"""Seconds after which a long poll has arrived, which a thing then answers with the next change."""
SOONEST = 0.01
"""Seconds from one to the next where it has: a thing that answers a long poll at once is followed that often."""


class ThingComponent(Component):
    """A thing as a component."""

    def __init__(
        self,
        thing: ThingInteractions,
        client: ThingClient,
        loop: asyncio.AbstractEventLoop,
        rate: float,
        lost: Callable[[str], None],
        tell: Callable[[str], None],
    ) -> None:
        """`lost` is called on the loop, with a sentence, when the thing has not done what its description says.

        `tell` hears there of what could not be sent to it.
        """
        self._thing, self._client, self._loop, self._rate = thing, client, loop, rate
        self._lost, self._tell = lost, tell
        self._work: list[asyncio.Task[None]] = []
        self._waiting: dict[str, asyncio.Queue[Signal]] = {}
        """The signals that are to be sent, for each input; replaced with each activation."""
        self._last: dict[str, ThingAnswer] = {}
        """What was issued last on each output."""

    # On the thread of the component's code.

    def started(self) -> None:
        """Begin to feed the outputs, and to take what the inputs receive."""
        waiting = {each.name: asyncio.Queue[Signal](MOST_COMMANDS if each.action else 1) for each in self._thing.inputs}
        self._waiting = waiting
        self._loop.call_soon_threadsafe(self._begin, waiting)

    def stopped(self) -> None:
        """End every request; what has reached the thing by then, the thing may still carry out."""
        self._waiting = {}
        self._loop.call_soon_threadsafe(self._end)

    def received(self, port: str, signal: Signal) -> None:
        """Have a signal sent to the thing."""
        queue = self._waiting.get(port)
        if queue is not None:
            self._loop.call_soon_threadsafe(self._append, port, queue, signal)

    def called(self, operation: str, request: Signal) -> Future[Any]:
        """Have an action called; the answer comes from the loop."""
        called = next(each for each in self._thing.operations if each.name == operation)
        return asyncio.run_coroutine_threadsafe(self._call(called, request), self._loop)

    # On the loop.

    def _begin(self, waiting: dict[str, asyncio.Queue[Signal]]) -> None:
        work = [self._feed(each) for each in self._thing.outputs]
        work += [self._send(each, waiting[each.name]) for each in self._thing.inputs]
        self._work = [asyncio.ensure_future(self._guarded(one)) for one in work]

    def _end(self) -> None:
        for task in self._work:
            task.cancel()
        self._work = []

    def _append(self, port: str, queue: asyncio.Queue[Signal], signal: Signal) -> None:
        if queue.full():
            queue.get_nowait()
            if queue.maxsize > 1:
                log.warning("%s: dropped a call of %s: %d wait already", self._name, port, queue.maxsize)
        queue.put_nowait(signal)

    @property
    def _name(self) -> str:
        return self._thing.component.iri.short

    async def _guarded(self, work: Awaitable[None]) -> None:
        try:
            await work
        except ThingError as error:
            self._lose(error)

    def _lose(self, error: Exception) -> None:
        self.fail(str(error))
        self._lost(str(error))

    async def _feed(self, output: ThingOutput) -> None:
        """Issue what the thing says on an output, for as long as this task runs."""
        await self._read(output)
        if output.follow is None:
            await self._poll(output)
        else:
            await self._follow(output)

    async def _poll(self, output: ThingOutput) -> None:
        """Read at the rate; a reading that was late is not made up for."""
        due = self._loop.time()
        while output.read is not None:
            due = max(due + 1 / self._rate, self._loop.time())
            await asyncio.sleep(due - self._loop.time())
            await self._read(output)

    async def _read(self, output: ThingOutput, *, changed: bool = False) -> None:
        """Issue what the thing says when it is asked, if it can be; if `changed`, only where that is not the last."""
        if output.read is None:
            return
        answer = await self._client.read(output.read)
        if not changed or answer != self._last.get(output.name):
            self._issue(output, answer)

    async def _follow(self, output: ThingOutput) -> None:
        """Follow a form anew each time that it comes to an end, or that its connection is cut.

        What lies between may cut one on which nothing comes; that the thing is not there is known by the next request.
        """
        form = output.follow
        while form is not None:
            began = self._loop.time()
            try:
                pause = await self._followed_once(output, form)
            except BrokenAnswerError:
                pause = AGAIN
                if self._loop.time() - began < AGAIN:
                    raise
            await asyncio.sleep(max(0.0, began + pause - self._loop.time()))

    async def _followed_once(self, output: ThingOutput, form: ThingForm) -> float:
        """Issue what comes of one request; how long after it the next one is made, at least."""
        if form.subprotocol == "sse":
            async with self._client.subscribed(form) as answers:
                await self._read(output, changed=True)  # it may have changed before the thing told of changes
                async for answer in answers:
                    self._issue(output, answer)
        elif (found := await self._polled(output, form)) is not None:
            self._issue(output, found)
            return SOONEST
        return AGAIN

    async def _polled(self, output: ThingOutput, form: ThingForm) -> ThingAnswer | None:
        """What comes of a long poll; None for nothing. What changed before the thing knew of it is read meanwhile."""
        polling = asyncio.ensure_future(self._client.wait(form))
        polling.add_done_callback(lambda done: done.cancelled() or done.exception())  # also where the reading fails
        try:
            await asyncio.wait((polling,), timeout=POLL_ARRIVED)
            if not polling.done():
                await self._read(output, changed=True)
            return await polling
        finally:
            polling.cancel()

    def _issue(self, output: ThingOutput, answer: ThingAnswer) -> None:
        self._last[output.name] = answer
        self.emit(output.name, _wrapped(answer, output.field), media=answer.media)

    async def _send(self, taken: ThingInput, queue: asyncio.Queue[Signal]) -> None:
        told = set[str]()
        while True:
            signal = await queue.get()
            value = None if taken.empty else _unwrapped(signal.value, taken.field)
            try:
                await self._client.send(taken.form, value, signal.media, taken.action)
            except UnsendableValueError as error:
                sentence = f"what {signal.source.short} issues is not sent to {taken.name!r}: {error}"
                if sentence not in told:  # else as many as there are signals, where this is so of two inputs
                    told.add(sentence)
                    self._tell(sentence)

    async def _call(self, called: ThingOperation, request: Signal) -> Any:
        """What an action answers. Raises Refused."""
        value = None if called.empty else _unwrapped(request.value, called.request_field)
        try:
            if called.answers:
                return _wrapped(await self._client.call(called.form, value, request.media), called.response_field)
            await self._client.send(called.form, value, request.media, action=True)
        except ThingError as error:
            if not isinstance(error, ThingRefusal | UnsendableValueError):
                self._lose(error)
            raise Refused(str(error)) from None
        return None


def _wrapped(answer: ThingAnswer, field: str | None) -> Any:
    """What a thing says as an object with a field, where it is no object and there is one that it stands for."""
    plain = field is not None and not answer.media and not isinstance(answer.value, dict)
    return {field: answer.value} if plain else answer.value


def _unwrapped(value: Any, field: str | None) -> Any:
    """The value of a field, where a signal has that one and the thing takes no object."""
    return value[field] if field is not None and isinstance(value, dict) and field in value else value

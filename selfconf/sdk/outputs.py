"""The outputs of a component: what it emits goes out, and the last signal is kept.

*Outputs are latched.* An output that gets its first follower issues its last signal of this activation again, so that
the new connection carries a signal at once. Of further followers it is not told; these ask for the last signal, and it
answers. An input passes over a signal that it has had already.
"""

from __future__ import annotations

import itertools
import math
import threading
import time
from collections.abc import Callable
from typing import Any

from selfconf.bus.answers import answering
from selfconf.bus.port import Publisher, Request, Undo, Urgency
from selfconf.errors import ProgrammerError
from selfconf.model.wording import listed
from selfconf.protocol.messages import SignalEncoding
from selfconf.protocol.stamps import PLAIN, StampWriter
from selfconf.sdk.component_context import ComponentContext
from selfconf.sdk.payloads import UnsayableError, as_bytes, as_json

SIGNALS_FIRST = 0.002
"""Seconds by which everything else that an activation asks of the network is delayed.

An activation makes new connections, and over these the latched signals flow. Others wait for these, while the answer
to the call and the watch for the supervisor's life may come later; sent at once, they would go first.
"""
NOTHING_YET = "it acts, and has issued nothing yet"
"""What an output says that is asked for its last signal and has none: one whose component does not act is silent."""


class Outputs:
    """The outputs of one component in one life."""

    def __init__(self, context: ComponentContext, active: Callable[[], bool]) -> None:
        """`active` says whether the component is active: what it emits otherwise is dropped."""
        bus, keys, profile, fields = context.bus, context.keys, context.profile, context.fields
        self._profile, self._active, self._malformed = profile, active, context.malformed
        self._fields = {
            port.name: [fields[signal] for signal in port.signals if signal in fields]
            for port in profile.signal_outputs
        }
        self._stamps = {port.name: StampWriter(profile.component, context.life) for port in profile.signal_outputs}
        self._sequence = itertools.count(1)
        self._newest = 0
        # Held while a signal is issued: inputs pass over one that comes after another with a higher number. Reentrant:
        # on a bus in memory it may arrive at once, at code that emits in turn.
        self._issuing = threading.RLock()
        self.issued = {port.name: 0 for port in profile.outputs}
        """How many signals each output has issued in this life."""
        self._last: dict[str, tuple[bytes, bytes]] = {}
        """The last signal of each output in the present activation, with its attachment."""
        self._publishers: dict[str, Publisher] = {
            port.name: bus.publisher(
                keys.output(profile.component, port.name), Urgency.SIGNAL, self._matched(port.name)
            )
            for port in profile.signal_outputs
        }
        self._names = {keys.output(profile.component, port.name): port.name for port in profile.signal_outputs}
        self._served: Undo = bus.serve(keys.outputs(profile.component), self._answer) if self._names else lambda: None

    def emit(self, port: str, value: Any, moment: float | None, media: str = "") -> None:
        """Issue a signal; may be called from any thread. Raises ProgrammerError for an output or a time that is none.

        A value that no signal can carry, or that is not of the kind that the output promises, is not issued.
        """
        if moment is not None and not math.isfinite(moment):
            raise ProgrammerError(f"{self._profile.component.short} cannot emit a signal of the time {moment!r}")
        output = self._publishers.get(port)
        if output is None:
            names = listed(map(repr, self._publishers)) or "none"
            raise ProgrammerError(
                f"{self._profile.component.short} advertises no output {port!r}; its outputs: {names}"
            )
        if not self._active():
            return
        try:
            payload, encoding, packed = self._packed(port, value, media)
        except UnsayableError as error:
            self._malformed(f"what it emits on {port!r} {error}")
            return
        with self._issuing:
            if not self._active():  # it has failed meanwhile, on another thread, and has said which signal was its last
                return
            self._newest = number = next(self._sequence)
            moment = time.time() if moment is None else moment
            stamp = self._stamps[port].write(number, moment, packed, encoding)
            self._last[port] = payload, stamp
            self.issued[port] += 1
            output.put(payload, stamp)

    @property
    def newest(self) -> int:
        """The number of the last signal that was issued in this life; 0 if none was."""
        with self._issuing:
            return self._newest

    def problem(self, port: str, value: Any) -> str | None:
        """What keeps a value from being a signal of an output, without its subject; None if nothing does."""
        try:
            self._packed(port, value)
        except UnsayableError as error:
            return str(error)
        return None

    def _packed(self, port: str, value: Any, media: str = "") -> tuple[bytes, SignalEncoding, bool]:
        """The payload of a signal, its encoding, and whether it is none of JSON. Raises UnsayableError."""
        packed = as_bytes(value, media)
        for fields in self._fields[port]:
            problem = fields.problem(value) if packed is None else fields.problem_of_bytes()
            if problem is not None:
                raise UnsayableError(problem)
        return (as_json(value), PLAIN, False) if packed is None else (*packed, True)

    def forget(self) -> None:
        """Forget the last signals: a new activation begins."""
        self._last.clear()

    def close(self) -> None:
        """Take the declarations back; the component does not act any more."""
        self._served()
        with self._issuing:  # Zenoh takes back no publisher that another thread puts on just then
            for output in self._publishers.values():
                output.undeclare()

    def _answer(self, request: Request) -> None:
        """Answer the question for an output with its last signal of this activation, or say that there is none yet."""
        with answering(request):
            name = self._names.get(request.key, "")
            last = self._last.get(name)
            if self._active() and last is not None:
                request.reply(request.key, *last)
            elif self._active() and name:
                request.refuse(NOTHING_YET)

    def _matched(self, port: str) -> Callable[[bool], None]:
        """Issue the last signal again when an output begins to be followed."""

        def matched(matching: bool) -> None:
            last = self._last.get(port)
            if matching and self._active() and last is not None:
                self._publishers[port].put(*last)

        return matched

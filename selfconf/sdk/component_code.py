"""The code of one component, as its runtime has it run: guarded, within its deadline, in the right order.

`start`, `change`, `stop`, `rest` and `unfed` are called on the thread of the bus and report there; `deliver` and what
the component itself does is called on the thread of its code. Everything that was handed over before a stop, and has
not begun by then, is not run any more.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from functools import partial
from typing import Any

from selfconf.model.literal_values import as_python
from selfconf.model.term import Term
from selfconf.sdk.component import Component, Refused, Signal
from selfconf.sdk.component_context import ComponentContext
from selfconf.sdk.unfed_inputs import TOLERATES, UnfedInputs

log = logging.getLogger(__name__)

INCOMPLETE = ""
"""Stands among the inputs that are unfed for the configuration itself, while that has long lacked a part."""
Done = Callable[["str | None"], None]
"""Hears, on the bus's thread, why something did not come about, or None."""


class ComponentCode:
    """Calls the methods of one component."""

    def __init__(
        self,
        context: ComponentContext,
        component: Component,
        woken: Callable[[str], None] = lambda port: None,
        restless: Callable[[str], None] = lambda why: None,
        rests: Callable[[], None] = lambda: None,
    ) -> None:
        """`woken` is called when the code has been woken from its rest by an input.

        That is on the bus's thread, and the input is empty where it was not one that had been unfed. `restless` is
        called when the code of an actuator breaks as it is to come to rest, on the thread of that code; `rests` when it
        is about to rest until its inputs are fed, on that thread as well.
        """
        self._woken, self._restless, self._about_to_rest = woken, restless, rests
        self._bus, self._thread, self._component, self._fail = context.bus, context.thread, component, context.fail
        profile = context.profile
        self._parameters = {parameter.name for parameter in profile.parameters}
        self._name = profile.component.short
        self._actuates = profile.is_actuator
        self._deadline = profile.callback_deadline
        self._start_deadline = profile.start_deadline
        self.stopping = False
        """Whether the code was asked to stop, and is not at rest yet."""
        self.turn = 0
        """Counts starts and stops: what belongs to an earlier one is not run any more."""
        self._wanted_turn = self._acting_turn = self._started_turn = -1
        self._rests = 0
        self.is_to_rest = False
        """Whether it has been blind for too long, and what runs now has not returned yet."""
        self._on = self._resting = self._lacking = False
        tolerates = TOLERATES if profile.tolerates is None else profile.tolerates
        required = frozenset(port.name for port in profile.required if not port.is_operation)
        self._unfed_inputs = UnfedInputs(
            self._bus, required | {INCOMPLETE}, tolerates if self._actuates else None, self._rest
        )
        self._values: dict[str, Term] = {}
        self._connected: set[str] = set()
        """The operations of which the code has heard, since it was started, that they are connected."""

    @property
    def on_bus_thread(self) -> bool:
        """Whether there is no other thread."""
        return self._thread.inline

    @property
    def active(self) -> bool:
        """Whether the component acts; ended by a stop or a FAIL at once, in whatever thread that comes from."""
        return self._acting_turn == self.turn

    @property
    def wanted(self) -> bool:
        """Whether the component is to act, if only once its parameters are set; ended as `active` is."""
        return self._wanted_turn == self.turn

    @property
    def started(self) -> bool:
        """Whether the component acts, and `started` has returned."""
        return self.active and self._started_turn == self.turn

    @property
    def stint(self) -> tuple[int, int]:
        """What changes whenever the code is started or stopped: a timer belongs to one such stretch."""
        return self.turn, self._rests

    # What the runtime asks for.

    def end_acting(self) -> None:
        """Be inactive at once, and do not go on with a start; may be called from any thread."""
        self._wanted_turn = self._acting_turn = -1

    def start(self, values: Mapping[str, Term], done: Done) -> None:
        """Set the parameters, then start."""
        self.turn += 1
        turn = self._wanted_turn = self.turn

        def start() -> None:
            self._resting = False
            trouble = self._over(turn) or self._set(values) or self._over(turn) or self._start(turn)
            self.run_on_bus(done, trouble)

        self._values = dict(values)
        self._thread.call(start)

    def change(self, values: Mapping[str, Term], done: Done) -> None:
        """Set the parameters that have other values than before."""
        changed = {name: value for name, value in values.items() if self._values.get(name) != value}

        def set_changed() -> None:
            trouble = self._set(changed)
            if trouble is not None:  # a call that is made again is to hear the same, and not that all is done
                for name in changed:
                    self._values.pop(name, None)
            self.run_on_bus(done, trouble)

        self._values |= values
        if changed:
            self._thread.call(set_changed)
        else:
            done(None)

    def stop(self, done: Callable[[], None]) -> None:
        """Be inactive at once, and at rest as soon as what runs now has returned."""
        self.turn += 1
        self.stopping = True
        self._unfed_inputs.forget()

        def at_rest() -> None:
            self.stopping = False
            done()

        def stop() -> None:
            rests = True  # also where `stopped` ends the program: the caller hears first that it has obeyed
            try:
                rests = self._stop()
            finally:
                if rests:
                    self.run_on_bus(at_rest)

        self._thread.rest(stop)

    def unfed(self, port: str) -> None:
        """Tell the component that an input has lost its last source; an actuator rests if that lasts.

        It may have lost it while its code is about to start.
        """
        if self.wanted and self._unfed_inputs.begin(port):
            self._thread.call(lambda: self._guarded("unfed", lambda: self._component.unfed(port)))

    def lack_a_part(self, lacking: bool) -> None:
        """Count an actuator as blind for as long as its tasks have lacked a part, and until they lack none any more."""

        def complete() -> None:
            if self._lacking:  # once more, while the code was busy
                return
            if self._unfed_inputs.end(INCOMPLETE) and self._resting and not self._unfed_inputs.blind:
                self._wake(INCOMPLETE)

        self._lacking = lacking
        if not lacking:
            if INCOMPLETE in self._unfed_inputs.unfed:
                self._thread.call(complete)
        elif self.wanted and self._unfed_inputs.begin(INCOMPLETE):
            self._unfed_inputs.has_lasted(TOLERATES)

    def connection_changed(self, operation: str, connected: bool) -> None:
        """Tell the component that an operation that it needs is connected, or is no more, unless it rests or knows."""
        component, known = self._component, self._connected
        what, tell = ("connected", component.connected) if connected else ("disconnected", component.disconnected)

        def change() -> None:
            if not self._resting and (operation in known) is not connected:
                (known.add if connected else known.discard)(operation)
                self._guarded(what, partial(tell, operation))

        self._thread.call(change)

    def tick(self, action: Callable[[], None]) -> None:
        """Run what the component wants done at intervals; in turns with signals, which else would never be read."""
        self._thread.tick(lambda: None if self._resting else self._guarded("every", action))

    def deliver(self, port: str, signal: Signal) -> None:
        """Hand a signal to the component; called on the thread of its code."""
        if not self.active:
            return
        if self._unfed_inputs.end(port):
            if self._resting and not self._unfed_inputs.blind:
                self._wake(port)
            self._guarded("fed", lambda: self._component.fed(port))
        if not self._resting:
            self._guarded("received", partial(self._component.received, port, signal))

    def read_value(self, value: Any, media: str) -> Any:
        """Return what the component receives of a value with its media type; raises ValueError if it passes it over.

        What else breaks there is a failure of the component, and no end of its program. On the thread of its code.
        """
        try:
            return self._component.signal_value(value, media)
        except (ValueError, RecursionError) as error:
            raise ValueError(str(error)) from None
        except Exception as error:
            log.exception("%s broke in signal_value", self._name)
            self._fail(f"it broke in signal_value: {type(error).__name__}: {error}")
            raise ValueError("breaks the component") from None

    def serve(self, operation: str, request: Signal) -> Any:
        """Return what the component answers to a call; raises Refused if it does not. On the thread of its code.

        What breaks there is a failure of the component. The answer may be a future, whose outcome `outcome` tells.
        """
        if not self.active or self._resting:
            raise Refused(f"{self._name} {'is at rest' if self.active else 'does not act'}")
        code = partial(self._component.called, operation, request)
        return self._judged(operation, lambda: self._thread.limited(self, "called", self._deadline, code))

    def outcome(self, operation: str, answer: Future[Any], stint: tuple[int, int]) -> Any:
        """Return what a future has come to that was the answer to a call; raises Refused like `serve`. On any thread.

        A future that was cancelled is a refusal, and so is one of another `stint`: one that was under way as the code
        was stopped cannot be cancelled, and what breaks there is no failure of what the component does now.
        """
        if answer.cancelled() or stint != self.stint:
            raise Refused(f"{self._name} ended the call before it answered")
        return self._judged(operation, answer.result)

    def _judged(self, operation: str, answer: Callable[[], Any]) -> Any:
        """Return an answer; what it raises is a refusal, or else a failure of the component, which is one as well."""
        try:
            return answer()
        except Refused:
            raise
        except Exception as error:
            log.exception("%s broke when %r was called", self._name, operation)
            self._fail(f"{type(error).__name__}: {error}")
            raise Refused(f"{self._name} broke: {type(error).__name__}: {error}") from None

    def answered(self, stint: tuple[int, int], action: Callable[[], None]) -> None:
        """Hand the answer to a call to the component, unless it was stopped since; on the thread of its code."""
        if stint == self.stint and not self._resting:
            self._guarded("answered", action)

    def _rest(self) -> None:
        """Be stopped until all inputs are fed again: the component is blind, and that is not tolerated any longer."""
        turn = self.turn
        self.is_to_rest = True

        def rest() -> None:
            self.is_to_rest = False
            if turn == self.turn and self.active and self._unfed_inputs.blind and not self._resting:
                lacking = (
                    "the configuration is incomplete" if INCOMPLETE in self._unfed_inputs.unfed else "an input is unfed"
                )
                log.warning("%s: %s; at rest for as long", self._name, lacking)
                self._rests += 1
                self._about_to_rest()
                self._resting = self._stop()

        self._thread.rest(rest)

    # What runs on the thread of the code.

    def _wake(self, port: str) -> None:
        self._resting = False
        self._rests += 1
        turn = self.turn
        trouble = self._set(dict(self._values)) or self._over(turn)  # a call may add values meanwhile
        if trouble is None:
            self._on = True
            trouble = self._started()
        if turn != self.turn:  # what was off meanwhile is no failure of what has been called for since
            return
        if trouble is not None:
            self._fail(trouble)
            return
        self._bus.wake_up(lambda: self._woken(port) if turn == self.turn else None)

    def _over(self, turn: int) -> str | None:
        if turn != self.turn:
            return "it was turned off again"
        if self._on:  # `stopped` broke
            return "it has not come to rest"
        return None if self.wanted else "it has failed"

    def _start(self, turn: int) -> str | None:
        self._on = True
        self._acting_turn = turn  # before `started`, which may emit
        trouble = self._started()
        if trouble is not None:
            self._acting_turn = -1
        else:
            self._started_turn = turn
        return trouble

    def _started(self) -> str | None:
        self._connected.clear()
        return self._carried_out("started", self._start_deadline, self._component.started, "it refuses")

    def _stop(self) -> bool:
        """Whether the code is at rest: an actuator that broke on the way there may act on, a sensor issues nothing."""
        if not self._on:
            return True
        try:
            self._thread.limited(self, "stopped", self._deadline, self._component.stopped)
        except Exception as error:
            log.exception("%s broke when it was stopped", self._name)
            if self._actuates:
                self._restless(f"it broke in stopped: {type(error).__name__}: {error}")
                return False
        self._on = False
        return True

    def _set(self, values: Mapping[str, Term]) -> str | None:
        for name, value in values.items():
            if name not in self._parameters:
                return f"it declares no parameter {name!r}"

            def set_value(name: str = name, value: Term = value) -> None:
                self._component.parameter_set(name, as_python(value))

            trouble = self._carried_out(f"parameter {name}", self._deadline, set_value, f"it refuses {name} = {value}")
            if trouble is not None:
                return trouble
        return None

    def _carried_out(self, what: str, limit: float, action: Callable[[], None], refusal: str) -> str | None:
        """Run code of the component that may refuse; a text if it does, or if it breaks."""
        try:
            self._thread.limited(self, what, limit, action)
        except Refused as refused:
            return str(refused) or refusal
        except Exception as error:
            log.exception("%s broke in %s", self._name, what)
            return f"it broke in {what}: {type(error).__name__}: {error}"
        return None

    def _guarded(self, what: str, action: Callable[[], None]) -> None:
        """Run code of the component while it acts; what breaks there is its failure, not that of its runtime."""
        if not self.active:
            return
        try:
            self._thread.limited(self, what, self._deadline, action)
        except Exception as error:
            log.exception("%s broke", self._name)
            self._fail(f"{type(error).__name__}: {error}")

    def run_on_bus(self, action: Callable[..., None], *arguments: Any) -> None:
        """Do something on the bus's thread; at once where the code has no other, and else soon."""
        if self._thread.inline:
            action(*arguments)
        else:
            self._bus.wake_up(partial(action, *arguments))

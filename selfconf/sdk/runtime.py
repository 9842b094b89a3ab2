"""The runtime of one component: what joins the code of a component to the bus.

It holds the liveliness token, answers control calls by the table in `selfconf.protocol.activation`, and calls the
component's code. Outputs, inputs and supervision have modules of their own.
"""

from __future__ import annotations

import itertools
import logging
import secrets
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from selfconf.bus.port import Bus, Request, Undo, Urgency
from selfconf.errors import PeerError
from selfconf.model.profile import Profile
from selfconf.protocol import activation as table
from selfconf.protocol.activation import Activation, ActivationPhase, ActivationStep
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import Keys, call_of, owner_of
from selfconf.protocol.messages import Apply, CallAnswer, Cause, Fail, Release, SetParameters, Verdict, Wire
from selfconf.sdk.component import Component, Refused, Signal
from selfconf.sdk.inputs import Inputs
from selfconf.sdk.outputs import SIGNALS_FIRST, Outputs
from selfconf.sdk.supervision import Supervision
from selfconf.sdk.values import as_python

log = logging.getLogger(__name__)

_MESSAGES: dict[str, type[Apply] | type[SetParameters] | type[Release]] = {
    "apply": Apply,
    "set": SetParameters,
    "release": Release,
}
"""The message that each call carries, apart from `state`, which carries none."""


class ComponentRuntime:
    """Joins a component to the bus; everything but `emit` and `fail` happens on the bus's thread."""

    def __init__(self, bus: Bus, keys: Keys, profile: Profile, component: Component, life: str = "") -> None:
        self.bus, self.keys, self.profile, self.component = bus, keys, profile, component
        self.life = life or secrets.token_hex(4)
        """Which incarnation of the component this is."""
        self.activation = Activation()
        self.active = False
        """Whether the component acts: unlike `activation` it ends in the thread and the moment of a FAIL."""
        self._timers: dict[int, Undo] = {}
        self._timer_numbers = itertools.count()
        component._runtime = self
        self.outputs = Outputs(bus, keys, profile, self.life, lambda: self.active)
        self.inputs = Inputs(bus, keys, self._deliver, self._report_silence)
        self.supervision = Supervision(bus, self._orphaned)
        self._fail = bus.publisher(keys.fail(profile.component), Urgency.EVENT)
        self._served = bus.serve(keys.call(profile.component), self._call)
        self._token = bus.announce(keys.life(profile.component, self.life))  # last: from now on it is called

    def close(self) -> None:
        """Turn the component off and leave the ecology."""
        self._become(*table.orphan(self.activation))
        self._served()
        self._token()
        self.outputs.close()
        self._fail.undeclare()

    # What the component does.

    def emit(self, port: str, value: Any, moment: float | None) -> None:
        """Issue a signal; may be called from any thread."""
        self.outputs.emit(port, value, moment)

    def fail(self, reason: str) -> None:
        """Raise FAIL, at once; may be called from any thread."""
        if self.active:
            self.active = False
            self._fail.put(encode(Fail(self.profile.component, self.life, self.activation.epoch, Cause.FAIL, reason)))
            self.bus.wake_up(self._failed)

    def every(self, seconds: float, action: Callable[[], None]) -> None:
        """Call `action` at that interval until the component stops or fails."""
        number = next(self._timer_numbers)

        def tick() -> None:
            if self.active:
                self._timers[number] = self.bus.later(seconds, tick)
                self._guarded(action)
            else:
                del self._timers[number]

        self._timers[number] = self.bus.later(seconds, tick)

    def _failed(self) -> None:
        """What `fail` leaves for the bus's thread."""
        self._become(*table.fail(self.activation))

    # Control calls.

    def _call(self, request: Request) -> None:
        call = call_of(request.key)
        try:
            answer = self._answer(call, request.payload)
        except PeerError as error:
            log.warning("%s: refused a call: %s", self.profile.component.short, error)
            request.refuse(str(error))
            request.finish()
            return

        def reply() -> None:
            request.reply(self.keys.call(self.profile.component, call), encode(answer))
            request.finish()

        if call == "apply":
            self.bus.later(SIGNALS_FIRST, reply)
        else:
            reply()

    def _answer(self, call: str, payload: bytes) -> CallAnswer:
        """Obey a call, if the table says so, and return the answer. Raises PeerError for what is no call."""
        if call == "state":
            return self._verdict(Verdict.DONE)
        if call not in _MESSAGES:
            raise PeerError(f"there is no call {call!r}")
        message: Apply | SetParameters | Release = decode(payload, _MESSAGES[call])
        if isinstance(message, Apply):
            unknown = sorted(set(message.inputs) - {port.name for port in self.profile.inputs})
            if unknown:
                return self._verdict(Verdict.REFUSED, f"it has no input {unknown[0]!r}")
            if not self.keys.is_configurator_life(message.supervisor):
                raise PeerError(f"{message.supervisor!r} is no life of a configurator")
        return self._obey(message)

    def _obey(self, message: Apply | SetParameters | Release) -> CallAnswer:
        # Within the grace period another configurator may take the component over, but not set its parameters.
        free = self.supervision.gone and not isinstance(message, SetParameters)
        before = replace(self.activation, supervisor=None) if free else self.activation
        after, verdict, step = table.obey(before, message)
        if verdict is Verdict.BUSY and self.activation.supervisor is not None:
            return self._verdict(verdict, f"the configurator {owner_of(self.activation.supervisor)} holds it")
        if verdict is not Verdict.DONE:
            return self._verdict(verdict)
        trouble = self._become(after, step) or self._carry_out(message)
        if trouble is None:
            return self._verdict(Verdict.DONE)
        if isinstance(message, Apply) and before.phase is not ActivationPhase.ACTIVE:
            self._become(*table.orphan(self.activation))
        return self._verdict(Verdict.REFUSED, trouble)

    def _carry_out(self, message: Apply | SetParameters | Release) -> str | None:
        """Do what a call asks for besides the change of the activation; a text if that cannot be done."""
        if isinstance(message, Apply):
            self.inputs.follow(message)
            self.supervision.begin(message.supervisor)
        elif isinstance(message, SetParameters):
            return self._set(message)
        return None

    def _verdict(self, verdict: Verdict, detail: str = "") -> CallAnswer:
        """The answer with a verdict; it always says how things are with the component."""
        activation = self.activation
        holder = activation.supervisor or ""
        return CallAnswer(verdict, self.profile.component, self.life, activation.epoch, self.active, detail, holder)

    def _become(self, activation: Activation, step: ActivationStep) -> str | None:
        """Take on an activation and let the component's code take its step; a text if the code refuses or breaks."""
        self.activation = activation
        if step in (ActivationStep.STOP, ActivationStep.RESTART):
            self._stop()
        if step is ActivationStep.RAISE_FAIL:
            self.active = False  # again: another thread's FAIL may have been overtaken by a release and an apply
        if step in (ActivationStep.START, ActivationStep.RESTART):
            return self._start()
        return None

    def _start(self) -> str | None:
        self.outputs.forget()
        self.active = True  # before `started`, which may emit
        try:
            self.component.started()
        except Refused as refusal:
            self.active = False
            return str(refusal) or "it refuses"
        except Exception as error:
            self.active = False
            log.exception("%s broke when it was started", self.profile.component.short)
            return f"it broke when it was started: {type(error).__name__}: {error}"
        return None

    def _stop(self) -> None:
        """Be off: no timers, no inputs, no supervisor, and the component's code at rest."""
        self.active = False
        for undo in self._timers.values():
            undo()
        self._timers.clear()
        self.inputs.end()
        self.supervision.end()
        try:
            self.component.stopped()
        except Exception:  # it is off all the same
            log.exception("%s broke when it was stopped", self.profile.component.short)

    def _set(self, message: SetParameters) -> str | None:
        known = {parameter.name for parameter in self.profile.parameters}
        for name, value in message.values.items():
            if name not in known:
                return f"it declares no parameter {name!r}"
            try:
                self.component.parameter_set(name, as_python(value))
            except Refused as refusal:
                return str(refusal) or f"it refuses {name} = {value}"
            except Exception as error:
                log.exception("%s broke when %s was set", self.profile.component.short, name)
                return f"it broke when {name!r} was set: {type(error).__name__}: {error}"
        return None

    # What arrives.

    def _deliver(self, port: str, signal: Signal) -> None:
        """Hand a signal to the component."""
        if self.active:
            self._guarded(lambda: self.component.received(port, signal))

    def _guarded(self, action: Callable[[], None]) -> None:
        """Run the component's code; what breaks there is the component's failure, not that of its runtime."""
        try:
            action()
        except Exception as error:
            log.exception("%s broke", self.profile.component.short)
            self.fail(f"{type(error).__name__}: {error}")

    def _report_silence(self, wire: Wire, seconds: float) -> None:
        """Raise FAIL for a component whose output has stopped: on the own key, as a report."""
        detail = f"no signal on {wire.output!r} for {seconds:.2f} s"
        self._fail.put(encode(Fail(wire.component, "", self.activation.epoch, Cause.SILENCE, detail)))

    def _orphaned(self) -> None:
        log.warning("%s: its configurator is gone; turning off", self.profile.component.short)
        self._become(*table.orphan(self.activation))

"""The body of a component: its life on the bus.

It holds the liveliness token, answers control calls by the table in `selfconf.protocol.life`, follows the outputs
that its inputs are told to follow, and issues what the component emits.

*Outputs are latched.* An output that is followed anew issues its last signal of this activation again, so that a new
connection carries a signal at once; inputs pass over what they have had already.

*Supervision.* A component obeys a configurator only as long as that is alive: when its token has been gone for
`GRACE` seconds, or this node is cut off for that long, the component turns itself off. Meanwhile another configurator
may take it over.

*Silence.* An input that follows an output with a promised rate reports to the configurator when nothing has come for
`PATIENCE` of the promised periods, and again as long as nothing comes.
"""

from __future__ import annotations

import itertools
import json
import logging
import secrets
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from selfconf.bus.port import Bus, Publisher, Request, Undo, Urgency
from selfconf.errors import PeerError, ProgrammerError
from selfconf.model.profile import Profile
from selfconf.protocol import life as lives
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import Keys, call_of, owner_of
from selfconf.protocol.life import Life, LifePhase
from selfconf.protocol.life import LifeStep as Told
from selfconf.protocol.messages import (
    Apply,
    CallAnswer,
    Cause,
    Fail,
    Release,
    SetParameters,
    Stamp,
    Verdict,
    Wire,
)
from selfconf.sdk.component import Component, Refused, Signal
from selfconf.sdk.following import RAW, Following
from selfconf.sdk.values import as_python

log = logging.getLogger(__name__)

GRACE = 1.0
"""Seconds after which a component without a living supervisor turns itself off."""
SIGNALS_FIRST = 0.002
"""Seconds for which what else an activation asks for stands back behind the signals that it sets free."""


class Body:
    """Joins a component to the bus; everything but `emit` and `fail` happens on the bus's thread."""

    def __init__(self, bus: Bus, keys: Keys, profile: Profile, component: Component, life: str = "") -> None:
        self.bus, self.keys, self.profile, self.component = bus, keys, profile, component
        self.name = life or secrets.token_hex(4)
        """Which life of the component this is."""
        self.life = Life()
        self.active = False
        self._following: dict[tuple[str, Wire], Following] = {}
        self._last: dict[str, tuple[bytes, bytes]] = {}
        self._sequence = itertools.count(1)
        self._timers: dict[int, Undo] = {}
        self._timer_numbers = itertools.count()
        self._supervision: list[Undo] = []
        self._supervisor = ""
        """Whose life is watched."""
        self._gone = False
        """Whether that life was seen to end."""
        self._grace: Undo | None = None
        component._body = self
        self._outputs: dict[str, Publisher] = {
            port.name: bus.publisher(
                keys.output(profile.component, port.name), Urgency.SIGNAL, self._matched(port.name)
            )
            for port in profile.outputs
        }
        self._fail = bus.publisher(keys.fail(profile.component), Urgency.EVENT)
        self._served = bus.serve(keys.call(profile.component), self._call)
        self._token = bus.announce(keys.life(profile.component, self.name))

    def close(self) -> None:
        """Turn the component off and leave the ecology."""
        self._become(*lives.orphan(self.life))
        self._served()
        self._token()
        for output in (*self._outputs.values(), self._fail):
            output.undeclare()

    # What the component does.

    def emit(self, port: str, value: Any, moment: float | None) -> None:
        """Issue a signal; may be called from any thread."""
        output = self._outputs.get(port)
        if output is None:
            raise ProgrammerError(f"{self.profile.component.short} advertises no output {port!r}")
        if not self.active:
            return
        stamp = Stamp(
            self.profile.component, self.name, next(self._sequence), time.time() if moment is None else moment
        )
        if isinstance(value, bytes):
            payload, attachment = value, RAW + encode(stamp)
        else:
            payload, attachment = self._json(port, value), encode(stamp)
        self._last[port] = payload, attachment
        output.put(payload, attachment)

    def _json(self, port: str, value: Any) -> bytes:
        """A signal as JSON, which has neither NaN nor infinity: a component in another language could not read them."""
        try:
            return json.dumps(value, separators=(",", ":"), allow_nan=False).encode()
        except (TypeError, ValueError, RecursionError) as error:
            name = self.profile.component.short
            raise ProgrammerError(f"JSON cannot say what {name} emits on {port!r}: {error}") from None

    def fail(self, reason: str) -> None:
        """Raise FAIL, at once; may be called from any thread."""
        if self.active:
            self.active = False
            self._fail.put(encode(Fail(self.profile.component, self.name, self.life.epoch, Cause.FAIL, reason)))
            self.bus.wake_up(self._fell)

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

    def _fell(self) -> None:
        """Take on the life of one that has failed."""
        self._become(*lives.fail(self.life))

    def _matched(self, port: str) -> Callable[[bool], None]:
        def matched(matching: bool) -> None:
            last = self._last.get(port)
            if matching and self.active and last is not None:
                self._outputs[port].put(*last)

        return matched

    # What it is told.

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
        if call == "state":
            return self._said(Verdict.DONE)
        kinds: dict[str, type[Apply] | type[SetParameters] | type[Release]] = {
            "apply": Apply,
            "set": SetParameters,
            "release": Release,
        }
        if call not in kinds:
            raise PeerError(f"there is no call {call!r}")
        message: Apply | SetParameters | Release = decode(payload, kinds[call])
        if isinstance(message, Apply):
            unknown = set(message.inputs) - {port.name for port in self.profile.inputs}
            if unknown:
                return self._said(Verdict.REFUSED, f"it has no input {sorted(unknown)[0]!r}")
            if not self.keys.is_configurator_life(message.supervisor):
                raise PeerError(f"{message.supervisor!r} is no life of a configurator")
        free = self._gone and not isinstance(message, SetParameters)
        before = replace(self.life, supervisor=None) if free else self.life
        life, verdict, told = lives.obey(before, message)
        if verdict is Verdict.BUSY and self.life.supervisor is not None:
            return self._said(verdict, f"the configurator {owner_of(self.life.supervisor)} holds it")
        if verdict is not Verdict.DONE:
            return self._said(verdict)
        trouble = self._become(life, told)
        if trouble is None and isinstance(message, Apply):
            self._follow(message)
            self._supervise(message.supervisor)
        elif trouble is None and isinstance(message, SetParameters):
            trouble = self._set(message)
        if trouble is not None:
            if isinstance(message, Apply) and before.phase is not LifePhase.ACTIVE:
                self._become(*lives.orphan(self.life))
            return self._said(Verdict.REFUSED, trouble)
        return self._said(Verdict.DONE)

    def _said(self, verdict: Verdict, detail: str = "") -> CallAnswer:
        holder = self.life.supervisor or ""
        return CallAnswer(verdict, self.profile.component, self.name, self.life.epoch, self.active, detail, holder)

    def _become(self, life: Life, told: Told) -> str | None:
        """Take on a life and tell the component's code; a text if that refuses or breaks."""
        self.life = life
        if told in (Told.STOP, Told.RESTART):
            self._rest()
        if told is Told.TELL:
            self.active = False
        if told in (Told.START, Told.RESTART):
            self._last.clear()
            self.active = True
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

    def _rest(self) -> None:
        """Be off: no timers, no inputs, no supervisor, and the component's code at rest."""
        self.active = False
        for undo in self._timers.values():
            undo()
        for following in self._following.values():
            following.end()
        self._timers.clear()
        self._following.clear()
        self._unsupervise()
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

    def _guarded(self, action: Callable[[], None]) -> None:
        """Run the component's code; what breaks there is the component's failure, not ours."""
        try:
            action()
        except Exception as error:
            log.exception("%s broke", self.profile.component.short)
            self.fail(f"{type(error).__name__}: {error}")

    # Inputs.

    def _follow(self, message: Apply) -> None:
        """New connections first, for somebody waits for them; the old ones end when the call has been answered."""
        wanted = dict.fromkeys((port, wire) for port, wires in message.inputs.items() for wire in wires)
        spare = dict.fromkeys((port, wire) for port, wires in message.standby.items() for wire in wires)
        for port, wire in (*wanted, *spare):
            if (port, wire) not in self._following:
                self._following[port, wire] = Following(self, port, wire)
        for key, following in list(self._following.items()):
            if key in wanted:
                following.heed()
                continue
            following.mute()
            if key not in spare:
                del self._following[key]
                self.bus.wake_up(following.end)

    def deliver(self, port: str, signal: Signal) -> None:
        """Hand a signal to the component."""
        if self.active:
            self._guarded(lambda: self.component.received(port, signal))

    def report_silence(self, wire: Wire, seconds: float) -> None:
        """Tell the configurator that an output we follow has stopped."""
        detail = f"no signal on {wire.output!r} for {seconds:.2f} s"
        self._fail.put(encode(Fail(wire.component, "", self.life.epoch, Cause.SILENCE, detail)))

    # Supervision.

    def _supervise(self, supervisor: str) -> None:
        if supervisor == self._supervisor:
            return
        self._unsupervise()
        self._supervisor = supervisor
        self._worry()
        self.bus.later(SIGNALS_FIRST, lambda: self._watch(supervisor))

    def _watch(self, supervisor: str) -> None:
        """Watch the supervisor's life, unless this component has been turned off or taken over meanwhile."""
        if self._supervisor == supervisor and not self._supervision:
            self._supervision.append(self.bus.watch(supervisor, self._supervisor_changed))

    def _unsupervise(self) -> None:
        for undo in self._supervision:
            undo()
        self._supervision.clear()
        self._supervisor, self._gone = "", False
        self._keep_calm()

    def _supervisor_changed(self, _: str, alive: bool) -> None:
        self._gone = not alive
        if alive:
            self._keep_calm()
        else:
            self._worry()

    def _worry(self) -> None:
        if self._grace is None:
            self._grace = self.bus.later(GRACE, self._orphaned)

    def _keep_calm(self) -> None:
        if self._grace is not None:
            self._grace()
            self._grace = None

    def _orphaned(self) -> None:
        self._grace = None
        log.warning("%s: its configurator is gone; turning off", self.profile.component.short)
        self._become(*lives.orphan(self.life))

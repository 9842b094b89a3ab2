"""The calls that a configurator makes to components: activate and connect, set, turn off, wake, stand by.

A time-out is not an outcome: after one the component is asked for its actual state, and that decides. A call is made
again if the state shows that it never arrived.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping

from selfconf.bus.port import Replies, Undo
from selfconf.configurator import machine
from selfconf.configurator.effects import ApplyTo, ReleaseFrom, SetOn
from selfconf.configurator.events import Answered, Call, Event
from selfconf.configurator.state import State
from selfconf.deployment.run_request import EventListener, Standby
from selfconf.discovery import EcologyView, FoundAdvertisement
from selfconf.errors import PeerError
from selfconf.model.configuration import Configuration, Connection
from selfconf.model.run_event import (
    ActivationSent,
    CallDeclined,
    ComponentActivated,
    ComponentReleased,
    ComponentUnreachable,
    ComponentWoken,
    InputConnected,
    ParametersSet,
)
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.messages import Apply, CallAnswer, Release, SetParameters, Verdict, Wake, Wire

log = logging.getLogger(__name__)

_DONE = {Call.APPLY: ComponentActivated, Call.SET: ParametersSet, Call.RELEASE: ComponentReleased}
"""The event of a call that was obeyed."""

CALL = 2.0
"""Seconds that a component may take to answer a call before it is asked for its state."""
STARTING = 8.0
"""Seconds that a component that lives, but does not answer, may take to obey a call: it may be in `started`."""
PAUSE = 0.1
"""Seconds after which a component that has not answered a question for its state is asked again."""
CALL_ATTEMPTS = 3
"""How often a call is made to a component that answers, but has not obeyed: the call may have been lost."""
WAKING = 15.0
"""Seconds that a component that a site starts may take to live."""


class Calls:
    """Makes the calls of one configurator, and feeds its machine with what becomes of them."""

    def __init__(
        self,
        ecology: EcologyView,
        supervisor: str,
        state: Callable[[], State],
        step: Callable[[Event], None],
        report: EventListener,
    ) -> None:
        self.bus, self.ecology, self.keys = ecology.bus, ecology, ecology.keys
        self.supervisor, self._state, self._step, self._report = supervisor, state, step, report
        self._waking: dict[IRI, tuple[ApplyTo, Undo]] = {}
        self._connections: dict[IRI, tuple[str, frozenset[Connection]]] = {}
        """The connections that each component was given, in which life, so that only new ones are reported."""

    def woken(self, component: IRI) -> None:
        """A component lives; if it was started for an apply, the apply goes out now."""
        waiting = self._waking.pop(component, None)
        if waiting is not None:
            waiting[1]()
            if waiting[0].epoch == self._state().epoch:
                self.apply(waiting[0])

    def set(self, effect: SetOn) -> None:
        """Give operational parameters their values."""
        message = SetParameters(effect.epoch, self.supervisor, effect.values)
        self._call(effect.component, Call.SET, message)

    def apply(self, effect: ApplyTo) -> None:
        """Activate a component and connect its inputs; one that is dormant is woken by its site first."""
        life = self.ecology.life(effect.component)
        found = self.ecology.discovery.found.get(effect.component)
        if life is None and found is not None and found.startable:
            self._wake(effect, found)
            return
        if life is None:
            self._later_answer(effect, "it is advertised, but it does not run")
            return
        inputs = self._with_promises(effect.inputs)
        self._call(effect.component, Call.APPLY, Apply(effect.epoch, self.supervisor, inputs))
        connections = {Connection(w.component, w.output, effect.component, p) for p, ws in inputs.items() for w in ws}
        known, before = self._connections.get(effect.component, (life, frozenset()))
        for c in sorted(connections - before if known == life else connections):
            self._report(InputConnected(c.source, c.output, c.sink, c.input))
        self._connections[effect.component] = life, frozenset(connections)
        self._report(ActivationSent(effect.component))

    def forget_connections(self) -> None:
        """Components may have turned themselves off: all that is applied to from now on is connected anew."""
        self._connections.clear()

    def _with_promises(self, wires: Mapping[str, tuple[Wire, ...]]) -> dict[str, tuple[Wire, ...]]:
        return {port: tuple(map(self._promised, outputs)) for port, outputs in wires.items()}

    def stand_by(self, configuration: Configuration, standby: Standby) -> None:
        """Let the inputs listen to what may come next, now that there is time; the answers are not waited for."""
        wires = machine.wiring(configuration)
        for component, outputs in standby.items():
            inputs, spare = self._with_promises(wires[component]), self._with_promises(outputs)
            message = Apply(self._state().epoch, self.supervisor, inputs, spare)
            self.bus.ask(self.keys.call(component, Call.APPLY.value), encode(message), CALL, lambda replies: None)

    def _promised(self, wire: Wire) -> Wire:
        """A wire with the longest pause that the output's advertisement promises."""
        found = self.ecology.discovery.found.get(wire.component)
        output = found.advertisement.profile.output(wire.output) if found else None
        return Wire(wire.component, wire.output, 1 / output.rate) if output and output.rate else wire

    def release(self, effect: ReleaseFrom) -> None:
        """Turn a component off; one that lives but does not obey is called again as long as it is owed the release."""
        self._connections.pop(effect.component, None)
        if self.ecology.life(effect.component) is None:
            off = Answered(effect.component, Call.RELEASE, effect.epoch, None)
            self.bus.wake_up(lambda: self._step(off))
            return

        def again() -> None:
            if self._state().owed.get(effect.component) == effect.epoch and self.ecology.life(effect.component):
                self.release(effect)

        self.bus.later(2 * CALL, again)
        self._call(effect.component, Call.RELEASE, Release(effect.epoch, self.supervisor))

    def _later_answer(self, effect: ApplyTo, detail: str) -> None:
        answer = Answered(effect.component, Call.APPLY, effect.epoch, None, detail=detail)
        self._report(ComponentUnreachable(effect.component, Call.APPLY.value, detail))
        self.bus.wake_up(lambda: self._step(answer))

    def _wake(self, effect: ApplyTo, found: FoundAdvertisement) -> None:
        """Have the site start the process; the apply goes out when the component lives."""
        self._report(ComponentWoken(effect.component, found.site))

        def give_up(detail: str) -> None:
            waiting = self._waking.get(effect.component)
            if waiting is not None and waiting[0] is effect:
                del self._waking[effect.component]
                waiting[1]()
                if effect.epoch == self._state().epoch:
                    self._later_answer(effect, detail)

        def answered(replies: Replies) -> None:
            if not replies.samples:
                give_up(replies.errors[0] if replies.errors else "its site does not answer")

        too_late = f"it was started, but does not live after {WAKING:.0f} s"
        self._waking[effect.component] = effect, self.bus.later(WAKING, lambda: give_up(too_late))
        self.bus.ask(self.keys.wake(found.site), encode(Wake(effect.component)), CALL, answered)

    def _call(
        self, component: IRI, call: Call, message: Apply | SetParameters | Release, attempts: int = CALL_ATTEMPTS
    ) -> None:
        began = self.bus.now()

        def answered(replies: Replies) -> None:
            answer = _answer_in(replies)
            if answer is not None:
                self._answered(component, call, message.epoch, answer)
            elif replies.errors:
                detail = replies.errors[0]
                self._step(Answered(component, call, message.epoch, Verdict.REFUSED, detail=detail))
            else:
                inspect()

        def inspect() -> None:
            """A time-out is not an outcome: ask for the actual state, then decide."""
            self.bus.ask(self.keys.call(component, "state"), b"", CALL, seen)

        def seen(replies: Replies) -> None:
            answer = _answer_in(replies)
            current = message.epoch == self._state().epoch
            obeyed = answer is not None and answer.epoch == message.epoch
            silent = not replies.samples and not replies.errors
            if obeyed and answer is not None and call is not Call.SET and answer.active == (call is Call.APPLY):
                self._answered(component, call, message.epoch, answer)
            elif attempts > 1 and answer is not None and current:
                self._call(component, call, message, attempts - 1)
            elif silent and current and call is not Call.RELEASE and self.bus.now() - began < STARTING:
                self.bus.later(PAUSE, inspect)  # it may be in `started`; if its life ends, it is lost at once
            elif current or call is Call.RELEASE:
                self._report(ComponentUnreachable(component, call.value, "it does not answer"))
                self._step(Answered(component, call, message.epoch, None))

        self.bus.ask(self.keys.call(component, call.value), encode(message), CALL, answered)

    def look(self, component: IRI, seen: Callable[[CallAnswer | None], None], attempts: int = CALL_ATTEMPTS) -> None:
        """Ask a component for its actual state; `seen` receives None if it does not answer."""

        def answered(replies: Replies) -> None:
            answer = _answer_in(replies)
            if answer is None and not replies.complete and attempts > 1:
                self.look(component, seen, attempts - 1)
            else:
                seen(answer)

        self.bus.ask(self.keys.call(component, "state"), b"", CALL, answered)

    def _answered(self, component: IRI, call: Call, epoch: int, answer: CallAnswer) -> None:
        done = answer.verdict is Verdict.DONE
        if done or call is not Call.RELEASE:  # a component that another configurator holds is released again and again
            event = _DONE[call] if done else CallDeclined
            self._report(event(component, answer.detail or answer.verdict.value))
        self._step(Answered(component, call, epoch, answer.verdict, answer.life, answer.epoch, answer.detail))


def _answer_in(replies: Replies) -> CallAnswer | None:
    for sample in replies.samples:
        try:
            return decode(sample.payload, CallAnswer)
        except PeerError as error:
            log.warning("passed over an answer on %s: %s", sample.key, error)
    return None

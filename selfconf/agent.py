"""The configurator as a program: it runs the machine's effects on the bus and feeds it what the bus says."""

from __future__ import annotations

import logging
import os
import secrets
import socket
import time
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

from selfconf.bus.port import Bus, Replies, Request, Sample, Undo, Urgency
from selfconf.configurator import machine
from selfconf.configurator.effects import (
    ApplyTo,
    Compose,
    Discover,
    Effect,
    Finish,
    ReleaseFrom,
    Running,
    SetOn,
    Unwatch,
    Watch,
)
from selfconf.configurator.events import (
    Accepted,
    Answered,
    Appeared,
    Call,
    Composed,
    Discovered,
    Event,
    Failed,
    Reconnected,
    Stopped,
)
from selfconf.configurator.machine import Phase, Policy, State
from selfconf.ecology import Discovery, Ecology, Found
from selfconf.errors import PeerError, SelfconfError
from selfconf.model.configuration import Configuration, Connection
from selfconf.model.refusal import Refusal
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import component_chunk, life_of, owner_of, owner_of_fail
from selfconf.protocol.messages import (
    Answer,
    Apply,
    Cause,
    Fail,
    Release,
    SetParameters,
    Status,
    Verdict,
    Wake,
    Wire,
)
from selfconf.rdf import write
from selfconf.rdf.advertisements import Advertisement

log = logging.getLogger(__name__)

CALL = 2.0
"""How long a component may take to answer a call."""
ATTEMPTS = 3
"""How often a call is made to a component that answers, but has not obeyed: a message may have been lost."""
TRY_AGAIN = 5.0
"""Seconds after which a patient configurator gives a crashed component that can be started another chance."""
WAKING = 15.0
"""How long a component that a site starts may take to live."""
SECOND_LOOK = 0.03
"""When to look again whether a life that has ended has: the network tells of it before it tells of a broken link."""
CUT_OFF = 0.25
"""How often a configurator that is cut off looks whether it still is."""
ASK_AGAIN = 5.0
"""When a site that lives, but has not answered, counts as news again."""
SETTLING = 1.0
"""How long others may take to be connected again after us; as long as components go on without a supervisor."""


Composer = Callable[[Mapping[IRI, Advertisement], frozenset[IRI], "Configuration | None"], "Configuration | Refusal"]
"""Act 3: from the advertisements, the lost components and what runs now, a configuration or a refusal."""


Standby = Mapping[IRI, Mapping[str, tuple[Wire, ...]]]


@dataclass(frozen=True, slots=True)
class Account:
    """One thing that the configurator did or noticed, for people and logs."""

    act: str
    time: float
    facts: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, kw_only=True)
class Order:
    """What an agent is to do: how to compose, how to mend, and who wants to know."""

    template: IRI
    compose: Composer
    policy: Policy = Policy.REPAIR
    patient: bool = False
    standby: Callable[[Configuration, frozenset[IRI]], Standby] = lambda configuration, lost: {}
    """For each component and input of a configuration, the outputs that might be connected next, but for the lost."""
    tell: Callable[[Account], None] = lambda account: None
    settle: Callable[[Refusal | None], None] = lambda refusal: None
    """Hears once when the task has ended; with the refusal if that is why."""


class Agent:
    """Runs one task: acts 1 to 4, then watches and configures again, until it is stopped or refused."""

    def __init__(
        self, bus: Bus, ecology: str, order: Order, name: str = "", clock: Callable[[], float] = time.time
    ) -> None:
        self.bus, self.order, self.clock = bus, order, clock
        self.ecology = Ecology(bus, ecology)
        self.keys = self.ecology.keys
        self.name = name or f"c{secrets.token_hex(4)}"
        self.supervisor = self.keys.configurator_life(self.name, secrets.token_hex(4))
        self.state = State(policy=order.policy, patient=order.patient)
        self.since = clock()
        self.trouble: SelfconfError | None = None
        """Why the task was given up, where that is neither a refusal nor a wish: its shapes cannot be judged."""
        self._sites: set[str] = set()
        self._unheard: dict[str, str] = {}
        self._link, self._cut_off = bus.link, False
        self._watched: set[IRI] = set()
        self._waking: dict[IRI, tuple[ApplyTo, Undo]] = {}
        self._connections: dict[IRI, frozenset[Connection]] = {}
        """The connections that each component was told to have, so that only new ones are told of."""
        self._events: deque[Event] = deque()
        self._stepping = False
        self._untold: list[Account] = []
        self._deployed: list[tuple[IRI, Configuration, int, float]] = []
        self._failures: list[tuple[IRI, str, str, float]] = []
        bus.serve(self.keys.configuration(self.name), self._serve_configuration)
        bus.serve(self.keys.configurator_call(self.name), self._serve_call)
        self._leave = bus.announce(self.supervisor)
        # One subscription for the FAIL of all: connecting to each as it joins would delay its activation.
        bus.subscribe(self.keys.any_fail(), self._heard_fail, Urgency.EVENT)
        bus.subscribe(self.keys.changed(), lambda _: self._step(Appeared({})), Urgency.EVENT)

    def start(self) -> None:
        """Begin with act 1."""
        self._step(Accepted(int(self.clock() * 1000)))

    def stop(self) -> None:
        """Take the configuration down; `order.settle` hears when that is done."""
        self._step(Stopped())

    @property
    def configuration(self) -> Configuration | None:
        """What is deployed, or being deployed."""
        return self.state.target

    def _step(self, event: Event) -> None:
        """Feed the machine; an event that an effect brings about comes after the other effects."""
        self._events.append(event)
        if self._stepping:
            return
        self._stepping = True
        try:
            while self._events:
                next_event, before = self._events.popleft(), self.state.phase
                if isinstance(next_event, Failed):
                    self._notice(next_event)
                self.state, effects = machine.step(self.state, next_event)
                for effect in effects:
                    self._do(effect)
                returned = isinstance(next_event, Appeared) and bool(next_event.lives)
                if returned and self.state.phase is Phase.RUNNING and self.state.target is not None:
                    self._stand_by(self.state.target)
                if self.state.phase is not before:
                    self._changed_phase(before)
        finally:
            self._stepping = False

    def _changed_phase(self, before: Phase) -> None:
        log.debug("%s -> %s", before.value, self.state.phase.value)
        self.since = self.clock()
        if self.state.phase is Phase.REFUSED and self.state.patient:
            self._tell("waiting", refusal=self.state.refusal)
            self.bus.later(TRY_AGAIN, self._forgive)

    def _forgive(self) -> None:
        """Somebody who crashed, and whose site can start it, may be tried again when there is no other way."""
        crashed = {
            component: ""
            for component, loss in self.state.lost.items()
            if loss.cause is Cause.CRASH and (found := self.ecology.discovery.found.get(component)) and found.startable
        }
        if crashed and self.state.phase is Phase.REFUSED:
            self._step(Appeared(crashed))

    def _notice(self, event: Failed) -> None:
        held = self.state.held.get(event.component)
        if held is not None and not (event.life and held.life and event.life != held.life):
            self._failures.append((event.component, event.cause.value, event.detail, self.clock()))
            self._tell("lost", component=event.component, cause=event.cause.value, detail=event.detail)

    def _tell(self, act: str, **facts: Any) -> None:
        """Note an account now, and tell it when there is nothing more urgent to do."""
        if not self._untold:
            self.bus.wake_up(self._tell_all)
        self._untold.append(Account(act, self.clock(), facts))

    def _tell_all(self) -> None:
        untold, self._untold = self._untold, []
        for account in untold:
            self.order.tell(account)

    # Effects.

    def _do(self, effect: Effect) -> None:
        match effect:
            case Discover():
                self._tell("query")
                self.ecology.discover(self._discovered)
            case Compose():
                self._compose(effect)
            case Watch():
                self._watch(effect.component)
            case Unwatch():
                self._watched.discard(effect.component)
            case ApplyTo():
                self._apply(effect)
            case SetOn():
                message = SetParameters(effect.epoch, self.supervisor, effect.values)
                self._call(effect.component, Call.SET, message)
            case ReleaseFrom():
                self.bus.wake_up(partial(self._release, effect))  # not before what others wait for
            case Running():
                name = write.configuration_iri(effect.configuration, self.state.epoch)
                self._deployed.append((name, effect.configuration, self.state.epoch, self.clock()))
                self._tell("running", configuration=effect.configuration, epoch=self.state.epoch)
                self._stand_by(effect.configuration)
            case Finish():
                lost = {component: f"{loss.cause.value}, {loss.detail}" for component, loss in self.state.lost.items()}
                self._tell("refused" if effect.refusal else "stopped", refusal=effect.refusal, lost=lost)
                try:
                    self._tell_all()
                finally:  # the end of a task depends on nobody who listens
                    self._leave()  # whoever could not be told to turn off will notice
                    self.order.settle(effect.refusal)

    def _discovered(self, discovery: Discovery) -> None:
        self.ecology.discovery = discovery
        self._sites.update(set(discovery.sites) - set(discovery.missing))
        if not self.ecology.followed:
            self._unheard = dict(self.ecology.lives)
            self.bus.later(SETTLING, self._end_unheard)
        self.ecology.follow(self._life_changed, self._site_changed)
        for complaint in discovery.complaints:
            self._tell("complaint", detail=complaint)
        self._tell("discovered", components=len(discovery.found), sites=discovery.sites, missing=discovery.missing)
        if discovery.missing:
            self.bus.later(ASK_AGAIN, lambda: self._step(Appeared({})))
        self._step(Discovered())

    def _compose(self, effect: Compose) -> None:
        found = {component: f.advertisement for component, f in self.ecology.discovery.found.items()}
        began = self.bus.now()
        try:
            outcome = self.order.compose(found, effect.lost, effect.running)
        except SelfconfError as error:
            self.trouble = error
            self._step(Stopped())
            return
        if isinstance(outcome, Refusal):
            outcome = replace(outcome, missing_sites=self.ecology.discovery.missing)
        seconds = self.bus.now() - began
        self._tell("composed", outcome=outcome, seconds=seconds)
        self._step(Composed(effect.attempt, outcome))

    def _watch(self, component: IRI) -> None:
        self._tell("watching", component=component)
        self._watched.add(component)

    def _heard_fail(self, sample: Sample) -> None:
        try:
            fail = decode(sample.payload, Fail)
        except PeerError as error:
            log.warning("passed over a FAIL on %s: %s", sample.key, error)
            return
        own = sample.key == self.keys.fail(fail.component)
        reported = fail.cause is Cause.SILENCE and owner_of_fail(sample.key) in map(component_chunk, self._watched)
        if fail.component in self._watched and (own or reported):
            self._step(Failed(fail.component, fail.life, fail.cause, fail.detail))

    def _apply(self, effect: ApplyTo) -> None:
        life = self.ecology.life(effect.component)
        found = self.ecology.discovery.found.get(effect.component)
        if life is None and found is not None and found.startable:
            self._wake(effect, found)
            return
        if life is None:
            self._later_answer(effect, "it is advertised, but it does not run")
            return
        inputs = self._with_promises(effect.inputs)
        connections = {Connection(w.component, w.output, effect.component, p) for p, ws in inputs.items() for w in ws}
        before = self._connections.get(effect.component, frozenset())
        for c in sorted(connections - before):
            self._tell("connecting", source=c.source, output=c.output, sink=c.sink, input=c.input)
        self._connections[effect.component] = frozenset(connections)
        self._tell("activating", component=effect.component)
        self._call(effect.component, Call.APPLY, Apply(effect.epoch, self.supervisor, inputs))

    def _with_promises(self, wires: Mapping[str, tuple[Wire, ...]]) -> dict[str, tuple[Wire, ...]]:
        return {port: tuple(map(self._promised, outputs)) for port, outputs in wires.items()}

    def _stand_by(self, configuration: Configuration) -> None:
        """Tell the inputs what may come next, now that there is time for it; nobody waits for the answers."""
        wires = machine.wiring(configuration)
        for component, standby in self.order.standby(configuration, frozenset(self.state.lost)).items():
            inputs, spare = self._with_promises(wires[component]), self._with_promises(standby)
            message = Apply(self.state.epoch, self.supervisor, inputs, spare)
            self.bus.ask(self.keys.call(component, Call.APPLY.value), encode(message), CALL, lambda replies: None)

    def _promised(self, wire: Wire) -> Wire:
        """The wire with the longest pause that the output's advertisement promises."""
        found = self.ecology.discovery.found.get(wire.component)
        output = found.advertisement.profile.output(wire.output) if found else None
        return Wire(wire.component, wire.output, 1 / output.rate) if output and output.rate else wire

    def _release(self, effect: ReleaseFrom) -> None:
        """Turn a component off; one that lives but does not answer is told again as long as it is owed that."""
        if self.ecology.life(effect.component) is None:
            off = Answered(effect.component, Call.RELEASE, effect.epoch, None)
            self.bus.wake_up(lambda: self._step(off))
            return

        def again() -> None:
            if self.state.owed.get(effect.component) == effect.epoch and self.ecology.life(effect.component):
                self._release(effect)

        self.bus.later(2 * CALL, again)
        self._call(effect.component, Call.RELEASE, Release(effect.epoch, self.supervisor))

    def _later_answer(self, effect: ApplyTo, detail: str) -> None:
        answer = Answered(effect.component, Call.APPLY, effect.epoch, None, detail=detail)
        self._tell("unreachable", component=effect.component, call=Call.APPLY.value, detail=detail)
        self.bus.wake_up(lambda: self._step(answer))

    def _wake(self, effect: ApplyTo, found: Found) -> None:
        """Have the site start the process; the apply goes out when the component lives."""
        self._tell("waking", component=effect.component, site=found.site)

        def give_up(detail: str) -> None:
            waiting = self._waking.get(effect.component)
            if waiting is not None and waiting[0] is effect:
                del self._waking[effect.component]
                waiting[1]()
                self._later_answer(effect, detail)

        def answered(replies: Replies) -> None:
            if not replies.samples:
                give_up(replies.errors[0] if replies.errors else "its site does not answer")

        too_late = f"it was started, but does not live after {WAKING:.0f} s"
        self._waking[effect.component] = effect, self.bus.later(WAKING, lambda: give_up(too_late))
        self.bus.ask(self.keys.wake(found.site), encode(Wake(effect.component)), CALL, answered)

    def _call(
        self, component: IRI, call: Call, message: Apply | SetParameters | Release, attempts: int = ATTEMPTS
    ) -> None:
        def answered(replies: Replies) -> None:
            answer = _answer_in(replies)
            if answer is not None:
                self._heard_answer(component, call, message.epoch, answer)
            elif replies.errors:
                detail = replies.errors[0]
                self._step(Answered(component, call, message.epoch, Verdict.REFUSED, detail=detail))
            else:
                self._inspect(component, call, message, attempts - 1)

        self.bus.ask(self.keys.call(component, call.value), encode(message), CALL, answered)

    def _inspect(self, component: IRI, call: Call, message: Apply | SetParameters | Release, attempts: int) -> None:
        """A time-out is not an outcome: look at the actual state, then decide."""

        def seen(replies: Replies) -> None:
            answer = _answer_in(replies)
            obeyed = answer is not None and answer.epoch == message.epoch
            if obeyed and answer is not None and call is not Call.SET and answer.active == (call is Call.APPLY):
                self._heard_answer(component, call, message.epoch, answer)
            elif attempts and answer is not None and message.epoch == self.state.epoch:
                self._call(component, call, message, attempts)
            else:
                if replies == Replies():  # nobody is there to answer, whatever we heard of its life
                    self.ecology.lives.pop(component_chunk(component), None)
                self._tell("unreachable", component=component, call=call.value, detail="it does not answer")
                self._step(Answered(component, call, message.epoch, None))

        self.bus.ask(self.keys.call(component, "state"), b"", CALL, seen)

    def _heard_answer(self, component: IRI, call: Call, epoch: int, answer: Answer) -> None:
        word = {Call.APPLY: "activated", Call.SET: "set", Call.RELEASE: "released"}[call]
        done = answer.verdict is Verdict.DONE
        self._tell(word if done else "declined", component=component, detail=answer.detail or answer.verdict.value)
        self._step(Answered(component, call, epoch, answer.verdict, answer.life, answer.epoch, answer.detail))

    # What the ecology says.

    def _life_changed(self, key: str, alive: bool) -> None:
        chunk, life = owner_of(key), life_of(key)
        component = self._component(chunk)
        known = self.ecology.lives.get(chunk) == life
        self._unheard.pop(chunk, None)
        if alive and not known:
            self.ecology.lives[chunk] = life
            waiting = self._waking.pop(component, None) if component is not None else None
            if waiting is not None:
                waiting[1]()
                if waiting[0].epoch == self.state.epoch:
                    self._apply(waiting[0])
            self._step(Appeared({component: life} if component is not None else {}))
        elif not alive:
            self._ended(chunk, life)

    def _ended(self, chunk: str, life: str) -> None:
        """A life has ended, or the way to it: who is connected to another router lives again in a moment."""
        component = self._component(chunk)
        known = self.ecology.lives.get(chunk) == life
        if known:
            del self.ecology.lives[chunk]

        def look_again() -> None:
            now = self.ecology.lives.get(chunk)
            if self.bus.link != self._link:
                self._await_link()
            elif component is not None and now != life:
                self._step(Failed(component, life, Cause.CRASH, "its life has ended"))
                if now is not None:
                    self._step(Appeared({component: now}))

        if known or (component is not None and self._held_life(component) == life):
            self.bus.later(SECOND_LOOK, look_again)

    def _end_unheard(self) -> None:
        """Who died between the roll-call and the beginning of the watch was called, but has never been heard."""
        for chunk, life in self._unheard.items():
            self._ended(chunk, life)
        self._unheard.clear()

    def _held_life(self, component: IRI) -> str | None:
        held = self.state.held.get(component)
        return held.life if held is not None else None

    def _site_changed(self, key: str, alive: bool) -> None:
        site = owner_of(key)
        if alive and site not in self._sites:
            self._sites.add(site)
            self._step(Appeared({}))
        elif not alive:
            self._sites.discard(site)

    def _await_link(self) -> None:
        """Who is cut off sees everybody die, and cannot tell; what has become of them is asked afterwards."""

        def look() -> None:
            if self.bus.link:
                self.bus.later(SETTLING, connected)
            else:
                self.bus.later(CUT_OFF, look)

        def connected() -> None:
            if not self.bus.link:
                look()
                return
            self._link, self._cut_off = self.bus.link, False
            self._tell("connected")
            self._step(Reconnected())

        if not self._cut_off:
            self._cut_off = True
            self._tell("cut off")
            look()

    def _component(self, chunk: str) -> IRI | None:
        for component in (*self.state.held, *self.state.owed, *self.state.lost, *self.ecology.discovery.found):
            if component_chunk(component) == chunk:
                return component
        return None

    # What others ask.

    def _serve_configuration(self, request: Request) -> None:
        try:
            if self._deployed:
                request.reply(self.keys.configuration(self.name), self.configuration_turtle().encode())
        finally:
            request.finish()

    def configuration_turtle(self) -> str:
        """What is deployed, as Turtle with its provenance."""
        name, configuration, epoch, generated = self._deployed[-1]
        revises = self._deployed[-2][0] if len(self._deployed) > 1 else None
        triples = write.configuration_triples(
            configuration,
            name,
            epoch=epoch,
            generated=generated,
            revises=revises,
            configurator=self.name,
            failures=self._failures,
        )
        return write.turtle(triples)

    def _serve_call(self, request: Request) -> None:
        try:
            call = request.key.rsplit("/", 1)[-1]
            if call == "stop":
                request.reply(self.keys.configurator_call(self.name, "stop"), encode(self.status()))
                self.bus.wake_up(self.stop)
            elif call in ("status", "*"):
                request.reply(self.keys.configurator_call(self.name, "status"), encode(self.status()))
            else:
                request.refuse(f"there is no call {call!r}")
        finally:
            request.finish()

    def status(self) -> Status:
        """What is deployed, by whom, since when."""
        return Status(
            configurator=self.name,
            phase="waiting" if self.state.phase is Phase.REFUSED else self.state.phase.value,
            template=self.order.template,
            epoch=self.state.epoch,
            since=self.since,
            host=socket.gethostname(),
            process=os.getpid(),
            components=tuple(self.state.held),
            lost={component: loss.cause.value for component, loss in self.state.lost.items()},
        )


def _answer_in(replies: Replies) -> Answer | None:
    for sample in replies.samples:
        try:
            return decode(sample.payload, Answer)
        except PeerError as error:
            log.warning("passed over an answer on %s: %s", sample.key, error)
    return None

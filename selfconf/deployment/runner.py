"""The configurator as a program: it runs the machine's effects on the bus and feeds it what the bus says."""

from __future__ import annotations

import logging
import os
import secrets
import socket
import time
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial

from selfconf.bus.port import Bus, Sample, Undo, Urgency
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
    Appeared,
    Composed,
    Discovered,
    Event,
    Failed,
    Stopped,
)
from selfconf.configurator.state import Loss, Phase, State
from selfconf.deployment.calls import Calls
from selfconf.deployment.liveness import Liveness
from selfconf.deployment.record import DeploymentRecord
from selfconf.deployment.run_request import RunRequest
from selfconf.discovery import Discovery, EcologyView
from selfconf.errors import PeerError, SelfconfError
from selfconf.model.configuration import Configuration
from selfconf.model.refusal import Refusal
from selfconf.model.run_event import (
    AnswerRejected,
    ComponentLost,
    EcologyAsked,
    EcologyDiscovered,
    FailWatched,
    RunEvent,
    SearchEnded,
    TaskRefused,
    TaskRunning,
    TaskStopped,
    TaskWaiting,
)
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode
from selfconf.protocol.keys import component_chunk, owner_of_fail
from selfconf.protocol.messages import (
    Cause,
    Fail,
    Status,
)

log = logging.getLogger(__name__)

AT_LEISURE = 0.01
"""Seconds by which reports and releases are delayed while a configuration is deployed: nothing waits for them."""
TRY_AGAIN = 5.0
"""How often, in seconds, a patient configurator that waits looks which lost components may be tried again."""


class TaskRunner:
    """Runs one task: acts 1 to 4, then watches and configures again, until it is stopped or refused."""

    def __init__(
        self, bus: Bus, ecology: str, request: RunRequest, name: str = "", clock: Callable[[], float] = time.time
    ) -> None:
        self.bus, self.request, self.clock = bus, request, clock
        self.ecology = EcologyView(bus, ecology)
        self.keys = self.ecology.keys
        self.name = name or f"c{secrets.token_hex(4)}"
        self.supervisor = self.keys.configurator_life(self.name, secrets.token_hex(4))
        self.state = State(policy=request.policy, patient=request.patient)
        self.since = clock()
        self.trouble: SelfconfError | None = None
        """Why the task was given up, where that is neither a refusal nor a wish: its shapes cannot be judged."""
        self._calls = Calls(self.ecology, self.supervisor, self._now, self._step, self._report)
        self._liveness = Liveness(self.ecology, self._now, self._step, self._report, self._calls)
        self._record = DeploymentRecord(bus, self.keys, self.name, request, self.status, self.stop)
        self._watched: set[IRI] = set()
        self._events: deque[Event] = deque()
        self._stepping = False
        self._unreported: list[RunEvent] = []
        self._look_again: Undo = lambda: None
        self._leave = bus.announce(self.supervisor)
        # One subscription for the FAIL of all components: one for each that joins would delay its activation.
        bus.subscribe(self.keys.any_fail(), self._received_fail, Urgency.EVENT)
        bus.subscribe(self.keys.changed(), lambda _: self._step(Appeared({})))  # not urgent: a flood delays no FAIL

    def start(self) -> None:
        """Begin with act 1."""
        self._step(Accepted(int(self.clock() * 1000)))

    def stop(self) -> None:
        """Take the configuration down; `request.ended` is called when that is done."""
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
                next_event, before, known = self._events.popleft(), self.state.phase, self.state.lost
                self.state, effects = machine.step(self.state, next_event)
                if self.state.lost is not known:
                    self._notice(known)
                for effect in effects:
                    self._do(effect)
                returned = isinstance(next_event, Appeared) and bool(next_event.lives)
                if returned and self.state.phase is Phase.RUNNING and self.state.target is not None:
                    self._stand_by(self.state.target)
                if self.state.phase is not before:
                    self._changed_phase(before)
        finally:
            self._stepping = False

    def _now(self) -> State:
        return self.state

    def _stand_by(self, configuration: Configuration) -> None:
        standby = self.request.standby(configuration, frozenset(self.state.lost))
        self._calls.stand_by(configuration, standby)

    def _changed_phase(self, before: Phase) -> None:
        log.debug("%s -> %s", before.value, self.state.phase.value)
        self.since = self.clock()
        if self.state.phase is Phase.REFUSED and self.state.patient:
            self._report(TaskWaiting(self.state.refusal, self.losses))
            self._await_another_chance()

    def _await_another_chance(self) -> None:
        self._look_again()
        self._look_again = self.bus.later(TRY_AGAIN, self._forgive)

    def _forgive(self) -> None:
        """While the task is refused, try lost components again that may be able to act by now."""
        if self.state.phase is not Phase.REFUSED:
            return
        again = {component: "" for component, loss in self.state.lost.items() if self._may_be_able(component, loss)}
        if again:
            self._step(Appeared(again))
        else:
            self._await_another_chance()

    def _may_be_able(self, component: IRI, loss: Loss) -> bool:
        """Whether a site can start a crashed component, or a busy one is free, as it has obeyed its release."""
        if loss.cause is Cause.CRASH:
            found = self.ecology.discovery.found.get(component)
            return found is not None and found.startable
        return loss.busy and component not in self.state.owed

    @property
    def losses(self) -> dict[IRI, str]:
        """Why each component that was lost was lost, for people."""
        return {component: f"{loss.cause.value}, {loss.detail}" for component, loss in self.state.lost.items()}

    def _notice(self, known: Mapping[IRI, Loss]) -> None:
        """Record and report every component that the machine has just given up, whatever the cause."""
        for component, loss in self.state.lost.items():
            if known.get(component) is not loss:
                self._record.lost(component, loss.cause.value, loss.detail, self.clock())
                self._report(ComponentLost(component, loss.cause.value, loss.detail))

    def _report(self, event: RunEvent) -> None:
        """Note an event with its time, and report it when there is nothing more urgent to do."""
        if not self._unreported:
            self.bus.later(AT_LEISURE, self._report_all)
        self._unreported.append(replace(event, time=self.clock()))

    def _report_all(self) -> None:
        unreported, self._unreported = self._unreported, []
        for event in unreported:
            self.request.report(event)

    # Effects.

    def _do(self, effect: Effect) -> None:
        match effect:
            case Discover():
                self._report(EcologyAsked())
                self.ecology.discover(self._discovered)
            case Compose():
                self._compose(effect)
            case Watch():
                self._watch(effect.component)
            case Unwatch():
                self._watched.discard(effect.component)
            case ApplyTo():
                self._calls.apply(effect)
            case SetOn():
                self._calls.set(effect)
            case ReleaseFrom():
                leisure = AT_LEISURE if self.state.phase in (Phase.COMPOSING, Phase.DEPLOYING) else 0.0
                self.bus.later(leisure, partial(self._calls.release, effect))
            case Running():
                self._record.deployed(effect.configuration, self.state.epoch, self.clock())
                self._report(TaskRunning(effect.configuration, self.state.epoch))
                self._stand_by(effect.configuration)
            case Finish():
                refusal, lost = effect.refusal, self.losses
                self._report(TaskStopped(lost=lost) if refusal is None else TaskRefused(refusal, lost))
                try:
                    self._report_all()
                finally:  # the end of a task must not depend on what receives the reports
                    self._leave()  # a component that could not be released turns itself off now
                    self.request.ended(effect.refusal)

    def _discovered(self, discovery: Discovery) -> None:
        self.ecology.discovery = discovery
        self._liveness.discovered(discovery)
        for complaint in discovery.complaints:
            self._report(AnswerRejected(complaint))
        self._report(EcologyDiscovered(len(discovery.found), discovery.sites, discovery.missing))
        self._step(Discovered())

    def _compose(self, effect: Compose) -> None:
        found = {component: f.advertisement for component, f in self.ecology.discovery.found.items()}
        began = self.bus.now()
        try:
            outcome = self.request.compose(found, effect.lost, effect.running)
        except SelfconfError as error:
            self.trouble = error
            self._step(Stopped())
            return
        if isinstance(outcome, Refusal):
            outcome = replace(outcome, missing_sites=self.ecology.discovery.missing)
        seconds = self.bus.now() - began
        self._report(SearchEnded(outcome, seconds))
        self._step(Composed(effect.attempt, outcome))

    def _watch(self, component: IRI) -> None:
        self._report(FailWatched(component))
        self._watched.add(component)

    def _received_fail(self, sample: Sample) -> None:
        try:
            fail = decode(sample.payload, Fail)
        except PeerError as error:
            log.warning("passed over a FAIL on %s: %s", sample.key, error)
            return
        own = sample.key == self.keys.fail(fail.component)
        reported = fail.cause is Cause.SILENCE and owner_of_fail(sample.key) in map(component_chunk, self._watched)
        if fail.component in self._watched and (own or reported):
            self._step(Failed(fail.component, fail.life, fail.cause, fail.detail))

    def status(self) -> Status:
        """What is deployed, by whom, since when."""
        return Status(
            configurator=self.name,
            phase="waiting" if self.state.phase is Phase.REFUSED else self.state.phase.value,
            template=self.request.task.template.iri,
            epoch=self.state.epoch,
            since=self.since,
            host=socket.gethostname(),
            process=os.getpid(),
            components=tuple(self.state.held),
            lost={component: loss.cause.value for component, loss in self.state.lost.items()},
        )

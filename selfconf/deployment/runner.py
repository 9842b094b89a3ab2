"""The configurator as a program: it runs the machine's effects on the bus and feeds it what the bus says."""

from __future__ import annotations

import logging
import os
import secrets
import socket
import time
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from itertools import islice

from selfconf.bus.port import Bus, Replies
from selfconf.configurator import (
    Accepted,
    Adopted,
    Answered,
    Appeared,
    AwaitReturn,
    Compose,
    Composed,
    Discover,
    Effect,
    Event,
    Failed,
    Finish,
    HandedOver,
    Loss,
    Phase,
    Ranked,
    Reconnected,
    Rewired,
    Running,
    State,
    StayedAway,
    Stopped,
    step,
)
from selfconf.deployment.components import TaskComponents
from selfconf.deployment.improvement import Improvement
from selfconf.deployment.lasting_losses import LastingLosses
from selfconf.deployment.notices import RunNotices, RunReports
from selfconf.deployment.readiness import Readiness
from selfconf.deployment.record import DeploymentRecord
from selfconf.deployment.retries import RetriesWhileRefused, RetriesWhileRunning
from selfconf.deployment.run_request import RunRequest, TaskIdentity
from selfconf.deployment.task_context import TaskContext
from selfconf.deployment.task_discovery import TaskDiscovery
from selfconf.deployment.task_search import TaskSearch
from selfconf.discovery import EcologyView
from selfconf.errors import ProgrammerError, SelfconfError
from selfconf.model.configuration import Configuration, Wants
from selfconf.model.immutable import FrozenMapping, replace
from selfconf.model.run_event import (
    ComponentLost,
    TaskRefused,
    TaskRunning,
    TaskStopped,
    TaskWaiting,
)
from selfconf.model.term import IRI
from selfconf.protocol.keys import safe_name, task_identity
from selfconf.protocol.messages import RecordedLoss, Status, Wire

log = logging.getLogger(__name__)

RETURN = 3.0
"""Seconds for which a task that does not wait is not refused for lack of what has gone without a word.

By then that has turned itself off (`GONE` of `selfconf.deployment.components.releases`): no refusal need doubt it. A
task that has yielded a component waits as long for what the other task lets go of instead."""
LOSSES_TOLD = 1000
"""How many losses are named at most, the newest: where ever new components come and go they have no end."""


class TaskRunner:
    """Runs one task: acts 1 to 4, then watches and configures again, until it is stopped or refused."""

    def __init__(
        self,
        bus: Bus,
        ecology: str,
        request: RunRequest,
        name: str = "",
        clock: Callable[[], float] = time.time,
        task: str = "",
        beginning: float | None = None,
    ) -> None:
        """`task` and `beginning` are those of a task that another configurator has begun; by default it is new."""
        self.bus, self.request, self.clock = bus, request, clock
        self.ecology = EcologyView(
            bus,
            ecology,
            request.believed,
            selects=True,
            aside=request.aside,
            suspended_sites=request.suspended_sites,
        )
        self.keys = self.ecology.keys
        self.name = name or f"c{secrets.token_hex(4)}"
        alone = not task
        task = task or task_identity(request.name or safe_name(request.task.template.iri.short), self.name)
        self.identity = TaskIdentity(task, request.priority, clock() if beginning is None else beginning)
        self.supervisor = self.keys.configurator_life(self.name, secrets.token_hex(4))
        self.state = State(
            policy=request.policy,
            patient=request.patient,
            task=task,
            alone=alone,
            inside=request.outside is not None,
            priority=self.identity.priority,
        )
        self.since = clock()
        self.trouble: SelfconfError | None = None
        """Why the task was given up, where that is neither a refusal nor a wish: its shapes cannot be judged."""
        self._notices = RunNotices(bus, self.keys, self.name, task)
        self.reports = RunReports(bus, request, self._notices, clock)
        context = TaskContext(
            request,
            self.ecology,
            self.name,
            self.supervisor,
            lambda: self.identity,
            lambda: self.state,
            self._step,
            self.reports.note,
        )
        self._components = TaskComponents(context)
        self._readiness = Readiness(context, self._components)
        self._discovery = TaskDiscovery(context, self._components.liveness)
        self._search = TaskSearch(context, self._components.liveness, self._give_up)
        self._lasting_losses = LastingLosses(context)
        self._retries_while_refused = RetriesWhileRefused(context, self._components.lives)
        self._retries_while_running = RetriesWhileRunning(context, self._components.lives)
        self._improvement = Improvement(context)
        self._record = DeploymentRecord(context, self.status, self.stop)
        self._events: deque[Event] = deque()
        self._stepping = False
        self._leave = bus.announce(self.supervisor)
        self._unsubscribe = bus.subscribe(self.keys.changed(), lambda _: self._step(Appeared({})))

    def start(self, lost: tuple[RecordedLoss, ...] = (), statuses: Replies | None = None) -> None:
        """Begin with act 1, without what another configurator of the task had lost, as its `recorded_losses` said.

        `statuses` is what the configurators of the ecology have answered just before, where they were asked.
        """
        self._discovery.just_answered = statuses
        self._components.begin()
        self._step(Accepted(int(self.clock() * 1000), lost))

    def adopt(self, configuration: Configuration, epoch: int, lost: tuple[RecordedLoss, ...]) -> None:
        """Go on with a task that runs, in that configuration since that epoch, and whose configurator is gone.

        That had lost some components, as `recorded_losses` of its runner said.
        """
        self._components.begin()
        self._step(Adopted(epoch, configuration, lost))

    def hand_over(self) -> None:
        """Leave everything as it runs to another configurator of the same task."""
        self._step(HandedOver())

    def stop(self) -> None:
        """Take the configuration down; `request.ended` is called when that is done."""
        self._step(Stopped())

    @property
    def configuration(self) -> Configuration | None:
        """What is deployed, or being deployed."""
        return self.state.target

    @property
    def recorded_losses(self) -> tuple[RecordedLoss, ...]:
        """What was lost and lives on as it was, so that another configurator would not find out by itself.

        Of very many those that were lost last, as sites take no record that is too large.
        """
        lasting = [(component, loss) for component, loss in self.state.lost.items() if loss.lasts][-LOSSES_TOLD:]
        return tuple(RecordedLoss(component, loss.life, loss.cause, loss.detail) for component, loss in sorted(lasting))

    def rewire(self, rests: bool = False) -> None:
        """Tell those inside that are connected to what is outside that it has changed; `rests` as in an `Apply`."""
        if self.request.outside is not None:
            self._step(Rewired(self.request.outside.composite, rests))

    def reconsider(self, rests: bool = False) -> None:
        """Search again beside what runs, as other inputs than before are fed from outside; `rests` as in `rewire`."""
        self._step(Reconnected())
        if rests != self.state.rests:
            self.rewire(rests)

    def rank(self, priority: int, beginning: float) -> None:
        """Give the task another rank, and claim what it holds with that; what runs runs on."""
        ranked = replace(self.identity, priority=priority, beginning=beginning)
        if ranked != self.identity:
            self.identity = ranked
            self._step(Ranked(priority))

    def issued_outside(self) -> dict[str, tuple[Wire, ...]]:
        """Which outputs stand behind those of the composite of which the task is the inside."""
        return {} if self.state.target is None else self._components.ends.issued_outside(self.state.target)

    def calling_outside(self) -> dict[str, tuple[IRI, ...]]:
        """Which components call what the composite needs of which the task is the inside."""
        return {} if self.state.target is None else self._components.ends.calling_outside(self.state.target)

    def _step(self, event: Event) -> None:
        """Feed the machine; an event that an effect brings about comes after the other effects."""
        if isinstance(event, (Answered, Failed)):
            found = self.ecology.discovery.found.get(event.component)
            event = replace(event, startable=found is not None and found.startable)
        self._events.append(event)
        if self._stepping:
            return
        self._stepping = True
        try:
            while self._events:
                self._take(self._events.popleft())
        finally:
            self._stepping = False

    def _take(self, event: Event) -> None:
        before, known = self.state.phase, self.state.lost
        if isinstance(event, Appeared):
            self._retries_while_refused.appeared()
        self.state, effects = step(self.state, event)
        if self.state.lost is not known:
            self._notice(known)
        if self.state.target is None:
            self._record.taken_down()
        self._lasting_losses.stepped()
        for effect in effects:
            self._carry_out(effect)
        if self.state.phase is Phase.RUNNING:
            self._run_on(event)
            if self.request.upgrade is not None and (self.state.phase is not before or self.state.lost is not known):
                self._retries_while_running.plan()
        if self.state.phase is not before:
            self._changed_phase(before)

    def _run_on(self, event: Event) -> None:
        """Be ready for what may be lost next, and for what would be rather had, after an event while the task runs."""
        if isinstance(event, Appeared) and self.state.target is not None:
            self._improvement.settle(event.lives)
            self._search.prepare()
            if event.lives:
                self._readiness.prepare_soon.set()
        if isinstance(event, Composed):
            self._search.prepare()  # what was found, or is held by others, may be other than before
            if self.state.left_to_others:
                self._improvement.look_whether_free()

    def _carry_out(self, effect: Effect) -> None:
        """Do what the machine wants done. What breaks there must not leave a task half deployed: it is taken down."""
        try:
            self._do(effect)
        except Exception as error:
            log.exception("%s broke", type(effect).__name__)
            if self.trouble is None:
                self.trouble = ProgrammerError(f"{type(effect).__name__} broke: {type(error).__name__}: {error}")
                self._events.append(Stopped())

    def _changed_phase(self, before: Phase) -> None:
        log.debug("%s -> %s", before.value, self.state.phase.value)
        self.since = self.clock()
        if self.state.phase is Phase.RUNNING:
            self._retries_while_refused.runs()
        if self.state.phase is Phase.REFUSED and self.state.patient:
            self.reports.note(TaskWaiting(self.state.refusal, self.losses))
            self._retries_while_refused.plan()

    @property
    def losses(self) -> Mapping[IRI, str]:
        """Why each component was lost, for people, as of now; of very many those that were lost last."""
        return FrozenMapping({component: loss.why for component, loss in self._newest_losses()})

    def _newest_losses(self) -> Iterable[tuple[IRI, Loss]]:
        lost = self.state.lost
        return islice(lost.items(), max(0, len(lost) - LOSSES_TOLD), None)

    def _notice(self, known: Mapping[IRI, Loss]) -> None:
        """Record and report every component that the machine has just given up, whatever the cause; each loss once.

        Where only its life has ended since, its site is to count that as a crash if it is to start it again.
        """
        for component, loss in self.state.lost.items():
            before = known.get(component)
            if before is None or replace(before, revival=loss.revival) != loss:
                self._components.abandon(component)
                if not loss.again:
                    self._record.lost(component, loss.cause.value, loss.detail, self.clock())
                    self.reports.note(ComponentLost(component, loss.cause.value, loss.detail))
                self._lasting_losses.lost()
            elif before is not loss and loss.life:
                self._components.lives.lost(component, loss.life)

    # Effects.

    def _do(self, effect: Effect) -> None:
        match effect:
            case Discover():
                self._discovery.begin()
            case Compose():
                self._search.begin(effect)
            case AwaitReturn():
                self.bus.later(RETURN, partial(self._stayed_away, effect.attempt))
            case Running():
                self._record.deployed(effect.configuration, self.state.epoch, self.clock())
                self.reports.note(TaskRunning(effect.configuration, self.state.epoch))
                self._readiness.prepare()
                self._search.prepare()
                self._improvement.settle()
            case Finish():
                self._finish(effect)
            case _:
                self._components.carry_out(effect)

    def _stayed_away(self, attempt: int) -> None:
        """End the wait of a search that has found nothing; if this node is cut off, it will be made anew."""
        if not self._components.reachability.cut_off:
            self._step(StayedAway(attempt))

    def _finish(self, effect: Finish) -> None:
        """End, once it is known of what has gone without a word that it is at rest; that takes `GONE` at most."""
        self._components.await_rest(partial(self._end, effect))

    def _end(self, effect: Finish) -> None:
        refusal, lost, owed = effect.refusal, self.losses, self._components.out_of_control()
        self.reports.note(TaskStopped(lost=lost, owed=owed) if refusal is None else TaskRefused(refusal, lost, owed))
        try:
            self.reports.tell()
        finally:  # the end of a task must not depend on what receives the reports
            self._leave()  # a component that could not be released turns itself off now
            self._components.close()
            self._unsubscribe()
            self._record.close()
            self._notices.close()
            self.ecology.unfollow()
            self._search.abandon()
            self.request.abandon()
            self.request.ended(effect.refusal)

    def _give_up(self, trouble: SelfconfError) -> None:
        self.trouble = trouble
        self._step(Stopped())

    def status(self) -> Status:
        """What is deployed, by which configurator, since when."""
        return Status(
            configurator=self.name,
            phase=self.state.phase_in_words,
            template=self.request.task.template.iri,
            epoch=self.state.epoch,
            since=self.since,
            host=socket.gethostname(),
            process=os.getpid(),
            components=tuple(self.state.held),
            lost={component: loss.cause.value for component, loss in self._newest_losses()},
            task=self.identity.task,
            priority=self.identity.priority,
            beginning=self.identity.beginning,
            owed=self._components.out_of_control(),
            dropped=self._components.dropped(),
            outside=None if self.request.outside is None else self.request.outside.composite,
            wants={one: wants for one in self.state.held if (wants := self._wants(one)) != Wants()},
        )

    def _wants(self, component: IRI) -> Wants:
        """What is wanted of a component that this task holds, for those that would share it."""
        target, held = self.state.target, self.state.held[component]
        if not self.ecology.may_be_shared(component):
            return Wants()
        if target is not None and component in target.components:
            return target.wants(component)
        wires = ((port, wire.component, wire.output) for port, some in held.inputs.items() for wire in some)
        return Wants(frozenset(wires), frozenset(held.values.items()))

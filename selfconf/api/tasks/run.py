"""A run: a task that is configured, deployed, watched and configured again, and what happens meanwhile as events."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack
from functools import partial
from types import TracebackType
from typing import NamedTuple

from selfconf import this_machine
from selfconf.api.answer import Answer
from selfconf.api.membership import Membership
from selfconf.api.method import Method
from selfconf.api.synchronous_bus import ROLL_CALL, SynchronousBus
from selfconf.api.task import TaskSpecification, completed
from selfconf.api.tasks.detached import task_record
from selfconf.api.tasks.living_tasks import LivingTasks
from selfconf.api.tasks.refusal_explanations import RefusalExplanations
from selfconf.api.tasks.run_outcomes import AnsweredEvent, answered, answered_event, composing
from selfconf.api.tasks.task_options import AS_USUAL, TaskOptions
from selfconf.api.tasks.work_queue import UNDISTURBED, WorkQueue
from selfconf.bus.port import Undo
from selfconf.bus.zenoh import ZenohBus
from selfconf.configurator import Loss
from selfconf.deployment import RunRequest, TaskRunner
from selfconf.errors import NetworkError, ProgrammerError
from selfconf.model.immutable import FrozenMapping, replace
from selfconf.model.refusal import Refusal, Undecided
from selfconf.model.run_event import AnyRunEvent, TaskRefused, TaskStopped, TaskWaiting
from selfconf.model.term import IRI
from selfconf.protocol.keys import Keys, task_name
from selfconf.rdf.advertisements import Advertisement
from selfconf.termination import Termination
from selfconf.this_machine import ClaimedName

TASKS_CALL = 0.5
"""Seconds that the other tasks may take to say their names, where none was given: one that hangs holds up no other."""
TAKING_DOWN = 15.0
"""How long, in seconds, a configurator may take to turn off everything that it holds."""
OF_TASK = "task"
"""The owner of what is done for a task, as long as it lasts."""
CHECK = 0.5
"""How often, in seconds, it is checked whether what a run rests on is still there."""


class _Begun(NamedTuple):
    """What a run has from when it is entered on: its link to the ecology, its name, and what runs the task."""

    bus: ZenohBus
    claimed: ClaimedName
    runner: TaskRunner


class Run:
    """A task that runs in a living ecology; use it in a `with` statement, which takes it down at its end.

    Until then it is connected to nothing and has no name in the ecology, so that one that is not used costs nothing.
    It listens to the ecology on a thread of its own. What takes long, such as a search after a failure, is done by
    `events` in the thread that reads them, so deal with an event briefly, and read on for as long as the task runs.

    >>> with join() as living, living.run(template("examples/clock/tell-the-time.ttl")) as run:
    ...     for event in run.events():
    ...         if event.act == "running":
    ...             print(event.configuration.components)
    ...             run.stop()
    (<https://example.org/my-home#clock>, <https://example.org/my-home#display>)
    """

    def __init__(
        self,
        task: TaskSpecification,
        method: Method,
        membership: Membership,
        options: TaskOptions = AS_USUAL,
        wait: bool = False,
        rests_on: Callable[[], bool] = lambda: True,
        described: Callable[[], Mapping[IRI, Advertisement]] = dict,
    ) -> None:
        """The run ends when `rests_on` does not hold any more; `described` are advertisements in files of this machine.

        A task without a `name` has that of its template, or where that is taken, one with a number: `patrol-2`. Raises
        BindingError, ProgrammerError for a task, priority or upgrade that is none, and NetworkError for credentials
        that do not let it run tasks.
        """
        membership.check_may_run()
        self.task, self.method = completed(task), method
        self._refusal: Refusal | Undecided | None = None
        composer, self._rests_on = method.composer(self.task), rests_on
        self._explanations = RefusalExplanations(self.task, method, composer, described)
        self._work = WorkQueue()
        self._begun: _Begun | None = None
        self._termination: Termination | None = None
        """What has signals stop the run, if they do."""
        self._left = self._ended = self._revoked = False
        self._membership = membership
        record = task_record(self.task, method, options)
        self._named = bool(options.name)
        self.wanted_name = self.task_name = task_name(record.task)
        """The name that was given to the task, or that of its template; and the one that it has in the ecology."""
        self._request = replace(
            RunRequest.of(composer, composing(composer, method.seconds)),
            policy=options.policy,
            patient=wait,
            believed=membership.beliefs(),
            suspended_sites=partial(this_machine.suspended_sites, membership.ecology),
            priority=record.priority,
            upgrade=options.upgrade,
            aside=self._aside,
            at_leisure=partial(self._work.at_leisure, owner=OF_TASK),
            abandon=partial(self._work.abandon, OF_TASK),  # and not what explains how the task has ended
            record=record,
            report=self._work.report,
            ended=self._settle,
        )

    def __enter__(self) -> Run:
        """Connect, claim the name, and begin. Raises NetworkError, also for a name that was given and is taken."""
        if self._begun is not None:
            raise ProgrammerError(f"the run of {self.task_name} was entered already; ask the ecology for another run")
        bus = self._membership.connect(self._distrusted)
        try:
            with ExitStack() as undone:
                tasks = self._tasks(bus)
                # A name that no other task of the ecology has: `stop` goes by it. One that was given is looked for in
                # the ecology when this task can be seen there as well.
                name = self.wanted_name
                claimed = undone.enter_context(tasks.claim_here(name) if self._named else tasks.claim(name, True))
                request = replace(self._request, name=claimed.name)
                runner = TaskRunner(bus, self._membership.ecology, request, self._membership.configurator_name())
                if self._named:
                    tasks.check_alone(runner.identity.task, runner.identity.beginning)
                undone.pop_all()
        except BaseException:
            bus.close()
            raise
        self.task_name = claimed.name
        self._begun = _Begun(bus, claimed, runner)
        bus.run_aside()
        bus.wake_up(partial(runner.start, statuses=tasks.statuses))
        bus.wake_up(self._check)
        return self

    def _tasks(self, bus: ZenohBus) -> LivingTasks:
        """The other tasks of the ecology."""
        keys = Keys(self._membership.ecology)
        asking = SynchronousBus(bus, ROLL_CALL if self._named else TASKS_CALL, keys.any_site_life())
        return LivingTasks(asking, keys, self._membership.endpoints)

    def _in_ecology(self) -> _Begun:
        """The run's part in the ecology. Raises ProgrammerError for a run that was not entered."""
        if self._begun is None:
            raise ProgrammerError(f"the run of {self.task_name} has not begun; use it in a `with` statement")
        return self._begun

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Turn every component off and leave, whatever has happened in the block."""
        bus, claimed, _ = self._in_ecology()
        try:
            self.stop()
            deadline = bus.now() + TAKING_DOWN
            while not self._ended and bus.now() < deadline:
                self._work.next(CHECK)
        finally:
            self._left = True
            claimed.release()
            bus.close()
            if self._termination is not None:
                self._termination.heed_no_more()

    def events(self) -> Iterator[AnsweredEvent]:
        """What happens, in order, until the task has ended; does the work of the run while it waits for the next event.

        Raises ProgrammerError outside of a `with` statement, in which alone the task runs, and SelfconfError where the
        shapes of the task cannot be judged, or the certificate of this program was revoked, once all is taken down.
        """
        runner = self._in_ecology().runner
        while True:
            ended = self._ended or self._left  # before the look at the queue: what was reported by then is in it
            event = self._work.next(0.0 if ended else CHECK)
            if event is not None:
                if self._revoked and isinstance(event, TaskStopped):
                    event = replace(event, owed=())  # no hub lets it turn off anything: they rest by themselves
                yield answered_event(self._with_explanation(event), self.task.document)
            elif ended:
                break
        if runner.trouble is not None:
            raise runner.trouble
        if self._revoked:
            raise NetworkError(f"the task {self.task_name} has ended, as the certificate of this program was revoked")

    def stop(self) -> None:
        """Take the configuration down; `events` ends when that is done. May be called from any thread.

        Raises ProgrammerError for a run that was not entered, as `name` does.
        """
        bus, _, runner = self._in_ecology()
        bus.wake_up(runner.stop)

    def stop_on_signals(self) -> None:
        """Until the run is left SIGINT, SIGTERM and SIGHUP stop it, and do not end the program in the middle of it."""
        bus, _, runner = self._in_ecology()
        if self._termination is None:
            self._termination = Termination(bus, runner.stop, told=self._work.abandon)

    @property
    def name(self) -> str:
        """The name under which the configurator of this run is known in the ecology."""
        return self._in_ecology().runner.name

    @property
    def configuration(self) -> Answer | None:
        """What is deployed, or being deployed."""
        return None if self._begun is None else answered(self._begun.runner.configuration, self.task.document)

    @property
    def refusal(self) -> Refusal | Undecided | None:
        """Why the task has ended, where there is no configuration (any more)."""
        return answered(self._refusal, self.task.document)

    @property
    def losses(self) -> Mapping[IRI, Loss]:
        """The components that were lost and have not come back, each with the cause."""
        return FrozenMapping({} if self._begun is None else self._begun.runner.state.lost)

    @property
    def lost(self) -> Mapping[IRI, str]:
        """Why each component that was lost was lost, in words."""
        return {} if self._begun is None else self._begun.runner.losses

    def explained(self) -> Refusal | Undecided | None:
        """The refusal by which the task has ended, with all that can be found out now that nothing runs any more."""
        if not isinstance(self._refusal, Refusal):
            return self._refusal
        return answered(self._explanations.in_full(self._refusal), self.task.document)

    def _aside(self, work: Callable[[], None]) -> Undo:
        """Have the thread that reads the events do what takes long, once it has read what has led to it."""
        self._in_ecology().runner.reports.tell()
        return self._work.add(work, OF_TASK)

    def _distrusted(self) -> None:
        self._revoked = True
        if self._begun is not None:
            self._begun.runner.stop()

    def _settle(self, refusal: Refusal | Undecided | None) -> None:
        self._refusal, self._ended = refusal, True
        self._in_ecology().claimed.release()
        self._work.wake_up()

    def _with_explanation(self, event: AnyRunEvent) -> AnyRunEvent:
        """An event with what else its refusal can tell; that is found out now, when nothing waits for act 4.

        A task that waits may have something to do any moment: then the refusal gets the places of its facts alone.
        """
        if not isinstance(event, TaskWaiting | TaskRefused) or not isinstance(event.refusal, Refusal):
            return event
        refusal, found, over = event.refusal, list[Refusal](), isinstance(event, TaskRefused)

        def explain() -> None:
            found.append(self._explanations.in_full(refusal) if over else self._explanations.meanwhile(refusal))

        if not (self._work.do(explain) if over else self._work.until_more(explain, UNDISTURBED)):
            found = [self._explanations.with_places(refusal, is_last=over)]
        elif isinstance(event, TaskWaiting):
            self._in_ecology().runner.reports.explained(event, found[0])
        return replace(event, refusal=found[0])

    def __repr__(self) -> str:
        phase = "not begun" if self._begun is None else self._begun.runner.state.phase_in_words
        return f"<run of {self.task_name}: {phase}>"

    def _check(self) -> None:
        bus, _, runner = self._in_ecology()
        if self._rests_on():
            bus.later(CHECK, self._check)
        else:
            runner.stop()

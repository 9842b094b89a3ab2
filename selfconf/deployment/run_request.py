"""The request to run a task, and how the running task is known to other tasks.

The request says which task it is, how to compose and to reconfigure, and where events are reported; the identity its
name, its rank, and since when it runs.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence, Set
from dataclasses import KW_ONLY
from typing import Protocol

from selfconf.bus.port import Undo
from selfconf.configurator import Policy
from selfconf.deployment.holders import WithoutConfigurator
from selfconf.discovery import Beliefs
from selfconf.model.configuration import Configuration
from selfconf.model.immutable import immutable
from selfconf.model.obstacle import NotJudged
from selfconf.model.partition import Barred
from selfconf.model.refusal import Outcome, Refusal, Undecided
from selfconf.model.run_event import AnyRunEvent
from selfconf.model.template import Task
from selfconf.model.term import IRI
from selfconf.protocol.keys import task_name
from selfconf.protocol.messages import TaskRecord, Wires
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.tasks import TaskDocument

ComposeFunction = Callable[[Mapping[IRI, Advertisement], frozenset[Barred], "Configuration | None"], Outcome]
"""Act 3: from the advertisements, what is left out and what runs now, a configuration or a refusal."""

Aside = Callable[[Callable[[], None]], Undo]
"""Runs what takes long apart from the bus; calling the result ends it and forgets it, where that can be."""


def at_once(work: Callable[[], None]) -> Undo:
    """Run what takes long where it stands: then there is nothing left to end."""
    work()
    return lambda: None


EventListener = Callable[[AnyRunEvent], None]
"""Receives an event of a run."""

Standby = Mapping[IRI, Wires]
"""For each component and input, the outputs that might be connected to it next."""


class TaskComposer(Protocol):
    """What composes one task again and again: a `selfconf.composition.Composer`, which is no part of this room."""

    @property
    def task(self) -> TaskDocument:
        """The task."""

    def compose(
        self, ecology: Mapping[IRI, Advertisement], left_out: frozenset[Barred], running: Configuration | None
    ) -> Outcome:
        """Act 3."""

    def not_judged(self) -> Mapping[IRI, NotJudged]:
        """The components that act 3 has left out last because they cannot be judged; called where that was."""

    def usable(self, components: Set[IRI], refusal: Refusal) -> Mapping[IRI, tuple[IRI, ...]]:
        """Of some components, those that could help where act 3 has refused, each with the roles that it may play."""

    def standby(self, configuration: Configuration, lost: frozenset[IRI]) -> Standby:
        """For each component and input of a configuration, the outputs that might be connected next, but the lost."""

    def passed_over(self, configuration: Configuration) -> Mapping[IRI, Sequence[IRI]]:
        """For each role of a configuration, the candidates that came before the chosen ones."""


@immutable
class Outside:
    """What is outside of a task that is the inside of a composite."""

    composite: IRI
    received: Callable[[], Wires] = dict
    """By which outputs outside each input of the composite is fed now, and each operation that it needs answered."""
    calling: Callable[[str], tuple[IRI, ...]] = lambda operation: ()
    """Which components outside may call an operation of the composite now, by the name of its output."""


@immutable
class RunRequest:
    """A task to run: how to compose, what to do after a loss, and where to report."""

    _: KW_ONLY
    composer: TaskComposer
    compose: ComposeFunction
    """Act 3, by the composer, or what is done in its place."""
    policy: Policy = Policy.REPAIR
    name: str = ""
    """The name of the task in the ecology; by default that of its template."""
    priority: int = 0
    """Of several tasks that want one component, the one of the highest priority has it."""
    believed: Beliefs | None = None
    """With keys: the site that owns a component which several advertise, as far as a person has said so."""
    suspended_sites: Callable[[], Iterable[str]] = tuple
    """The sites of the ecology whose processes are known to be suspended, so that they may seem to be gone."""
    outside: Outside | None = None
    """What is outside of the task, if it is the inside of a composite."""
    upgrade: float | None = None
    """After how many seconds a component that the strategy would rather have is changed to; None: never."""
    patient: bool = False
    """Whether a refusal does not end the run: it waits until the ecology has what the task needs."""
    aside: Aside = at_once
    """Runs what takes long, such as a search, apart from the bus; by default at once, where that is the only thread."""
    at_leisure: Callable[[Callable[[], None]], None] = lambda work: None
    """Does what nothing waits for, apart from the bus like `aside`, in place of what it was given before; where it is
    interrupted, it does that once more. By default it is not done."""
    abandon: Callable[[], None] = lambda: None
    """Called once when the task has ended: what still runs aside for it may end, as no caller waits for it."""
    explain: Callable[[Refusal, Callable[[Refusal], None]], None] = lambda refusal, found: None
    """Receives each refusal for which the task waits, and may hand it back with more facts for observers, from any
    thread."""
    without_configurator: WithoutConfigurator = lambda known: ()
    """What other tasks hold whose configurator has just gone, and with which the next is about to go on."""
    record: TaskRecord | None = None
    """The task as sites keep it, the answer to a program that asks which one it is; None: there is none."""
    report: EventListener = lambda event: None
    """Receives what the configurator does and notices, in order."""
    ended: Callable[[Refusal | Undecided | None], None] = lambda refusal: None
    """Called once when the task has ended; with the refusal if that is why."""

    @classmethod
    def of(cls, composer: TaskComposer, compose: ComposeFunction | None = None) -> RunRequest:
        """The request to run the task of a composer; `compose`, if there is any, does act 3 in its place."""
        return cls(composer=composer, compose=compose or composer.compose)

    @property
    def task(self) -> Task:
        """The task."""
        return self.composer.task.task


@immutable
class TaskIdentity:
    """A running task: what stays the same if another configurator goes on with it."""

    task: str
    """The name of the task and a text that no other task of that name has: `selfconf.protocol.keys.task_identity`."""
    priority: int = 0
    beginning: float = 0.0
    """When it began, in seconds of the Unix epoch."""

    @property
    def name(self) -> str:
        """The name of the task, as its user knows it."""
        return task_name(self.task)

"""What happens while a task runs, as values: what `run` reports, line by line or as JSON, and `Run.events` yields.

Each event has an `act`, a name that is stable for programs, and a time in seconds of the Unix epoch. Type checkers know
the facts of an event after `event.act == "running"`, `isinstance` or `match`.
`selfconf.render` words them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field, fields
from typing import ClassVar, Literal, TypeAlias

from selfconf.model.configuration import Configuration
from selfconf.model.immutable import immutable
from selfconf.model.refusal import Outcome, Refusal, Undecided
from selfconf.model.term import IRI


@immutable
class RunEvent:
    """Something that the configurator did or noticed; its subclasses say what."""

    act: ClassVar[str] = ""
    time: float = field(default=0.0, kw_only=True)

    def __str__(self) -> str:
        """The act and its facts in one line: `lost component=clock cause=crash detail='its life has ended'`."""
        facts = ((one.name, getattr(self, one.name)) for one in fields(self) if one.name != "time")
        return " ".join((self.act, *(f"{name}={_brief(value)}" for name, value in facts)))


@immutable
class EcologyAsked(RunEvent):
    """Act 1: the ecology was asked what it has."""

    act: ClassVar[Literal["query"]] = "query"


@immutable
class EcologyDiscovered(RunEvent):
    """Act 2: the ecology has answered; `missing` are the sites that live and did not answer in full."""

    act: ClassVar[Literal["discovered"]] = "discovered"
    components: int
    sites: tuple[str, ...]
    missing: tuple[str, ...] = ()


@immutable
class AnswerRejected(RunEvent):
    """Something in an answer of the ecology was left out, and why."""

    act: ClassVar[Literal["complaint"]] = "complaint"
    detail: str


@immutable
class ComponentLeftOut(RunEvent):
    """Act 3: what a component says cannot be judged, or not in time, so it plays no role; reported once."""

    act: ClassVar[Literal["left out"]] = "left out"
    component: IRI
    reason: str


@immutable
class SearchEnded(RunEvent):
    """Act 3: the search has ended, after so many seconds."""

    act: ClassVar[Literal["composed"]] = "composed"
    outcome: Outcome
    seconds: float


@immutable
class FailWatched(RunEvent):
    """Act 4: the configurator listens to the FAIL of a component."""

    act: ClassVar[Literal["watching"]] = "watching"
    component: IRI


@immutable
class ComponentWoken(RunEvent):
    """Act 4: a site was asked to start a dormant component."""

    act: ClassVar[Literal["waking"]] = "waking"
    component: IRI
    site: str


@immutable
class ComponentAwaited(RunEvent):
    """Act 4: another task holds a component, and it is waited for."""

    act: ClassVar[Literal["awaiting"]] = "awaiting"
    component: IRI


@immutable
class InputConnected(RunEvent):
    """Act 4: an input of a component was asked to follow an output of another."""

    act: ClassVar[Literal["connecting"]] = "connecting"
    source: IRI
    output: str
    sink: IRI
    input: str


@immutable
class ActivationSent(RunEvent):
    """Act 4: a component was asked to act."""

    act: ClassVar[Literal["activating"]] = "activating"
    component: IRI


@immutable
class CallAnswered(RunEvent):
    """A component has answered a call; its subclasses say which one."""

    component: IRI
    detail: str = ""


@immutable
class ComponentActivated(CallAnswered):
    """Act 4: a component acts."""

    act: ClassVar[Literal["activated"]] = "activated"


@immutable
class ParametersSet(CallAnswered):
    """Act 4: a component has its operational parameters."""

    act: ClassVar[Literal["set"]] = "set"


@immutable
class ComponentReleased(CallAnswered):
    """A component was turned off, or goes on for others that share it."""

    act: ClassVar[Literal["released"]] = "released"
    holder: str = ""
    """The name of a task for which it acts on; empty if it is off."""


@immutable
class CallDeclined(CallAnswered):
    """A component does not do what it was asked, and why."""

    act: ClassVar[Literal["declined"]] = "declined"


@immutable
class ComponentUnreachable(RunEvent):
    """A component did not answer a call."""

    act: ClassVar[Literal["unreachable"]] = "unreachable"
    component: IRI
    call: str
    detail: str


@immutable
class ComponentLost(RunEvent):
    """A component was given up: it failed, crashed, went silent, or refused."""

    act: ClassVar[Literal["lost"]] = "lost"
    component: IRI
    cause: str
    detail: str


@immutable
class TaskRunning(RunEvent):
    """A configuration is complete and runs."""

    act: ClassVar[Literal["running"]] = "running"
    configuration: Configuration
    epoch: int


@immutable
class TaskWaiting(RunEvent):
    """There is no configuration now, and the task waits for the ecology to change; `lost` by component, and why."""

    act: ClassVar[Literal["waiting"]] = "waiting"
    refusal: Refusal | Undecided | None
    lost: Mapping[IRI, str] = field(default_factory=dict)


@immutable
class TaskRefused(RunEvent):
    """The task has ended as there is no configuration, or none was found in time."""

    act: ClassVar[Literal["refused"]] = "refused"
    refusal: Refusal | Undecided
    lost: Mapping[IRI, str] = field(default_factory=dict)
    owed: tuple[IRI, ...] = ()
    """The components that were turned off and have not obeyed: they are out of control until they are gone."""


@immutable
class TaskStopped(RunEvent):
    """The task was taken down as wanted."""

    act: ClassVar[Literal["stopped"]] = "stopped"
    refusal: None = None
    lost: Mapping[IRI, str] = field(default_factory=dict)
    owed: tuple[IRI, ...] = ()
    """The components that were turned off and have not obeyed: they are out of control until they are gone."""


@immutable
class TaskDetached(RunEvent):
    """The task was handed to the sites of the ecology, which go on with it."""

    act: ClassVar[Literal["detached"]] = "detached"
    task: str


@immutable
class EcologyUnreachable(RunEvent):
    """The configurator has lost its link to the ecology, and believes nothing until it is back."""

    act: ClassVar[Literal["cut off"]] = "cut off"


@immutable
class EcologyReachable(RunEvent):
    """The configurator is linked to the ecology again."""

    act: ClassVar[Literal["connected"]] = "connected"


EventWithoutConfiguration: TypeAlias = (
    EcologyAsked
    | EcologyDiscovered
    | AnswerRejected
    | ComponentLeftOut
    | FailWatched
    | ComponentWoken
    | ComponentAwaited
    | InputConnected
    | ActivationSent
    | ComponentActivated
    | ParametersSet
    | ComponentReleased
    | CallDeclined
    | ComponentUnreachable
    | ComponentLost
    | TaskWaiting
    | TaskRefused
    | TaskStopped
    | TaskDetached
    | EcologyUnreachable
    | EcologyReachable
)
"""An event of a run that never has a configuration among its facts."""
AnyRunEvent: TypeAlias = EventWithoutConfiguration | SearchEnded | TaskRunning
"""An event of a run, told apart from the others by its `act` or its class."""


def _brief(value: object) -> str:
    """A fact of an event in a few words; of what is large, how much there is of it."""
    if isinstance(value, IRI):
        return value.short
    if isinstance(value, Configuration):
        return f"<{len(value.components)} components>"
    if isinstance(value, Refusal | Undecided):
        return "<refused>" if isinstance(value, Refusal) else "<undecided>"
    if isinstance(value, tuple | Mapping):
        return f"({', '.join(map(_brief, value))})"
    return value if isinstance(value, str) and value.isidentifier() else repr(value)

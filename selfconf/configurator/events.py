"""What a configurator hears."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from enum import Enum

from selfconf.configurator.starting_order import Plan
from selfconf.model.configuration import Configuration
from selfconf.model.holder import Holder
from selfconf.model.immutable import immutable
from selfconf.model.refusal import Outcome
from selfconf.model.term import IRI
from selfconf.protocol.messages import Cause, RecordedLoss, Verdict


class Call(str, Enum):
    """The calls that a configurator makes to a component, or to its site."""

    WAKE = "wake"
    """Have the site start a dormant component; a component that lives is awake."""
    RESERVE = "reserve"
    APPLY = "apply"
    RELEASE = "release"


class Unanswered(str, Enum):
    """Why nothing is known of what a call has come to, where the component has not answered it."""

    SILENT = "it does not answer"
    """It lives, and has neither answered nor done what it was asked in time."""
    ENDED = "its life has ended"
    """It was to be turned off, and its life has ended, or seems to have: it may act on out of sight."""
    NOT_STARTED = "it was not started"
    """It was to be started: nothing starts it, or its site could not, or not in time."""
    SITE_UNSEEN = "its site does not answer"
    """It was to be started by a site that cannot be reached either: both may only be cut off."""


@immutable
class Accepted:
    """A task is to be configured. Epochs start above `epoch`, so that they are newer than those of earlier runs.

    Another configurator of it, which is gone, may have lost some components, which live on.
    """

    epoch: int
    lost: tuple[RecordedLoss, ...] = ()


@immutable
class Adopted:
    """A task that runs already is to be gone on with, whose configurator is gone.

    That had lost some components, which live on, and was perhaps about to do without one that runs.
    """

    epoch: int
    configuration: Configuration
    lost: tuple[RecordedLoss, ...] = ()


@immutable
class HandedOver:
    """Another configurator is to go on with this task."""


@immutable
class Discovered:
    """The ecology has answered; `holders` are the other tasks that hold components."""

    holders: Mapping[IRI, Holder] = field(default_factory=dict)
    sharers: Mapping[IRI, Holder] = field(default_factory=dict)
    """The tasks that hold components which can be shared, by component."""
    unseen: bool = False
    """Whether something that is held for the task was not advertised: its site may be out of sight for a moment."""


@immutable
class Composed:
    """The search has ended; `attempt` is its number, so that the outcome of an older search is passed over."""

    attempt: int
    outcome: Outcome
    usable: frozenset[IRI] = frozenset()
    """The components that other tasks hold, and that may play a role or be recruited where candidates lack."""
    plan: Plan | None = None
    """The plan of a configuration that was found, if it was made while there was time."""


@immutable
class Answered:
    """A component has answered a call, or it is known by now that it does not."""

    component: IRI
    call: Call
    epoch: int
    verdict: Verdict | Unanswered
    life: str = ""
    newest: int = 0
    detail: str = ""
    holder: Holder | None = None
    """The holder of the component, where that is another task."""
    shared: bool = False
    """Whether a component that is busy acts for this task as well, as it has before."""
    acts: bool = False
    """Whether a component that is reserved acts for this task, as one does that was given up when it was cut off."""
    startable: bool = False
    """Whether the site of the component can start it again."""


@immutable
class Failed:
    """A component is lost. `life` is empty where the life is not known."""

    component: IRI
    life: str
    cause: Cause
    detail: str = ""
    startable: bool = False
    """Whether the site of the component can start it again."""


@immutable
class Freed:
    """A component that another task held is kept for this one, for a moment."""

    component: IRI


@immutable
class BegunElsewhere:
    """A component begins to act for another task while some wait for it, which may share it if they want the same."""

    component: IRI


@immutable
class WaitedLong:
    """A component that was asked for, and is held by another task, has not become free for some time."""

    component: IRI
    epoch: int


@immutable
class Appeared:
    """Something has come that may help: a component lives (again), or the advertisements of a site have changed."""

    lives: Mapping[IRI, str]


@immutable
class Rewired:
    """Other components than before issue the outputs of a component, or call by it: what is connected hears that."""

    component: IRI
    rests: bool = False
    """Whether actuators that follow it are to rest, where nothing stands behind it for now."""


@immutable
class LossLasts:
    """A component was lost a while ago; perhaps nothing has taken its place yet."""

    actuators: frozenset[IRI] = frozenset()
    """What has no outputs of what is held, if the configuration has been incomplete for longer than that may act."""


@immutable
class StayedAway:
    """What was lost has not come back in time, so a search that has found nothing counts; `attempt` is its number."""

    attempt: int


@immutable
class Improvable:
    """What the task needs may be had from components that the strategy would rather have.

    But not from those that have appeared of late: it is `unsettled` whether they stay.
    """

    unsettled: frozenset[IRI] = frozenset()


@immutable
class Reconnected:
    """This node was cut off from the ecology, or the task from what feeds it: all that is known may be outdated."""


@immutable
class Ranked:
    """The task has another priority, or another beginning, than before: what it holds is to know that."""

    priority: int


@immutable
class Stopped:
    """The configuration is to be taken down."""


Event = (
    Accepted
    | Adopted
    | HandedOver
    | Discovered
    | Composed
    | Answered
    | Failed
    | Freed
    | BegunElsewhere
    | WaitedLong
    | Appeared
    | Rewired
    | LossLasts
    | StayedAway
    | Improvable
    | Reconnected
    | Ranked
    | Stopped
)

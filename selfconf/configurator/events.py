"""What a configurator hears."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

from selfconf.model.refusal import Outcome
from selfconf.model.term import IRI
from selfconf.protocol.messages import Cause, Verdict


class Call(str, Enum):
    """The calls that a configurator makes to a component."""

    APPLY = "apply"
    SET = "set"
    RELEASE = "release"


@dataclass(frozen=True, slots=True)
class Accepted:
    """A task is to be configured. Epochs start above `epoch`, so that they are newer than those of earlier runs."""

    epoch: int


@dataclass(frozen=True, slots=True)
class Discovered:
    """The ecology has answered."""


@dataclass(frozen=True, slots=True)
class Composed:
    """The search has ended; `attempt` is its number, so that the outcome of an older search is passed over."""

    attempt: int
    outcome: Outcome


@dataclass(frozen=True, slots=True)
class Answered:
    """A component has answered a call, or could not be reached (no verdict)."""

    component: IRI
    call: Call
    epoch: int
    verdict: Verdict | None
    life: str = ""
    newest: int = 0
    detail: str = ""


@dataclass(frozen=True, slots=True)
class Failed:
    """A component is lost. `life` is empty where the life is not known."""

    component: IRI
    life: str
    cause: Cause
    detail: str = ""


@dataclass(frozen=True, slots=True)
class Appeared:
    """Something has come that may help: a component lives (again), or the advertisements of a site have changed."""

    lives: Mapping[IRI, str]


@dataclass(frozen=True, slots=True)
class Reconnected:
    """This node was cut off from the ecology and is not any more: all that is known of it may be outdated."""


@dataclass(frozen=True, slots=True)
class Stopped:
    """The configuration is to be taken down."""


Event = Accepted | Discovered | Composed | Answered | Failed | Appeared | Reconnected | Stopped

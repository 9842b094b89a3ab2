"""The messages of the control plane, as values.

Everything that can be stale carries a *life* (which incarnation of a component) or an *epoch* (which deployment). A
component obeys the newest epoch that it knows of and refuses an older one.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from typing import Any

from selfconf.model.term import IRI, Term


class Cause(str, Enum):
    """Why a component is lost. The paper has only the first."""

    FAIL = "fail"
    """The component raised FAIL itself."""
    CRASH = "crash"
    """Its liveliness ended."""
    SILENCE = "silence"
    """An output that promised a rate has stopped."""
    REFUSED = "refused"
    """It refused to be activated, or could not be."""


@dataclass(frozen=True, slots=True)
class Wire:
    """An output that an input shall follow; `period` is the longest pause in seconds that the output promises."""

    component: IRI
    output: str
    period: float | None = None


@dataclass(frozen=True, slots=True)
class Apply:
    """Be active, and let each input follow exactly these outputs.

    Outputs that stand by are listened to as well, but what they issue is passed over, until a later call makes them
    inputs: then no time is lost with connecting.
    """

    epoch: int
    supervisor: str
    """The liveliness key of the configurator that supervises this configuration."""
    inputs: Mapping[str, tuple[Wire, ...]] = field(default_factory=dict)
    standby: Mapping[str, tuple[Wire, ...]] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class SetParameters:
    """Take these values for operational parameters, by name."""

    epoch: int
    supervisor: str
    values: Mapping[str, Term] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Release:
    """Stop, follow no output any more, and be free for others."""

    epoch: int
    supervisor: str


class Verdict(str, Enum):
    """How a component answers a call."""

    DONE = "done"
    STALE = "stale"
    """The epoch is older than the newest one the component has obeyed."""
    BUSY = "busy"
    """Another configurator that is alive holds the component."""
    REFUSED = "refused"
    """The component itself refuses, or its code broke; `detail` says why."""


@dataclass(frozen=True, slots=True)
class CallAnswer:
    """The answer to a call: the verdict, the component's life, and the newest epoch it has obeyed."""

    verdict: Verdict
    component: IRI
    life: str
    epoch: int = 0
    active: bool = False
    detail: str = ""
    supervisor: str = ""
    """The liveliness key of the configurator that holds the component; empty if none does, or if it is left out."""


@dataclass(frozen=True, slots=True)
class Fail:
    """FAIL, the special output that every component has."""

    component: IRI
    life: str
    epoch: int
    cause: Cause = Cause.FAIL
    detail: str = ""


@dataclass(frozen=True, slots=True)
class Wake:
    """Start the process of a dormant component."""

    component: IRI


@dataclass(frozen=True, slots=True)
class Page:
    """What goes with each advertisement that a site replies: which of how many, of which revision, from which file."""

    index: int
    total: int
    revision: int
    component: IRI | None = None
    source: str = ""
    startable: bool = False


@dataclass(frozen=True, slots=True)
class Stamp:
    """What goes with each signal: its source, in which life, its number there, and its time in seconds."""

    component: IRI
    life: str
    sequence: int
    time: float


@dataclass(frozen=True, slots=True)
class Status:
    """What a configurator has deployed."""

    configurator: str
    phase: str
    template: IRI
    epoch: int
    since: float
    host: str = ""
    process: int = 0
    components: tuple[IRI, ...] = ()
    lost: Mapping[str, Any] = field(default_factory=dict)


Message = Apply | SetParameters | Release | CallAnswer | Fail | Wake | Page | Stamp | Status

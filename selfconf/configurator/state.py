"""What a configurator knows about its task, as values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum

from selfconf.configurator.events import Call
from selfconf.model.configuration import Configuration
from selfconf.model.refusal import Refusal, Undecided
from selfconf.model.term import IRI, Term
from selfconf.protocol.messages import Cause, Wire

InputWires = Mapping[str, tuple[Wire, ...]]
"""Which outputs each input of a component follows."""


class Phase(str, Enum):
    """Where the configurator is."""

    IDLE = "idle"
    DISCOVERING = "discovering"
    COMPOSING = "composing"
    DEPLOYING = "deploying"
    SETTING = "setting"
    RUNNING = "running"
    DISMANTLING = "dismantling"
    REFUSED = "refused"
    STOPPED = "stopped"


class Policy(str, Enum):
    """What to do with the rest of a configuration when a component is lost."""

    REPAIR = "repair"
    DISMANTLE = "dismantle"


@dataclass(frozen=True, slots=True)
class Held:
    """A component that was applied to: its inputs and life, whether it has confirmed, and what was set on it."""

    inputs: InputWires
    life: str = ""
    confirmed: bool = False
    values: Mapping[str, Term] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Loss:
    """Why a component was given up, and in which life."""

    cause: Cause
    detail: str = ""
    life: str = ""
    busy: bool = False
    """Whether another configurator held it; it is free once it obeys the release that it is owed."""


@dataclass(frozen=True, slots=True)
class State:
    """All that a configurator knows about its task, apart from the advertisements."""

    policy: Policy = Policy.REPAIR
    patient: bool = False
    """Whether a refusal does not end the task: the configurator waits until the ecology has what it needs."""
    phase: Phase = Phase.IDLE
    epoch: int = 0
    attempt: int = 0
    target: Configuration | None = None
    held: Mapping[IRI, Held] = field(default_factory=dict)
    pending: frozenset[tuple[IRI, Call]] = frozenset()
    owed: Mapping[IRI, int] = field(default_factory=dict)
    """The components that were released and have not obeyed yet, each with the epoch of the release."""
    watched: frozenset[IRI] = frozenset()
    lost: Mapping[IRI, Loss] = field(default_factory=dict)
    afterwards: Phase = Phase.STOPPED
    """What comes when everything has been released: COMPOSING, REFUSED or STOPPED."""
    refusal: Refusal | Undecided | None = None
    news: bool = False
    """Whether something has appeared since the ecology was last asked."""

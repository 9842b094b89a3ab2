"""What a configurator wants done."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from selfconf.model.configuration import Configuration
from selfconf.model.refusal import Refusal, Undecided
from selfconf.model.term import IRI, Term
from selfconf.protocol.messages import Wire


@dataclass(frozen=True, slots=True)
class Discover:
    """Acts 1 and 2: broadcast a query, collect the advertisements."""


@dataclass(frozen=True, slots=True)
class Compose:
    """Act 3: search for a configuration without the lost components, which keeps as much of `running` as it can."""

    attempt: int
    lost: frozenset[IRI]
    running: Configuration | None


@dataclass(frozen=True, slots=True)
class Watch:
    """Act 4, first: connect to the FAIL of a component, and notice if its life ends."""

    component: IRI


@dataclass(frozen=True, slots=True)
class Unwatch:
    """Stop listening to a component."""

    component: IRI


@dataclass(frozen=True, slots=True)
class ApplyTo:
    """Act 4: activate a component and connect its inputs."""

    component: IRI
    epoch: int
    inputs: Mapping[str, tuple[Wire, ...]] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class SetOn:
    """Act 4, last: give operational parameters their values."""

    component: IRI
    epoch: int
    values: Mapping[str, Term] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class ReleaseFrom:
    """Turn a component off."""

    component: IRI
    epoch: int


@dataclass(frozen=True, slots=True)
class Running:
    """The configuration is complete: note and report it."""

    configuration: Configuration


@dataclass(frozen=True, slots=True)
class Finish:
    """The task has ended: taken down as wanted, or refused."""

    refusal: Refusal | Undecided | None = None


Effect = Discover | Compose | Watch | Unwatch | ApplyTo | SetOn | ReleaseFrom | Running | Finish

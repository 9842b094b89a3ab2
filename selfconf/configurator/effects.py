"""What a configurator wants done."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field

from selfconf.configurator.starting_order import Callers
from selfconf.model.configuration import Configuration
from selfconf.model.immutable import immutable
from selfconf.model.partition import Barred
from selfconf.model.refusal import Refusal, Undecided
from selfconf.model.term import IRI, Term
from selfconf.protocol.messages import Wires


@immutable
class Discover:
    """Acts 1 and 2: broadcast a query, collect the advertisements, and ask the other tasks what they hold."""


@immutable
class Compose:
    """Act 3: search for a configuration without what is left out, which keeps as much of `running` as it can."""

    attempt: int
    left_out: frozenset[Barred]
    running: Configuration | None


@immutable
class Watch:
    """Act 4, first: connect to the FAIL of a component, and notice if its life ends."""

    component: IRI


@immutable
class Unwatch:
    """Stop listening to a component."""

    component: IRI


@immutable
class WakeUp:
    """Act 4: have a component started by its site, unless it lives."""

    component: IRI
    epoch: int


@immutable
class ReserveOf:
    """Act 4: have a component held for this task, without acting."""

    component: IRI
    epoch: int
    inputs: Wires = field(default_factory=dict)
    values: Mapping[str, Term] = field(default_factory=dict)


@immutable
class QueueFor:
    """Have a component remember that this task waits for it, and tell when it is free."""

    component: IRI
    epoch: int


@immutable
class Decline:
    """Tell a component that is kept for this task, and that it cannot take now, to go to the next that waits.

    Or one that it has reserved, where another configurator goes on with the task.
    """

    component: IRI
    epoch: int


@immutable
class ApplyTo:
    """Act 4: give a component the values of its parameters, activate it, and connect its inputs."""

    component: IRI
    epoch: int
    inputs: Wires = field(default_factory=dict)
    values: Mapping[str, Term] = field(default_factory=dict)
    callers: Callers = field(default_factory=dict)
    """Which components may call its operations."""
    gently: bool = False
    """Whether what an input followed before is let go of only when the new output delivers."""
    adopted: bool = False
    """Whether it has acted for the task already, for a configurator that is gone."""
    rests: bool = False
    """Whether an actuator is to rest, as it follows nothing for now, unless it tolerates more than a second of that."""


@immutable
class ReleaseFrom:
    """Turn a component off, as far as this task is concerned."""

    component: IRI
    epoch: int


@immutable
class AwaitRelease:
    """Another task holds a component: it is waited for, but not for long without a look (`WaitedLong`)."""

    component: IRI
    epoch: int


@immutable
class AwaitReturn:
    """What is missing may be so for a moment only: a search that has found nothing waits (`StayedAway`)."""

    attempt: int


@immutable
class Running:
    """The configuration is complete: note and report it."""

    configuration: Configuration


@immutable
class Finish:
    """The task has ended: taken down as wanted, or refused."""

    refusal: Refusal | Undecided | None = None


Effect = (
    Discover
    | Compose
    | Watch
    | Unwatch
    | WakeUp
    | ReserveOf
    | QueueFor
    | Decline
    | ApplyTo
    | ReleaseFrom
    | AwaitRelease
    | AwaitReturn
    | Running
    | Finish
)

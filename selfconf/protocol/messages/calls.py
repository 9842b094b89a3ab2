"""The calls of configurators to components, and what these answer."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from enum import Enum

from selfconf.model.immutable import immutable
from selfconf.model.term import IRI, Term
from selfconf.protocol.messages.texts import Label, Remark


@immutable
class Wire:
    """An output that an input shall follow; `period` is the longest pause in seconds that the output promises."""

    component: IRI
    output: str
    period: float | None = None


Wires = Mapping[str, tuple[Wire, ...]]
"""Some outputs for each port, by its name: those that an input follows, or that stand behind an output."""


@immutable
class Claim:
    """What every call says of the task that makes it, and of the component that it means."""

    epoch: int
    supervisor: Label
    """The liveliness key of the configurator that supervises the configuration now."""
    task: Label = ""
    """The identity of the task, which stays when another configurator goes on with it; empty from an older peer."""
    life: Label = ""
    """Which life of the component is meant; empty for whichever answers, as an older peer has it."""
    priority: int = 0
    beginning: float = 0.0
    """When the task began, in seconds of the Unix epoch by the clock of its configurator."""


@immutable
class Reserve(Claim):
    """Be held for a task, without acting for it: none of its components acts before it has reserved them all.

    A task that cannot begin now only waits: it is remembered, and told when the component is free.
    """

    inputs: Wires = field(default_factory=dict)
    values: Mapping[str, Term] = field(default_factory=dict)
    waits: bool = False


@immutable
class Apply(Claim):
    """Be active with these values of the operational parameters, and let each input follow exactly these outputs.

    Outputs that stand by are listened to as well, but what they issue is passed over, until a later call makes them
    inputs: then no time is lost with connecting. A component that is free is reserved by the same call.
    """

    inputs: Wires = field(default_factory=dict)
    standby: Wires = field(default_factory=dict)
    values: Mapping[str, Term] = field(default_factory=dict)
    callers: Mapping[str, tuple[IRI, ...]] = field(default_factory=dict)
    """For each operation of the component, by the name of its output, the components that may call it."""
    gently: bool = False
    """Whether an input is to follow the output before until the new one has issued a signal: make before break."""
    rests: bool = False
    """Whether an actuator is to rest: for a second already the configuration has lacked a part."""


@immutable
class Release(Claim):
    """Act for this task no more; the component is off when no task is left for which it acts."""


@immutable
class StateOf:
    """What goes with a question for a component's state: of which task it is."""

    task: Label


class Verdict(str, Enum):
    """How a component answers a call."""

    DONE = "done"
    STALE = "stale"
    """The epoch is older than the newest one the component has obeyed."""
    BUSY = "busy"
    """Another task holds the component; the task that asked is remembered, and hears when the component is free."""
    REFUSED = "refused"
    """The component itself refuses, or its code broke; `detail` says why."""
    NOT_HELD = "not held"
    """The component has no outputs, and the task that applies to it has not reserved it, or not since it was let go."""
    OTHER_LIFE = "another life"
    """The call means another life of the component than the one that answers, or that life is ending."""


@immutable
class CallAnswer:
    """The answer to a call: the verdict, the component's life, and the newest epoch obeyed for the task of the call."""

    verdict: Verdict
    component: IRI
    life: Label
    epoch: int = 0
    active: bool = False
    detail: Remark = ""
    supervisor: Label = ""
    """The liveliness key of the configurator that holds the component; empty if none does, or if it is left out."""
    task: Label = ""
    """The identity of the task that holds the component, of the highest priority if there are several."""
    priority: int = 0
    beginning: float = 0.0
    place: Remark = ""
    """The process and the host of the component, for people."""
    dropped: int = 0
    """How many signals the component has passed over since it lives, because its code was too slow."""
    age: float = 0.0
    """For how long the component has lived, in seconds; this and what follows stand in the answer to `state` alone."""
    memory: int = 0
    """The resident memory of its process in bytes; zero where the system does not say."""
    issued: Mapping[str, int] = field(default_factory=dict)
    """How many signals each output has issued since the component lives."""
    outputs: Wires = field(default_factory=dict)
    """Of a composite that acts: by which outputs inside of it each of its own is issued."""
    callers: Mapping[str, tuple[IRI, ...]] = field(default_factory=dict)
    """Of a composite that acts: which components inside of it call by each operation that it needs."""
    patience: float = 0.0
    """Of a composite whose inside is being started, or a component of which an input is being handed over gently: for
    how many seconds the caller may wait for that."""
    stopping: bool = False
    """Whether the code of the component was asked to stop, and is not at rest yet: it may still act."""
    shared: bool = False
    """Whether a component that is busy acts for the task that calls as well, as it has before.

    In the answer to `state`: whether it acts for that task and for others as well."""

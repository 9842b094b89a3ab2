"""What a component says of itself, or its site and others of it: FAIL, free, moved."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from enum import Enum

from selfconf.model.immutable import immutable
from selfconf.model.term import IRI
from selfconf.protocol.messages.calls import Wires
from selfconf.protocol.messages.texts import Label, Remark


class Cause(str, Enum):
    """Why a component is lost. The paper has only the first."""

    FAIL = "fail"
    """The component raised FAIL itself."""
    CRASH = "crash"
    """The liveliness of the component has ended."""
    SILENCE = "silence"
    """An output that promised a rate has stopped."""
    REFUSED = "refused"
    """The component refused to be activated, or could not be."""
    HUNG = "hung"
    """Code of the component has not returned within its deadline."""
    MALFORMED = "malformed"
    """The component emitted what is not a signal of the type that its output promises."""
    YIELD = "yield"
    """A task of higher priority asks for it; it is not broken, and free for that task once it is released."""
    LET_GO = "let go"
    """It is not broken, but acts no more for a task whose configurator seemed gone, or has not yielded in time."""


@immutable
class Fail:
    """FAIL, the special output that every component has."""

    component: IRI
    life: Label
    epoch: int
    cause: Cause = Cause.FAIL
    detail: Remark = ""
    task: Label = ""
    """The identity of the task that it is put for; empty: every task that the component acts for."""
    sequence: int = 0
    """The number of the last signal that this life has issued: what comes of it later, up to that, is no news.

    0 where there was none, or where it is not known, as to a site.
    """


@immutable
class Free:
    """To those that wait for a component: it is free, and kept for a moment for the task that goes first.

    Without a task: it begins to act for the one that holds it, so waiting for it may last.
    """

    component: IRI
    life: Label
    task: Label = ""


@immutable
class Moved:
    """The outputs of a composite are issued by others inside of it than before, or others call what it needs."""

    component: IRI
    life: Label
    outputs: Wires = field(default_factory=dict)
    callers: Mapping[str, tuple[IRI, ...]] = field(default_factory=dict)

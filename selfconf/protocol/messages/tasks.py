"""What is said of a task: by its configurator to all, and to the sites that keep it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Any

from selfconf.model.configuration import Wants
from selfconf.model.immutable import immutable
from selfconf.model.term import IRI, Term
from selfconf.protocol.keys import task_name
from selfconf.protocol.messages.component_reports import Cause
from selfconf.protocol.messages.texts import Identity, Label, Remark


@immutable
class Status:
    """What a configurator has deployed, and for which task."""

    configurator: Label
    phase: Remark
    template: IRI
    epoch: int
    since: float
    host: Remark = ""
    process: int = 0
    components: tuple[IRI, ...] = ()
    lost: Mapping[str, Any] = field(default_factory=dict)
    task: Label = ""
    """The identity of the task."""
    priority: int = 0
    beginning: float = 0.0
    owed: tuple[IRI, ...] = ()
    """The components that were turned off and have not obeyed yet."""
    dropped: Mapping[str, Any] = field(default_factory=dict)
    """How many signals those components have passed over that are too slow."""
    outside: IRI | None = None
    """The composite of which the task is the inside, if it is one."""
    wants: Mapping[IRI, Wants] = field(default_factory=dict)
    """What the task wants of those components that can be shared, where it wants anything of them."""

    @property
    def name(self) -> str:
        """The name of the task, as its user knows it."""
        return task_name(self.task)


@immutable
class Notice:
    """An event of a run, for observers: nothing depends on its arrival."""

    configurator: Label
    sequence: int
    """Grows by one with each event of the configurator; a gap tells that one was lost."""
    task: Label
    event: Mapping[str, Any]
    """The event as `selfconf run --format json` prints it."""


@immutable
class RecordedLoss:
    """A component that a task has lost and that lives on: in which life, and why."""

    component: IRI
    life: Label
    cause: Cause
    detail: Remark = ""


@immutable
class TaskRecord:
    """A task that lives in the ecology: what the sites keep of it, and by which one of them goes on with it."""

    task: Identity
    """The identity of the task."""
    revision: int
    """Of two records of a task that has not ended, the one with the higher revision counts."""
    ended: bool = False
    """Whether it is to run no more; kept so that a site that was away hears of it."""
    priority: int = 0
    beginning: float = 0.0
    document: str = ""
    """The Turtle document that holds its template."""
    source: Remark = ""
    """Where the document was read from, for people."""
    wanted: Label = ""
    """The IRI of the template or task, in case the document holds several."""
    bindings: Mapping[str, Term] = field(default_factory=dict)
    ontologies: tuple[str, ...] = ()
    """Turtle documents of further ontologies, in which no IRI is relative to where they come from."""
    options: Mapping[str, Any] = field(default_factory=dict)
    """`policy`, `strategy`, `reasoning`, `steps`, `seconds`, `upgrade`, as the command `run` has them."""
    epoch: int = 0
    """The newest epoch in which it was deployed; zero: never yet."""
    configuration: Mapping[str, Any] = field(default_factory=dict)
    """What is deployed, as `selfconf configure --format json` prints it; empty if nothing is."""
    lost: tuple[RecordedLoss, ...] = ()
    """What has failed and lives on: a site that goes on with the task does without it, until it lives anew."""
    keeper: Label = ""
    """The site that begins to run the task, by which the one that runs it may let go; empty: none does now."""

    @property
    def version(self) -> tuple[bool, int, int]:
        """Of two records of one task the one of the greater version counts: the end of a task is final.

        Two sites may make one revision, where one of them was frozen or cut off: what runs is of the newer epoch.
        """
        return self.ended, self.revision, self.epoch

    def supersedes(self, known: TaskRecord | None) -> bool:
        """Whether this record counts, and not the one that is known of the same task."""
        return known is None or self.version > known.version

"""One task of a living ecology, all that run, and a configurator that only what it holds tells of."""

from __future__ import annotations

from selfconf.model.immutable import immutable
from selfconf.model.term import IRI
from selfconf.protocol.keys import task_name
from selfconf.protocol.messages import Status, TaskRecord
from selfconf.this_machine import LocalTask


@immutable
class LivingTask:
    """A task of an ecology: who runs it, since when, and with which components."""

    name: str
    priority: int
    beginning: float
    """When it began, in seconds of the Unix epoch."""
    phase: str
    template: IRI | None
    """None: the record that the sites keep of it does not say."""
    configurator: str
    """The name of the configurator that runs it; empty if no site has begun to."""
    detached: bool
    """Whether it lives in the sites."""
    components: tuple[IRI, ...] = ()
    inside_of: IRI | None = None
    """The composite of which it is the inside, if it is one: its site runs it."""

    @classmethod
    def of(cls, status: Status, detached: bool) -> LivingTask:
        """A task that a configurator runs."""
        return cls(
            status.name,
            status.priority,
            status.beginning,
            status.phase,
            status.template,
            status.configurator,
            detached,
            status.components,
            status.outside,
        )

    @property
    def lives_in(self) -> str:
        """What goes on with it: the sites, the command that runs it, or the composite of which it is the inside."""
        if self.inside_of is not None:
            return f"composite {self.inside_of.short}"
        return "sites" if self.detached else "command"

    @classmethod
    def kept(cls, record: TaskRecord) -> LivingTask:
        """A task that the sites keep and that none runs now."""
        return cls(
            task_name(record.task),
            record.priority,
            record.beginning,
            "kept",
            IRI.unchecked(record.wanted) if record.wanted else None,
            "",
            detached=True,
        )

    def body(self) -> dict[str, object]:
        """The task as JSON."""
        return {
            "task": self.name,
            "priority": self.priority,
            "beginning": self.beginning,
            "phase": self.phase,
            "template": self.template,
            "inside_of": self.inside_of,
            "configurator": self.configurator,
            "detached": self.detached,
            "components": list(self.components),
        }


@immutable
class SilentHolder:
    """A configurator that is not seen to live, though components say that it holds them: suspended, or just killed."""

    configurator: str
    task: str
    """The identity of its task."""
    components: tuple[IRI, ...]

    def is_named(self, name: str | None) -> bool:
        """Whether a name is that of the configurator or of its task; None means all."""
        return name in (None, self.configurator, task_name(self.task))

    def __str__(self) -> str:
        named = ", ".join(component.short for component in self.components)
        return f"the configurator {self.configurator!r} of {task_name(self.task)!r} holds {named}, but does not answer"


@immutable
class RunningTasks:
    """The tasks that run, as their configurators say when they are asked, and those that do not answer."""

    statuses: tuple[Status, ...] = ()
    """What each configurator says of its task, sorted by the configurator's name."""
    silent: tuple[str, ...] = ()
    """The configurators that live or hold components, but do not answer, sorted."""
    holding: tuple[SilentHolder, ...] = ()
    """Those of them that hold components, as far as these were asked."""
    suspended: tuple[LocalTask, ...] = ()
    """The tasks of suspended programs of this machine of which nothing else tells."""
    sites: frozenset[str] = frozenset()
    """The names of the sites that live."""
    complaints: tuple[str, ...] = ()
    """What was wrong with the answers of configurators, and which sites have one name."""

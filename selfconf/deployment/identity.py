"""Which task a configurator runs, as other tasks see it: its name, its rank, and since when."""

from __future__ import annotations

from selfconf.model.immutable import immutable
from selfconf.protocol.keys import task_name


@immutable
class TaskIdentity:
    """A running task: what stays the same if another configurator goes on with it."""

    task: str
    """Its name and a text that no other task of that name has: `selfconf.protocol.keys.task_identity`."""
    priority: int = 0
    beginning: float = 0.0
    """When it began, in seconds of the Unix epoch."""

    @property
    def name(self) -> str:
        """Its name, as its user knows it."""
        return task_name(self.task)

"""How a task is to run, as programs and commands that begin one say it, be it here or in the sites of the ecology."""

from __future__ import annotations

from selfconf.api.arguments import checked_choice, checked_priority, checked_text
from selfconf.api.task import TaskSpecification
from selfconf.configurator import Policy
from selfconf.model.immutable import immutable
from selfconf.protocol.keys import checked_name


@immutable
class TaskOptions:
    """How a task is to run: what is done about a loss and for the better, and its name and rank among others."""

    policy: Policy = Policy.REPAIR
    name: str = ""
    """The name of the task; empty for that of its template."""
    priority: int | None = None
    """The priority of the task; None for that of its template."""
    upgrade: float | None = None
    """The seconds before a change for the better; None for no such change."""

    @classmethod
    def of(cls, policy: str, name: str, priority: int | None, upgrade: float | None) -> TaskOptions:
        """The options that a caller of the library has named.

        Raises ProgrammerError for a policy or text that is none, and AuthorError for a name that is none. The priority
        is checked by `priority_of`, the seconds where they are used.
        """
        if checked_text(name, "the name of a task"):
            checked_name(name, "a task")
        return cls(checked_choice(Policy, "policy", policy), name, priority, upgrade)

    def priority_of(self, task: TaskSpecification) -> int:
        """The priority of a task that runs so. Raises ProgrammerError for one that is none."""
        return task.document.task.priority if self.priority is None else checked_priority(self.priority)


AS_USUAL = TaskOptions()
"""How a task runs of which nothing else is said."""

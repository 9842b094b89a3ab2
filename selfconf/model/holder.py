"""Who holds a component: a task of the living ecology."""

from __future__ import annotations

from selfconf.model.configuration import Configuration, Wants
from selfconf.model.immutable import immutable
from selfconf.model.term import IRI


@immutable
class Holder:
    """Who holds a component: a task, its priority and beginning, and its configurator."""

    task: str
    """The identity of the task: its name, a tilde, and a text that no other task has."""
    priority: int = 0
    beginning: float = 0.0
    """When the task began, in seconds of the Unix epoch."""
    configurator: str = ""
    acting: bool = True
    """Whether the component acts for it: else it has only been reserved."""
    wants: Wants = Wants()
    """What it wants of the component, where that can be shared: by those that want the same."""

    def disagrees(self, component: IRI, configuration: Configuration) -> bool:
        """Whether it wants something else of a component than a configuration."""
        return self.wants != configuration.wants(component)

    @property
    def name(self) -> str:
        """The name of the task, as its user knows it."""
        return self.task.partition("~")[0]

    def __str__(self) -> str:
        return f"the task {self.name} (priority {self.priority}, configurator {self.configurator}) holds it"

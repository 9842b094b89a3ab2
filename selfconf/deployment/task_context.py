"""What every part of the configurator of a running task is given: the request, the ecology, its name, the machine."""

from __future__ import annotations

from collections.abc import Callable

from selfconf.configurator import Event, State
from selfconf.deployment.run_request import EventListener, RunRequest, TaskIdentity
from selfconf.discovery import EcologyView
from selfconf.model.immutable import immutable


@immutable
class TaskContext:
    """One running task, as the parts of its configurator see it."""

    request: RunRequest
    ecology: EcologyView
    name: str
    """The name of the configurator in the ecology."""
    supervisor: str
    """The liveliness key of the configurator, by which components supervise it."""
    identity: Callable[[], TaskIdentity]
    """Returns how the task is known to others, with the rank that it has now."""
    state: Callable[[], State]
    """Returns the state of the machine as it is now."""
    step: Callable[[Event], None]
    """Feeds the machine with an event, and carries out what it wants done."""
    report: EventListener
    """Hears what happens, when there is nothing more urgent to do."""

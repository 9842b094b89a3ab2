"""Several components in one process with one session, as a simulated world or a robot's computer has them."""

from __future__ import annotations

from collections.abc import Callable

from selfconf import files
from selfconf.bus.port import Bus
from selfconf.errors import AuthorError, ProgrammerError
from selfconf.model.profile import Profile
from selfconf.protocol.keys import Keys
from selfconf.sdk.component import Component
from selfconf.sdk.runtime import ComponentRuntime


class Host:
    """Components that share one session and one thread: the thread that calls `run` or `poll`."""

    def __init__(self, bus: Bus, ecology: str) -> None:
        self.bus, self.keys = bus, Keys(ecology)
        self.runtimes: list[ComponentRuntime] = []

    def add(self, component: Component, life: str = "") -> Component:
        """Let a component join the ecology. Raises AuthorError for an advertisement that cannot be read."""
        self.runtimes.append(ComponentRuntime(self.bus, self.keys, profile_of(type(component)), component, life))
        return component

    def poll(self, seconds: float = 0.0) -> None:
        """Let the components hear everything there is to hear; wait up to that long if there is nothing."""
        self.bus.poll(seconds)

    def run(self, until: Callable[[], bool]) -> None:
        """Let the components hear everything, until `until` holds."""
        self.bus.run(until)

    def close(self) -> None:
        """Turn every component off and leave the ecology."""
        for runtime in self.runtimes:
            runtime.close()
        self.runtimes.clear()
        self.bus.close()


def profile_of(kind: type[Component]) -> Profile:
    """The profile of a component class, read from its advertisement."""
    path = kind.advertisement_path()
    if not path.is_file():
        raise ProgrammerError(f"the advertisement of {kind.__name__} is not there: {path}")
    good, bad = files.advertisements(path)
    for malformed in bad:
        raise AuthorError(f"{malformed.component}: {malformed.problems[0]}", file=str(path))
    wanted = [a.profile for a in good if not kind.component or a.profile.component == kind.component]
    if len(wanted) != 1:
        names = ", ".join(a.profile.component for a in good) or "none"
        raise ProgrammerError(f"{kind.__name__} must say by `component` which one of {path} it is; there: {names}")
    return wanted[0]

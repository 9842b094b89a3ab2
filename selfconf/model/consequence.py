"""The consequence of a failure: what would come instead of a component of a configuration if it failed (N - 1)."""

from __future__ import annotations

from collections.abc import Callable

from selfconf.model.configuration import Configuration
from selfconf.model.immutable import immutable
from selfconf.model.refusal import Refusal, Undecided
from selfconf.model.term import IRI


@immutable
class Consequence:
    """A component that may fail, the role it plays, and the configuration after that, or why none is known."""

    component: IRI
    role: IRI | None
    """None for a recruit, which plays none."""
    after: Configuration | Refusal | Undecided
    started: tuple[IRI, ...] = ()
    """Components that would begin to play a part, in the order of the roles."""
    stopped: tuple[IRI, ...] = ()
    """Components that would no longer play one, apart from the one that failed."""
    moved: tuple[tuple[IRI, IRI | None], ...] = ()
    """Components that would play another role, each with that role; None for a player that would be recruited."""

    @property
    def fatal(self) -> bool:
        """Whether it is a single point of failure."""
        return isinstance(self.after, Refusal)

    def told(self, name: Callable[[IRI], str]) -> str:
        """What would come instead, with names for things."""
        if self.fatal:
            return "NONE, a single point of failure"
        if isinstance(self.after, Undecided):
            return "not decided"
        changes = [", ".join(map(name, self.started))] if self.started else []
        changes += [f"{name(one)} as {'recruit' if role is None else name(role)}" for one, role in self.moved]
        instead = ", ".join(changes) or "no component needed"
        return f"{instead}, and {', '.join(map(name, self.stopped))} would stop" if self.stopped else instead

    def __str__(self) -> str:
        part = "recruit" if self.role is None else self.role.short
        return f"{self.component.short} ({part}): {self.told(lambda iri: iri.short)}"

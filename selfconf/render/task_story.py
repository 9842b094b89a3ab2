"""What a task was at a moment, by the events that its configurator has told until then.

The events are those of `run --format json`, as a configurator keeps them.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from selfconf.model.immutable import immutable

EventBody = Mapping[str, Any]


@immutable
class ToldConfiguration:
    """A configuration as an event tells it; components and roles are named by their IRIs."""

    roles: Mapping[str, list[str]] = field(default_factory=dict)
    """The components of each role."""
    recruits: tuple[str, ...] = ()
    """The components that play no role and feed those that do, or each other."""
    connections: tuple[tuple[str, tuple[str, str]], ...] = ()
    """Each connection: the source, and the sink with its input."""
    bindings: tuple[str, ...] = ()
    """The values of the parameters."""

    @property
    def players(self) -> dict[str, list[str]]:
        """The components of each role, and each recruit as its own."""
        return {**self.roles, **{one: [one] for one in self.recruits}}

    def sinks_of(self, component: str) -> list[str]:
        """The components that a component feeds, each once."""
        return list(dict.fromkeys(sink for source, (sink, _) in self.connections if source == component))

    def recruits_of(self, components: Collection[str]) -> list[str]:
        """The recruits that feed some of these components, each once."""
        fed = {source for source, (sink, _) in self.connections if sink in components}
        return [one for one in self.recruits if one in fed]

    def fed_before(self, recruit: str, before: ToldConfiguration) -> Iterator[str]:
        """Yield the recruits of a configuration before, here no more, that have fed an input that a recruit feeds."""
        fed = {wanted for source, wanted in self.connections if source == recruit}
        for source, wanted in before.connections:
            if wanted in fed and source in before.recruits and source not in self.recruits:
                yield source


NO_CONFIGURATION = ToldConfiguration()


def _told(body: Mapping[str, Any]) -> ToldConfiguration:
    """The configuration that an event tells."""
    return ToldConfiguration(
        {str(one["role"]): list(map(str, one["components"])) for one in body.get("roles", ())},
        tuple(map(str, body.get("recruits", ()))),
        tuple(
            (str(one["from"]["component"]), (str(one["to"]["component"]), str(one["to"]["input"])))
            for one in body.get("connections", ())
        ),
        tuple(map(str, body.get("bindings", {}).values())),
    )


@dataclass(slots=True)
class TaskStory:
    """What a task was at a moment, by its events until then."""

    task: str
    configuration: ToldConfiguration = NO_CONFIGURATION
    refusal: Mapping[str, Any] | None = None
    since: float = 0.0
    """When its configuration began, or since when it has none."""
    unchanged: dict[str, float] = field(default_factory=dict)
    """Since when each role has been played by the same components, and each recruit has been one; by their IRIs."""
    lost: dict[str, EventBody] = field(default_factory=dict)
    replaced: dict[str, str] = field(default_factory=dict)
    """The component before, by the one that took over from it."""
    ended: float | None = None
    """When it was taken down, if it was."""
    begun: bool = False
    """Whether it has told anything."""

    def take(self, event: EventBody) -> None:
        """Note an event."""
        act, self.begun = event.get("act"), True
        if act == "lost":
            self.lost[str(event.get("component"))] = event
        elif act == "running" and isinstance(event.get("configuration"), dict):
            found = _told(event["configuration"])
            # One that was taken down is replaced by none, unless that is said, as of one that ended by a failure.
            before = self.configuration if self.ended is None or event.get("revises") else NO_CONFIGURATION
            self._note_unchanged(found, time_of(event))
            self._note_replaced(before, found)
            self.configuration, self.refusal, self.since, self.ended = found, None, time_of(event), None
        elif act in ("waiting", "refused"):
            if self.refusal is None:  # one that waits comes to the same again and again
                self.since = time_of(event)
            self.refusal = event.get("refusal") or {}
        elif act in ("stopped", "detached"):
            self.ended = time_of(event)

    def _note_unchanged(self, found: ToldConfiguration, time: float) -> None:
        """Note what goes on through a new configuration: nothing does after an end, a refusal or a loss of its own."""
        interrupted = self.ended is not None or self.refusal is not None
        lost = {component for component, event in self.lost.items() if time_of(event) >= self.since}
        before = {} if interrupted else self.configuration.players
        self.unchanged = {
            one: self.unchanged[one] if before.get(one) == players and not lost.intersection(players) else time
            for one, players in found.players.items()
        }

    def _note_replaced(self, before: ToldConfiguration, found: ToldConfiguration) -> None:
        """Note which components have come since a configuration, each with the one that it took over from."""
        for role, components in found.roles.items():
            played = before.roles.get(role, [])
            gone = [one for one in played if one not in components]
            come = [one for one in components if one not in played]
            for one in come:
                self.replaced.pop(one, None)
            self.replaced.update(zip(come, gone, strict=False))
        for one in found.recruits:
            if one not in before.recruits:
                self.replaced.pop(one, None)
                self.replaced.update((one, gone) for gone in found.fed_before(one, before))


def story(task: str, events: Iterable[EventBody], at: float | None = None) -> TaskStory:
    """The story of a task until a moment, or until now."""
    found = TaskStory(task)
    for event in events:
        if at is None or time_of(event) <= at:
            found.take(event)
    return found


def time_of(event: EventBody) -> float:
    """When an event happened, in seconds of the Unix epoch; zero where it does not say so."""
    moment = event.get("time")
    return float(moment) if isinstance(moment, int | float) else 0.0

"""What is known of an ecology now, and what has happened lately, on the thread that serves."""

from __future__ import annotations

import json
from collections import Counter, deque
from collections.abc import Callable, Iterable, Mapping, Sequence

from selfconf.discovery import FoundAdvertisement
from selfconf.model.term import IRI
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import TaskRecord
from selfconf.rdf.sparql import QUERY_PREFIXES
from selfconf.serve.event_stream import EventStream
from selfconf.serve.merge_patch import merge_patch
from selfconf.serve.metrics import Metrics
from selfconf.serve.things import thing_description
from selfconf.serve.watching.change import Body, EcologyChange

REMEMBERED = 2000
"""How many events of the ecology are remembered."""
MOST_SHARED = 8
"""How many answers are kept for all who ask for them."""
CHANGE = "change"
"""The kind of the server-sent events of the page."""
THING_EVENTS = ("thing_created", "thing_updated", "thing_deleted")
"""The kinds of the events of the directory (W3C WoT Discovery, section 7.2.2.3)."""


class Board:
    """The components, sites, tasks and events of one ecology, and the streams that tell of their changes."""

    def __init__(self, ecology: str, metrics: Metrics) -> None:
        self.keys, self._metrics = Keys(ecology), metrics
        self.stream = EventStream()
        self.advertised: dict[IRI, FoundAdvertisement] = {}
        self.descriptions: dict[IRI, str] = {}
        """The Thing Description of each as JSON, made once: that takes longer than to send it."""
        self.ready = False
        """Whether the first look at the ecology has come."""
        self.link = ""
        """The link over which was last found what there is."""
        self._components: dict[str, Body] = {}
        self._sites: dict[str, Body] = {}
        self._tasks: dict[str, Body] = {}
        self._records: dict[str, TaskRecord] = {}
        self._events: deque[Body] = deque(maxlen=REMEMBERED)
        self._answers: dict[str, bytes] = {}

    def apply(self, change: EcologyChange) -> None:
        """Note a change, and tell of it."""
        self._metrics.changes += 1
        self._answers.clear()
        for event in change.events:
            self._metrics.happened(str(event.get("act")), str(event.get("cause", "")), event["time"])
        for component, found in change.advertised.items():
            self._advertise(component, found)
        for known, new in (
            (self._components, change.components),
            (self._sites, change.sites),
            (self._tasks, change.tasks),
        ):
            _merge(known, new)
        self._records |= change.records
        self._records = {task: record for task, record in self._records.items() if task in self._tasks}
        self._events.extend(change.events)
        self.link = change.link or self.link
        self.ready = True
        told = {"components": change.components, "sites": change.sites, "tasks": change.tasks, "events": change.events}
        if any(told.values()):
            self.stream.put(CHANGE, {kind: new for kind, new in told.items() if new})

    def _advertise(self, component: IRI, found: FoundAdvertisement | None) -> None:
        """Note an advertisement, and tell of it, unless it is described as before: its site has advertised others.

        The event of a thing that was described otherwise says what has changed, as JSON Merge Patch.
        """
        before, now, thing = self.descriptions.pop(component, None), None, {}
        if found is None:
            self.advertised.pop(component, None)
        else:
            self.advertised[component] = found
            thing = thing_description(found.advertisement.profile, self.keys)
            now = self.descriptions[component] = json.dumps(thing, ensure_ascii=False)
        if self.ready and before != now:
            kind = THING_EVENTS[2] if now is None else THING_EVENTS[0 if before is None else 1]
            told = thing if now is None or before is None else merge_patch(json.loads(before), json.loads(now))
            self.stream.put(kind, {**told, "id": str(component)})

    def knows(self, task: str) -> bool:
        """Whether there is a task of this identity, or was one lately."""
        return task in self._tasks

    def task(self, task: str) -> Body:
        """What is known of a task, as JSON; nothing where there is none of this identity."""
        return self._tasks.get(task, {})

    def record(self, task: str) -> TaskRecord | None:
        """The template of a task, and how it is searched for; None where its configurator has not told it."""
        return self._records.get(task)

    def running(self) -> Sequence[str]:
        """The tasks that are not over, by priority and age."""
        living = {task: body for task, body in self._tasks.items() if not body.get("over")}
        return sorted(living, key=lambda task: (-living[task]["priority"], living[task]["beginning"]))

    def lost(self, task: str) -> frozenset[IRI]:
        """The components that a task has lost and that have not come back."""
        return frozenset(map(IRI.unchecked, self._tasks.get(task, {}).get("lost", ())))

    def state(self) -> Body:
        """Everything, with the identifier of the last event that it holds."""
        return {
            "ecology": self.keys.ecology,
            "last": self.stream.last,
            "prefixes": QUERY_PREFIXES,
            "ready": self.ready,
            "components": self._components,
            "sites": self._sites,
            "tasks": self._tasks,
            "events": list(self._events),
        }

    def shared(self, name: str, written: Callable[[], str]) -> bytes:
        """An answer as it is sent, written once for all who ask for it until something changes."""
        if name not in self._answers:
            if len(self._answers) == MOST_SHARED:
                self._answers.clear()
            self._answers[name] = written().encode()
        return self._answers[name]

    def gauges(self, linked: bool) -> Mapping[str, Iterable[tuple[Mapping[str, str], float]]]:
        """What can be read off the ecology now, for the metrics."""
        states = Counter(body["state"] for body in self._components.values())
        phases = Counter(body["phase"] for body in self._tasks.values() if not body["over"])
        held = {component for body in self._tasks.values() for component in body["components"]}
        return {
            "selfconf_up": [({}, float(linked))],
            "selfconf_sites": [({}, float(len(self._sites)))],
            "selfconf_components": [({"state": s}, float(states[s])) for s in ("alive", "dormant", "absent")],
            "selfconf_components_held": [({}, float(len(held)))],
            "selfconf_tasks": [({"phase": phase}, float(count)) for phase, count in sorted(phases.items())],
            "selfconf_subscribers": [({}, float(self.stream.listeners))],
        }


def _merge(known: dict[str, Body], new: Mapping[str, Body | None]) -> None:
    for name, body in new.items():
        if body is None:
            known.pop(name, None)
        else:
            known[name] = body

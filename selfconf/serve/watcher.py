"""A living ecology, followed from a bus: what is advertised, what lives, which tasks run, and what happens to them.

It only reads: it has no life of its own, answers nobody, and makes no call to a component, so nobody notices that it is
there. Changes come by push: lives by liveliness, files by `changed`, the events of a run by notices. Every `LOOK_ANEW`
seconds the configurators are asked once more, which heals what was lost and serves those that put no notices.
"""

from __future__ import annotations

import logging
import time
from collections import deque
from collections.abc import Callable, Iterable

from selfconf.bus.port import Bus, Replies, Sample
from selfconf.discovery import Discovery, EcologyView
from selfconf.errors import PeerError, TurtleError
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode
from selfconf.protocol.keys import component_chunk, life_of, owner_of, task_name
from selfconf.protocol.messages import Notice, Status, TaskRecord
from selfconf.rdf import turtle
from selfconf.serve.change import Body, EcologyChange
from selfconf.serve.component_bodies import component_body
from selfconf.serve.deployed import deployed_body
from selfconf.serve.watched_task import WatchedTask

log = logging.getLogger(__name__)

LOOK_ANEW = 10.0
"""Seconds between two looks at all configurators."""
TOGETHER = 0.05
"""Seconds for which changes are collected, so that a rush of them is told at once."""
ASKED_AGAIN = 5.0
"""Seconds after which a site is asked again that has not answered in full."""
PATIENCE_WITH_PEERS = 2.0
"""Seconds that a configurator may take to answer."""
ENDED_TASKS = 12
"""How many tasks that are over are still shown."""


class EcologyWatcher:
    """Follows one ecology and hands on each change; runs on the thread of its bus."""

    def __init__(
        self,
        bus: Bus,
        ecology: str,
        tell: Callable[[EcologyChange], None],
        clock: Callable[[], float] = time.time,
        aside: Callable[[Callable[[], None]], object] = lambda work: work(),
    ) -> None:
        """`aside` reads what the sites have answered on another thread than the bus's."""
        self.bus, self._tell, self._clock = bus, tell, clock
        self.view = EcologyView(bus, ecology)
        self.view.aside = lambda work: (aside(work), None)[1]
        self.keys = self.view.keys
        self._components: dict[IRI, Body] = {}
        self._chunks: dict[str, IRI] = {}
        self._sites: dict[str, Body] = {}
        self._tasks: dict[str, WatchedTask] = {}
        """By the name of the configurator."""
        self._over: deque[str] = deque()
        self._kept: dict[str, TaskRecord] = {}
        self._shown: dict[str, Body] = {}
        """The tasks as they were told last, by identity."""
        self._events: list[Body] = []
        self._graphs: dict[str, bytes] = {}
        self._deployed_text: dict[str, bytes] = {}
        """What each configurator has said last of what it has deployed."""
        self._touched: set[IRI] = set()
        self._flushing = self._discovering = self._discover_again = self._following = False
        self._asking: set[str] = set()

    def begin(self) -> None:
        """Look at what there is, and follow it from then on."""
        self._discover()

    # What is advertised, and what lives.

    def _discover(self) -> None:
        if self._discovering:
            self._discover_again = True
            return
        self._discovering = True
        self.view.discover(self._discovered)

    def _discovered(self, discovery: Discovery) -> None:
        self._discovering = False
        before, self.view.discovery = self.view.discovery.found, discovery
        gone: dict[IRI, None] = {c: None for c in before if c not in discovery.found}
        new = {c: found for c, found in discovery.found.items() if before.get(c) != found}
        for component in gone:
            self._chunks.pop(component_chunk(component), None)
            self._components.pop(component, None)
        self._chunks.update({component_chunk(component): component for component in new})
        bodies = {component: component_body(found, self._state(component)) for component, found in new.items()}
        self._components.update(bodies)
        graphs = {str(c): turtle.ntriples(found.advertisement.triples) for c, found in new.items()}
        graphs |= {str(c): b"" for c in gone}
        shown: dict[str, Body | None] = {str(component): body for component, body in bodies.items()}
        shown |= {str(component): None for component in gone}
        self._hand_on(EcologyChange({**new, **gone}, shown, self._changed_sites(discovery), graphs=graphs))
        if not self._following:
            self._follow()
        if self._discover_again:
            self._discover_again = False
            self._discover()
        elif discovery.missing:
            self.bus.later(ASKED_AGAIN, self._discover)

    def _changed_sites(self, discovery: Discovery) -> dict[str, Body | None]:
        before, self._sites = self._sites, {site: {"missing": site in discovery.missing} for site in discovery.sites}
        gone: dict[str, Body | None] = {site: None for site in before if site not in self._sites}
        return {**gone, **{site: body for site, body in self._sites.items() if before.get(site) != body}}

    def _follow(self) -> None:
        """Follow everything, once; not before the first discovery has ended, as `EcologyView.follow` says."""
        self._following = True
        self.view.follow(self._life_changed, self._site_changed)
        self.bus.subscribe(self.keys.changed(), lambda _: self._discover())
        self.bus.subscribe(self.keys.notices(), self._noticed)
        self.bus.subscribe(self.keys.task(), self._kept_changed)
        self.bus.watch(self.keys.any_configurator_life(), self._configurator_changed)
        self._audit()

    def _state(self, component: IRI) -> str:
        if self.view.life(component) is not None:
            return "alive"
        found = self.view.discovery.found.get(component)
        return "dormant" if found is not None and found.startable else "absent"

    def _life_changed(self, key: str, alive: bool) -> None:
        chunk, life = owner_of(key), life_of(key)
        known = life in self.view.lives.get(chunk, ())
        (self.view.began if alive else self.view.ended)(chunk, life)
        component = self._chunks.get(chunk)
        if component is None or known == alive:
            return
        self._touched.add(component)
        act, what = ("began", "lives") if alive else ("ended", "lives no more")
        self._happened({"act": act, "component": component, "message": f"{component.short} {what}"})

    def _site_changed(self, key: str, alive: bool) -> None:
        site = owner_of(key)
        if alive != (site in self._sites):
            act, what = ("site came", "is there") if alive else ("site left", "has gone")
            self._happened({"act": act, "site": site, "message": f"the site {site} {what}"})
        self._discover()

    # What the configurators do.

    def _configurator_changed(self, key: str, alive: bool) -> None:
        name = owner_of(key)
        if alive:
            self._tasks.setdefault(name, WatchedTask(name)).alive = True
            self._ask_all(name)
        elif name in self._tasks:
            self._tasks[name].alive = False
            self._over.append(name)
            while len(self._over) > ENDED_TASKS:
                self._tasks.pop(self._over.popleft(), None)
            self._deployed_text.pop(name, None)
            self._graphs[self._graph(name)] = b""
            self._flush_soon()

    def _noticed(self, sample: Sample) -> None:
        try:
            notice = decode(sample.payload, Notice)
        except PeerError as error:
            log.warning("passed over a notice on %s: %s", sample.key, error)
            return
        if sample.key != self.keys.notices(notice.configurator):
            return
        task = self._tasks.setdefault(notice.configurator, WatchedTask(notice.configurator))
        if notice.sequence > task.sequence + 1:
            self._ask(self.keys.notices(task.configurator), self._hear_all)  # what was lost, in its order
        else:
            self._hear(task, notice)
            self._ask_soon(task.configurator)

    def _hear(self, task: WatchedTask, notice: Notice) -> None:
        event = task.hear(notice)
        if event is not None:
            self._happened(event)
        if notice.event.get("act") == "running":
            self._ask(self.keys.configuration(task.configurator), self._deployed)

    def _hear_all(self, replies: Replies) -> None:
        notices = []
        for sample in replies.samples:
            try:
                notice = decode(sample.payload, Notice)
            except PeerError:
                continue
            if sample.key == self.keys.notices(notice.configurator):
                notices.append(notice)
        for notice in sorted(notices, key=lambda notice: (notice.configurator, notice.sequence)):
            self._hear(self._tasks.setdefault(notice.configurator, WatchedTask(notice.configurator)), notice)

    def _audit(self) -> None:
        """Ask everyone, so that nothing that was lost stays lost."""
        self.bus.later(LOOK_ANEW, self._audit)
        self._ask_all("*")
        self._ask(self.keys.kept_tasks(), self._take_kept)

    def _ask_all(self, configurator: str) -> None:
        self._ask(self.keys.notices(configurator), self._hear_all)
        self._ask(self.keys.configurator_call(configurator, "status"), self._take_statuses)
        self._ask(self.keys.configuration(configurator), self._deployed)

    def _ask_soon(self, configurator: str) -> None:
        """Ask a configurator how things are, once for a rush of events."""
        if configurator not in self._asking:
            self._asking.add(configurator)

            def ask() -> None:
                self._asking.discard(configurator)
                self._ask(self.keys.configurator_call(configurator, "status"), self._take_statuses)

            self.bus.later(TOGETHER, ask)

    def _ask(self, key: str, done: Callable[[Replies], None]) -> None:
        self.bus.ask(key, b"", PATIENCE_WITH_PEERS, done)

    def _take_statuses(self, replies: Replies) -> None:
        for sample in replies.samples:
            try:
                status = decode(sample.payload, Status)
            except PeerError:
                continue
            if sample.key == self.keys.configurator_call(status.configurator, "status"):
                self._tasks.setdefault(status.configurator, WatchedTask(status.configurator)).take_status(status)
        self._flush_soon()

    def _graph(self, configurator: str) -> str:
        return f"urn:selfconf:{self.keys.configuration(configurator)}"

    def _deployed(self, replies: Replies) -> None:
        for sample in replies.samples:
            name = sample.key.split("/")[3] if sample.key.count("/") == 4 else ""
            task = self._tasks.get(name)
            if task is None or not task.alive or sample.key != self.keys.configuration(name):
                continue
            if self._deployed_text.get(name) == sample.payload:
                continue
            self._deployed_text[name] = sample.payload
            try:
                document = turtle.parse(sample.payload, sample.key)
            except TurtleError as error:
                log.warning("passed over a configuration: %s", error)
                continue
            self._graphs[self._graph(name)] = turtle.ntriples(document.triples())
            if task.refusal is None:
                task.configuration = deployed_body(document)
        self._flush_soon()

    def _kept_changed(self, sample: Sample) -> None:
        self._take_kept(Replies((sample,)))

    def _take_kept(self, replies: Replies) -> None:
        for sample in replies.samples:
            try:
                record = decode(sample.payload, TaskRecord)
            except PeerError:
                continue
            known = self._kept.get(record.task)
            if known is None or known.revision < record.revision:
                self._kept[record.task] = record
        self._flush_soon()

    # Handing on.

    def _happened(self, event: Body) -> None:
        self._events.append({"time": self._clock(), **event})
        self._flush_soon()

    def _flush_soon(self) -> None:
        if not self._flushing:
            self._flushing = True
            self.bus.later(TOGETHER, self._flush)

    def _flush(self) -> None:
        self._flushing = False
        components: dict[str, Body | None] = {}
        for component in self._touched & self._components.keys():
            body = {**self._components[component], "state": self._state(component)}
            if body != self._components[component]:
                components[component] = self._components[component] = body
        self._touched.clear()
        shown = dict(self._bodies())
        tasks: dict[str, Body | None] = {one: body for one, body in shown.items() if self._shown.get(one) != body}
        tasks |= {one: None for one in self._shown if one not in shown}
        self._shown = shown
        # What was asked for at the beginning comes from several configurators, one after the other.
        events, graphs = tuple(sorted(self._events, key=_moment)), self._graphs
        self._events, self._graphs = [], {}
        self._hand_on(EcologyChange(components=components, tasks=tasks, events=events, graphs=graphs))

    def _bodies(self) -> Iterable[tuple[str, Body]]:
        """Every task; of two configurators of one, the one that lives."""
        kept = {task for task, record in self._kept.items() if not record.ended}
        for identity in sorted(kept):
            record = self._kept[identity]
            task = WatchedTask("")
            facts = {"name": task_name(identity), "priority": record.priority, "beginning": record.beginning}
            yield identity, {**task.body(detached=True), **facts, "phase": "kept", "template": record.wanted}
        for task in sorted(self._tasks.values(), key=lambda task: task.alive):
            yield task.identity, task.body(task.identity in kept)

    def _hand_on(self, change: EcologyChange) -> None:
        if not change.empty:
            self._tell(change)


def _moment(event: Body) -> float:
    """When an event was."""
    return float(event["time"])

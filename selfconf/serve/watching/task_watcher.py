"""The tasks of an ecology, followed from a bus: by the lives, the notices and the answers of their configurators."""

from __future__ import annotations

import logging
import re
from collections import deque
from collections.abc import Callable, Iterable
from functools import partial

from selfconf.api.living.deployed import deployed_body
from selfconf.bus.answers import own_answers
from selfconf.bus.port import Bus, Replies, Sample
from selfconf.errors import PeerError, TurtleError
from selfconf.model.term import Literal
from selfconf.protocol.codec import decode
from selfconf.protocol.keys import Keys, configurator_of, owner_of, task_name
from selfconf.protocol.messages import Notice, Status, TaskRecord
from selfconf.rdf import turtle
from selfconf.rdf.turtle import Document
from selfconf.rdf.vocabulary import SC
from selfconf.serve.watching.change import Body
from selfconf.serve.watching.watched_task import WatchedTask

log = logging.getLogger(__name__)
_EPOCH = re.compile("[0-9]{1,18}")

DEPLOYED = "urn:selfconf:selfconf/"
"""What the names of the graphs begin with in which configurators tell what they have deployed."""
LOOK_ANEW = 10.0
"""Seconds between two looks at all configurators."""
TOGETHER = 0.05
"""Seconds for which changes are collected, so that a rush of them is sent at once."""
LAST_WORDS_OF_TASK = 0.25
"""Seconds for which the end of a configurator waits for its last notice: the end of a life may overtake it."""
PATIENCE_WITH_PEERS = 2.0
"""Seconds that a configurator may take to answer."""
ENDED_TASKS = 12
"""How many tasks that are over are still shown."""
TOLD_TASKS = 100
"""Of how many tasks it is kept what their configurators have told: with a template, each may be large."""
EARLY = 64
"""How many notices wait at most for those before them, which have been asked for."""
MOST_TASKS = 1000
"""How many tasks are followed; what a stranger says of more is passed over. Of those that the sites keep the latest."""


class TaskWatcher:
    """Follows the tasks of one ecology; runs on the thread of its bus."""

    def __init__(self, bus: Bus, keys: Keys, happened: Callable[[Body], None], changed: Callable[[], None]) -> None:
        """`happened` receives each event of a task, and `changed` is called when anything of a task may be new."""
        self.bus, self.keys, self._happened, self._changed = bus, keys, happened, changed
        self._tasks: dict[str, WatchedTask] = {}
        """By the name of the configurator."""
        self._over: deque[str] = deque()
        self._kept: dict[str, TaskRecord] = {}
        self._new_records: dict[str, TaskRecord] = {}
        """What each configurator has told of its task, by the name of the configurator, until that is handed on."""
        self._graphs: list[dict[str, bytes]] = [{}]
        """What is to be handed on, in its order: one that replaces another before that was handed on comes after it."""
        self._asking: set[str] = set()
        self._early: deque[Sample] = deque(maxlen=EARLY)
        """What was received while something before it is missing: the configurator may end before it can say that."""

    def follow(self) -> None:
        """Follow every configurator from now on, those that are there first."""
        self.bus.subscribe(self.keys.notices(), self._noticed)
        self.bus.subscribe(self.keys.configuration(), lambda sample: self._take_deployed(Replies((sample,))))
        self.bus.subscribe(self.keys.task(), lambda sample: self._take_kept(Replies((sample,))))
        self.bus.watch(self.keys.any_configurator_life(), self._configurator_changed)
        self._audit()

    def look(self, looked: Callable[[], None]) -> None:
        """Ask each configurator that lives what it has deployed; `looked` is called once that is to be handed on."""

        def called(lives: tuple[str, ...]) -> None:
            for key in lives:
                if (task := self._tasks.get(owner_of(key))) is None or not task.alive:
                    self._configurator_changed(key, alive=True)
            self._ask(self.keys.configuration(), answered)

        def answered(replies: Replies) -> None:
            self._take_deployed(replies)
            looked()

        self.bus.roll_call(self.keys.any_configurator_life(), PATIENCE_WITH_PEERS, called)

    def bodies(self) -> Iterable[tuple[str, Body]]:
        """Every task by its identity; of two configurators of one the one that lives comes last."""
        kept = {task for task, record in self._kept.items() if not record.ended}
        for identity in sorted(kept):
            record = self._kept[identity]
            task = WatchedTask("")
            facts = {"name": task_name(identity), "priority": record.priority, "beginning": record.beginning}
            yield identity, {**task.body(detached=True), **facts, "phase": "kept", "template": record.wanted}
        for task in sorted(self._tasks.values(), key=lambda task: task.alive):
            yield task.identity, task.body(task.identity in kept)

    def take_graphs(self) -> list[dict[str, bytes]]:
        """What was deployed or has ended since the last call, as N-Triples by the name of its graph, in its order."""
        graphs, self._graphs = self._graphs, [{}]
        return graphs

    def take_records(self) -> dict[str, TaskRecord]:
        """The tasks of which more is known since the last call, by identity; one that is not known yet has to wait."""
        told = {name: record for name, record in self._new_records.items() if name in self._tasks}
        self._new_records = {name: record for name, record in told.items() if self._tasks[name].identity == name}
        new = told.keys() - self._new_records.keys()
        return {self._tasks[name].identity: told[name] for name in new}

    def _put_graph(self, configurator: str, triples: bytes) -> None:
        graph = f"urn:selfconf:{self.keys.configuration(configurator)}"
        if graph in self._graphs[-1]:  # the history is to have also what was replaced within moments
            self._graphs.append({})
        self._graphs[-1][graph] = triples

    def _task(self, configurator: str) -> WatchedTask:
        """The task of a configurator; of one too many, a task that is not followed."""
        found = self._tasks.get(configurator) or WatchedTask(configurator)
        if len(self._tasks) < MOST_TASKS:
            self._tasks[configurator] = found
        return found

    def _configurator_changed(self, key: str, alive: bool) -> None:
        name = owner_of(key)
        if alive:
            if name in self._over:  # only the way to it was gone
                self._over.remove(name)
            task = self._task(name)
            task.alive, task.is_leaving = True, False
            self._ask_all(name)
            self._ask_task(name)
        elif name in self._tasks:
            self._tasks[name].is_leaving = True
            if self._tasks[name].ended:
                self._end(name)
            else:
                self.bus.later(LAST_WORDS_OF_TASK, lambda: self._end(name))

    def _end(self, name: str) -> None:
        """Take a configurator for ended, unless it has come back meanwhile."""
        task = self._tasks.get(name)
        if task is None or not task.is_leaving:
            return
        task.alive, task.is_leaving, task.deployed_text = False, False, b""
        self._over.append(name)
        while len(self._over) > ENDED_TASKS:
            self._tasks.pop(self._over.popleft(), None)
        self._put_graph(name, b"")
        self._changed()

    def _noticed(self, sample: Sample) -> None:
        try:
            notice = decode(sample.payload, Notice)
        except PeerError as error:
            log.warning("passed over a notice on %s: %s", sample.key, error)
            return
        if sample.key != self.keys.notices(notice.configurator):
            return
        task = self._task(notice.configurator)
        if notice.sequence > task.sequence + 1:
            self._early.append(sample)
            self._ask(sample.key, partial(self._catch_up, sample.key))
        else:
            self._hear(task, notice)
            self._ask_soon(task.configurator)

    def _hear(self, task: WatchedTask, notice: Notice) -> None:
        event = task.hear(notice)
        if event is not None:
            self._happened(event)
            if event["act"] == "waiting":  # what was deployed is taken down, which no configuration tells
                self._put_graph(task.configurator, b"")
                # Where this comes late, the configuration that was deployed after it is known already, and counts anew.
                task.deployed_text = b""
        if notice.event.get("act") == "running":
            self._ask(self.keys.configuration(task.configurator), self._take_deployed)

    def _catch_up(self, key: str, replies: Replies) -> None:
        """Hear what was lost, if the configurator could still say it, and what has come after it."""
        early = [sample for sample in self._early if sample.key == key]
        self._early = deque((sample for sample in self._early if sample.key != key), maxlen=EARLY)
        self._hear_all(Replies((*replies.samples, *early)))

    def _hear_all(self, replies: Replies) -> None:
        notices = []
        for sample in replies.samples:
            try:
                notice = decode(sample.payload, Notice)
            except PeerError:
                continue
            # An answer may come after the end of a configurator that was forgotten: then it is not to come back by it.
            if notice.configurator in self._tasks and sample.key == self.keys.notices(notice.configurator):
                notices.append(notice)
        for notice in sorted(notices, key=lambda notice: (notice.configurator, notice.sequence)):
            self._hear(self._tasks[notice.configurator], notice)

    def _audit(self) -> None:
        """Ask everyone, so that nothing that was lost stays lost."""
        self.bus.later(LOOK_ANEW, self._audit)
        self._ask_all("*")
        for name in [name for name, task in self._tasks.items() if task.alive and not task.is_told]:
            self._ask_task(name)
        self._ask(self.keys.kept_tasks(), self._take_kept)

    def _ask_all(self, configurator: str) -> None:
        self._ask(self.keys.notices(configurator), self._hear_all)
        self._ask(self.keys.configurator_call(configurator, "status"), self._take_statuses)
        self._ask(self.keys.configuration(configurator), self._take_deployed)

    def _ask_task(self, configurator: str) -> None:
        """Ask a configurator for its task at once: one that is refused does not live long."""

        def take(replies: Replies) -> None:
            for sample in replies.samples:
                try:
                    record = decode(sample.payload, TaskRecord)
                except PeerError:
                    continue
                told = sum(task.is_told for task in self._tasks.values())
                if sample.key == key and configurator in self._tasks and told < TOLD_TASKS:
                    self._tasks[configurator].is_told = True
                    self._new_records[configurator] = record
            self._changed()

        key = self.keys.configurator_call(configurator, "task")
        self._ask(key, take)

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
        call = self.keys.configurator_call
        for status in own_answers(replies.samples, Status, lambda one: call(one.configurator, "status"))[0]:
            task = self._tasks.get(status.configurator)
            if task is not None:
                task.take_status(status)
        self._changed()

    def _take_deployed(self, replies: Replies) -> None:
        for sample in replies.samples:
            try:
                name = configurator_of(sample.key)
            except PeerError:
                continue
            task = self._tasks.get(name)
            if task is None or not task.alive or sample.key != self.keys.configuration(name):
                continue
            if task.deployed_text == sample.payload:
                continue
            task.deployed_text = sample.payload
            try:
                document = turtle.parse(sample.payload, sample.key)
            except TurtleError as error:
                log.warning("passed over a configuration: %s", error)
                continue
            epoch = _epoch(document)
            # An answer may come after what was put later, and what was put before the notice that the task runs again.
            if epoch > task.deployed or (epoch == task.deployed and task.refusal is None):
                task.deployed, task.refusal = epoch, None
                self._put_graph(name, turtle.ntriples(document.triples()))
                task.configuration = deployed_body(document)
        self._changed()

    def _take_kept(self, replies: Replies) -> None:
        for sample in replies.samples:
            try:
                record = decode(sample.payload, TaskRecord)
            except PeerError:
                continue
            if record.supersedes(self._kept.get(record.task)):
                self._kept.pop(record.task, None)  # the newest record stands last
                self._kept[record.task] = record
        while len(self._kept) > MOST_TASKS:
            del self._kept[next(iter(self._kept))]
        self._changed()


def _epoch(document: Document) -> int:
    """The epoch of the configuration that a document tells; 0 if it does not say."""
    told = (document.value(name, SC.epoch) for name in document.instances(SC.Configuration))
    return next((int(one.lexical) for one in told if isinstance(one, Literal) and _EPOCH.fullmatch(one.lexical)), 0)

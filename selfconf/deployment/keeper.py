"""Tasks that live in the sites: every site keeps all of them, and one living site runs each.

Which one is the same for all who see the same sites: the site whose name gives the highest hash with the task's
identity (rendezvous hashing, Thaler and Ravishankar 1998). When it goes, the next one goes on with what runs: no
component is stopped or started, each only hears whose life to watch from now on. When a site comes that is to have a
task, the one that has it goes on until the other says that it begins to run it, for until then none would watch over
the components. In the middle of a deployment it does not let go: the other would go on with what ran before, as it
knows of nothing else. The components do not listen to the other until then, and it tries again.

A site that was frozen, or cut off, finds by a newer record that another one has gone on with its task meanwhile. It
leaves that as it runs, and goes on with it in turn: what it knows itself is outdated, and the components would come to
rest before it has asked all of them. How the sites keep the same records is in `record_exchange`.
"""

from __future__ import annotations

import hashlib
import logging
import time
from collections.abc import Callable, Collection, Iterable, Set
from dataclasses import dataclass
from typing import TYPE_CHECKING

from selfconf.bus.port import Bus, Urgency
from selfconf.bus.timer import Timer
from selfconf.configurator import Phase
from selfconf.deployment.configuration_record import configuration_record, recorded_configuration
from selfconf.deployment.holders import Holding
from selfconf.deployment.record_exchange import RecordExchange
from selfconf.deployment.stable_view import StableView
from selfconf.deployment.task_folder import TaskFolder
from selfconf.deployment.task_requests import TaskRequests
from selfconf.errors import PeerError
from selfconf.model.holder import Holder
from selfconf.model.immutable import replace
from selfconf.model.run_event import RunEvent, TaskRunning, TaskWaiting
from selfconf.protocol.keys import Keys, owner_of
from selfconf.protocol.messages import TaskRecord

if TYPE_CHECKING:
    from selfconf.deployment.run_request import RunRequest
    from selfconf.deployment.runner import TaskRunner

log = logging.getLogger(__name__)

KEEPER_LOOK = 1.0
"""Seconds between two looks at which tasks this site is to run."""
KEEPER_AGAIN = 0.3
"""Seconds after which a task that this site ran, and has left to another, is looked at again: components let go of a
task that no site runs after a second."""
LINKED_AGAIN = 0.2
"""Seconds after which a site that has lost its hub looks whether it has one again: the hub may have been that of the
site which ran a task, and components let go of that after a second."""
ADOPTED = 3.0
"""Seconds after a site has come or gone in which a task that none runs is about to be run by the next: what it held
then counts as held, or another task, which has lost something, would take it just before."""


def keeper_of(task: str, sites: Iterable[str]) -> str:
    """The site that is to run a task; empty if there is none."""
    return max(sites, key=lambda site: (hashlib.blake2s(f"{site} {task}".encode()).digest(), site), default="")


def _task_runner() -> type[TaskRunner]:
    """The class that runs a task: loaded with the first task that is read, as there is no time when one is adopted."""
    from selfconf.deployment.runner import TaskRunner

    return TaskRunner


@dataclass(slots=True)
class _RunHere:
    """A task that a site runs."""

    runner: TaskRunner
    version: tuple[bool, int, int]
    """The version of the record with which it was begun, or that was written of it last."""
    has_run: bool = False
    """Whether it was in a configuration, or waited for one, since it was begun here."""


class Keeper:
    """Keeps the tasks of an ecology at one site, and runs those that it is to run."""

    def __init__(
        self,
        bus: Bus,
        ecology: str,
        site: str,
        folder: TaskFolder,
        request_for: Callable[[TaskRecord], RunRequest],
        clock: Callable[[], float] = time.time,
    ) -> None:
        """`request_for` reads a task; it raises SelfconfError for one that cannot be read. `clock` is the site's."""
        self.bus, self.ecology, self.site, self.folder, self._clock = bus, ecology, site, folder, clock
        keys = Keys(ecology)
        self._requests = TaskRequests(bus, request_for)
        self._run_here: dict[str, _RunHere] = {}
        """The tasks that this site runs, by their identity."""
        self._beginning: dict[str, str] = {}
        """The site that has begun each task last, as it has said."""
        self._living: dict[str, set[str]] = {site: {""}}
        self._changed = bus.now()
        """When a site has come or gone."""
        self._view = StableView(bus.now, lambda: bus.link)
        self._look_again = Timer(bus, KEEPER_LOOK, self._look)
        self._assign_later = Timer(bus, LINKED_AGAIN, self._assign)
        """Looks again once what it sees of the other sites is to be believed, to run a task."""
        self._exchange = RecordExchange(bus, keys, site, folder, self)
        bus.watch(keys.any_site_life(), self._site_changed)
        bus.subscribe(keys.reopens(), lambda _: self._view.reopens(), Urgency.EVENT)

    @property
    def runners(self) -> dict[str, TaskRunner]:
        """What runs each task that this site runs, by the identity of the task."""
        return {task: one.runner for task, one in self._run_here.items()}

    def close(self) -> None:
        """Leave the tasks as they run to whichever site is next."""
        for runner in self.runners.values():
            runner.hand_over()

    # What the exchange of records has to tell, and asks.

    def learnt(self, record: TaskRecord) -> None:
        """Have the task of a record run, if this is the site to do so."""
        if record.ended:
            self._beginning.pop(record.task, None)
        self._requests.insist(record.task)
        self._read(record)
        self.bus.wake_up(self._assign)
        self._look_later()

    def caught_up(self) -> None:
        """Look at all tasks from now on: this site knows what the others keep."""
        self._look()

    def begins(self, task: str, site: str) -> None:
        """Leave a task to another site that begins to run it, if that is the one to do so."""
        if not self.folder.records[task].ended:
            self._beginning[task] = site
        if self.runs(task):
            self._assign()

    def runs(self, task: str) -> bool:
        """Whether this site runs a task."""
        return task in self._run_here

    def others(self) -> Collection[str]:
        """The other sites that live."""
        return self._living.keys() - {self.site}

    def _read(self, record: TaskRecord) -> None:
        self._requests.read(record)
        if self._requests.of(record.task) is not None:
            _task_runner()

    # Which site runs what.

    def _site_changed(self, key: str, alive: bool) -> None:
        site, lives = owner_of(key), self._living
        if site == self.site:
            return
        self._changed = self.bus.now()
        self._view.changes(site, alive)
        if alive:
            lives.setdefault(site, set()).add(key)
            self._exchange.ask_newcomer(site)
        elif site in lives:
            lives[site].discard(key)
            if not lives[site]:
                del lives[site]
                for task in self.folder.records:  # it may have been that one which went on with it
                    self._requests.insist(task)
                self._beginning = {task: keeper for task, keeper in self._beginning.items() if keeper != site}
        self._assign()

    def _look(self) -> None:
        """Look from time to time, as what was to be handed over may be free by now."""
        self._look_again.stop()
        for record in list(self.folder.records.values()):
            self._read(record)
        self._assign()
        self._look_later()

    def _look_later(self) -> None:
        """Look again in a while; not where there is no task: most sites keep none, and sleep."""
        if self.folder.records:
            self._look_again.set()

    def _assign(self) -> None:
        """Run the tasks that this site is to run; another's only until that begins to run it.

        Cut off it begins with none: to it all other sites seem gone, and it would find that nothing is there.
        """
        linked = bool(self.bus.link)
        for task, record in list(self.folder.records.items()):
            keeper, mine = keeper_of(task, self._living), self._run_here.get(task)
            if mine is not None and record.ended:
                mine.runner.stop()
            elif mine is not None:
                self._leave_what_is_anothers(mine, record, keeper)
            request = self._requests.of(task) if keeper == self.site and not record.ended else None
            if request is not None and not self.runs(task):
                if wait := self._view.unrest() if linked else LINKED_AGAIN:
                    self._assign_later.set(wait)
                else:
                    self._run(record, request)

    def _leave_what_is_anothers(self, mine: _RunHere, record: TaskRecord, keeper: str) -> None:
        """Let go of a task that another site has gone on with, or that the one that is to run it has begun to run.

        To that one it is handed over: it may have found before that the components did not listen to it yet.
        """
        if record.version != mine.version:
            self._hand_over(record.task)
        elif keeper != self.site and mine.runner.state.phase in (Phase.RUNNING, Phase.REFUSED):
            if self._beginning.get(record.task) == keeper:
                self._hand_over(record.task)
                self._exchange.hand_to(keeper, record.task)
            else:
                self._exchange.ask_later((keeper,))  # it may have said so when this site did not hear it

    def _hand_over(self, task: str) -> None:
        self._run_here.pop(task).runner.hand_over()

    def _without_configurator(self, known: Set[str]) -> list[Holding]:
        """What each task holds that is to be run, by its record, while it may be without a configurator.

        Of those that are known to have one nothing is read, or the time to go on would grow with their square.
        """
        found: list[Holding] = []
        if self.bus.now() - self._changed > ADOPTED:
            return found
        for record in self.folder.records.values():
            if record.task in known or record.ended or not record.configuration or not self._requests.of(record.task):
                continue
            try:
                configuration = recorded_configuration(record.configuration)
            except PeerError:
                continue  # it begins anew
            holder = Holder(record.task, record.priority, record.beginning)
            found.append(Holding(holder, {one: configuration.wants(one) for one in configuration.components}))
        return found

    def _run(self, record: TaskRecord, request: RunRequest) -> None:
        def ended(_: object) -> None:
            mine, again = self._run_here.pop(record.task, None), KEEPER_AGAIN
            if mine is not None and mine.runner.trouble is not None:
                self._requests.leave_alone(record.task, f"{record.task}: {mine.runner.trouble}")
            elif mine is not None and not mine.has_run:
                again = self._requests.give_way(record.task)
            self.bus.later(again, self._assign)

        runner = _task_runner()(
            self.bus,
            self.ecology,
            replace(
                request,
                report=lambda event: self._report(record.task, event),
                ended=ended,
                without_configurator=lambda known: self._without_configurator({record.task, *known}),
            ),
            clock=self._clock,
            task=record.task,
            beginning=record.beginning,
        )
        self._run_here[record.task] = _RunHere(runner, record.version)
        self._exchange.tell(replace(record, keeper=self.site))
        if record.configuration:
            try:
                runner.adopt(recorded_configuration(record.configuration), record.epoch, record.lost)
                return
            except PeerError as error:
                log.error("the task %s begins anew, as its configuration is not to be read: %s", record.task, error)
        runner.start(record.lost)

    def _report(self, task: str, event: RunEvent) -> None:
        """Let every site know what runs, and what was lost, so that the next one can go on with it.

        Of a task that waits nothing runs: the next one begins anew, as it would let act what is not held any more.
        """
        log.info("%s: %s", task, event.act)
        known, mine = self.folder.records.get(task), self._run_here.get(task)
        if known is None or mine is None or mine.version != known.version:  # it has ended, or is another site's by now
            return
        record = replace(known, lost=mine.runner.recorded_losses)
        if isinstance(event, (TaskRunning, TaskWaiting)):
            mine.has_run = True
        if isinstance(event, TaskRunning):
            record = replace(record, epoch=event.epoch, configuration=configuration_record(event.configuration))
        elif isinstance(event, TaskWaiting):
            record = replace(record, configuration={})
        if isinstance(event, TaskRunning) or record != known:
            record = replace(record, revision=known.revision + 1)
            mine.version = record.version
            self._exchange.learn(record)
            self._exchange.tell(record)

"""Tasks that live in the sites: every site keeps all of them, and one living site runs each.

Which one is the same for all who see the same sites: the site whose name gives the highest hash with the task's
identity (rendezvous hashing, Thaler and Ravishankar 1998). When it goes, the next one goes on with what runs: no
component is stopped or started, each only hears whose life to watch from now on. When a site comes that is to have a
task, the one that has it goes on until the other says that it begins to run it, for until then none would watch over
the components. In the middle of a deployment it does not let go: the other would go on with what ran before, as it
knows of nothing else. The components do not listen to the other until then, and it tries again.

A site that was frozen, or cut off, finds by a newer record that another one has gone on with its task meanwhile. It
leaves that as it runs, and goes on with it in turn: what it knows itself is outdated, and the components would come to
rest before it has asked all of them. One that could hear the others, but was not heard when it asked them, learns what
is newer all the same: a site that hears an outdated record puts the newer one.
"""

from __future__ import annotations

import hashlib
import logging
import time
from collections.abc import Callable, Iterable, Set
from functools import partial
from typing import TYPE_CHECKING

from selfconf.bus.port import Bus, Replies, Request, Sample, Undo, Urgency
from selfconf.configurator import Phase
from selfconf.deployment.configuration_record import configuration_record, recorded_configuration
from selfconf.deployment.holders import Holding
from selfconf.deployment.stable_view import StableView
from selfconf.deployment.task_folder import TaskFolder
from selfconf.errors import PeerError, SelfconfError, reason
from selfconf.model.holder import Holder
from selfconf.model.immutable import replace
from selfconf.model.run_event import RunEvent, TaskRunning
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import Keys, owner_of
from selfconf.protocol.messages import TaskRecord

if TYPE_CHECKING:
    from selfconf.deployment.run_request import RunRequest
    from selfconf.deployment.runner import TaskRunner

log = logging.getLogger(__name__)

KEEPER_LOOK = 1.0
"""Seconds between two looks at which tasks this site is to run."""
KEEPER_AGAIN = 0.3
"""Seconds after which a task that has been left to another configurator is looked at again: that may be about to leave
it to this site, and components let go of a task that no site runs after a second."""
OTHERS = 2.0
"""Seconds that the other sites may take to say what they keep."""
ASKED_AT_ONCE = 10
"""How many sites that have come are asked at once what they keep. Where more come together, as fifty do after a common
stall, the others wait for the next looks, or each would ask each while all have enough to do."""
ADOPTED = 3.0
"""Seconds after a site has come or gone in which a task that none runs is about to be run by the next: what it held
then counts as held, or another task, which has lost something, would take it just before."""
RESPITE = 60.0
"""Seconds after which a task is tried again that could not be read for want of room, or whose search broke."""
MOST_REJECTIONS = 100
"""How many different things are said of the records of other sites; a site that sends nonsense fills no disk."""


def keeper_of(task: str, sites: Iterable[str]) -> str:
    """The site that is to run a task; empty if there is none."""
    return max(sites, key=lambda site: (hashlib.blake2s(f"{site} {task}".encode()).digest(), site), default="")


def _task_runner() -> type[TaskRunner]:
    """The class that runs a task: loaded with the first task that is read, as there is no time when one is adopted."""
    from selfconf.deployment.runner import TaskRunner

    return TaskRunner


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
        self.bus, self.ecology, self.keys, self.site = bus, ecology, Keys(ecology), site
        self.folder, self._request_for, self._clock = folder, request_for, clock
        self.runners: dict[str, TaskRunner] = {}
        self._versions: dict[str, tuple[bool, int, int]] = {}
        """The version of the record that each runner has begun with, or that was written of it last."""
        self._requests: dict[str, RunRequest | None] = {}
        self._respites: dict[str, float] = {}
        """Until when each task is left alone that has given trouble."""
        self._beginning: dict[str, str] = {}
        """The site that has begun each task last, as it has said."""
        self._complaints: set[str] = set()
        self._living: dict[str, set[str]] = {site: {""}}
        self._changed = bus.now()
        """When a site has come or gone."""
        self._view = StableView(bus.now, lambda: bus.link)
        self._to_ask: dict[str, None] = {}
        """The sites that have come and were not asked once more since: they may not have been reached at first."""
        self._unlook: Undo | None = None
        """Takes back that it will look again; None where it will not."""
        self._is_to_assign = False
        """Whether it waits for what it sees of the other sites to be believed, to run a task."""
        bus.serve(self.keys.keep(site), self._keep)
        bus.serve(self.keys.kept_tasks(site), self._answer)
        bus.subscribe(self.keys.task(), self._take, Urgency.EVENT)
        bus.watch(self.keys.any_site_life(), self._site_changed)
        bus.ask(self.keys.kept_tasks(), b"", OTHERS, self._all_answered)

    def close(self) -> None:
        """Leave the tasks as they run to whichever site is next."""
        for runner in list(self.runners.values()):
            runner.hand_over()

    # What is kept.

    def _keep(self, request: Request) -> None:
        """A task is handed over, or its end is asked for."""
        try:
            record = decode(request.payload, TaskRecord)
            self._learn(record)
            request.reply(self.keys.keep(self.site), encode(self.folder.records[record.task]))
            self.bus.wake_up(self._assign)
        except PeerError as error:
            request.refuse(f"site {self.site} cannot keep the task: {error}")
        except OSError as error:
            why = f"site {self.site} cannot keep the task on its disk: {error.strerror}"
            request.refuse(f"{why}; mend that, or give the site another folder for its tasks")
            # Others may have room for it, and count on this one to run it; where none has, it is not to be run.
            self._to_ask |= dict.fromkeys(self._living.keys() - {self.site})
            self._look_later()
        finally:
            request.finish()

    def _answer(self, request: Request) -> None:
        try:
            for task, record in self.folder.records.items():
                runs = task in self.runners
                payload = encode(replace(record, keeper=self.site)) if runs else self.folder.encoded(task)
                request.reply(self.keys.kept_task(self.site, task), payload)
        finally:
            request.finish()

    def _all_answered(self, replies: Replies) -> None:
        self._take_all(replies)
        self._look()

    def _take_all(self, replies: Replies) -> None:
        for sample in replies.samples:
            self._take(sample)

    def _ask_again(self) -> None:
        """Ask those that have come once more, and have one that does not answer asked at another look."""
        for site in list(self._to_ask)[:ASKED_AT_ONCE]:
            del self._to_ask[site]
            self.bus.ask(self.keys.kept_tasks(site), b"", OTHERS, partial(self._asked_again, site))

    def _asked_again(self, site: str, replies: Replies) -> None:
        self._take_all(replies)
        if not replies.complete and site in self._living:
            self._to_ask[site] = None
            self._look_later()

    def _take(self, sample: Sample) -> None:
        task = sample.key.rpartition("/")[2]
        if task in self.folder.records and sample.payload == self.folder.encoded(task):
            return
        try:
            heard = decode(sample.payload, TaskRecord)
            record = replace(heard, keeper="")
            self._learn_of_another(record)
            newest = self.folder.records[record.task]
            if newest.supersedes(record):
                self._tell(newest)
            elif heard.keeper:
                self._beginning[heard.task] = heard.keeper
                if heard.task in self.runners:
                    self._assign()
        except PeerError as error:
            self._complain(f"this site does not keep the task that another one has sent on {sample.key}: {error}")
        except OSError as error:
            wrong = f"a task that came on {sample.key} is lost with this site, which cannot write it: {reason(error)}"
            self._complain(wrong)

    def _complain(self, trouble: str) -> None:
        """Log what people should see, once: the other sites send what they keep again and again."""
        if trouble not in self._complaints and len(self._complaints) < MOST_REJECTIONS:
            self._complaints.add(trouble)
            log.error("%s", trouble)

    def _learn_of_another(self, record: TaskRecord) -> None:
        """Learn a record that another site has, and so is to be run though it cannot be written here."""
        try:
            self._learn(record)
        except OSError:
            self.folder.hold(record)
            self._learnt(record)
            raise

    def _learn(self, record: TaskRecord) -> None:
        if self.folder.learn(record):
            self._learnt(record)

    def _learnt(self, record: TaskRecord) -> None:
        """A record is new: have its task run, if this is the site to do so."""
        self._read(record)
        self.bus.wake_up(self._assign)
        self._look_later()

    def _read(self, record: TaskRecord) -> None:
        """Read a task in advance, so that going on with it takes no time; one that cannot be read is never run."""
        if record.ended:
            self._requests.pop(record.task, None)
            self._respites.pop(record.task, None)
            self._beginning.pop(record.task, None)
            return
        if record.task in self._requests or self._has_respite(record.task):
            return
        self._requests[record.task] = None
        try:
            request = self._request_for(record)
        except SelfconfError as error:
            log.error("the task %s cannot be run: %s", record.task, error)
        except OSError as error:
            log.error("the task %s cannot be read now: %s; trying again in %.0f s", record.task, error, RESPITE)
            del self._requests[record.task]
            self._respites[record.task] = self.bus.now() + RESPITE
        else:
            _task_runner()
            self._requests[record.task] = replace(request, report=lambda event: self._report(record.task, event))

    # Which site runs what.

    def _site_changed(self, key: str, alive: bool) -> None:
        site, lives = owner_of(key), self._living
        if site == self.site:
            return
        self._changed = self.bus.now()
        self._view.changes(site, alive)
        if alive:
            lives.setdefault(site, set()).add(key)
            # When this site began it may have been cut off from that one, and no other site says what that one keeps.
            self._to_ask[site] = None
            self._look_later()
            if len(self._to_ask) <= ASKED_AT_ONCE:
                self.bus.ask(self.keys.kept_tasks(site), b"", OTHERS, self._take_all)
        elif site in lives:
            lives[site].discard(key)
            if not lives[site]:
                del lives[site]
                self._beginning = {task: keeper for task, keeper in self._beginning.items() if keeper != site}
        self._assign()

    def _look(self) -> None:
        """Look from time to time, as what was to be handed over may be free by now."""
        if self._unlook is not None:
            self._unlook()
            self._unlook = None
        for record in list(self.folder.records.values()):
            self._read(record)
        self._ask_again()
        self._assign()
        self._look_later()

    def _look_later(self) -> None:
        """Look again in a while; not where there is no task, nor a site to ask: most sites keep none, and sleep."""
        if self._unlook is None and (self.folder.records or self._to_ask):
            self._unlook = self.bus.later(KEEPER_LOOK, self._look)

    def _assign(self) -> None:
        """Run the tasks that this site is to run; another's only until that begins to run it.

        Cut off it begins with none: to it all other sites seem gone, and it would find that nothing is there.
        """
        linked = bool(self.bus.link)
        for task, record in list(self.folder.records.items()):
            keeper, runner = keeper_of(task, self._living), self.runners.get(task)
            if runner is not None and record.ended:
                runner.stop()
            elif runner is not None:
                self._leave_what_is_anothers(runner, record, keeper)
            mine = keeper == self.site
            if task not in self.runners and mine and linked and not record.ended and not self._has_respite(task):
                if unrest := self._view.unrest():
                    self._assign_later(unrest)
                else:
                    self._run(record)

    def _assign_later(self, seconds: float) -> None:
        def assign() -> None:
            self._is_to_assign = False
            self._assign()

        if not self._is_to_assign:
            self._is_to_assign = True
            self.bus.later(seconds, assign)

    def _leave_what_is_anothers(self, runner: TaskRunner, record: TaskRecord, keeper: str) -> None:
        """Let go of a task that another site has gone on with, or that the one that is to run it has begun to run.

        To that one it is handed over: it may have found before that the components did not listen to it yet.
        """
        if record.version != self._versions[record.task]:
            runner.hand_over()
        elif keeper != self.site and runner.state.phase in (Phase.RUNNING, Phase.REFUSED):
            if self._beginning.get(record.task) == keeper:
                runner.hand_over()
                self.bus.ask(self.keys.keep(keeper), self.folder.encoded(record.task), OTHERS, lambda _: None)
            else:
                self._to_ask[keeper] = None  # it may have said so when this site did not hear it

    def _without_configurator(self, known: Set[str]) -> list[Holding]:
        """What each task holds that is to be run, by its record, while it may be without a configurator.

        Of those that are known to have one nothing is read, or the time to go on would grow with their square.
        """
        found: list[Holding] = []
        if self.bus.now() - self._changed > ADOPTED:
            return found
        for record in self.folder.records.values():
            if record.task in known or record.ended or not record.configuration or not self._requests.get(record.task):
                continue
            try:
                configuration = recorded_configuration(record.configuration)
            except PeerError:
                continue  # it begins anew
            holder = Holder(record.task, record.priority, record.beginning)
            found.append(Holding(holder, {one: configuration.wants(one) for one in configuration.components}))
        return found

    def _has_respite(self, task: str) -> bool:
        return self._respites.get(task, 0.0) > self.bus.now()

    def _run(self, record: TaskRecord) -> None:
        request = self._requests.get(record.task)
        if request is None:
            return

        def ended(_: object) -> None:
            runner = self.runners.pop(record.task, None)
            self._versions.pop(record.task, None)
            self.bus.later(KEEPER_AGAIN, self._assign)
            if runner is not None and runner.trouble is not None:
                log.error("%s: %s; trying again in %.0f s", record.task, runner.trouble, RESPITE)
                self._respites[record.task] = self.bus.now() + RESPITE

        runner = _task_runner()(
            self.bus,
            self.ecology,
            replace(
                request,
                ended=ended,
                without_configurator=lambda known: self._without_configurator({record.task, *known}),
            ),
            clock=self._clock,
            task=record.task,
            beginning=record.beginning,
        )
        self.runners[record.task], self._versions[record.task] = runner, record.version
        self._tell(replace(record, keeper=self.site))
        if record.configuration:
            try:
                runner.adopt(recorded_configuration(record.configuration), record.epoch, record.lost)
                return
            except PeerError as error:
                log.error("the task %s begins anew, as its configuration is not to be read: %s", record.task, error)
        runner.start()

    def _report(self, task: str, event: RunEvent) -> None:
        """Let every site know what runs, and what was lost, so that the next one can go on with it."""
        log.info("%s: %s", task, event.act)
        known = self.folder.records.get(task)  # none if it has ended, and was forgotten meanwhile
        if known is None or self._versions.get(task) != known.version:
            return
        record = replace(known, lost=self.runners[task].recorded_losses)
        if isinstance(event, TaskRunning):
            record = replace(record, epoch=event.epoch, configuration=configuration_record(event.configuration))
        if isinstance(event, TaskRunning) or record.lost != known.lost:
            record = replace(record, revision=known.revision + 1)
            self._versions[task] = record.version
            self._learn(record)
            self._tell(record)

    def _tell(self, record: TaskRecord) -> None:
        """Have every site that hears this one learn a record."""
        notice = self.bus.publisher(self.keys.task(record.task), Urgency.EVENT)
        notice.put(encode(record))
        notice.undeclare()

"""The records of tasks that the sites of an ecology keep, and what a site and the others tell each other of them.

The keeper of a site hears of each record that is new there. Sites that come are asked what they keep, and once more:
they may not have been reached at first. One that could hear the others, but was not heard when it asked them, learns
what is newer all the same: a site that hears an outdated record puts the newer one.
"""

from __future__ import annotations

import logging
from collections.abc import Collection
from functools import partial
from typing import Protocol

from selfconf.bus.answers import answering
from selfconf.bus.port import Bus, Replies, Request, Sample, Urgency
from selfconf.bus.timer import Timer
from selfconf.deployment.task_folder import TaskFolder
from selfconf.errors import PeerError, reason
from selfconf.model.immutable import replace
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import TaskRecord

log = logging.getLogger(__name__)

OTHERS = 2.0
"""Seconds that the other sites may take to say what they keep."""
ASK_ONCE_MORE = 1.0
"""Seconds after which sites that have come are asked once more what they keep."""
ASKED_AT_ONCE = 10
"""How many sites that have come are asked at once what they keep. Where more come together, as fifty do after a common
stall, the others wait for the next time, or each would ask each while all have enough to do."""
MOST_REJECTIONS = 100
"""How many different things are said of the records of other sites; a site that sends nonsense fills no disk."""


class RecordKeeper(Protocol):
    """What the records are kept for."""

    def learnt(self, record: TaskRecord) -> None:
        """Take in a record that is new to this site, or that was handed to it."""
        ...

    def caught_up(self) -> None:
        """Take in that the other sites have said what they keep, or had time to, since this one began."""
        ...

    def begins(self, task: str, site: str) -> None:
        """Take in that another site begins to run a task."""
        ...

    def runs(self, task: str) -> bool:
        """Whether this site runs a task."""
        ...

    def others(self) -> Collection[str]:
        """The other sites that live."""
        ...


class RecordExchange:
    """Exchanges the records of tasks between one site and the others."""

    def __init__(self, bus: Bus, keys: Keys, site: str, folder: TaskFolder, keeper: RecordKeeper) -> None:
        self._bus, self._keys, self._site, self._folder, self._keeper = bus, keys, site, folder, keeper
        self._complaints: set[str] = set()
        self._to_ask: dict[str, None] = {}
        """The sites that have come and were not asked once more since."""
        self._ask_soon = Timer(bus, ASK_ONCE_MORE, self._ask_again)
        bus.serve(keys.keep(site), self._keep)
        bus.serve(keys.kept_tasks(site), self._answer)
        bus.subscribe(keys.task(), self._take, Urgency.EVENT)
        bus.ask(keys.kept_tasks(), b"", OTHERS, self._all_answered)

    def tell(self, record: TaskRecord) -> None:
        """Have every site that hears this one learn a record."""
        notice = self._bus.publisher(self._keys.task(record.task), Urgency.EVENT)
        notice.put(encode(record))
        notice.undeclare()

    def hand_to(self, site: str, task: str) -> None:
        """Hand a task to another site, which is to run it."""
        self._bus.ask(self._keys.keep(site), self._folder.encoded(task), OTHERS, lambda _: None)

    def learn(self, record: TaskRecord) -> None:
        """Keep a record if it is new. Raises PeerError and OSError as `TaskFolder.learn` does."""
        if self._folder.learn(record):
            self._keeper.learnt(record)

    def ask_newcomer(self, site: str) -> None:
        """Ask a site that has come, at once unless very many have, and once more.

        When this site began it may have been cut off from that one, and no other site says what that one keeps.
        """
        self.ask_later((site,))
        if len(self._to_ask) <= ASKED_AT_ONCE:
            self._bus.ask(self._keys.kept_tasks(site), b"", OTHERS, self._take_all)

    def ask_later(self, sites: Collection[str]) -> None:
        """Ask some sites in a moment, and again as long as one lives and does not answer."""
        self._to_ask |= dict.fromkeys(sites)
        if self._to_ask:
            self._ask_soon.set()

    def _ask_again(self) -> None:
        for site in list(self._to_ask)[:ASKED_AT_ONCE]:
            del self._to_ask[site]
            self._bus.ask(self._keys.kept_tasks(site), b"", OTHERS, partial(self._asked_again, site))
        self.ask_later(())

    def _asked_again(self, site: str, replies: Replies) -> None:
        self._take_all(replies)
        if not replies.complete and site in self._keeper.others():
            self.ask_later((site,))

    def _keep(self, request: Request) -> None:
        """A task is handed over, or its end is asked for."""
        with answering(request):
            try:
                record = decode(request.payload, TaskRecord)
                self._folder.learn(record)
                kept = self._folder.records[record.task]
                request.reply(self._keys.keep(self._site), encode(kept))
                self._keeper.learnt(kept)
            except PeerError as error:
                raise PeerError(f"site {self._site} cannot keep the task: {error}") from None
            except OSError as error:
                # Others may have room for it, and count on this one to run it; where none has, it is not to be run.
                self.ask_later(self._keeper.others())
                why = f"site {self._site} cannot keep the task on its disk: {error.strerror}"
                raise PeerError(f"{why}; mend that, or give the site another folder for its tasks") from None

    def _answer(self, request: Request) -> None:
        with answering(request):
            for task, record in self._folder.records.items():
                runs = self._keeper.runs(task)
                payload = encode(replace(record, keeper=self._site)) if runs else self._folder.encoded(task)
                request.reply(self._keys.kept_task(self._site, task), payload)

    def _all_answered(self, replies: Replies) -> None:
        self._take_all(replies)
        self._keeper.caught_up()

    def _take_all(self, replies: Replies) -> None:
        for sample in replies.samples:
            self._take(sample)

    def _take(self, sample: Sample) -> None:
        task = sample.key.rpartition("/")[2]
        if task in self._folder.records and sample.payload == self._folder.encoded(task):
            return
        try:
            heard = decode(sample.payload, TaskRecord)
            record = replace(heard, keeper="")
            self._learn_of_another(record)
            newest = self._folder.records[record.task]
            if newest.supersedes(record):
                self.tell(newest)
            elif heard.keeper:
                self._keeper.begins(heard.task, heard.keeper)
        except PeerError as error:
            self._complain(f"this site does not keep the task that another one has sent on {sample.key}: {error}")
        except OSError as error:
            wrong = f"a task that came on {sample.key} is lost with this site, which cannot write it: {reason(error)}"
            self._complain(wrong)

    def _learn_of_another(self, record: TaskRecord) -> None:
        """Learn a record that another site has, and so is to be run though it cannot be written here."""
        try:
            self.learn(record)
        except OSError:
            self._folder.hold(record)
            self._keeper.learnt(record)
            raise

    def _complain(self, trouble: str) -> None:
        """Log what people should see, once: the other sites send what they keep again and again."""
        if trouble not in self._complaints and len(self._complaints) < MOST_REJECTIONS:
            self._complaints.add(trouble)
            log.error("%s", trouble)

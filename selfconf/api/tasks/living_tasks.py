"""The tasks of a living ecology: those that configurators run, and those that its sites keep."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence, Set
from contextlib import suppress
from itertools import chain, count

from selfconf.api.synchronous_bus import SynchronousBus
from selfconf.api.tasks.last_words import LastWords
from selfconf.api.tasks.living_task import LivingTask, RunningTasks, SilentHolder
from selfconf.api.tasks.meant_tasks import MeantTasks, raise_for, said_of_silent
from selfconf.api.tasks.released_components import ReleasedComponents
from selfconf.bus.answers import own_answers
from selfconf.bus.port import Replies
from selfconf.discovery import namesakes
from selfconf.errors import NetworkError, PeerError
from selfconf.model.immutable import replace
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import Keys, owner_of, task_name
from selfconf.protocol.messages import Status, TaskRecord
from selfconf.render import disobedience
from selfconf.this_machine import ClaimedName, claim, local_sites, suspended_tasks

UNNUMBERED = 56
"""How many characters of a task's name stand before a number; with that they are 64 at most."""


class LivingTasks:
    """Lists the tasks of an ecology, hands it others, and takes them down."""

    def __init__(self, bus: SynchronousBus, keys: Keys, endpoints: Sequence[str]) -> None:
        """The bus has joined by some endpoints; runs of this machine that have joined by others are not looked at."""
        self._bus, self._keys, self._endpoints = bus, keys, endpoints
        self._released = ReleasedComponents(bus, keys)
        self.statuses: Replies | None = None
        """What configurators have answered when a name was last looked for in the ecology, if it was."""

    def running(self, by_components: bool = False) -> RunningTasks:
        """What the configurators of the ecology say of the tasks that they run.

        A configurator that is suspended is not seen to live any more before the components that it holds are at rest:
        `by_components`, these are asked as well by which configurator each of them is held. A program of this machine
        that is suspended is seen for as long as it is.
        """
        living = {owner_of(key) for key in self._bus.living(self._keys.any_configurator_life())}
        found, rejected = _statuses(self._bus.ask(self._keys.configurator_call("*", "status")), self._keys)
        answered = {status.configurator for status in found}
        holding = self._holding_beside(answered) if by_components else ()
        holders = {one.configurator for one in holding}
        rejected += map(said_of_silent, sorted(living - answered - holders))
        rejected += map(str, holding)
        named = {status.name for status in found if status.outside is None}
        named.update(task_name(one.task) for one in holding)
        suspended = [one for one in suspended_tasks(self._keys.ecology, self._endpoints) if one.name not in named]
        rejected += (one.suspension() for one in suspended)
        sites = self._bus.living(self._keys.any_site_life())
        return RunningTasks(
            statuses=tuple(sorted(found, key=lambda status: status.configurator)),
            silent=tuple(sorted((living - answered) | holders)),
            holding=holding,
            suspended=tuple(suspended),
            sites=frozenset(map(owner_of, sites)),
            complaints=(*rejected, *namesakes(sites)),
        )

    def _holding_beside(self, known: Set[str]) -> tuple[SilentHolder, ...]:
        """What components are held by configurators that are not among some, sorted by the configurator's name."""
        found: dict[tuple[str, str], list[IRI]] = {}
        for one in self._released.states():
            with suppress(PeerError):
                if one.supervisor and (configurator := owner_of(one.supervisor)) not in known:
                    found.setdefault((configurator, one.task), []).append(one.component)
        return tuple(SilentHolder(*holder, tuple(sorted(components))) for holder, components in sorted(found.items()))

    def kept(self, name: str | None = None) -> list[TaskRecord]:
        """The tasks that live in the sites, each by its newest record."""
        return [one for one in self._records() if name in (None, task_name(one.task)) and not one.ended]

    def _records(self) -> list[TaskRecord]:
        """The newest record of each task that lives in the sites, or has ended there."""
        return _newest(self._bus.ask(self._keys.kept_tasks()))

    def all(self, running: RunningTasks) -> tuple[LivingTask, ...]:
        """The tasks that run, as `running` has found them, and those that live in the sites, sorted by name.

        While one site takes over from another, both may say that they run a task: the later phase counts.
        """
        records = {record.task: record for record in self._records()}  # one that has ended may still be coming to rest
        by_beginning = sorted(running.statuses, key=lambda status: status.since)
        runs = {status.task or status.configurator: status for status in by_beginning}
        found = [LivingTask.of(status, status.task in records) for status in runs.values()]
        found += [LivingTask.kept(one) for task, one in records.items() if not (one.ended or task in runs)]
        return tuple(sorted(found, key=lambda task: (task.name, task.beginning)))

    def claim(self, wanted: str, numbered: bool = False) -> ClaimedName:
        """Claim a name for a task: the wanted one, or with `numbered` that with the first number from 2 on: `patrol-2`.

        No task of the ecology has it, and none of this machine begins under it in the same moment. Raises NetworkError
        if that cannot be.
        """
        running, kept = self._ask_for_names()
        taken = {status.name for status in running} | kept
        further = (f"{wanted[:UNNUMBERED]}-{number}" for number in count(2)) if numbered else ()
        for name in chain([wanted], further):
            claimed = None if name in taken else self._claimed_here(name)
            if claimed is not None:
                return claimed
        raise _taken(wanted)

    def claim_here(self, wanted: str) -> ClaimedName:
        """Claim a name for a task among those of this machine; `check_alone` then looks for it in the whole ecology.

        Raises NetworkError if it is taken.
        """
        claimed = self._claimed_here(wanted)
        if claimed is None:
            raise _taken(wanted)
        return claimed

    def check_alone(self, task: str, beginning: float) -> None:
        """Raise NetworkError if another task has the name of this one, or has begun with it in the same moment.

        Of two that see each other before they run, the one that goes on is the same for both.
        """
        from selfconf.configurator import Phase  # here: a program that only looks on runs nothing

        running, kept = self._ask_for_names()
        if task_name(task) in kept:
            raise _taken(task_name(task))
        for other in running:
            before = other.phase != Phase.IDLE.value or (other.beginning, other.task) < (beginning, task)
            if other.outside is None and other.name == task_name(task) and other.task != task and before:
                raise _taken(other.name)

    def _ask_for_names(self) -> tuple[list[Status], set[str]]:
        """What the configurators say of their tasks, and the names of the tasks that live in the sites."""
        questions = [(self._keys.configurator_call("*", "status"), b""), (self._keys.kept_tasks(), b"")]
        self.statuses, kept = self._bus.ask_each(questions)
        names = {task_name(record.task) for record in _newest(kept) if not record.ended}
        return _statuses(self.statuses, self._keys)[0], names

    def _claimed_here(self, name: str) -> ClaimedName | None:
        return claim(self._keys.ecology, name, self._endpoints)

    def detach(self, record: TaskRecord) -> str:
        """Hand a task to the sites; returns its name. Raises NetworkError if none keeps it, or if its name is taken."""
        with self.claim(task_name(record.task)) as claimed:
            try:
                self._keep(record)
            except NetworkError:
                with suppress(NetworkError):  # a site may have taken it whose answer was lost
                    self._end_record(record)
                raise
            self._settle(record)
            return claimed.name

    def _settle(self, record: TaskRecord) -> None:
        """Have one go on of the tasks of a name that were handed over in the same moment, on several hosts.

        The last to look sees all. Raises NetworkError if it is another one than that of the record.
        """
        same = [one for one in self.kept(task_name(record.task)) if one.task != record.task]
        first = min([record, *same], key=lambda one: (one.beginning, one.task))
        for other in same if first is record else [record]:
            self._end_record(other)
        if first is not record:
            raise _taken(task_name(record.task))

    def stop(self, name: str | None = None) -> tuple[tuple[str, ...], RunningTasks]:
        """Take down a task, given by its name or that of its configurator, or all of them.

        Returns the names of the tasks, and what ran before, with the complaints that remain. The inside of a composite,
        which has the name of the composite, is meant only where no other task has that name; then the composite fails.
        Raises NetworkError if there is none of that name, or if several insides alone have it, or if one does not
        answer or does not end in time, or if a component was turned off and does not obey; of all tasks those are taken
        down first that answer. One that does not answer, suspended perhaps, is an error also where what it held has
        come to rest: it may go on, unless the sites keep its task, and so the end of that.
        """
        meant = MeantTasks.of(name, self.running(by_components=True), self.kept())
        raise_for(
            [
                *self._take_down(meant.running, meant.kept, meant.found.sites),
                *self._unheard(meant),
                *(one.suspension() for one in meant.suspended),
            ]
        )
        return meant.names, meant.found_beside_holders

    def _unheard(self, meant: MeantTasks) -> Iterator[str]:
        """What is to be said of configurators that could not be asked to stop, once what they hold has come to rest.

        One that goes on learns from the sites that its task, if they have kept that, has ended.
        """
        ended, silent, holding = {record.task for record in meant.kept}, meant.silent, meant.holding
        if silent:  # one that is suspended is no longer seen to live after a while
            living = {owner_of(key) for key in self._bus.living(self._keys.any_configurator_life())}
            yield from map(said_of_silent, sorted(living & silent))
            holding += tuple(one for one in self._holding_beside(living) if one.configurator in silent)
            for gone in sorted(silent.difference(living, (one.configurator for one in holding))):
                yield f"the configurator {gone!r} did not answer and is not seen any more; if suspended, it will go on"
        for one in holding:
            if self._released.still_acting((component, one.task) for component in one.components):
                yield f"{one}; they act on"
            elif one.task not in ended:
                yield f"{one}; they have come to rest, and if it was suspended, it takes them again when it goes on"

    def _take_down(self, running: Sequence[Status], kept: Sequence[TaskRecord], sites: Set[str]) -> list[str]:
        """End tasks that run, and those that the sites keep; returns what is to be said once what they held rests."""
        here = {site.site for site in local_sites(self._keys.ecology)}
        last_words = LastWords(self._bus, self._keys, {status.configurator for status in running})
        for record in kept:
            self._end_record(record)
        for status in running:
            self._bus.ask(self._keys.configurator_call(status.configurator, "stop"))
        try:
            self._await_end({status.configurator for status in running})
            return self._disobedience(running, last_words.owed())
        except NetworkError:
            # the site of a `run` with advertisements of its own ends with it, and all that the site has started
            if sites and sites <= here and not local_sites(self._keys.ecology):
                return []
            raise

    def _disobedience(self, ended: Sequence[Status], owed: Iterable[IRI]) -> list[str]:
        """What is to be said of components that do not obey in time though their task has ended: they may act on.

        So may those that were `owed` their release at the end and do not live: they may be frozen, or cut off.
        """
        asked = {(component, status.task) for status in ended for component in (*status.components, *status.owed)}
        troubles = {component: why for (component, _), why in self._released.still_acting(asked).items()}
        unseen = (one for one in owed if one not in troubles and not self._bus.living(self._keys.lives(one)))
        troubles |= dict.fromkeys(unseen, "it is not seen any more, and may only be frozen or cut off")
        return sorted(
            f"{disobedience(component.short, why)}; it is out of control until it is gone"
            for component, why in troubles.items()
        )

    def _end_record(self, record: TaskRecord) -> None:
        self._keep(replace(record, revision=record.revision + 1, ended=True))

    def _keep(self, record: TaskRecord) -> None:
        replies = self._bus.ask(self._keys.keep(), encode(record))
        if not replies.samples:
            raise NetworkError("; ".join(replies.errors) or "no site of the ecology keeps tasks")

    def _await_end(self, names: set[str]) -> None:
        """Wait until configurators have released everything and left."""
        from selfconf.api.tasks.run import TAKING_DOWN  # here: a program that only looks on runs nothing

        deadline = self._bus.now() + TAKING_DOWN
        while names:
            names &= {owner_of(key) for key in self._bus.living(self._keys.any_configurator_life())}
            if names and self._bus.now() > deadline:
                raise NetworkError(f"{', '.join(sorted(names))} did not end after {TAKING_DOWN:.0f} s")
            self._bus.pause(0.02)


def _taken(name: str) -> NetworkError:
    return NetworkError(f"a task {name!r} lives already; give another name, or `selfconf stop {name}`")


def _statuses(replies: Replies, keys: Keys) -> tuple[list[Status], list[str]]:
    """What configurators have answered, each on its own key, and what is wrong with the answers that are left out."""
    return own_answers(replies.samples, Status, lambda one: keys.configurator_call(one.configurator, "status"))


def _newest(replies: Replies) -> list[TaskRecord]:
    """The newest record of each task that sites have kept."""
    newest: dict[str, TaskRecord] = {}
    for sample in replies.samples:
        with suppress(PeerError):
            record = decode(sample.payload, TaskRecord)
            if record.supersedes(newest.get(record.task)):
                newest[record.task] = record
    return list(newest.values())

"""Which tasks of a living ecology are meant by a name, or by none: that means all of them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import filterfalse

from selfconf.api.tasks.living_task import RunningTasks, SilentHolder
from selfconf.errors import NetworkError
from selfconf.model.immutable import immutable, replace
from selfconf.model.wording import listed
from selfconf.protocol.keys import task_name
from selfconf.protocol.messages import Status, TaskRecord
from selfconf.this_machine import LocalTask


@immutable
class MeantTasks:
    """The tasks that a name means, by what tells of them."""

    name: str | None
    found: RunningTasks
    """All that were found to run, and what was wrong with the answers."""
    running: tuple[Status, ...]
    """What their configurators say."""
    kept: tuple[TaskRecord, ...]
    """Those of them that live in the sites, each by its newest record: a site goes on with a task of which only the
    configurator has ended."""
    holding: tuple[SilentHolder, ...]
    """Those of which only what they hold tells."""
    suspended: tuple[LocalTask, ...]
    """Those of suspended programs of this machine, of which nothing else tells."""

    @classmethod
    def of(cls, name: str | None, found: RunningTasks, records: Sequence[TaskRecord]) -> MeantTasks:
        """Those of a name, that of the task or of its configurator, among what runs and what the sites keep.

        The inside of a composite, which has the name of the composite, is meant only where no other task has that name.
        Raises NetworkError if there is none of that name, or if several insides alone have it.
        """
        named = {record.task for record in records if name in (None, task_name(record.task))}
        holding = tuple(one for one in found.holding if one.is_named(name))
        suspended = tuple(one for one in found.suspended if name in (None, one.name))
        running = _running(name, found.statuses, others=bool(named or holding or suspended))
        named |= {status.task for status in running} | {holder.task for holder in holding}
        kept = tuple(record for record in records if record.task in named)
        meant = cls(name, found, running, kept, holding, suspended)
        if name is not None and not kept:
            meant._check_there()
        return meant

    def _check_there(self) -> None:
        raise_for(map(said_of_silent, sorted(self.silent)))
        if not (self.running or self.holding or self.suspended):
            raise NetworkError(f"no task or configurator {self.name!r} answers; `selfconf tasks` shows those that do")

    @property
    def silent(self) -> frozenset[str]:
        """The configurators that do not answer and may run one of them, but for those that are seen to hold something.

        Each may run what is kept and none is known to run.
        """
        silent = frozenset(self.found.silent).difference(one.configurator for one in self.found.holding)
        runs_all = {record.task for record in self.kept} <= {status.task for status in self.running}
        return silent & {self.name} if self.name is not None and runs_all else silent

    @property
    def names(self) -> tuple[str, ...]:
        """The names of those that run or live in the sites, sorted."""
        names = {status.name or status.configurator for status in self.running}
        return tuple(sorted(names.union(task_name(record.task) for record in self.kept)))

    @property
    def found_beside_holders(self) -> RunningTasks:
        """All that were found, without the complaints of what is held: for once that has come to rest for good."""
        over = set(map(str, self.holding))
        return replace(self.found, complaints=tuple(filterfalse(over.__contains__, self.found.complaints)))


def _running(name: str | None, statuses: Sequence[Status], others: bool) -> tuple[Status, ...]:
    """What runs of a name; the inside of a composite only where there are no others of that name, nor a task."""
    found = tuple(one for one in statuses if name in (None, one.configurator, one.name))
    own = tuple(one for one in found if one.outside is None or name in (None, one.configurator))
    if own or others:
        return own
    if len(found) > 1:
        named = listed(sorted(one.configurator for one in found))
        raise NetworkError(f"several composites are called {name!r}; name the configurator of one inside: {named}")
    return found


def said_of_silent(configurator: str) -> str:
    """What is said of a configurator that lives, but does not answer."""
    return f"the configurator {configurator!r} lives, but does not answer"


def raise_for(troubles: Iterable[str]) -> None:
    """Raise NetworkError if there is trouble to report."""
    said = "; ".join(troubles)
    if said:
        raise NetworkError(said)

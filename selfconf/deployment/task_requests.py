"""Tasks that a site keeps, read in advance from their records, so that going on with one takes no time."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import TYPE_CHECKING

from selfconf.bus.port import Bus
from selfconf.errors import SelfconfError
from selfconf.protocol.messages import TaskRecord

if TYPE_CHECKING:
    from selfconf.deployment.run_request import RunRequest

log = logging.getLogger(__name__)

GIVES_WAY = 0.3
"""Seconds for which a task is left at first to another configurator of it: that may be about to leave it to this site,
and components let go of a task that no site runs after a second."""
GIVES_WAY_AT_MOST = 2.4
"""Seconds for which a task is left at most to another configurator: for longer than components count on one that has
gone before they saw it, or each that is begun would find what the one before it has reserved, and so on for good."""
RESPITE = 60.0
"""Seconds after which a task is tried again that could not be read for want of room, or whose search broke."""


class TaskRequests:
    """The requests to run the tasks that one site keeps."""

    def __init__(self, bus: Bus, request_for: Callable[[TaskRecord], RunRequest]) -> None:
        """`request_for` reads a task; it raises SelfconfError for one that cannot be read, and OSError for now."""
        self._bus, self._request_for = bus, request_for
        self._requests: dict[str, RunRequest | None] = {}
        self._respites: dict[str, float] = {}
        """Until when each task is left alone that has given trouble."""
        self._given_way: dict[str, tuple[float, float]] = {}
        """For how many seconds each task was left last to another configurator of it, and until when."""

    def read(self, record: TaskRecord) -> None:
        """Read a task, unless it has ended, was read before or is left alone; one that cannot be read is never run."""
        task = record.task
        if record.ended:
            self._requests.pop(task, None)
            self._respites.pop(task, None)
            self.insist(task)
            return
        if task in self._requests or self._is_left_alone(task):
            return
        try:
            self._requests[task] = self._request_for(record)
        except SelfconfError as error:
            log.error("the task %s cannot be run: %s", task, error)
            self._requests[task] = None
        except OSError as error:
            self.leave_alone(task, f"the task {task} cannot be read now: {error}")

    def of(self, task: str) -> RunRequest | None:
        """What was read of a task; None where it cannot be run, or is left alone for a while."""
        return None if self._is_left_alone(task) else self._requests.get(task)

    def leave_alone(self, task: str, trouble: str) -> None:
        """Let a task be for a while that has given trouble, and log that."""
        log.error("%s; trying again in %.0f s", trouble, RESPITE)
        self._respites[task] = self._bus.now() + RESPITE

    def give_way(self, task: str) -> float:
        """Leave a task to another configurator of it, for longer each time, and return for how many seconds."""
        last, _ = self._given_way.get(task, (GIVES_WAY / 2, 0.0))
        seconds = min(2 * last, GIVES_WAY_AT_MOST)
        self._given_way[task] = seconds, self._bus.now() + seconds
        return seconds

    def insist(self, task: str) -> None:
        """Leave a task to no other configurator any more: that has handed it over, or may have gone."""
        self._given_way.pop(task, None)

    def _is_left_alone(self, task: str) -> bool:
        _, until = self._given_way.get(task, (0.0, 0.0))
        return max(until, self._respites.get(task, 0.0)) > self._bus.now()

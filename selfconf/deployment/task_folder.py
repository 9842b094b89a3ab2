"""The tasks that a site keeps, on its disk: one JSON file for each, so that they outlive the site and a power cut."""

from __future__ import annotations

import logging
from contextlib import suppress
from pathlib import Path

from selfconf.atomic_write import write_atomically
from selfconf.errors import PeerError
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.messages import TaskRecord

log = logging.getLogger(__name__)

MOST_RECORDS = 1000
"""How many tasks a site keeps, those that have ended included; one that comes later is refused."""


class TaskFolder:
    """A folder of task records; without one they are kept in memory only."""

    def __init__(self, folder: Path | None) -> None:
        self._folder = folder
        self.records: dict[str, TaskRecord] = {}
        """The newest record of each task, by the identity of the task."""
        self._encoded: dict[str, tuple[TaskRecord, bytes]] = {}
        for path in _kept_in(folder) if folder is not None else ():
            try:
                record = decode(path.read_bytes(), TaskRecord)
            except (OSError, PeerError) as error:
                log.error(
                    "the task in %s cannot be read, and this site does not run it: %s; mend the file, or remove it and"
                    " hand the task over again with `selfconf run --detach`",
                    path,
                    error.strerror if isinstance(error, OSError) else error,
                )
                continue
            if record.supersedes(self.records.get(record.task)):  # a person may have copied a file beside it
                self.records[record.task] = record

    def learn(self, record: TaskRecord) -> bool:
        """Keep a record, unless a newer one of the same task is kept; whether it was new.

        Raises PeerError where too many tasks are kept already, and OSError for a new task that cannot be written, which
        is not kept then.
        """
        known = self.records.get(record.task)
        if not record.supersedes(known):
            return False
        if known is None and len(self.records) >= MOST_RECORDS:
            self._forget_ended()
        if known is None and len(self.records) >= MOST_RECORDS:
            raise PeerError(f"{MOST_RECORDS} tasks are kept already; end some with `selfconf stop TASK`")
        if self._folder is not None:
            try:
                self._write(self._folder, record)
            except OSError as error:
                if known is None:
                    raise
                log.error("cannot write what has become of the task %s: %s", record.task, error.strerror)
                if record.ended:  # to be gone takes no room, and what has ended may not begin again
                    with suppress(OSError):
                        self._path(self._folder, record.task).unlink(missing_ok=True)
        self.records[record.task] = record
        return True

    def hold(self, record: TaskRecord) -> None:
        """Keep a record that cannot be written until this site ends, as another one has it on its disk."""
        self.records[record.task] = record

    def encoded(self, task: str) -> bytes:
        """The record of a task as it is sent; made once, as every site asks every other that comes for all of them."""
        record = self.records[task]
        made_of, payload = self._encoded.get(task, (None, b""))
        if made_of is not record:
            payload = encode(record)
            self._encoded[task] = record, payload
        return payload

    @staticmethod
    def _path(folder: Path, task: str) -> Path:
        return folder / f"{task}.json"

    def _write(self, folder: Path, record: TaskRecord) -> None:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        write_atomically(self._path(folder, record.task), encode(record))

    def _forget_ended(self) -> None:
        """Forget the older half of the tasks that have ended: only a site that was away for long may not know it."""
        ended = sorted((one for one in self.records.values() if one.ended), key=lambda one: one.beginning)
        for record in ended[: (len(ended) + 1) // 2]:
            del self.records[record.task]
            self._encoded.pop(record.task, None)
            if self._folder is not None:
                self._path(self._folder, record.task).unlink(missing_ok=True)


def _kept_in(folder: Path) -> list[Path]:
    """The files of the tasks that are kept in a folder, sorted; none where it is not there yet, or cannot be read."""
    try:  # no glob: it finds nothing in a folder that it may not read
        return sorted(path for path in folder.iterdir() if path.suffix == ".json")
    except FileNotFoundError:
        return []
    except OSError as error:
        log.error(
            "the tasks in %s cannot be read, and this site runs none of them: %s; let its user read and write there, or"
            " give the site another folder for its tasks",
            folder,
            error.strerror,
        )
        return []

"""The tasks that a site keeps, on its disk: one JSON file for each, so that they outlive the site."""

from __future__ import annotations

import logging
from pathlib import Path

from selfconf.errors import PeerError
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.messages import TaskRecord

log = logging.getLogger(__name__)


class TaskFolder:
    """A folder of task records; without one they are kept in memory only."""

    def __init__(self, folder: Path | None) -> None:
        self._folder = folder
        self.records: dict[str, TaskRecord] = {}
        """The newest record of each task, by the identity of the task."""
        for path in sorted(folder.glob("*.json")) if folder is not None and folder.is_dir() else ():
            try:
                record = decode(path.read_bytes(), TaskRecord)
            except (OSError, PeerError) as error:
                log.warning("passed over %s: %s", path, error)
                continue
            self.records[record.task] = record

    def learn(self, record: TaskRecord) -> bool:
        """Keep a record, unless a newer one of the same task is kept; whether it was new. Raises OSError."""
        known = self.records.get(record.task)
        if known is not None and known.revision >= record.revision:
            return False
        self.records[record.task] = record
        if self._folder is not None:
            self._folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            path = self._folder / f"{record.task}.json"
            temporary = path.with_suffix(".new")
            temporary.write_bytes(encode(record))
            temporary.replace(path)
        return True

"""The file by which the programs of this machine find a site, as the site itself writes it.

What is written into the runtime folder may be lost, as when that is emptied, or a disk is full: a file that is not
there is written again. Another site writes into it as well, when it takes the place of this one as the one that relays.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from pathlib import Path

from selfconf import this_machine
from selfconf.errors import NetworkError
from selfconf.this_machine import LocalSite

log = logging.getLogger(__name__)


class AnnouncedSite:
    """The file of one site."""

    def __init__(self, described: Callable[[], LocalSite]) -> None:
        """`described` is what the file is to say."""
        self._described = described
        self._file: Path | None = None
        self._said_to_relay = False
        """Whether it says that the site relays, unless another site has written it since."""
        self._trouble = ""
        """What has kept the site from writing into the runtime folder the last time; empty if nothing has."""

    @property
    def is_there(self) -> bool:
        """Whether it was written, and not taken back; another may have removed it."""
        return self._file is not None

    @property
    def is_lost(self) -> bool:
        """Whether it has to be written again: it could not be the last time, or was removed."""
        file = self._file  # once: another thread may take it back
        return bool(self._trouble) or (file is not None and not file.exists())

    @property
    def is_overruled(self) -> bool:
        """Whether it said that the site relays, and another site has written into it that it does not.

        Where the disk is full the file of a site that has begun to relay still says what was so before.
        """
        file = self._file
        return file is not None and self._said_to_relay and not this_machine.relays(file)

    def write(self) -> None:
        """Write it. Raises NetworkError."""
        mine = self._described()
        self._file = this_machine.announce(mine)
        self._said_to_relay = mine.relays

    def write_again(self) -> None:
        """Write it once more, as what it says has changed or is lost; where it cannot be written, that is said once."""
        try:
            self.write()
            self._trouble = ""
        except NetworkError as error:
            self.complain(error)

    def remove(self) -> None:
        """Take it back."""
        file, self._file = self._file, None  # first: the thread of the bus writes it anew where it is lost
        if file is not None:
            this_machine.leave(file)

    def complain(self, trouble: NetworkError) -> None:
        """Log what keeps the site from telling the others of this machine where it is, once."""
        if str(trouble) != self._trouble:
            self._trouble = str(trouble)
            log.error("programs of this machine may not find this site: %s", trouble)

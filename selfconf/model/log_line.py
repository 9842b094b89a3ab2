"""A line of what a component has printed, as the log of its site keeps it."""

from __future__ import annotations

from datetime import datetime, timezone
from typing import NamedTuple

from selfconf.model.term import IRI

LONGEST_LINE = 8192
"""How many bytes a line has at most; a longer one is broken."""


class LogLine(NamedTuple):
    """A line of the log of a site."""

    time: str
    """When it was printed, as UTC in ISO 8601."""
    stream: str
    """`stdout`, `stderr`, or `site` for what the site itself has noted."""
    components: tuple[IRI, ...]
    """The components of the process that has printed it."""
    text: str

    def concerns(self, component: str) -> bool:
        """Whether a component, by its IRI or its local name, is among those of the process."""
        return not component or any(component in (one, one.short) for one in self.components)

    @property
    def local_time(self) -> str:
        """The time of day here, for people."""
        try:
            moment = datetime.strptime(self.time, "%Y-%m-%dT%H:%M:%S.%fZ").replace(tzinfo=timezone.utc)
        except ValueError:
            return self.time
        return moment.astimezone().strftime("%H:%M:%S.%f")[:-3]

    def body(self) -> dict[str, object]:
        """The line as JSON."""
        return {"time": self.time, "stream": self.stream, "components": list(self.components), "text": self.text}

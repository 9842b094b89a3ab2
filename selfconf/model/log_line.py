"""A line of what a component has printed, as the log of its site keeps it."""

from __future__ import annotations

from datetime import datetime, timezone
from typing import NamedTuple

from selfconf.model.term import IRI

LONGEST_LINE = 8192
"""How many bytes a line has at most; a longer one is broken."""
BETWEEN_COMPONENTS = "|"
"""What is between the components of a line in a file: a character that no IRI has."""


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
    def moment(self) -> float | None:
        """When it was printed, in seconds of the Unix epoch; None where the time is none."""
        try:
            printed = datetime.strptime(self.time, "%Y-%m-%dT%H:%M:%S.%fZ")
        except ValueError:
            return None
        return printed.replace(tzinfo=timezone.utc).timestamp()

    def body(self) -> dict[str, object]:
        """The line as JSON."""
        return {"time": self.time, "stream": self.stream, "components": list(self.components), "text": self.text}

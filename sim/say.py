"""What the programs of a scene report to the one that runs it: a line of JSON on stdout for each event."""

from __future__ import annotations

import json
import sys
import time
from typing import Any


def say(event: str, **facts: Any) -> None:
    """A line of JSON with the real time.

    In one write, for several programs share a pipe, and theirs must not come between the line and its end.
    """
    sys.stdout.write(json.dumps({"event": event, "real": time.time(), **facts}) + "\n")
    sys.stdout.flush()

"""How programs on one machine find each other's routers: a small file for each site, in the user's runtime folder.

Across machines endpoints are given (`--connect`); on one machine none is needed. A file whose process is gone is
passed over, and removed.
"""

from __future__ import annotations

import json
import os
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path

from selfconf.errors import NetworkError


@dataclass(frozen=True, slots=True)
class Meeting:
    """A site of this machine: its ecology, name, endpoint and process."""

    ecology: str
    site: str
    endpoint: str
    process: int


def folder() -> Path:
    """Where the files are: `$SELFCONF_RUNTIME_DIR`, or `selfconf` in the user's runtime folder."""
    given = os.environ.get("SELFCONF_RUNTIME_DIR")
    if given:
        return Path(given)
    runtime = os.environ.get("XDG_RUNTIME_DIR")
    if runtime and Path(runtime).is_dir():
        return Path(runtime) / "selfconf"
    return Path(tempfile.gettempdir()) / f"selfconf-{os.getuid()}"


def announce(meeting: Meeting) -> Path:
    """Write the file of a site; whoever wrote it removes it."""
    root = folder()
    root.mkdir(mode=0o700, parents=True, exist_ok=True)
    if root.stat().st_uid != os.getuid():
        raise NetworkError(f"{root} belongs to somebody else; set SELFCONF_RUNTIME_DIR to a folder of your own")
    path = root / f"{meeting.ecology}@{meeting.site}.json"
    temporary = path.with_suffix(f".{os.getpid()}")
    temporary.write_text(json.dumps(asdict(meeting)))
    temporary.replace(path)
    return path


def meetings(ecology: str | None = None) -> list[Meeting]:
    """The sites that run on this machine, of one ecology or of all, sorted."""
    found: list[Meeting] = []
    root = folder()
    if not root.is_dir() or root.stat().st_uid != os.getuid():
        return found
    for path in sorted(root.glob("*.json")):
        try:
            meeting = Meeting(**json.loads(path.read_text()))
            alive = _alive(int(meeting.process))
        except (OSError, ValueError, TypeError):
            continue
        if not alive:
            path.unlink(missing_ok=True)
        elif ecology is None or meeting.ecology == ecology:
            found.append(meeting)
    return found


def find(ecology: str | None, connect: list[str]) -> tuple[str, list[str]]:
    """The ecology and the endpoints to connect to; raises NetworkError, saying what to try, if there are none."""
    if connect:
        return ecology or "home", connect
    found = meetings(ecology)
    names = sorted({meeting.ecology for meeting in found})
    if not names:
        which = f"of the ecology {ecology!r} " if ecology else ""
        raise NetworkError(
            f"no site {which}runs on this machine; start one with `selfconf site`, or give --connect ENDPOINT"
        )
    if len(names) > 1:
        raise NetworkError(f"several ecologies run on this machine; say which with --ecology: {', '.join(names)}")
    return names[0], [meeting.endpoint for meeting in found]


def _alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True

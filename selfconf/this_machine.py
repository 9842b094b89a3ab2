"""What the sites and the tasks of this machine tell each other by files in the user's runtime folder.

A site writes a small file by which programs find it; one whose process is gone is passed over, and removed. A program
that runs a task locks a file of the task's name, so that no two begin with one name in the same moment.
"""

from __future__ import annotations

import fcntl
import json
import math
import os
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import asdict, field
from io import FileIO
from pathlib import Path

from selfconf.atomic_write import write_atomically
from selfconf.errors import NetworkError
from selfconf.files import FileStamp, stamp
from selfconf.model.immutable import immutable, replace
from selfconf.termination import alive_since, start_time, stopped

CLAIMED = "names"
"""The folder of the files that are locked: `tasks` is where sites keep tasks, and a site may be called like a task."""
PROCESSES_ASKED_AGAIN = 1.0
"""Seconds after which it is checked again whether the processes of sites are there, where no file has changed."""
_TEMPORARY = "/tmp"
"""The folder for temporary files where there is none that this program can write in."""
TURN = 5.0
"""Seconds to wait for a turn: a site that was stopped in its own does not stop all others."""


@immutable
class LocalSite:
    """A site of this machine: its ecology, name, endpoint and process."""

    ecology: str
    site: str
    endpoint: str
    """Where it listens, or, if it does not relay, where a relay does by which it is reached."""
    process: int
    started: str = field(default="", compare=False)
    """When the process began: after a restart of the machine another one may have its number. Empty if not known."""
    relays: bool = True
    """Whether a relay of its own listens at the endpoint."""
    log: str = field(default="", compare=False)
    """The file in which it keeps what its components print; empty from a site of before that does not say it."""
    from_here: str = field(default="", compare=False)
    """Where its relay listens for its own host, beside the endpoint that others know; empty if there it does not."""
    served: Sequence[str] = field(default=(), compare=False)
    """The files and folders with what it advertises, as absolute paths."""

    def is_suspended(self) -> bool:
        """Whether the process was stopped by a signal and has not gone on, as after Ctrl-Z."""
        return stopped(self.process)

    def suspension(self) -> str:
        """The sentence that the process is suspended, and how it goes on."""
        return _suspension(self.process, f"the site {self.site!r} of ecology {self.ecology!r}")


def runtime_folder() -> Path:
    """Where the files are: `$SELFCONF_RUNTIME_DIR`, or `selfconf` in the user's runtime folder."""
    given = os.environ.get("SELFCONF_RUNTIME_DIR")
    if given:
        return Path(given)
    runtime = os.environ.get("XDG_RUNTIME_DIR")
    if runtime and Path(runtime).is_dir():
        return Path(runtime) / "selfconf"
    try:
        temporary = tempfile.gettempdir()
    except FileNotFoundError:  # none can be written in, as in some containers: what needs one says so
        temporary = _TEMPORARY
    return Path(temporary) / f"selfconf-{os.getuid()}"


def log_folder() -> Path:
    """Where the sites of this user keep what their components print, unless an option says otherwise."""
    return runtime_folder() / "log"


@contextmanager
def _writing() -> Iterator[Path]:
    """The folder, made and checked, to write in. Raises NetworkError where that cannot be."""
    root = runtime_folder()
    try:
        root.mkdir(mode=0o700, parents=True, exist_ok=True)
        if root.stat().st_uid != os.getuid():
            raise NetworkError(f"{root} belongs to another user; set SELFCONF_RUNTIME_DIR to a folder of your own")
        yield root
    except OSError as error:
        raise NetworkError(
            f"cannot write in {root} ({error.strerror}); set SELFCONF_RUNTIME_DIR to a folder of your own"
        ) from None


def made_runtime_folder() -> Path:
    """The folder, made for this user alone if it is not there. Raises NetworkError where that cannot be."""
    with _writing() as root:
        return root


@contextmanager
def turn(seconds: float = TURN) -> Iterator[bool]:
    """Hold a lock in which one site, and no other, looks for other sites, opens its relay, and announces itself.

    Without it two sites that start at once would miss each other, and neither would connect to the other. The value is
    False if another site has held the lock for all that time.
    """
    with _writing() as root:
        descriptor = os.open(root, os.O_RDONLY)
    try:
        yield _locked(descriptor, time.monotonic() + seconds)
    finally:
        os.close(descriptor)


def _locked(descriptor: int, deadline: float) -> bool:
    while True:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            if time.monotonic() >= deadline:
                return False
            time.sleep(0.005)  # flock has no time-out, and nothing tells when a lock is free
        else:
            return True


@immutable
class LocalTask:
    """A task whose name a program of this machine has claimed, and the process of the program."""

    ecology: str
    name: str
    process: int
    started: str
    """When the process began, to tell it from a later one with its number; empty where not known."""
    endpoints: Sequence[str]
    """The endpoints by which the program has joined: on another network there may be another ecology of this name."""

    def is_suspended(self) -> bool:
        """Whether the process was stopped by a signal and has not gone on, as after Ctrl-Z."""
        return stopped(self.process) and start_time(self.process) == self.started

    def suspension(self) -> str:
        """The sentence that the process is suspended, and how it goes on."""
        return _suspension(self.process, f"which runs the task {self.name!r}")


def _suspension(process: int, which: str) -> str:
    return f"process {process} of this machine, {which}, is suspended; `kill -CONT {process}` lets it go on"


class ClaimedName:
    """The name of a task that a program of this machine has, until it is released or the program has ended."""

    def __init__(self, name: str, file: FileIO | None = None) -> None:
        self.name = name
        self._file = file
        """The file that is locked; None where the runtime folder cannot be written in."""

    def __enter__(self) -> ClaimedName:
        return self

    def __exit__(self, *_: object) -> None:
        self.release()

    def release(self) -> None:
        """Let others have the name; may be called again."""
        file, self._file = self._file, None
        if file is not None:
            Path(file.name).unlink(missing_ok=True)  # while it is locked, so that no other program has it
            file.close()


def claim(ecology: str, name: str, endpoints: Sequence[str]) -> ClaimedName | None:
    """Claim the name of a task of an ecology; None if another program of this machine has it, or is about to.

    Programs that begin in the same moment do not see each other in the ecology yet. The endpoints, by which this
    program has joined the ecology, are for others to see.
    """
    try:
        with _writing() as root:
            folder = root / CLAIMED
            folder.mkdir(mode=0o700, exist_ok=True)
            file = _locked_file(folder / f"{ecology}@{name}")
    except NetworkError:
        return ClaimedName(name)
    if file is None:
        return None
    task = LocalTask(ecology, name, os.getpid(), start_time(os.getpid()), endpoints)
    with suppress(OSError):  # the disk is full: the name is claimed by the lock
        file.truncate(0)  # what a program that was killed has left
        file.write(json.dumps(asdict(task)).encode())
    return ClaimedName(name, file)


def suspended_tasks(ecology: str, endpoints: Sequence[str]) -> tuple[LocalTask, ...]:
    """The tasks of an ecology that suspended programs of this machine run, sorted by name.

    Only of programs that have joined by one of the endpoints. No file is locked, which would keep others from a name.
    """
    found = []
    for path in _files(f"{CLAIMED}/*"):
        try:
            task = LocalTask(**json.loads(path.read_bytes()))
            joined = task.ecology == ecology and not set(endpoints).isdisjoint(task.endpoints)
            if joined and task.is_suspended():
                found.append(task)
        except (OSError, ValueError, TypeError):  # it was released, or is being written
            continue
    return tuple(found)


def _locked_file(path: Path) -> FileIO | None:
    """Open and lock a file that is removed before it is unlocked; None if another process has locked it."""
    while True:
        file = FileIO(path, "a")  # that of another process stays as it is
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if os.path.samestat(os.fstat(file.fileno()), path.stat()):
                return file
        except BlockingIOError:
            file.close()
            return None
        except FileNotFoundError:
            pass  # it was removed after it was opened, by the one who had it
        file.close()


def announce(site: LocalSite) -> Path:
    """Write the file of a site, which `leave` removes; return its path. Raises NetworkError where that cannot be."""
    site = replace(site, started=start_time(site.process))
    if any(other.site == site.site and other.process != os.getpid() for other in local_sites(site.ecology)):
        raise NetworkError(f"a site {site.site!r} of ecology {site.ecology!r} runs on this machine already")
    return _write(site)


def announce_no_relay(other: LocalSite) -> None:
    """Write into the file of another site, in a turn, that it does not relay; it reads that when it goes on."""
    _write(replace(other, relays=False))


def relays(path: Path) -> bool:
    """Whether the file of a site says that it relays; True where it cannot be read."""
    try:
        return json.loads(path.read_text("utf-8"))["relays"] is not False
    except (OSError, ValueError, KeyError, TypeError):
        return True


def _write(site: LocalSite) -> Path:
    with _writing() as root:
        path = root / f"{site.ecology}@{site.site}.json"
        write_atomically(path, json.dumps(asdict(site)).encode())
    return path


def leave(path: Path) -> None:
    """Remove the file of a site of this process; a file that another process has written since stays."""
    try:
        if json.loads(path.read_text("utf-8"))["process"] == os.getpid():
            path.unlink()
    except (OSError, ValueError, KeyError, TypeError):
        return


def _is_the_same(site: LocalSite, began: str, path: Path) -> bool:
    """Whether the process of that number, which began then, is the one that has written the file, and no later one."""
    if site.started or not began:
        return site.started in ("", began)
    since_boot = time.clock_gettime(time.CLOCK_BOOTTIME) - int(began) / os.sysconf("SC_CLK_TCK")
    return time.time() - since_boot < path.stat().st_mtime + 1.0  # it began before the file was written


def _files(pattern: str) -> list[Path]:
    """The files of the runtime folder that match a pattern, sorted; none where it belongs to another user."""
    root = runtime_folder()
    mine = root.is_dir() and root.stat().st_uid == os.getuid()
    return sorted(root.glob(pattern)) if mine else []


def _announced() -> Iterator[tuple[Path, LocalSite]]:
    """The files of all sites that can be read, and what they say, sorted; their processes may be gone."""
    for path in _files("*.json"):
        try:
            site = LocalSite(**json.loads(path.read_bytes()))
        except (OSError, ValueError, TypeError):
            continue
        yield path, site


def _lives(site: LocalSite, path: Path) -> bool:
    """Whether the process that has written the file of a site is there; if not, the file is removed if that can be."""
    try:
        began = alive_since(int(site.process))
        living = began is not None and _is_the_same(site, began, path)
    except (OSError, ValueError, TypeError, OverflowError):  # no system has processes of such numbers
        return False
    if not living:
        with suppress(OSError):  # it is gone already, or the folder cannot be written in
            path.unlink()
    return living


def local_sites(ecology: str | None = None) -> list[LocalSite]:
    """The sites that run on this machine, of one ecology or of all, sorted."""
    living = [site for path, site in _announced() if _lives(site, path)]
    return [site for site in living if ecology is None or site.ecology == ecology]


class LocalSiteNames:
    """The names of the sites of an ecology that run on this machine, for one that asks many times a second.

    That one came or left in order is seen at once, the end of one that was killed within `PROCESSES_ASKED_AGAIN`.
    """

    def __init__(self, ecology: str) -> None:
        self._ecology = ecology
        self._names: tuple[str, ...] = ()
        self._stamp: FileStamp = ()
        self._until = -math.inf

    def __call__(self) -> tuple[str, ...]:
        """The names, sorted."""
        folder = stamp(runtime_folder())
        if folder != self._stamp or time.monotonic() >= self._until:
            self._stamp, self._until = folder, time.monotonic() + PROCESSES_ASKED_AGAIN
            self._names = tuple(site.site for site in local_sites(self._ecology))
        return self._names


def relaying_sites(ecology: str) -> list[LocalSite]:
    """The sites of an ecology that run on this machine and relay, sorted.

    Only of these is it asked whether their processes are there, which takes most of the time: each of many sites looks
    for those that relay when it has lost its hub.
    """
    return [site for path, site in _announced() if site.relays and site.ecology == ecology and _lives(site, path)]


def suspended_sites(ecology: str) -> tuple[str, ...]:
    """The names of the sites of an ecology that run on this machine and were stopped by a signal, as after Ctrl-Z."""
    return tuple(site.site for site in local_sites(ecology) if site.is_suspended())

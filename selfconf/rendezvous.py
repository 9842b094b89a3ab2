"""How a program finds its ecology: by its arguments, by its environment, or by the sites that run on this machine.

Across machines endpoints are given (`--connect`, or `SELFCONF_CONNECT`); on one machine none is needed, for each site
writes a small file into the user's runtime folder. A file whose process is gone is passed over, and removed.

One site of an ecology on a machine relays, on a port that follows from the ecology's name; all others are its clients
(`selfconf.api.joining`). So a program that knows the name knows where to look for one that takes its place.
"""

from __future__ import annotations

import fcntl
import hashlib
import json
import os
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import asdict, field, replace
from io import FileIO
from pathlib import Path

from selfconf.bus.credentials import Credentials
from selfconf.bus.zenoh_bus import client
from selfconf.errors import AuthorError, NetworkError, ProgrammerError
from selfconf.model.immutable import immutable
from selfconf.model.setting_names import setting
from selfconf.model.term import IRI
from selfconf.protocol.keys import any_ecology, checked_name, ecology_of
from selfconf.termination import alive, start_time, stopped

ECOLOGY_VARIABLE = "SELFCONF_ECOLOGY"
"""The variable that names the ecology of a program to which none is given."""
CONNECT_VARIABLE = "SELFCONF_CONNECT"
"""The variable with the endpoints, apart by spaces, that a program connects to when none are given."""
KEYS_VARIABLE = "SELFCONF_KEYS"
"""The variable with the folder of keys of a program to which none is given."""
ONTOLOGY_VARIABLE = "SELFCONF_ONTOLOGY"
"""The variable with the ontologies of a site, apart as the folders of $PATH are; its components are checked by them."""
LIFE_VARIABLE = "SELFCONF_LIFE"
"""The variable with the life that a site gives to the components of a program that it starts, so that it knows them."""
ECOLOGY_ANSWER = 3.0
"""Seconds that an endpoint may take to say which ecologies are there."""
PLACES = 4
"""How many usual ports an ecology has: the first that is free is taken, by the one site that relays."""
TURN = 5.0
"""Seconds to wait for a turn: a site that was stopped in its own does not stop all others."""
USUAL_PORTS = range(20000, 32768)
"""The ports of sites: below those that Linux takes for outgoing connections.

Else a client that tries to connect to a port where nothing listens might be given that very port for its own end.
"""


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


def runtime_folder() -> Path:
    """Where the files are: `$SELFCONF_RUNTIME_DIR`, or `selfconf` in the user's runtime folder."""
    given = os.environ.get("SELFCONF_RUNTIME_DIR")
    if given:
        return Path(given)
    runtime = os.environ.get("XDG_RUNTIME_DIR")
    if runtime and Path(runtime).is_dir():
        return Path(runtime) / "selfconf"
    return Path(tempfile.gettempdir()) / f"selfconf-{os.getuid()}"


def log_folder() -> Path:
    """Where the sites of this user keep what their components print, unless an option says otherwise."""
    return runtime_folder() / "log"


def usual_endpoints(ecology: str, secure: bool = False) -> list[str]:
    """Where the site that relays for an ecology on this machine listens: on the first that is free.

    They depend on the ecology and the runtime folder alone, so that a site that takes the place of another is where
    the clients of the one before look for it. With keys they are `secure`, and others than without.
    """
    digest = hashlib.blake2s(f"{runtime_folder()} {ecology}{' with keys' * secure}".encode(), digest_size=8).digest()
    first = int.from_bytes(digest, "big")
    protocol = "tls" if secure else "tcp"
    return [f"{protocol}/127.0.0.1:{USUAL_PORTS[(first + number) % len(USUAL_PORTS)]}" for number in range(PLACES)]


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
    """Those by which the program has joined: on another network there may be another ecology of this name."""

    def __str__(self) -> str:
        return (
            f"process {self.process} of this machine, which runs the task {self.name!r}, is suspended;"
            f" `kill -CONT {self.process}` lets it go on"
        )

    def is_suspended(self) -> bool:
        """Whether the process was stopped by a signal and has not gone on, as after Ctrl-Z."""
        return stopped(self.process) and start_time(self.process) == self.started


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
            folder = root / "tasks"
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
    for path in _files("tasks/*"):
        try:
            task = LocalTask(**json.loads(path.read_bytes()))
            joined = task.ecology == ecology and not set(endpoints).isdisjoint(task.endpoints)
            if joined and task.is_suspended():
                found.append(task)
        except (OSError, ValueError, TypeError):  # it was released, is being written, or is the folder of a site
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


def announce_for(other: LocalSite, relays: bool) -> None:
    """Write into the file of another site, in a turn, whether it relays; it reads that when it goes on."""
    _write(replace(other, relays=relays))


def relays(path: Path) -> bool:
    """Whether the file of a site says that it relays; True where it cannot be read."""
    try:
        return json.loads(path.read_text())["relays"] is not False
    except (OSError, ValueError, KeyError, TypeError):
        return True


def _write(site: LocalSite) -> Path:
    with _writing() as root:
        path = root / f"{site.ecology}@{site.site}.json"
        temporary = path.with_suffix(f".{os.getpid()}")
        temporary.write_text(json.dumps(asdict(site)))
        temporary.replace(path)
    return path


def leave(path: Path) -> None:
    """Remove the file of a site of this process; a file that another process has written since stays."""
    try:
        if json.loads(path.read_text())["process"] == os.getpid():
            path.unlink()
    except (OSError, ValueError, KeyError, TypeError):
        return


def _is_the_same(site: LocalSite, path: Path) -> bool:
    """Whether the process of that number is the one that has written the file, and not a later one."""
    began = start_time(site.process)
    if site.started or not began:
        return site.started in ("", began)
    since_boot = time.clock_gettime(time.CLOCK_BOOTTIME) - int(began) / os.sysconf("SC_CLK_TCK")
    return time.time() - since_boot < path.stat().st_mtime + 1.0  # it began before the file was written


def _files(pattern: str) -> list[Path]:
    """The files of the runtime folder that match a pattern, sorted; none where it belongs to another user."""
    root = runtime_folder()
    mine = root.is_dir() and root.stat().st_uid == os.getuid()
    return sorted(root.glob(pattern)) if mine else []


def local_sites(ecology: str | None = None) -> list[LocalSite]:
    """The sites that run on this machine, of one ecology or of all, sorted."""
    found: list[LocalSite] = []
    for path in _files("*.json"):
        try:
            site = LocalSite(**json.loads(path.read_text()))
            living = alive(int(site.process)) and _is_the_same(site, path)
        except (OSError, ValueError, TypeError, OverflowError):  # no system has processes of such numbers
            continue
        if not living:
            path.unlink(missing_ok=True)
        elif ecology is None or site.ecology == ecology:
            found.append(site)
    return found


def suspended_sites(ecology: str) -> tuple[str, ...]:
    """The names of the sites of an ecology that run on this machine and were stopped by a signal, as after Ctrl-Z."""
    return tuple(site.site for site in local_sites(ecology) if stopped(site.process))


def environment(ecology: str, endpoint: str, ontologies: Sequence[Path] = ()) -> dict[str, str]:
    """The variables by which a program that is started finds an ecology, and the ontologies of its parent."""
    found = {ECOLOGY_VARIABLE: ecology, CONNECT_VARIABLE: endpoint}
    return {**found, ONTOLOGY_VARIABLE: os.pathsep.join(str(path.resolve()) for path in ontologies)}


def site_ontologies() -> list[Path]:
    """The ontologies that the environment names: those of the site that has started this program."""
    return [Path(path) for path in os.environ.get(ONTOLOGY_VARIABLE, "").split(os.pathsep) if path]


def asked_for(ecology: str | None, connect: Sequence[str]) -> tuple[str | None, list[str]]:
    """The ecology and the endpoints that are given, else those that the environment names, if it does."""
    if ecology is None:
        ecology = os.environ.get(ECOLOGY_VARIABLE) or None
    return ecology, list(connect) or os.environ.get(CONNECT_VARIABLE, "").split()


def keys_folder(keys: Path | None) -> Path | None:
    """The folder of keys that is given, else the one that the environment names, if it does."""
    named = os.environ.get(KEYS_VARIABLE)
    return keys or (Path(named) if named else None)


def credentials(keys: Path | None, *kinds: str, name: str = "main") -> Credentials | None:
    """What a program shows to others: from the folder of keys that is given, else named by the environment, if one is.

    `kinds` are those of the principals that may do what the program does (`selfconf.access.PrincipalKind`); with the
    folder of an authority the program gets a certificate of the first, of that name. Raises AuthorError.
    """
    folder = keys_folder(keys)
    if folder is None:
        return None
    from selfconf.access import KeysFolder, PrincipalKind  # what it needs is an extra

    return KeysFolder(folder).credentials([PrincipalKind(kind) for kind in kinds], name)


def component_credentials(keys: Path | None, components: Sequence[IRI]) -> Credentials | None:
    """What a process of components shows: by its own folder of keys, or by that of a site of this host.

    Raises AuthorError for keys that are none, or that do not speak for each of the components, and ProgrammerError
    where there are keys and no components.
    """
    folder = keys_folder(keys)
    if folder is None:
        return None
    if not components:
        raise ProgrammerError("with keys a process has to say which components it is, for it speaks for no others")
    from selfconf.access import KeysFolder, Principal, PrincipalKind  # what it needs is an extra

    opened = KeysFolder(folder)
    if opened.serves_a_host:
        first, *others = map(Principal.component, components)
        opened = KeysFolder(opened.component(first, others))
    shown = opened.credentials((PrincipalKind.COMPONENT,))
    speaks = opened.own().principals
    for component in components:
        if Principal.component(component) not in speaks:
            raise AuthorError(
                f"{folder} speaks for {speaks[0]}, not for {component} ({Principal.component(component)})"
            )
    return shown


def find(ecology: str | None, connect: Sequence[str], credentials: Credentials | None = None) -> tuple[str, list[str]]:
    """The ecology and the endpoints to connect to.

    Each is what is given, else what the environment says, else that of the sites on this machine: where they are
    reached, then where they will be if one that hangs has its place taken by another. Raises NetworkError, saying what
    to try, if there are none, and AuthorError for what cannot name an ecology.
    """
    ecology, endpoints = asked_for(ecology, connect)
    if ecology is not None:
        checked_name(ecology, "an ecology")
    if endpoints:
        return ecology or _ecology_at(endpoints, credentials), endpoints
    found = local_sites(ecology)
    names = sorted({site.ecology for site in found})
    if not names:
        which = "" if ecology is None else f"of the ecology {ecology!r} "
        raise NetworkError(
            f"no site {which}runs on this machine; start one with `selfconf site`, or give"
            f" {setting('connect', 'ENDPOINT')}"
        )
    if len(names) > 1:
        which = f"{setting('ecology')}: {', '.join(names)}"
        raise NetworkError(f"several ecologies run on this machine; say which with {which}")
    usual = usual_endpoints(names[0], secure=credentials is not None)
    return names[0], list(dict.fromkeys([*(site.endpoint for site in found), *usual]))


def _ecology_at(endpoints: list[str], credentials: Credentials | None) -> str:
    """The one ecology that has a site behind some endpoints. Raises NetworkError if there is none, or several."""
    bus = client(endpoints, credentials=credentials)
    try:
        heard: list[tuple[str, ...]] = []
        bus.roll_call(any_ecology(), ECOLOGY_ANSWER, heard.append)
        deadline = bus.now() + ECOLOGY_ANSWER
        bus.run(lambda: bool(heard) or bus.now() > deadline)
    finally:
        bus.close()
    names = sorted({ecology_of(key) for keys in heard for key in keys})
    if len(names) == 1:
        return names[0]
    if names:
        raise NetworkError(f"several ecologies are there; say which with {setting('ecology')}: {', '.join(names)}")
    raise NetworkError(f"a router answers at {', '.join(endpoints)}, but no site of any ecology")

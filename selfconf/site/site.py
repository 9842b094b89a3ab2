"""A site: the init-component of a host (section 2.1 of the paper).

It serves the advertisements of its host, dormant components included, watches their files, announces that it is
alive, and starts the process of a dormant component when a configurator asks for it. The command line that does so
comes from the local advertisement (`sc:grounding [ sc:command ... ]`), never from the network.
"""

from __future__ import annotations

import logging
import os
import secrets
import shlex
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from selfconf import files
from selfconf import termination as ending
from selfconf.bus.port import Bus, Request, Urgency
from selfconf.errors import AuthorError, PeerError, reason
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import Keys, checked_name
from selfconf.protocol.messages import Cause, Fail, Page, Wake
from selfconf.rdf.advertisements import Advertisement, SegmentCache
from selfconf.rdf.turtle import ntriples

log = logging.getLogger(__name__)

FILE_CHECK = 1.0
"""How often, in seconds, the files are looked at for changes."""
ENDING = 3.0
"""How long, in seconds, a process that this site has started may take to end before it is killed."""
FOLLOW = 0.2
"""How often, in seconds, it is looked whether a started process still runs."""
STDERR = 2
"""Where components print: stdout is for the results of the command that started them."""
Complaint = Callable[[str], None]


class Shelf:
    """The advertisements in some files and folders, read again when the files change."""

    def __init__(self, paths: Sequence[Path], complain: Complaint) -> None:
        self._paths, self._complain = paths, complain
        self._seen: dict[Path, tuple[int, int]] = {}
        self._told: frozenset[str] = frozenset()
        self.advertisements: dict[IRI, Advertisement] = {}

    def _files(self, complaints: list[str]) -> list[Path]:
        """Every Turtle file of the shelf that can be found, sorted."""

        def left_out(error: AuthorError) -> None:
            complaints.append(f"left out: {error}")

        return sorted({file for path in self._paths for file in files.within(path, left_out)})

    def refresh(self) -> bool:
        """Read the files again if any has changed, come or gone; whether the advertisements are others now."""
        stamps: dict[Path, tuple[int, int]] = {}
        complaints: list[str] = []
        for path in self._files(complaints):
            try:
                status = path.stat()
            except OSError:
                continue
            stamps[path] = status.st_mtime_ns, status.st_size
        if stamps == self._seen and self._told.issuperset(complaints):
            return False
        self._seen = stamps
        found: dict[IRI, Advertisement] = {}
        segments = SegmentCache()
        for path in stamps:
            try:
                good, bad = files.advertisements(path, segments)
            except AuthorError as error:
                complaints.append(f"left out: {error}")
                continue
            complaints += [f"{path}: left out {one.component}: {one.problems[0]}" for one in bad]
            for advertisement in good:
                component = advertisement.profile.component
                if found.setdefault(component, advertisement) is not advertisement:
                    complaints.append(f"{path}: {component} is advertised twice; the first advertisement counts")
        self._tell(complaints)
        changed = found != self.advertisements
        self.advertisements = found
        return changed

    def _tell(self, complaints: Sequence[str]) -> None:
        """Complain of what was not wrong the last time already."""
        for complaint in dict.fromkeys(complaints):
            if complaint not in self._told:
                self._complain(complaint)
        self._told = frozenset(complaints)


class Site:
    """Serves a shelf on the bus."""

    def __init__(
        self,
        bus: Bus,
        ecology: str,
        name: str,
        shelf: Shelf,
        environment: Mapping[str, str] | None = None,
    ) -> None:
        """`environment` is what a started component finds its ecology by; None: this site starts none."""
        self.bus, self.keys, self.name, self.shelf = bus, Keys(ecology), checked_name(name, "a site"), shelf
        self._environment = environment
        self._processes: dict[IRI, subprocess.Popen[bytes]] = {}
        self._revision = 1
        self._pages: list[tuple[str, bytes, IRI, str, bool]] = []
        shelf.refresh()
        self._open()
        self._notify = bus.publisher(self.keys.changed(name), Urgency.EVENT)
        bus.serve(self.keys.advertisements(name), self._answer)
        bus.serve(self.keys.wake(name), self._wake)
        bus.announce(self.keys.site_life(name, secrets.token_hex(4)))
        self._look()

    def close(self) -> None:
        """End the processes this site has started, and leave the ecology."""
        for process in self._processes.values():
            process.terminate()
        for process in self._processes.values():
            try:
                process.wait(ENDING)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        self.bus.close()

    def _open(self) -> None:
        """Make the pages that are replied: one for each advertisement."""
        self._pages = [
            (
                self.keys.advertisement(self.name, component),
                ntriples(advertisement.triples),
                component,
                str(advertisement.profile.place or ""),
                advertisement.profile.command is not None,
            )
            for component, advertisement in sorted(self.shelf.advertisements.items())
        ]

    def _look(self) -> None:
        self.bus.later(FILE_CHECK, self._look)
        if self.shelf.refresh():
            self._revision += 1
            self._open()
            self._notify.put(encode(Page(0, len(self._pages), self._revision)))
            log.info("%d advertisements", len(self._pages))

    def _answer(self, request: Request) -> None:
        try:
            total = len(self._pages)
            for index, (key, payload, component, source, startable) in enumerate(self._pages):
                page = Page(index, total, self._revision, component, source, startable)
                request.reply(key, payload, encode(page))
            if not total:
                empty = Page(0, 0, self._revision)
                request.reply(self.keys.advertisements(self.name).replace("**", "none"), b"", encode(empty))
        finally:
            request.finish()

    def _wake(self, request: Request) -> None:
        try:
            wake = decode(request.payload, Wake)
            self.start(wake.component)
            request.reply(self.keys.wake(self.name), b"started")
        except PeerError as error:
            request.refuse(str(error))
        finally:
            request.finish()

    def start(self, component: IRI) -> None:
        """Start the process of a dormant component, unless it runs. Raises PeerError if that cannot be done."""
        advertisement = self.shelf.advertisements.get(component)
        command = advertisement.profile.command if advertisement else None
        if advertisement is None or command is None or self._environment is None:
            raise PeerError(f"this site cannot start {component}: its advertisement has no sc:command")
        running = self._processes.get(component)
        if running is not None and running.poll() is None:
            return
        place = advertisement.profile.place
        folder = Path(place.source).parent if place else Path()
        environment = {**os.environ, **self._environment, **ending.parent_environment(), "PATH": _path()}
        try:
            words = shlex.split(command) or [""]
            self._processes[component] = subprocess.Popen(
                words, cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=STDERR
            )
        except OSError as error:
            raise PeerError(f"the command of {component} does not start: {reason(error)}") from None
        except ValueError as error:
            raise PeerError(f"the command of {component} cannot be read: {error}") from None
        log.info("started %s: %s", component, command)
        self._follow(component)

    def _follow(self, component: IRI) -> None:
        """Tell whoever waits for a component if the process that was started for it has ended."""
        code = self._processes[component].poll()
        if code is None:
            self.bus.later(FOLLOW, lambda: self._follow(component))
            return
        detail = f"the process that its site started for it has ended with code {code}"
        notice = self.bus.publisher(self.keys.fail(component), Urgency.EVENT)
        notice.put(encode(Fail(component, "", 0, Cause.CRASH, detail)))
        notice.undeclare()


def _path() -> str:
    """The search path with this program's own Python first, so that `python` in a command is the same one."""
    return os.pathsep.join((str(Path(sys.executable).parent), os.environ.get("PATH", os.defpath)))

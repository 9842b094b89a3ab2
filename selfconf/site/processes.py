"""The processes of dormant components: started when a configurator asks for one, ended with their site.

The command line comes from the local advertisement (`sc:grounding [ sc:command ... ]`), never from the network. A
command is started once, however many components of its folder share it.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from itertools import groupby
from pathlib import Path

from selfconf.bus.port import Bus
from selfconf.errors import PeerError, SiteEndingError
from selfconf.model.immutable import immutable
from selfconf.model.profile import Profile
from selfconf.model.term import IRI
from selfconf.protocol.keys import Keys
from selfconf.site.component_program import ComponentProgram
from selfconf.site.log_file import LogFile
from selfconf.site.printed_lines import PrintedLines
from selfconf.site.process_group import ProcessGroup

log = logging.getLogger(__name__)

ENDING = 3.0
"""How long, in seconds, the processes of a site may take to end before they are killed, when the site ends."""
ACTUATORS_ALONE = 0.5
"""For which part of that time at most what feeds the actuators runs on, while these come to rest."""
Started = tuple[Path, str]
"""What is started once: a command, in the folder of the advertisement that has it."""


@immutable
class ProcessSettings:
    """How a site starts the processes of its components."""

    environment: Mapping[str, str] | None = None
    """What a component finds its ecology by; None: no process is ever started."""
    log_path: Path | None = None
    """The file that keeps what components print; None: it is only shown."""
    keys_of: Callable[[IRI], Path] | None = None
    """Makes the folder of keys of a process, by the component that stands for it; None: there are no keys."""


NONE_STARTED = ProcessSettings()


class ComponentProcesses:
    """The processes that one site has started, by component."""

    def __init__(self, bus: Bus, keys: Keys, settings: ProcessSettings) -> None:
        self._bus, self._keys, self._settings = bus, keys, settings
        self._programs: dict[Started, ComponentProgram] = {}
        self._printed: PrintedLines | None = None
        self._closed = False
        self.by_component: dict[IRI, ComponentProgram] = {}
        """The program that each component was started by last."""

    def start(self, profile: Profile, sharing: Iterable[Profile] = (), after: str = "") -> None:
        """Start the process of a component, unless it runs. Raises PeerError if that cannot be done.

        `sharing` are the components with the same command in the same folder. `after` is the life that a task has
        lost, if that is why it is started.
        """
        component, started = profile.component, started_once(profile)
        environment = self._settings.environment
        if started is None or environment is None:
            raise cannot_start(component)
        if self._closed:
            raise SiteEndingError
        last = program = self.by_component.get(component)
        if program is None or not program.running:  # the command of one that runs may have changed since
            program = self._programs.get(started)
        if program is None:
            folder, command = started
            program = ComponentProgram(
                self._bus, self._keys, command, folder, environment, self._printing, self._settings.keys_of
            )
            self._programs[started] = program
            if self._closed:  # after it is known: either it is closed here, or by `close`
                program.close()
        if last is not None and last is not program and last.group is not None:  # two processes would be one too many
            last.end(partial(self._start_late, profile, tuple(sharing), after))
            return
        program.start(profile, sharing, after)
        before = {self.by_component.get(one.component, program) for one in (*sharing, profile)} - {program}
        for one in (*sharing, profile):
            self.by_component[one.component] = program
        for left in before.difference(self.by_component.values()) if before else ():
            left.give_up()

    def _start_late(self, profile: Profile, sharing: Iterable[Profile], after: str) -> None:
        """Start a component, now that its process by another command is gone."""
        try:
            self.start(profile, sharing, after)
        except PeerError as error:
            log.error("%s", error)

    def end(self, component: IRI, life: str = "", ended: Callable[[], None] = lambda: None) -> None:
        """End the process of a component, and call `ended` once it is gone; it can be started again.

        Tasks name the `life` that they mean; without one a person has it ended, which is no crash. With it end the
        other components of the process. Raises PeerError if this site has not started it, or if `life` is not the life
        that it has started.
        """
        program = self.by_component.get(component)
        if program is None:
            raise PeerError(f"this site has not started {component}")
        if life and not program.is_life(component, life):
            raise PeerError(f"this site has not started the life {life} of {component}")
        program.end(ended, wanted=not life)

    def close(self) -> None:
        """End every process, with all that it has started: what runs after `ENDING` seconds, all in all, is killed.

        Those with actuators come to rest first, before what feeds them; when all have ended, that is said. Unlike
        everything else here it may be called from any thread: the bus may have one of its own.
        """
        self._closed = True
        began, groups = time.monotonic(), list[ProcessGroup]()
        programs = sorted(self._programs.values(), key=lambda program: not program.actuates)
        for program in programs:
            program.close()
        for actuates, programs_alike in groupby(programs, key=lambda program: program.actuates):
            # Each once: that of a process that has just gone is taken away on the thread of the bus.
            alike = [group for program in programs_alike if (group := program.group) is not None]
            for group in alike:
                group.terminate()
            for group in alike if actuates else ():
                if not group.frozen():
                    group.wait_for_all(max(0.0, began + ENDING * ACTUATORS_ALONE - time.monotonic()))
            groups += alike
        for group in groups:
            if group.frozen() or not group.wait_for_all(max(0.0, began + ENDING - time.monotonic())):
                group.kill()
                group.wait(ENDING)
        for program in programs:
            program.tell_end()
        if self._printed is not None:
            self._printed.close()
            self._printed = None

    def _printing(self) -> PrintedLines:
        """The reader of what the processes print, from the first process on."""
        if self._printed is None:
            path = self._settings.log_path
            self._printed = PrintedLines(None if path is None else LogFile(path))
        return self._printed


def started_once(profile: Profile) -> Started | None:
    """The command of a component with its folder; None if it has none."""
    if profile.command is None:
        return None
    return Path(profile.place.source).parent if profile.place else Path(), profile.command


def programs_of(profiles: Iterable[Profile]) -> dict[IRI, IRI]:
    """By component, the one that stands for its process: the first of those that share a command in a folder."""
    first: dict[Started, IRI] = {}
    found: dict[IRI, IRI] = {}
    for profile in sorted(profiles, key=lambda profile: profile.component):
        started = started_once(profile)
        found[profile.component] = (
            profile.component if started is None else first.setdefault(started, profile.component)
        )
    return found


def cannot_start(component: IRI) -> PeerError:
    """The error of a configurator that asks for a component that this site cannot start."""
    return PeerError(f"this site cannot start {component}: its advertisement has no sc:command")

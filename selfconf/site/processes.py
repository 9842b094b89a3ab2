"""The processes of dormant components: started when a configurator asks for one, ended with their site.

The command line comes from the local advertisement (`sc:grounding [ sc:command ... ]`), never from the network.
"""

from __future__ import annotations

import logging
import os
import shlex
import subprocess
import sys
import time
from collections.abc import Mapping
from pathlib import Path

from selfconf.bus.port import Bus, Urgency
from selfconf.errors import PeerError, reason
from selfconf.model.profile import Profile
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Cause, Fail
from selfconf.termination import parent_environment

log = logging.getLogger(__name__)

ENDING = 3.0
"""How long, in seconds, the processes of a site may take to end before they are killed."""
PROCESS_CHECK = 0.2
"""How often, in seconds, it is looked whether a started process still runs."""
STDERR = 2
"""Where components print: stdout is for the results of the command that started them."""


class ComponentProcesses:
    """The processes that one site has started, by component."""

    def __init__(self, bus: Bus, keys: Keys, environment: Mapping[str, str] | None) -> None:
        """`environment` is what a started component finds its ecology by; None: no process is ever started."""
        self._bus, self._keys, self._environment = bus, keys, environment
        self.by_component: dict[IRI, subprocess.Popen[bytes]] = {}

    def start(self, profile: Profile) -> None:
        """Start the process of a component, unless it runs. Raises PeerError if that cannot be done."""
        component, command = profile.component, profile.command
        if command is None or self._environment is None:
            raise cannot_start(component)
        running = self.by_component.get(component)
        if running is not None and running.poll() is None:
            return
        folder = Path(profile.place.source).parent if profile.place else Path()
        environment = {**os.environ, **self._environment, **parent_environment(), "PATH": _path()}
        try:
            words = shlex.split(command) or [""]
            process = subprocess.Popen(words, cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=STDERR)
        except OSError as error:
            raise PeerError(f"the command of {component} does not start: {reason(error)}") from None
        except ValueError as error:
            raise PeerError(f"the command of {component} cannot be read: {error}") from None
        log.info("started %s: %s", component, command)
        self.by_component[component] = process
        self._watch(component, process)

    def close(self) -> None:
        """End every process: those that still run after `ENDING` seconds, all in all, are killed."""
        for process in self.by_component.values():
            process.terminate()
        deadline = time.monotonic() + ENDING
        for process in self.by_component.values():
            try:
                process.wait(max(0.0, deadline - time.monotonic()))
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()

    def _watch(self, component: IRI, process: subprocess.Popen[bytes]) -> None:
        """Look at a process until it ends, and then raise FAIL for its component: a configurator may wait for it."""
        code = process.poll()
        if code is None:
            self._bus.later(PROCESS_CHECK, lambda: self._watch(component, process))
            return
        detail = f"the process that its site started for it has ended with code {code}"
        notice = self._bus.publisher(self._keys.fail(component), Urgency.EVENT)
        notice.put(encode(Fail(component, "", 0, Cause.CRASH, detail)))
        notice.undeclare()


def cannot_start(component: IRI) -> PeerError:
    """The error of a configurator that asks for a component that this site cannot start."""
    return PeerError(f"this site cannot start {component}: its advertisement has no sc:command")


def _path() -> str:
    """The search path with this program's own Python first, so that `python` in a command is the same one."""
    return os.pathsep.join((str(Path(sys.executable).parent), os.environ.get("PATH", os.defpath)))

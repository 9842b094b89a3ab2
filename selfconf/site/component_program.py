"""The program behind one `sc:command` of a site: one process, however many of the site's components share the command.

    idle --start--> running --crash--> pausing --time, start--> running
    running --end, trouble--> ending --gone--> idle, or pausing if it was for trouble

A process that ends with 0 has wanted to, and one that ends with 2 has said why it cannot run (its component lives
already, for one); every other end is a crash, but for one that a person has asked for (`selfconf site restart`). So is
each end after which a task that held a component of the process has it started again, and each before any of its
components has lived: both would go on forever. After a crash the program is started again with a pause, until it has
crashed too often (`selfconf.site.restart_limit`); after an end by 0 or 2 only when it is asked for, and then not before
the pause is over. The pause after a first crash ends when the program is asked for, as a task may stand still without
it; further ones do not, else a task that asks at once would leave no pauses. What still runs of the process is ended
first: there is never more than one.
"""

from __future__ import annotations

import logging
import os
import secrets
import shlex
import sys
import threading
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from selfconf.bus.port import Bus, Urgency
from selfconf.bus.timer import Timer
from selfconf.errors import AuthorError, PeerError, SiteEndingError, reason
from selfconf.model.log_line import BETWEEN_COMPONENTS
from selfconf.model.profile import Profile
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Cause, Fail
from selfconf.rendezvous import KEYS_VARIABLE, LIFE_VARIABLE
from selfconf.site.component_process import ComponentProcess, CountedAs
from selfconf.site.printed_lines import PrintedLines
from selfconf.site.process_group import ProcessGroup
from selfconf.site.restart_limit import CRASH_WINDOW, DEFAULT_RESTARTS, RestartLimit
from selfconf.termination import parent_environment

log = logging.getLogger(__name__)

PROCESS_CHECK = 0.5
"""How often, in seconds, it is checked whether a started process still runs; its end is heard of by its pipes."""
ENDING_CHECK = 0.02
"""After how many seconds it is first looked whether a process has ended that is to end, with all that it has started.
So it is looked at one whose pipes have ended, as they may end a moment before it.

It is looked again when as much time has passed as before, as each look at what has left the session reads about all
processes of the machine."""
TERMINATION = 2.0
"""Seconds that a process may take to end before it is killed."""
UNKILLABLE = 3.0
"""Seconds after which a process counts as gone even so: it is killed, and its parent may not have waited for it."""
NAMED_IN_LOG = 32
"""How many components of a process each line of the log names, so that names are not most of the log."""
NO_CRASH = (0, 2)
"""The codes of processes that have wanted to end, and of those that have said why they cannot run."""


@dataclass
class _Ending:
    """How a process is being ended."""

    since: float
    """When it was asked to end."""
    again: bool
    """Whether the program is to be started again once it is gone."""
    when_gone: list[Callable[[], None]] = field(default_factory=list)


class ComponentProgram:
    """One command in one folder, and the components that share it.

    There is a process while it is running or ending, and a timer while it is pausing; it is idle without either.
    """

    def __init__(
        self,
        bus: Bus,
        keys: Keys,
        command: str,
        folder: Path,
        environment: Mapping[str, str],
        printed: Callable[[], PrintedLines],
        keys_of: Callable[[IRI], Path] | None,
    ) -> None:
        """`printed` is where its lines go, `environment` is what it finds its ecology by.

        `keys_of` makes the folder of keys of a process, by the first of its components; None: there are no keys.
        """
        self._keys_of = keys_of
        self._bus, self._keys, self.command, self._folder = bus, keys, command, folder
        self._environment, self._printed = environment, printed
        self._profiles: dict[IRI, Profile] = {}
        self._asked: set[IRI] = set()
        """The components that it was started for."""
        self._limit = RestartLimit()
        self._process: ComponentProcess | None = None
        """The process, while there is anything left of it."""
        self._last: ComponentProcess | None = None
        """The process that is gone, until there is another one."""
        self._ending: _Ending | None = None
        """Of a process that is to end."""
        self._pause = Timer(bus, 0.0, self._launch_again)
        """Set while the program is to be started again after a pause."""
        self._closed = False
        self._launching = threading.RLock()
        """Held while the process is started: `close`, which any thread may call, waits until it is known."""
        self._next_check = Timer(bus, PROCESS_CHECK, self._check)

    @property
    def group(self) -> ProcessGroup | None:
        """The process with all that it has started, while there is anything left of them."""
        process = self._process
        return None if process is None else process.group

    @property
    def actuates(self) -> bool:
        """Whether one of the components that share it is an actuator."""
        return any(profile.is_actuator for profile in self._profiles.values())

    @property
    def running(self) -> bool:
        """Whether there is a process that is not to end."""
        return self._process is not None and self._ending is None

    def start(self, profile: Profile, sharing: Iterable[Profile], after: str = "") -> None:
        """Start the process for one of its components, unless it runs. Raises PeerError if that cannot be done.

        `after` is the life that a task has lost, if that is why it is started: then the end of that life was a crash.
        """
        self._asked.add(profile.component)
        self._profiles = {one.component: one for one in (profile, *sharing)}
        self._asked.intersection_update(self._profiles)  # one may have been given another command since
        if self._process is not None and self._ending is None:
            self._process.follow(self._profiles.values())
            self._process.asked_for = True
            return
        self._count_lost(after)
        wait = self._limit.wait(self._bus.now(), self._restarts())
        if wait > 0:
            crashed = f"has ended more than {self._restarts()} times within {CRASH_WINDOW:.0f} s"
            raise PeerError(f"the command of {profile.component} {crashed}; it can be started in {wait:.0f} s")
        if self._ending is not None:
            self._ending.again = True  # one process at a time; the end of this one is near
        elif self._limit.first(self._bus.now()):
            self._launch()
        elif not self._pause.is_set:
            if self._last is not None and self._last.counted_as is CountedAs.CRASH:
                self._start_again()
            else:
                self._launch()

    def end(self, gone: Callable[[], None], *, wanted: bool = False) -> None:
        """End the process: TERM, after `TERMINATION` seconds KILL; then call `gone`. It can be started again.

        Where it is being ended already, what has been asked to follow stays: a start, after which it is waited for. And
        unless the end is `wanted`, as a person has it ended, it is that of a task which wants a life of before to act
        no more: what has ended by itself is started again as after every crash, and so is what another task waits for.
        """
        if self._ending is None:
            self._check()  # it may have ended a moment ago
        if wanted:
            self._pause.stop()
        if self._process is None:
            gone()
        elif self._ending is not None:
            self._ending.when_gone.append(gone)
        else:
            again = self._process.is_waited_for and not wanted
            if wanted:
                self._process.counted_as = CountedAs.WANTED
            self._begin_ending(self._process, _Ending(self._bus.now(), again, [gone]))

    def _begin_ending(self, process: ComponentProcess, ending: _Ending) -> None:
        self._ending = ending
        if process.group.frozen():
            process.group.kill()  # it would have to go on, and might act, before it could end by itself
        else:
            process.group.terminate()
        self._next_check.reset(ENDING_CHECK)

    def give_up(self) -> None:
        """Start it again no more by itself: no component has its command any more."""
        self._pause.stop()
        if self._ending is not None:
            self._ending.again = False

    def is_life(self, component: IRI, life: str) -> bool:
        """Whether a life of a component is that of the present process, as far as is known."""
        process = self._process or self._last
        return process is not None and process.is_life(component, life)

    def _count_lost(self, life: str) -> None:
        """Count the end of the process in which a task has lost a life, unless it has counted."""
        process = self._process or self._last
        if life and process is not None and process.counted_as is CountedAs.OPEN and process.was_life(life):
            self._count_crash(process)

    def _count_crash(self, process: ComponentProcess) -> None:
        process.counted_as = CountedAs.CRASH
        self._limit.crashed(self._bus.now())

    def close(self) -> None:
        """Start nothing any more; the process is ended by the caller. May be called from any thread."""
        with self._launching:
            self._closed = True

    def tell_end(self) -> None:
        """Say that the process has ended with its site, if it has; after `close`, and also from any thread.

        Only the site knows that for certain: to a task that ends in the same moment what has gone may only be frozen.
        """
        process = self._process
        if process is not None and process.group.code() is not None:
            self._tell(process, Cause.CRASH, "its process has ended with its site")

    def _launch(self) -> None:
        """Start the process. Raises PeerError."""
        self._pause.stop()
        self._last = None
        life = secrets.token_hex(4)
        environment = {
            **os.environ,
            **self._environment,
            **self._keys_environment(),
            **parent_environment(),
            LIFE_VARIABLE: life,
            "PATH": _path(),
            "PYTHONUNBUFFERED": "1",
        }
        first = next(iter(self._profiles))
        try:
            words = shlex.split(self.command) or [""]
            with self._launching:
                if self._closed:
                    raise SiteEndingError
                printed = self._printed()
                group = ProcessGroup(words, self._folder, environment)
                process = self._process = ComponentProcess(self._bus, self._keys, group, life)
                if self._closed:  # by a signal to this very thread, which the lock does not keep out
                    group.kill()
        except OSError as error:
            raise PeerError(f"the command of {first} does not start: {reason(error)}") from None
        except ValueError as error:
            raise PeerError(f"the command of {first} cannot be read: {error}") from None
        self._next_check.reset(PROCESS_CHECK)  # first: whatever breaks below, its end is seen
        process.follow(self._profiles.values())
        for stream, pipe in group.pipes():
            printed.follow(pipe, stream, self._source(), lambda: self._bus.wake_up(lambda: self._look(process)))
        self._note(f"started as process {group.number}: {self.command}")

    def _keys_environment(self) -> dict[str, str]:
        """The variable by which the process finds its keys. Raises PeerError where they cannot be made."""
        if self._keys_of is None:
            return {}
        try:
            return {KEYS_VARIABLE: str(self._keys_of(min(self._profiles)).absolute())}
        except AuthorError as error:
            raise PeerError(f"there is no certificate for {min(self._profiles)}: {error}") from None

    def _look(self, process: ComponentProcess) -> None:
        """A pipe of a process has ended: mostly the process has too, or does in a moment."""
        if process is self._process:
            process.silent_since = self._bus.now()
            self._check()

    def _check(self) -> None:
        """See how it is with the process."""
        process = self._process
        if process is None or self._closed:
            return
        if self._ending is not None:
            self._check_ending(process, self._ending)
            return
        code = process.group.code()
        if code is not None:
            self._ended(process, code)
            return
        trouble = process.trouble()
        if trouble is None:
            self._next_check.reset(max(ENDING_CHECK, min(self._bus.now() - process.silent_since, PROCESS_CHECK)))
        else:
            self._end_for(process, *trouble)

    def _check_ending(self, process: ComponentProcess, ending: _Ending) -> None:
        waited = self._bus.now() - ending.since
        if waited >= TERMINATION:
            process.group.kill()
        if not process.group.gone() and waited < UNKILLABLE:
            self._next_check.reset(_next_ending_check(waited))
            return
        self._next_check.stop()
        process.close()
        self._process, self._last, self._ending = None, process, None
        if ending.again:
            self._start_again()
        for gone in ending.when_gone:
            gone()

    def _ended(self, process: ComponentProcess, code: int) -> None:
        """The process has ended by itself."""
        again = code not in NO_CRASH
        # One that ends before it lives is not started again, but what asks for it may not ask without a limit.
        if again or not process.lived:
            self._count_crash(process)
        outlook = self._outlook() if again else ""
        if code == 0 and not process.lived:  # nothing was printed that would tell why
            outlook = " before the component lived; does its program call `main`?"
        self._report(
            process, Cause.CRASH, f"the process that its site started for it has ended with code {code}{outlook}"
        )
        self._begin_ending(process, _Ending(self._bus.now(), again))  # what it has started may still run
        self._check()

    def _end_for(self, process: ComponentProcess, cause: Cause, trouble: str) -> None:
        """End a process that cannot say itself that something is wrong with it."""
        self._count_crash(process)
        self._report(process, cause, f"its process {trouble}; its site ends it{self._outlook()}")
        self._begin_ending(process, _Ending(self._bus.now(), again=True))

    def _start_again(self) -> None:
        """Start the program after a pause, if it has not crashed too often."""
        pause = self._limit.pause(self._bus.now(), self._restarts())
        if pause is not None:
            self._pause.set(pause)

    def _launch_again(self) -> None:
        if not self._closed:
            try:
                self._launch()
            except PeerError as error:
                self._note(str(error))
                self._limit.crashed(self._bus.now())
                self._start_again()

    def _restarts(self) -> int:
        """How often a minute it is started again: as often as the most demanding of its components says."""
        said = [one.restarts for one in self._profiles.values()]
        return max(DEFAULT_RESTARTS if one is None else one for one in said)

    def _outlook(self) -> str:
        """What comes after a crash, in words."""
        if self._limit.pause(self._bus.now(), self._restarts()) is not None:
            return "; it is started again"
        return f", for the {self._restarts() + 1}. time within {CRASH_WINDOW:.0f} s; it is not started again"

    def _report(self, process: ComponentProcess, cause: Cause, detail: str) -> None:
        self._note(detail)
        self._tell(process, cause, detail)

    def _tell(self, process: ComponentProcess, cause: Cause, detail: str) -> None:
        """Raise FAIL for what the process was started for, as a configurator may wait for one that has no life yet.

        So for what else has lived in it.
        """
        lived = {one for one in self._profiles if process.last_life(one) == process.life}
        for component in sorted(self._asked | lived):
            notice = self._bus.publisher(self._keys.fail(component), Urgency.EVENT)
            notice.put(encode(Fail(component, process.last_life(component), 0, cause, detail)))
            notice.undeclare()

    def _note(self, text: str) -> None:
        log.info("%s: %s", self._source(), text)
        self._printed().note(self._source(), text)

    def _source(self) -> str:
        """The components of the process, as a line of the log has them; of too many those that were asked for first."""
        others = sorted(self._profiles.keys() - self._asked)
        return BETWEEN_COMPONENTS.join(sorted([*sorted(self._asked), *others][:NAMED_IN_LOG]))


def _next_ending_check(waited: float) -> float:
    """In how many seconds it is looked again at a process that is to end, by the seconds since it was asked to."""
    if waited < TERMINATION:
        return max(ENDING_CHECK, min(waited, PROCESS_CHECK, TERMINATION - waited))
    return max(ENDING_CHECK, min(waited - TERMINATION, PROCESS_CHECK))  # it was killed then


def _path() -> str:
    """The search path with this program's own Python first, so that `python` in a command is the same one."""
    return os.pathsep.join((str(Path(sys.executable).parent), os.environ.get("PATH", os.defpath)))

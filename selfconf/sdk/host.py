"""Several components in one process with one session, as a simulated world or a robot's computer has them.

The code of all of them runs on the thread that calls `run` or `poll`; the bus has a thread of its own, so that neither
a call of a configurator nor the end of its life waits for that code, and so that code that hangs is noticed.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping, Sequence
from functools import cache, partial
from pathlib import Path
from typing import TypeVar

from selfconf import files, library, rendezvous
from selfconf.bus.port import Bus, Replies
from selfconf.errors import AuthorError, NetworkError, PeerError, ProgrammerError, SessionClosedError
from selfconf.model.immutable import FIRST_VALUES
from selfconf.model.profile import Profile
from selfconf.model.signal_fields import SignalFields
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import CallAnswer
from selfconf.sdk.code_pages import let_go_of_code
from selfconf.sdk.code_thread import CodeThread, RunningCode
from selfconf.sdk.component import Component
from selfconf.sdk.runtime import ComponentRuntime

CODE_CHECK = 0.1
"""How often, in seconds, it is checked whether the code that runs is within its deadline."""
STOOD_STILL = 0.5
"""Seconds by which such a look comes late, without this process having used the time, after which it stood still."""
JOINING = 1.0
"""Seconds that a component of the same IRI may take to say that it lives."""
AT_REST = 0.2
"""After how many seconds a host lets go of what it needed to begin, and makes ready what it will need."""
WARM_UPS = FIRST_VALUES + 1
"""How often it goes through a call beforehand: until all values of that are made by what is compiled."""
PARSER = "pyoxigraph"
"""The library that reads advertisements and ontologies; once these are read, its code is a fifth of the memory."""
LEAVING = 2.5
"""Seconds that the code of the components may take to come to rest when the host is closed."""
_Kind = TypeVar("_Kind", bound=Component)
_Heard = TypeVar("_Heard")


class Host:
    """Components that share one session and one thread: the thread that calls `run` or `poll`."""

    def __init__(
        self,
        bus: Bus,
        ecology: str,
        hung: Callable[[str], None] = lambda what: None,
        ontologies: Sequence[Path] = (),
    ) -> None:
        """`hung` is called, on the bus's thread, when code of a component does not return within its deadline.

        So it is when an actuator breaks as it is to come to rest: either may act on, and obeys no call any more.

        Some `ontologies` say of which fields signals consist, besides those of selfconf and of the environment.
        """
        self.bus, self.keys = bus, Keys(ecology)
        self.runtimes: list[ComponentRuntime] = []
        self._leaving: set[ComponentRuntime] = set()
        """Those that leave the ecology, and whose code has not come to rest yet."""
        self.trouble: NetworkError | None = None
        """Why a component had to leave: another process is the same one, or code has closed the session."""
        self.code = CodeThread(inline=not bus.run_aside())
        self._hung, self._ontologies = hung, tuple(ontologies)
        self._overdue: RunningCode | None = None
        """The code that was found to hang last."""
        self._looked = self._went_on = time.monotonic()
        """When the code was looked at last, and when this process has gone on last that had stood still."""
        self._used = time.process_time()
        """How many seconds of a processor this process had used by the last look."""
        bus.when_lost(self._be_lost)
        if not self.code.inline:
            bus.wake_up(self._watch_code)
            bus.later(AT_REST, self._settle)

    def add(self, component: _Kind, life: str = "", advertisement: Path | None = None) -> _Kind:
        """Let a component join the ecology.

        `advertisement` is the file that says what it is, where that is not said by its class: one class may stand for
        many things. Raises AuthorError for an advertisement that cannot be read, and NetworkError if the component
        lives already.
        """
        kind = type(component)
        path = advertisement or kind.advertisement_path()
        profile = _profile(path, kind.__name__, kind.component)
        fields = signal_fields_of(path, profile, self._ontologies)
        self._check_alone(profile)

        def join(done: Callable[[ComponentRuntime], None]) -> None:
            done(
                ComponentRuntime(
                    self.bus,
                    self.keys,
                    profile,
                    component,
                    life,
                    self.code,
                    self._be_superseded,
                    fields,
                    restless=lambda why: self._hung(f"{profile.component}: {why}"),
                )
            )

        self.runtimes.append(self._on_bus_thread(join))
        return component

    def remove(self, component: Component) -> None:
        """Turn a component off and let it leave the ecology; nothing happens if it has left already."""
        for runtime in [one for one in self.runtimes if one.component is component]:
            self._let_leave(runtime)

    def _let_leave(self, runtime: ComponentRuntime) -> None:
        self.runtimes.remove(runtime)
        self._leaving.add(runtime)
        self.bus.wake_up(partial(runtime.close, partial(self._leaving.discard, runtime)))

    def poll(self, seconds: float = 0.0) -> None:
        """Let the components hear everything there is to hear; wait up to that long if there is nothing."""
        if self.code.inline:
            self.bus.poll(seconds)
        else:
            self.code.poll(seconds)

    def run(self, until: Callable[[], bool]) -> None:
        """Let the components hear everything, until `until` holds; `code.wake_up` has it asked at once.

        Raises NetworkError if another process is the same component, and this one has to leave, and SessionClosedError
        if code of this process has closed the session.
        """
        if self.code.inline:
            self.bus.run(until)
        else:
            self.code.run(lambda: until() or self.trouble is not None)
        if self.trouble is not None:
            raise self.trouble

    def leave(self) -> None:
        """Let every component leave the ecology at once, whatever its code does: the process is about to end.

        So no task has a life of it activated that is as good as over. On the thread of the bus.
        """
        for runtime in list(self.runtimes):
            runtime.close()

    def close(self) -> None:
        """Turn every component off and leave the ecology, once all are at rest, those that were removed as well.

        Actuators come to rest first.
        """
        for runtime in sorted(self.runtimes, key=lambda runtime: not runtime.profile.is_actuator):
            self._let_leave(runtime)
        deadline = self.bus.now() + LEAVING
        self._poll_until(lambda: not self._leaving or self.bus.now() > deadline)
        self.bus.close()

    def _poll_until(self, until: Callable[[], bool]) -> None:
        if self.code.inline:
            self.bus.run(until)
            return
        while not until():
            self.code.poll(0.01)

    def _on_bus_thread(self, action: Callable[[Callable[[_Heard], None]], None]) -> _Heard:
        """Do something on the thread of the bus that hears of a result, and wait for that. What it raises is raised."""
        heard: list[_Heard] = []
        raised: list[BaseException] = []
        there = threading.Event()

        def hear(result: _Heard) -> None:
            heard.append(result)
            there.set()

        def act() -> None:
            try:
                action(hear)
            except BaseException as error:  # it is raised again, in the thread that waits
                raised.append(error)
                there.set()

        self.bus.wake_up(act)
        if self.code.inline:
            self.bus.run(there.is_set)
        else:
            there.wait()
        if raised:
            raise raised[0]
        return heard[0]

    def _check_alone(self, profile: Profile) -> None:
        """Raise NetworkError if a process is this component already."""
        component = profile.component
        called = partial(self._on_bus_thread, partial(self.bus.roll_call, self.keys.lives(component), JOINING))
        lives: tuple[str, ...] = called()
        if not lives:
            return
        ask = partial(self.bus.ask, self.keys.call(component, "state"), b"", JOINING)
        replies: Replies = self._on_bus_thread(ask)
        places = []
        for sample in replies.samples:
            try:
                places.append(decode(sample.payload, CallAnswer).place)
            except PeerError:
                continue
        if not places and not set(lives).intersection(called()):
            return  # the end of a life was on its way
        where = ", ".join(place for place in places if place) or "a process that does not answer"
        raise NetworkError(f"{component} is alive already: {where}; end that one first")

    def _be_superseded(self, reason: str) -> None:
        self._have_to_leave(NetworkError(reason))

    def _be_lost(self) -> None:
        """Let every component leave: none hears of a configurator any more, nor is heard of."""
        self.leave()
        names = ", ".join(runtime.profile.component for runtime in self.runtimes) or "this program"
        self._have_to_leave(
            SessionClosedError(f"code of {names} has closed the session by which it was in the ecology")
        )

    def _have_to_leave(self, why: NetworkError) -> None:
        self.trouble = why
        self.code.wake_up()

    def _settle(self) -> None:
        let_go_of_code(PARSER)
        self._warm_up(WARM_UPS)

    def _warm_up(self, times: int) -> None:
        """Go through a call beforehand while no component is held, and again when what waits had its turn."""
        if times and not any(runtime.activation.holds for runtime in self.runtimes):
            from selfconf.sdk.warm_up import warm_up_calls  # loads a bus in memory, of which others have no need

            warm_up_calls()
            self.bus.later(0.0, partial(self._warm_up, times - 1))

    def _watch_code(self) -> None:
        """Look at intervals whether the code that runs is within its deadline; once for each piece of code.

        What time this process stood still, as a whole machine does that stalls, the code has not taken.
        """
        self.bus.later(CODE_CHECK, self._watch_code)
        now, used = time.monotonic(), time.process_time()
        late = now - self._looked - CODE_CHECK
        if late > STOOD_STILL and used - self._used < late / 2:
            self._went_on = now
        self._looked, self._used = now, used
        overdue = self.code.overdue(self._went_on)
        if overdue is None or overdue == self._overdue:
            return
        self._overdue = overdue
        for runtime in (*self.runtimes, *self._leaving):
            # What delays a rest has not failed itself: another component of this host may be the one that is to rest.
            if runtime.code.is_to_rest if overdue.delays_rest else runtime.code is overdue.owner:
                runtime.hung(overdue.why_overdue)
            if runtime.code is overdue.owner:
                self._hung(f"{runtime.profile.component}: {overdue.why_overdue}")


def signal_fields_of(path: Path, profile: Profile, ontologies: Sequence[Path]) -> Mapping[IRI, SignalFields]:
    """The fields of what a component emits, sends along and answers.

    What they are is said by its advertisement, the ontologies of selfconf, those of the site that has started it, and
    those that are given.
    """
    carried = {signal for port in profile.signal_outputs for signal in port.signals}
    calls = [(port.request, port.response) for port in profile.operations]
    calls += [(port.request, port.response) for port in profile.needed_operations]
    carried.update(one for call in calls for one in call if one is not None)
    others = files.ontology_files([*rendezvous.site_ontologies(), *ontologies])
    return _signal_fields(path, tuple(others), frozenset(carried))


@cache
def _signal_fields(path: Path, ontologies: tuple[Path, ...], signals: frozenset[IRI]) -> Mapping[IRI, SignalFields]:
    if not signals:
        return {}
    advertisement = files.octets(path), str(path), files.base(path)
    return files.signal_fields([*ontologies, *library.ontologies()], signals, [advertisement])


def profile_of(kind: type[Component]) -> Profile:
    """The profile of a component class, read from its advertisement."""
    return _profile(kind.advertisement_path(), kind.__name__, kind.component)


def _profile(path: Path, name: str, component: str) -> Profile:
    """The profile of the component in an advertisement's file, which may have to say which one it is."""
    if not path.is_file():
        raise ProgrammerError(f"the advertisement of {name} is not there: {path}")
    good, bad = files.advertisements(path)
    for malformed in bad:
        if component and component != malformed.component:
            continue  # what else stands in the file is not its concern
        raise AuthorError(f"{malformed.component}: {malformed.problems[0]}", file=str(path))
    wanted = [a.profile for a in good if not component or a.profile.component == component]
    if len(wanted) != 1:
        names = ", ".join(a.profile.component for a in good) or "none"
        raise ProgrammerError(f"{name} must say by `component` which one of {path} it is; there: {names}")
    return wanted[0]

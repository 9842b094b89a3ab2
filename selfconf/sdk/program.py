"""`main`: a component class as a program of its own."""

from __future__ import annotations

import argparse
import logging
import os
import sys
import threading
import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import NoReturn

from selfconf import rendezvous
from selfconf.aside_writer import AsideHandler, AsideWriter, write_line
from selfconf.errors import ProgrammerError, SelfconfError, SessionClosedError
from selfconf.model.setting_names import options_named
from selfconf.model.wording import plain
from selfconf.sdk.component import Component
from selfconf.sdk.host import Host, profile_of
from selfconf.termination import Termination, started_by_another

HUNG_ENDS = 0.2
"""Seconds from the FAIL of code that hangs to the end of its process, if a site started it and can start it again."""
TIME_TO_END = 2.5
"""Seconds that a program may take to end on a signal; code that does not return is not waited for longer."""
THREADS_GO_ON = 0.5
"""Seconds that threads which code of the components has started may go on after the main thread has ended."""
HUNG_EXIT_CODE = 70
"""The exit code of a program that ends as its code hangs, or has closed its session: EX_SOFTWARE of sysexits.h."""


@options_named()
def main(*kinds: type[Component], arguments: Sequence[str] | None = None) -> NoReturn:
    """Run components as one program until SIGINT, SIGTERM or SIGHUP; then exit, with 2 if it cannot run.

    It exits with 70 if its code hangs, or closes its session.

    Threads that the components have started are not waited for.

    Arguments that are not options of selfconf are the program's own. The ecology is taken from `--ecology` and
    `--connect`, else from `SELFCONF_ECOLOGY` and `SELFCONF_CONNECT` (as set by a site that starts a dormant
    component), else from the sites that run on this machine.
    """
    said = next((kind.__doc__ for kind in kinds), None)
    parser = argparse.ArgumentParser(description=(said or "a component").splitlines()[0])
    add_connection_arguments(parser)
    given, _ = parser.parse_known_args(arguments)
    life = os.environ.pop(rendezvous.LIFE_VARIABLE, "")  # it is this process's own: what it starts shall not have it
    logging.basicConfig(level=logging.WARNING, handlers=[AsideHandler("%(name)s: %(message)s")])
    try:
        _check(kinds)
        host = open_host(given.ecology, given.connect, given.keys, kinds)
        # All are made first: one that has joined is called, and starts once this is over.
        components = [kind() for kind in kinds]
        for component in components:
            host.add(component, life)
        run_until_ended(host)
    except SelfconfError as error:
        print(plain(str(error)), file=sys.stderr)
        raise SystemExit(_exit_code(error)) from None
    raise SystemExit(0)


def _check(kinds: Sequence[object]) -> None:
    """Raises ProgrammerError for what are no classes of components."""
    wrong = [kind for kind in kinds if not (isinstance(kind, type) and issubclass(kind, Component))]
    if wrong or not kinds:
        found = repr(wrong[0]) if wrong else "nothing"
        raise ProgrammerError(f"`main` takes classes that are derived from selfconf.sdk.Component, not {found}")


def add_connection_arguments(parser: argparse.ArgumentParser) -> None:
    """The options by which a program finds its ecology."""
    parser.add_argument("--ecology", metavar="NAME", help="the ecology; by default the only one on this machine")
    parser.add_argument(
        "--connect",
        metavar="ENDPOINT",
        action="append",
        default=[],
        help="where a site listens, such as tcp/127.0.0.1:7447; repeatable",
    )
    parser.add_argument("--keys", metavar="DIR", type=Path, help="a folder of keys (default: $SELFCONF_KEYS)")


def open_host(
    ecology: str | None = None,
    connect: Sequence[str] = (),
    keys: Path | None = None,
    kinds: Sequence[type[Component]] = (),
) -> Host:
    """A host for components of some kinds, in the ecology that `selfconf.rendezvous.find` finds.

    `keys` is a folder of keys: that of the process itself, or that of a site of this host, by which the process gets a
    certificate for its components. Raises NetworkError, AuthorError for keys that are none or of others, and
    ProgrammerError where there are keys and the kinds are not said.
    """
    components = [] if rendezvous.keys_folder(keys) is None else [profile_of(kind).component for kind in kinds]
    shown = rendezvous.component_credentials(keys, components)
    name, endpoints = rendezvous.find(ecology, connect, shown)
    bus = rendezvous.member_bus(name, endpoints, shown, shared_memory=True)
    said = AsideWriter(write_line, str)

    def hung(what: str) -> None:
        if started_by_another():
            host.leave()
            bus.later(HUNG_ENDS, lambda: os._exit(HUNG_EXIT_CODE))
        said.put(what)

    host = Host(bus, name, hung)
    return host


def run_until_ended(host: Host) -> None:
    """Run a host until SIGINT, SIGTERM or SIGHUP, or until the site that started this program is gone; then close it.

    Raises NetworkError if another process is the same component, and this one has to leave, and SessionClosedError if
    code of this process has closed the session.
    """

    def then() -> None:
        host.code.wake_up()
        if not host.code.inline:
            host.bus.later(TIME_TO_END, lambda: os._exit(HUNG_EXIT_CODE))

    ending = Termination(host.bus, then)
    try:
        host.run(ending)
    finally:
        host.close()
        _leave_threads_behind(_exit_code(sys.exc_info()[1]))


def _exit_code(error: BaseException | None) -> int:
    """The exit code of a program that ends by what was raised, if anything was."""
    if isinstance(error, SystemExit):
        return error.code if isinstance(error.code, int) else int(error.code is not None)
    if error is None:
        return 0
    if isinstance(error, SessionClosedError):
        return HUNG_EXIT_CODE
    return 2 if isinstance(error, SelfconfError) else 1


def _leave_threads_behind(code: int) -> None:
    """End the process with a code soon after its main thread has ended, though threads go on that its code has started.

    Python would wait for them without end, and they may turn a motor that no configurator can stop any more.
    """

    def end() -> None:
        threading.main_thread().join()
        time.sleep(THREADS_GO_ON)  # for no condition: without such threads the process has ended before
        for stream in (sys.stdout, sys.stderr):
            with suppress(Exception):  # there may be none, or nothing that reads it
                stream.flush()
        os._exit(code)

    threading.Thread(target=end, daemon=True, name="end").start()

"""Tests run by several processes that are forked when all tests are collected: `pytest --forks 5`.

To import the modules of ten thousand tests, and to collect these, takes six seconds of a processor. pytest-xdist has
each of its processes do so, and so does each that takes the place of one that has died. Here it is done once: the
processes are forked from one that has collected and that has begun no thread, and that hands out the tests and tells
how they went. Which tests share a process, and which come first, is said in `tests/harness/schedule.py`.
"""

from __future__ import annotations

import os
import signal
import sys
import time
import traceback
from collections import OrderedDict, deque
from collections.abc import Sequence
from contextlib import suppress
from multiprocessing import Pipe
from multiprocessing.connection import Connection, wait
from typing import Any, NoReturn

import pytest

from tests.harness import schedule

LEAVING = 20.0
"""Seconds that a process may take to leave the fixtures of its tests when no further ones are to be run."""
AHEAD = 3
"""Tests that a process has before it: it waits for no further ones, and knows after each what the next one needs."""


def add_option(parser: pytest.Parser) -> None:
    """Add the option that says how many processes run the tests."""
    parser.addoption("--forks", type=int, default=0, help="run the tests in so many forked processes")


def run(session: pytest.Session) -> bool | None:
    """Run the tests of a session in several processes; None if this process is to run them, as pytest does."""
    config = session.config
    number = min(config.option.forks, len(session.items))
    if number < 2 or config.option.collectonly or session.testsfailed:
        return None
    config.option.usepdb = False
    Forks(session, number).run()
    return True


class Fork:
    """A process that runs tests, as the process sees it that has forked it."""

    def __init__(self, session: pytest.Session, number: int) -> None:
        self.number = number
        self.left: list[int] = []
        """The tests that it was given and that are not over, in the order in which it runs them."""
        self.ended = False
        """Whether it was told that no more tests come."""
        self.connection, other = Pipe()
        sys.stdout.flush()
        sys.stderr.flush()
        self.process = os.fork()
        if not self.process:
            self.connection.close()
            _work(session, number, other)
        other.close()

    def give(self, tests: Sequence[int] | None) -> None:
        """Give it tests, or tell it that no more come; that it has died is noticed when it is listened to."""
        self.left.extend(tests or ())
        self.ended = tests is None
        with suppress(OSError):
            self.connection.send(tests)

    def over(self) -> None:
        """Wait for its end, which is near."""
        self.connection.close()
        os.waitpid(self.process, 0)

    def interrupt(self) -> None:
        """Have it leave the test that it runs, and begin no other."""
        os.kill(self.process, signal.SIGINT)

    def end(self) -> None:
        """Wait until it has left its fixtures, which may have begun programs; kill it if that takes too long."""
        deadline = time.monotonic() + LEAVING
        try:
            while wait([self.connection], max(0.0, deadline - time.monotonic())):
                self.connection.recv()
            os.kill(self.process, signal.SIGKILL)
        except (EOFError, OSError):
            pass
        self.over()


class Forks:
    """The processes that run the tests of a session, and the tests that no process has yet, in groups."""

    def __init__(self, session: pytest.Session, number: int) -> None:
        self._session, self._number = session, number
        groups: OrderedDict[str, list[int]] = OrderedDict()
        for place, item in enumerate(session.items):
            group = schedule.group_of(item.nodeid, getattr(item, "fixturenames", ()))
            groups.setdefault(group, []).append(place)
        self._groups = deque(groups.values())
        self._forks: dict[Connection, Fork] = {}

    def run(self) -> None:
        """Have all tests run, and tell how each went, until too many have failed."""
        session = self._session
        session.config._tmp_path_factory.getbasetemp()  # type: ignore[attr-defined]  # one for all processes
        try:
            for number in range(self._number):
                self._begin(number)
            while self._forks:
                for connection in wait(list(self._forks)):
                    self._hear(self._forks[connection])  # type: ignore[index]
                    if session.shouldfail:
                        raise session.Failed(session.shouldfail)
                    if session.shouldstop:
                        raise session.Interrupted(session.shouldstop)
        except (session.Failed, session.Interrupted):  # a terminal interrupts all of its processes itself
            for fork in self._forks.values():
                fork.interrupt()
            raise
        finally:
            for fork in self._forks.values():
                fork.end()

    def _begin(self, number: int) -> None:
        fork = Fork(self._session, number)
        self._forks[fork.connection] = fork
        self._supply(fork)

    def _supply(self, fork: Fork) -> None:
        """Keep some tests before a process; one in three takes them from the end."""
        while self._groups and len(fork.left) < AHEAD:
            fork.give(self._groups.pop() if schedule.computes(fork.number) else self._groups.popleft())
        if not self._groups and not fork.ended:
            fork.give(None)

    def _hear(self, fork: Fork) -> None:
        """Tell how a test went, or in which one a process has died, of which the others take over what is left."""
        hook = self._session.config.hook
        try:
            test, warnings, reports = fork.connection.recv()
        except (EOFError, OSError):
            del self._forks[fork.connection]
            fork.over()
            if fork.left:
                self._crashed(fork)
            return
        for facts in warnings:
            hook.pytest_warning_recorded.call_historic(kwargs=facts)
        for data in reports:
            report = hook.pytest_report_from_serializable(config=self._session.config, data=data)
            hook.pytest_runtest_logreport(report=report)
        fork.left.remove(test)
        item = self._session.items[test]
        # The process has looked up where the test stands, which takes longer than all else that is done here.
        location = reports[-1]["location"] if reports else item.location
        hook.pytest_runtest_logfinish(nodeid=item.nodeid, location=location)
        self._supply(fork)

    def _crashed(self, fork: Fork) -> None:
        place, *left = fork.left
        item = self._session.items[place]
        report = pytest.TestReport(
            nodeid=item.nodeid,
            location=item.location,
            keywords={},
            outcome="failed",
            longrepr=f"process {fork.number} crashed while running {item.nodeid!r}",
            when="call",
        )
        self._session.config.hook.pytest_runtest_logreport(report=report)
        if left:
            self._groups.appendleft(left)
        if self._groups:
            self._begin(fork.number)


class _Telling:
    """Notes how a test goes, for the process that tells it."""

    def __init__(self, config: pytest.Config) -> None:
        self._config = config
        self._all = config.get_verbosity() > 0 or config.option.durations is not None
        self.reports: list[dict[str, Any]] = []
        self.warnings: list[dict[str, Any]] = []

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Note how a phase went.

        That one before or after a test went well is news where its duration is asked for, and that after a failure has
        what was printed then.
        """
        failed = any(data["outcome"] == "failed" for data in self.reports)
        if self._all or report.when == "call" or not report.passed or failed:
            data = self._config.hook.pytest_report_to_serializable(config=self._config, report=report)
            self.reports.append(data)

    def pytest_warning_recorded(self, warning_message: Any, when: str, nodeid: str, location: Any) -> None:
        """Note a warning."""
        self.warnings.append({"warning_message": warning_message, "when": when, "nodeid": nodeid, "location": location})


def _work(session: pytest.Session, number: int, connection: Connection) -> NoReturn:
    """Run the tests that come, in a process of its own."""
    code = 1
    try:
        _run_tests(session, number, connection)
        code = 0
    except KeyboardInterrupt:
        session._setupstate.teardown_exact(None)
    except BaseException:
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)


def _run_tests(session: pytest.Session, number: int, connection: Connection) -> None:
    config = session.config
    if schedule.computes(number):
        os.nice(schedule.YIELDS)
    for name in ("terminalreporter", "terminalprogress"):
        if config.pluginmanager.has_plugin(name):
            config.pluginmanager.unregister(name=name)
    capture = config.pluginmanager.getplugin("capturemanager")
    if capture is not None:  # else all processes write into one file
        capture.stop_global_capturing()
        capture.start_global_capturing()
    folders = config._tmp_path_factory  # type: ignore[attr-defined]
    folders._basetemp = folders.getbasetemp() / f"fork-{number}-{os.getpid()}"
    folders._basetemp.mkdir(mode=0o700)
    telling = _Telling(config)
    config.pluginmanager.register(telling, "telling")
    telling.warnings.clear()  # those that were recorded before, of which it hears now
    queue: deque[int] = deque()
    more = True
    while queue or more:
        while more and (len(queue) < 2 or connection.poll()):
            tests = connection.recv()
            more = tests is not None
            queue.extend(tests or ())
        if not queue:
            return
        test = queue.popleft()
        following = session.items[queue[0]] if queue else None
        config.hook.pytest_runtest_protocol(item=session.items[test], nextitem=following)
        connection.send((test, telling.warnings, telling.reports))
        telling.reports, telling.warnings = [], []

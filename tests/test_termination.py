"""When a program ends: by a signal, or because the one that started it is gone."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator

import pytest

from selfconf.bus.memory import Network
from selfconf.termination import (
    PARENT_CHECK,
    Termination,
    alive,
    alive_since,
    end_as_by_ctrl_c,
    orphaned,
    parent_environment,
    resident_memory,
    start_time,
)


def test_a_process_lives_until_it_has_ended_even_if_its_parent_has_not_waited_for_it() -> None:
    process = subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE)
    try:
        assert alive(process.pid)
        process.send_signal(signal.SIGKILL)
        os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
        assert not alive(process.pid)
    finally:
        process.communicate()
    assert not alive(process.pid)


def test_a_process_of_another_user_may_live() -> None:
    assert alive(os.getpid())
    assert alive(1)


@pytest.fixture
def handlers() -> Iterator[None]:
    """Afterwards signals are handled as they were."""
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)}
    signal.signal(signal.SIGHUP, signal.SIG_DFL)
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
@pytest.mark.usefixtures("handlers")
def test_a_signal_ends_the_program_once_however_often_it_comes(number: signal.Signals) -> None:
    network, said = Network(0), list[str]()
    ended = Termination(network.node(), lambda: said.append("ending"))
    assert not ended()
    for _ in range(3):
        signal.raise_signal(number)
    assert network.run(ended, 1.0)
    network.run(lambda: False, 1.0)
    assert said == ["ending"]


@pytest.mark.usefixtures("handlers")
def test_signals_do_again_what_they_did_before_unless_another_handles_them_by_now() -> None:
    end_as_by_ctrl_c()
    ended = Termination(Network(0).node())
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    elsewhere = threading.Thread(target=ended.heed_no_more)
    elsewhere.start()
    elsewhere.join()
    assert signal.getsignal(signal.SIGTERM) != signal.default_int_handler  # Python lets the main thread alone do it
    ended.heed_no_more()
    signal.raise_signal(signal.SIGHUP)
    with pytest.raises(KeyboardInterrupt):
        signal.raise_signal(signal.SIGTERM)
    assert not ended()


@pytest.mark.usefixtures("handlers")
def test_a_signal_ends_a_program_whose_bus_is_held_up() -> None:
    ended = Termination(Network(0).node())  # nobody lets its time pass
    signal.raise_signal(signal.SIGTERM)
    assert ended()


@pytest.mark.usefixtures("handlers")
def test_a_program_ends_when_the_one_that_started_it_is_gone(monkeypatch: pytest.MonkeyPatch) -> None:
    network = Network(0)
    monkeypatch.setenv("SELFCONF_PARENT", str(os.getppid()))
    ended = Termination(network.node())
    assert not network.run(ended, 10 * PARENT_CHECK)
    monkeypatch.setattr(os, "getppid", lambda: 1)
    assert network.run(ended, 10 * PARENT_CHECK)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
@pytest.mark.usefixtures("handlers")
def test_before_that_a_signal_ends_a_program_as_ctrl_c_does(number: signal.Signals) -> None:
    end_as_by_ctrl_c()
    with pytest.raises(KeyboardInterrupt):
        signal.raise_signal(number)


@pytest.mark.usefixtures("handlers")
def test_a_program_that_ignores_the_end_of_its_terminal_goes_on() -> None:
    signal.signal(signal.SIGHUP, signal.SIG_IGN)  # as nohup does
    network = Network(0)
    end_as_by_ctrl_c()
    ended = Termination(network.node())
    signal.raise_signal(signal.SIGHUP)
    assert not network.run(ended, 1.0)


def test_a_program_that_another_one_started_is_an_orphan_once_that_one_is_gone(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    parent = os.getppid()
    assert not orphaned(parent)
    monkeypatch.setenv("SELFCONF_PARENT", "no number")
    assert not orphaned(1)
    monkeypatch.setenv("SELFCONF_PARENT", str(parent))
    assert not orphaned(parent)
    assert orphaned(parent + 1)
    gone = subprocess.Popen([sys.executable, "-c", ""])
    gone.wait()
    monkeypatch.setenv("SELFCONF_PARENT", str(gone.pid))
    assert orphaned(parent)


def test_a_program_tells_those_that_it_starts_who_it_is() -> None:
    assert parent_environment() == {"SELFCONF_PARENT": str(os.getpid())}


def test_a_process_began_at_one_time_and_a_dead_one_at_none() -> None:
    assert start_time(os.getpid()).isdigit()
    assert start_time(os.getpid()) == start_time(os.getpid())
    process = subprocess.Popen([sys.executable, "-c", ""])
    process.wait()
    assert start_time(process.pid) == ""
    assert alive_since(os.getpid()) == start_time(os.getpid())
    assert alive_since(process.pid) is None


def test_this_program_takes_memory() -> None:
    assert 1 << 20 < resident_memory() < 1 << 40


@pytest.mark.usefixtures("handlers")
def test_whoever_waits_for_the_end_is_woken_by_the_signal_and_by_the_bus_as_it_may_be_about_to_wait() -> None:
    network, woken = Network(0), list[bool]()
    ended = Termination(network.node(), told=lambda: woken.append(ended()))
    signal.raise_signal(signal.SIGTERM)
    assert woken == [True]
    network.run(lambda: False, 1.0)
    assert woken == [True, True]

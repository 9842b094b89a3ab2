"""When a program ends: which processes count as gone."""

from __future__ import annotations

import os
import signal
import subprocess
import sys

from selfconf.termination import alive, start_time


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


def test_a_process_began_at_one_time_and_a_dead_one_at_none() -> None:
    assert start_time(os.getpid()).isdigit()
    assert start_time(os.getpid()) == start_time(os.getpid())
    process = subprocess.Popen([sys.executable, "-c", ""])
    process.wait()
    assert start_time(process.pid) == ""

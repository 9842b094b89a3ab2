"""A process with all that it starts: in a session of its own, ended as a whole."""

from __future__ import annotations

import ctypes
import os
import resource
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from selfconf.site import process_group
from selfconf.site.process_group import ProcessGroup
from selfconf.termination import alive
from tests.site.served import until

pytestmark = pytest.mark.process
CHILD = (
    "import os, signal, subprocess, sys;"
    "child = subprocess.Popen([sys.executable, '-c', 'import signal; signal.pause()']);"
    "open('child', 'w').write(str(child.pid));"
)


@pytest.fixture
def groups() -> Iterator[list[ProcessGroup]]:
    """Groups that are ended after the test."""
    made: list[ProcessGroup] = []
    yield made
    for group in made:
        group.kill()
        group.wait(10)


def started(groups: list[ProcessGroup], folder: Path, code: str) -> ProcessGroup:
    """A program of Python."""
    group = ProcessGroup([sys.executable, "-c", code], folder, os.environ)
    for _, pipe in group.pipes():
        os.close(pipe)
    groups.append(group)
    return group


def test_a_group_has_a_session_of_its_own(groups: list[ProcessGroup], tmp_path: Path) -> None:
    group = started(groups, tmp_path, "import signal; signal.pause()")
    assert os.getsid(group.number) == os.getpgid(group.number) == group.number != os.getsid(0)
    assert group.code() is None
    assert not group.gone()
    assert not group.wait(0.01)


def test_with_a_program_ends_what_it_has_started(groups: list[ProcessGroup], tmp_path: Path) -> None:
    group = started(groups, tmp_path, CHILD + "signal.pause()")
    assert until(lambda: (tmp_path / "child").exists() and (tmp_path / "child").read_text() != "")
    child = int((tmp_path / "child").read_text())
    group.terminate()
    assert group.wait(10)
    assert until(lambda: not alive(child))


def test_a_program_that_leaves_something_behind_is_not_gone(groups: list[ProcessGroup], tmp_path: Path) -> None:
    group = started(groups, tmp_path, CHILD + "os._exit(3)")
    assert group.wait(10)
    assert group.code() == 3
    child = int((tmp_path / "child").read_text())
    assert alive(child)
    assert not group.gone()
    group.kill()
    assert until(lambda: not alive(child))


def test_a_program_is_ended_and_seen_to_be_gone_where_no_file_can_be_opened(
    groups: list[ProcessGroup], tmp_path: Path
) -> None:
    group = started(groups, tmp_path, "import signal; signal.pause()")
    before = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (0, before[1]))
    try:
        assert not group.gone()
        group.terminate()
        assert group.wait(10)
        assert group.gone()
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, before)


@pytest.mark.parametrize("then", ["signal.pause()", "os._exit(0)"], ids=["its parent lives", "its parent has ended"])
def test_what_has_left_the_session_is_ended_too(groups: list[ProcessGroup], tmp_path: Path, then: str) -> None:
    left = CHILD.replace("pause()'])", "pause()'], start_new_session=True)")
    group = started(groups, tmp_path, left + then)
    assert until(lambda: (tmp_path / "child").exists() and (tmp_path / "child").read_text() != "")
    child = int((tmp_path / "child").read_text())
    assert os.getsid(child) == child != group.number
    if then != "signal.pause()":
        assert group.wait(10)
        assert alive(child)
    assert not group.gone()
    opened = len(list(Path("/proc/self/fd").iterdir()))
    group.terminate()
    assert len(list(Path("/proc/self/fd").iterdir())) == opened
    assert group.wait(10)
    assert until(lambda: not alive(child))
    assert until(group.gone)


def test_what_is_on_its_way_into_a_program_is_waited_for(
    groups: list[ProcessGroup], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    group = started(groups, tmp_path, "pass")
    assert group.wait(10)
    shown = tmp_path / "proc" / str(os.getpid())  # for a process outside of the group
    shown.mkdir(parents=True)
    for name in ("environ", "cmdline"):
        (shown / name).write_bytes(b"")
    (shown / "exe").symlink_to(sys.executable)
    looks = []

    def begin(seconds: float) -> None:
        looks.append(seconds)
        if len(looks) == 2:
            (shown / "environ").write_bytes(f"{process_group.GROUP_VARIABLE}={group._mark}\0".encode())

    monkeypatch.setattr(process_group, "_PROCESSES", tmp_path / "proc")
    monkeypatch.setattr(process_group.time, "sleep", begin)
    assert not group.gone()
    assert len(looks) == 2
    (shown / "environ").write_bytes(b"")
    (shown / "cmdline").write_bytes(b"env\0-i\0")
    assert group.gone()
    (shown / "cmdline").write_bytes(b"")
    (shown / "exe").unlink()  # a zombie, or one of the kernel
    assert group.gone()
    assert len(looks) == 2


def test_the_number_of_a_group_is_not_signalled_once_it_may_be_another_programs(
    groups: list[ProcessGroup], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    left = CHILD.replace("pause()'])", "pause()'], start_new_session=True)")
    group = started(groups, tmp_path, left + "os._exit(0)")
    assert group.wait(10)
    child = int((tmp_path / "child").read_text())
    assert not group.gone()
    later = subprocess.Popen([sys.executable, "-c", "import signal; signal.pause()"], start_new_session=True)
    try:
        monkeypatch.setattr(group, "number", later.pid)  # as if the system had given the number once more
        group.terminate()
        group.kill()
        assert until(lambda: not alive(child))
        assert group.gone()
        assert later.poll() is None
    finally:
        later.kill()
        later.wait(10)


def test_a_later_process_of_the_number_of_a_group_is_not_taken_for_it(
    groups: list[ProcessGroup], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    group = started(groups, tmp_path, "pass")
    assert group.wait(10)
    later = subprocess.Popen([sys.executable, "-c", "import signal; signal.pause()"], start_new_session=True)
    try:
        monkeypatch.setattr(group, "number", later.pid)
        assert group.gone()
        group.kill()
        assert later.poll() is None
    finally:
        later.kill()
        later.wait(10)


def test_a_group_that_was_empty_once_is_signalled_no_more(
    groups: list[ProcessGroup], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    group, later = (started(groups, tmp_path, code) for code in ("pass", CHILD + "os._exit(0)"))
    assert group.wait(10)
    assert group.gone()
    assert later.wait(10)
    child = int((tmp_path / "child").read_text())
    monkeypatch.setattr(group, "number", later.number)  # which no process has any more, but a group
    group.kill()
    assert group.gone()
    assert alive(child)
    assert not later.gone()


def test_what_ignores_the_variable_is_still_ended_in_the_group(groups: list[ProcessGroup], tmp_path: Path) -> None:
    group = started(groups, tmp_path, CHILD.replace("pause()'])", "pause()'], env={})") + "os._exit(0)")
    assert group.wait(10)
    child = int((tmp_path / "child").read_text())
    assert not group.gone()
    group.kill()
    assert until(lambda: not alive(child))


def test_what_has_left_the_session_without_the_variable_is_left_alone(
    groups: list[ProcessGroup], tmp_path: Path
) -> None:
    code = CHILD.replace("pause()'])", "pause()'], env={}, start_new_session=True)")
    group = started(groups, tmp_path, code + "os._exit(0)")
    assert group.wait(10)
    child = int((tmp_path / "child").read_text())
    try:
        group.kill()
        assert until(group.gone)
        assert alive(child)
    finally:
        os.kill(child, signal.SIGKILL)


def test_what_a_group_inside_of_a_group_has_started_belongs_to_both(groups: list[ProcessGroup], tmp_path: Path) -> None:
    inner = (
        "import os, sys; from pathlib import Path; from selfconf.site.process_group import ProcessGroup;"
        'code = \'import signal; open("ready", "w"); signal.pause()\';'
        "print(ProcessGroup([sys.executable, '-c', code], Path(), os.environ).number, file=open('child', 'w'));"
        "os._exit(0)"
    )
    group = started(groups, tmp_path, inner)
    assert group.wait(10)
    assert until((tmp_path / "ready").exists)
    child = int((tmp_path / "child").read_text())
    assert not group.gone()
    group.kill()
    assert until(lambda: not alive(child))


def test_what_another_program_has_started_is_left_alone(groups: list[ProcessGroup], tmp_path: Path) -> None:
    group, other = (started(groups, tmp_path, "import signal; signal.pause()") for _ in range(2))
    group.kill()
    assert group.wait(10)
    assert until(group.gone)
    assert other.code() is None


def test_a_program_that_is_stopped_is_frozen_until_it_goes_on(groups: list[ProcessGroup], tmp_path: Path) -> None:
    group = started(groups, tmp_path, "import signal; signal.pause()")
    assert not group.frozen()
    os.kill(group.number, signal.SIGSTOP)
    assert until(group.frozen)
    os.kill(group.number, signal.SIGCONT)
    assert until(lambda: not group.frozen())
    group.kill()
    assert group.wait(10)
    assert not group.frozen()


def test_signals_to_a_group_that_is_gone_reach_nobody(groups: list[ProcessGroup], tmp_path: Path) -> None:
    group = started(groups, tmp_path, "pass")
    assert group.wait(10)
    assert until(group.gone)
    group.terminate()
    group.kill()


PR_SET_CHILD_SUBREAPER = 36
"""Of prctl(2): what loses its parent gets this process for one."""


@pytest.fixture
def foster_parent() -> Iterator[None]:
    """This process is the parent of orphans, and waits for none of them, as process 1 of some containers."""
    libc = ctypes.CDLL(None, use_errno=True)
    if not sys.platform.startswith("linux") or libc.prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0):
        pytest.skip("orphans cannot be had here")
    yield
    libc.prctl(PR_SET_CHILD_SUBREAPER, 0, 0, 0, 0)


@pytest.mark.usefixtures("foster_parent")
def test_a_group_of_which_nothing_is_left_that_has_not_ended_is_gone(
    groups: list[ProcessGroup], tmp_path: Path
) -> None:
    group = started(groups, tmp_path, CHILD)
    assert group.wait(10)
    child = int((tmp_path / "child").read_text())
    assert not group.gone()
    os.kill(child, signal.SIGKILL)
    assert until(group.gone)
    assert os.getpgid(child) == group.number, "nobody has waited for it"
    os.waitpid(child, 0)
    assert group.gone()

"""Sites and tasks of one machine tell each other of themselves by files in the runtime folder."""

from __future__ import annotations

import errno
import fcntl
import json
import os
import re
import resource
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from selfconf import rendezvous, this_machine
from selfconf.errors import NetworkError
from selfconf.model.immutable import replace
from selfconf.rendezvous import usual_endpoints
from selfconf.termination import start_time
from selfconf.this_machine import LocalSite
from tests.suspended_run import suspended_run


def meeting(ecology: str = "home", site: str = "a", process: int | None = None) -> LocalSite:
    """A site of this process."""
    return LocalSite(ecology, site, f"tcp/127.0.0.1:{len(site) + 7000}", os.getpid() if process is None else process)


def dead_process() -> int:
    """The number of a process that has just ended."""
    process = subprocess.Popen([sys.executable, "-c", ""])
    process.wait()
    return process.pid


def test_a_site_that_has_announced_itself_is_found(runtime_folder: Path) -> None:
    path = this_machine.announce(meeting())
    assert path.parent == runtime_folder
    (found,) = this_machine.local_sites()
    assert (found, str(found), found.is_suspended()) == (meeting(), repr(found), False)
    assert rendezvous.find(None, []) == ("home", [meeting().endpoint, *usual_endpoints("home")])
    path.unlink()
    assert this_machine.local_sites() == []


def test_where_the_file_of_one_that_is_gone_cannot_be_removed_the_others_are_found(
    runtime_folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    this_machine.announce(meeting())
    left = runtime_folder / "home@gone.json"
    left.write_text((runtime_folder / "home@a.json").read_text().replace(str(os.getpid()), str(dead_process())))

    def read_only(path: Path, missing_ok: bool = False) -> None:
        raise OSError(errno.EROFS, os.strerror(errno.EROFS), path)

    with monkeypatch.context() as folder:
        folder.setattr(Path, "unlink", read_only)
        assert this_machine.local_sites() == [meeting()]
    assert left.exists()
    assert this_machine.local_sites() == [meeting()]
    assert not left.exists()


def test_the_file_of_a_site_is_as_the_protocol_shows_it() -> None:
    page = (Path(__file__).parents[1] / "docs" / "protocol.md").read_text("utf-8")
    (shown,) = re.findall(r'^(\{"ecology".*?\})$', page, re.DOTALL | re.MULTILINE)
    assert list(json.loads(shown)) == list(json.loads(this_machine.announce(meeting()).read_text()))


def test_a_site_that_cannot_be_announced_for_want_of_room_leaves_nothing(runtime_folder: Path) -> None:
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (16, before[1]))
    try:
        with pytest.raises(NetworkError, match=r"cannot write in"):
            this_machine.announce(meeting())
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert list(runtime_folder.iterdir()) == []


def test_all_sites_of_an_ecology_are_found_and_none_of_another() -> None:
    for ecology, site in (("home", "a"), ("home", "bb"), ("office", "ccc")):
        this_machine.announce(meeting(ecology, site))
    assert [found.site for found in this_machine.local_sites("home")] == ["a", "bb"]
    assert rendezvous.find("office", []) == ("office", [meeting("office", "ccc").endpoint, *usual_endpoints("office")])


def test_those_that_relay_are_found_and_no_process_of_the_others_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    for site, relays in (("a", True), ("bb", False), ("ccc", True)):
        this_machine.announce(replace(meeting(site=site), relays=relays))
    this_machine.announce(meeting("office"))
    gone = this_machine.announce(meeting(site="dddd", process=dead_process()))
    asked = processes_asked_for(monkeypatch)
    assert [found.site for found in this_machine.relaying_sites("home")] == ["a", "ccc"]
    assert len(asked) == 3
    assert not gone.exists()


def test_the_names_of_sites_are_looked_up_when_one_comes_or_leaves_and_once_a_second(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    clock = [1000.0]
    monkeypatch.setattr(this_machine.time, "monotonic", lambda: clock[0])
    process = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(60)"])
    first = this_machine.announce(meeting())
    this_machine.announce(meeting(site="bb", process=process.pid))
    names = this_machine.LocalSiteNames("home")
    asked = processes_asked_for(monkeypatch)
    assert [names() for _ in range(9)] == [("a", "bb")] * 9
    assert len(asked) == 2
    this_machine._write(replace(meeting(site="ccc"), started=start_time(os.getpid())))
    assert names() == ("a", "bb", "ccc")
    this_machine.leave(first)
    assert names() == ("bb", "ccc")
    process.kill()
    process.wait()
    clock[0] += 0.9 * this_machine.PROCESSES_ASKED_AGAIN
    assert names() == ("bb", "ccc")
    clock[0] += 0.2 * this_machine.PROCESSES_ASKED_AGAIN
    assert names() == ("ccc",)


def processes_asked_for(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """The processes of which it is asked from now on whether they are there."""
    asked, alive_since = list[int](), this_machine.alive_since
    monkeypatch.setattr(this_machine, "alive_since", lambda process: asked.append(process) or alive_since(process))
    return asked


def test_a_turn_that_another_site_holds_is_waited_for_but_not_for_ever() -> None:
    with this_machine.turn() as mine:
        assert mine
        with this_machine.turn(seconds=0.01) as theirs:
            assert not theirs
    with this_machine.turn(seconds=0.0) as mine:
        assert mine


def test_a_site_whose_process_number_another_process_has_by_now_is_gone() -> None:
    path = this_machine.announce(meeting())
    path.write_text(json.dumps({**json.loads(path.read_text()), "started": "1"}))
    assert this_machine.local_sites() == []
    assert not path.exists()


def test_a_site_that_does_not_say_when_its_process_began_is_known_by_its_number() -> None:
    path = this_machine.announce(meeting())
    body = json.loads(path.read_text())
    del body["started"]
    path.write_text(json.dumps(body))
    assert this_machine.local_sites() == [meeting()]


def test_a_file_that_is_older_than_the_process_of_its_number_is_that_of_another_process() -> None:
    path = this_machine.announce(meeting())
    body = json.loads(path.read_text())
    del body["started"]
    path.write_text(json.dumps(body))
    os.utime(path, (1e9, 1e9))
    assert this_machine.local_sites() == []
    assert not path.exists()


def test_a_site_whose_process_is_gone_is_passed_over_and_forgotten() -> None:
    path = this_machine.announce(meeting(process=dead_process()))
    assert this_machine.local_sites() == []
    assert not path.exists()


HUGE = '{"ecology": "home", "site": "x", "endpoint": "tcp/127.0.0.1:1", "process": 1000000000000000000000000000000}'


@pytest.mark.parametrize("text", ["", "{", "[]", "{}", "7", '{"ecology": "home"}', '{"process": "x"}', HUGE])
def test_a_file_that_is_no_meeting_is_passed_over(runtime_folder: Path, text: str) -> None:
    (runtime_folder / "home@x.json").write_text(text)
    this_machine.announce(meeting())
    assert this_machine.local_sites() == [meeting()]


def test_the_folder_is_ones_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("SELFCONF_RUNTIME_DIR")
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    assert this_machine.runtime_folder() == tmp_path / "selfconf"
    this_machine.announce(meeting())
    assert (tmp_path / "selfconf").stat().st_mode & 0o077 == 0
    monkeypatch.delenv("XDG_RUNTIME_DIR")
    assert str(os.getuid()) in this_machine.runtime_folder().name


def test_a_machine_without_a_folder_for_temporary_files_has_no_sites_and_its_tasks_have_their_names(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").touch()  # a folder in a file cannot be made, by root either
    monkeypatch.delenv("SELFCONF_RUNTIME_DIR")
    monkeypatch.delenv("XDG_RUNTIME_DIR", raising=False)
    monkeypatch.setattr(tempfile, "tempdir", None)
    monkeypatch.setattr(tempfile, "_candidate_tempdir_list", list)
    monkeypatch.setattr(this_machine, "_TEMPORARY", str(tmp_path / "file"))
    assert this_machine.local_sites() == []
    claimed = this_machine.claim("home", "patrol", [])
    assert claimed is not None
    claimed.release()
    with pytest.raises(NetworkError, match="set SELFCONF_RUNTIME_DIR to a folder of your own"):
        this_machine.announce(meeting())


def test_a_folder_of_another_user_is_neither_written_nor_read(
    runtime_folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    this_machine.announce(meeting())
    monkeypatch.setattr("os.getuid", lambda: runtime_folder.stat().st_uid + 1)
    assert this_machine.local_sites() == []
    with pytest.raises(NetworkError, match="belongs to another user"):
        this_machine.announce(meeting())


def test_the_file_is_plain_json(runtime_folder: Path) -> None:
    body = json.loads(this_machine.announce(meeting()).read_text())
    process = {"process": os.getpid(), "started": start_time(os.getpid())}
    assert body == {
        "ecology": "home",
        "site": "a",
        "endpoint": "tcp/127.0.0.1:7001",
        "relays": True,
        "log": "",
        "from_here": "",
        "served": [],
        **process,
    }


def test_the_name_of_a_living_site_is_taken() -> None:
    this_machine.announce(meeting(process=os.getppid()))
    with pytest.raises(NetworkError, match="runs on this machine already"):
        this_machine.announce(meeting())


def test_a_site_that_leaves_removes_no_file_of_another_process() -> None:
    path = this_machine.announce(meeting(process=os.getppid()))
    this_machine.leave(path)
    assert path.is_file()
    mine = this_machine.announce(meeting(site="bb"))
    this_machine.leave(mine)
    assert not mine.exists()


def test_a_name_that_is_claimed_is_free_again_when_it_is_released_or_its_process_ends(runtime_folder: Path) -> None:
    program = (
        "from selfconf.this_machine import claim; claimed = claim('home', 'patrol', []); print(claimed.name); input()"
    )
    with subprocess.Popen(
        [sys.executable, "-c", program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as other:
        assert other.stdout is not None
        assert other.stdout.readline() == "patrol\n"
        assert this_machine.claim("home", "patrol", []) is None
        with this_machine.claim("office", "patrol", []) or pytest.fail("none"):
            assert sorted(path.name for path in (runtime_folder / this_machine.CLAIMED).iterdir()) == [
                "home@patrol",
                "office@patrol",
            ]
        other.kill()
    claimed = this_machine.claim("home", "patrol", [])
    assert claimed is not None
    assert this_machine.claim("home", "patrol", []) is None
    claimed.release()
    claimed.release()
    assert list((runtime_folder / this_machine.CLAIMED).iterdir()) == []


def names_of_suspended(ecology: str, *endpoints: str) -> list[str]:
    """The names of the tasks that suspended programs run, as one sees them that has joined by some endpoints."""
    return [task.name for task in this_machine.suspended_tasks(ecology, endpoints)]


def test_a_suspended_program_is_seen_by_those_that_have_joined_where_it_has_until_it_goes_on_or_ends(
    runtime_folder: Path,
) -> None:
    (runtime_folder / this_machine.CLAIMED / "folder-of-a-site").mkdir(parents=True)
    (runtime_folder / this_machine.CLAIMED / "home@half-written").write_text('{"ecology": "home"')
    here, there, elsewhere = "tcp/127.0.0.1:7001", "tcp/127.0.0.1:7002", "tcp/127.0.0.1:7003"
    with this_machine.claim("home", "tidy", [here]) or pytest.fail("none"):  # which goes on
        with suspended_run("home", "patrol", here, there) as program:
            (task,) = this_machine.suspended_tasks("home", [there, elsewhere])
            assert (task.name, task.process) == ("patrol", program.pid)
            said = f"process {program.pid} of this machine, which runs the task 'patrol', is suspended; `kill -CONT"
            assert task.suspension().startswith(said)
            assert names_of_suspended("home", elsewhere) == names_of_suspended("office", here) == []
            program.send_signal(signal.SIGCONT)
            assert os.WIFCONTINUED(os.waitpid(program.pid, os.WCONTINUED)[1])
            assert names_of_suspended("home", here) == []
        assert (runtime_folder / this_machine.CLAIMED / "home@patrol").exists()  # it was killed
        assert names_of_suspended("home", here) == []


def test_a_suspended_process_that_has_by_now_the_number_of_one_that_ran_a_task_is_another(runtime_folder: Path) -> None:
    with suspended_run("home", "patrol", "tcp/127.0.0.1:7001"):
        path = runtime_folder / this_machine.CLAIMED / "home@patrol"
        path.write_text(json.dumps({**json.loads(path.read_text()), "started": "1"}))
        assert names_of_suspended("home", "tcp/127.0.0.1:7001") == []


def test_a_claim_that_is_refused_leaves_the_program_that_has_the_name_as_it_was_seen() -> None:
    with suspended_run("home", "patrol", "tcp/127.0.0.1:7001"):
        assert this_machine.claim("home", "patrol", ["tcp/127.0.0.1:7002"]) is None
        assert names_of_suspended("home", "tcp/127.0.0.1:7001") == ["patrol"]


def test_a_claim_that_follows_one_of_a_program_that_was_killed_says_nothing_of_that(runtime_folder: Path) -> None:
    path = runtime_folder / this_machine.CLAIMED / "home@patrol"
    path.parent.mkdir()
    path.write_text("x" * 1000)
    with this_machine.claim("home", "patrol", ["tcp/127.0.0.1:7001"]) or pytest.fail("none"):
        assert json.loads(path.read_text())["process"] == os.getpid()


def test_a_look_at_what_is_claimed_keeps_no_program_from_a_name(
    runtime_folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The file of a program that was killed is read; any lock on it would be in the way of the next claim."""
    with suspended_run("home", "patrol", "tcp/127.0.0.1:7001"):
        pass
    locked = list[object]()
    monkeypatch.setattr(fcntl, "flock", lambda *given: locked.append(given))
    this_machine.suspended_tasks("home", ["tcp/127.0.0.1:7001"])
    assert locked == []


def test_where_nothing_can_be_written_every_name_can_be_had(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", str(tmp_path / "file" / "runtime"))
    for _ in range(2):
        with this_machine.claim("home", "patrol", []) or pytest.fail("none") as claimed:
            assert claimed.name == "patrol"

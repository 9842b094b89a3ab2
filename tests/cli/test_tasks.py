"""`tasks`, `run --detach` and `stop TASK`: tasks with names, in real processes."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from selfconf import join
from selfconf.cli.tasks import code_of_tasks
from selfconf.protocol.codec import decode
from selfconf.protocol.messages import Notice
from tests.cli.command import run
from tests.cli.processes import Home
from tests.suspended_run import suspended_run

pytestmark = pytest.mark.process

ROOT = Path(__file__).resolve().parents[2]
CLOCK = str(ROOT / "examples" / "clock")
TEMPLATE = str(ROOT / "examples" / "clock" / "tell-the-time.ttl")


@pytest.fixture
def house(tmp_path: Path) -> Iterator[Home]:
    """An ecology of its own, which ends with the test."""
    home = Home(tmp_path)
    yield home
    home.close()


def test_a_task_that_runs_is_listed_by_its_name_and_stopped_by_it(
    house: Home, capsys: pytest.CaptureFixture[str]
) -> None:
    house.site("kitchen", CLOCK)
    where = house.arguments()
    assert run(capsys, "tasks", *where).out == f"there is no task in ecology {house.ecology}\n"
    program = house.selfconf("run", TEMPLATE, *where, "--format", "json", "--name", "noon", "--priority", "3")
    program.act("running")
    (task,) = run(capsys, "tasks", "--format", "json", *where).body
    assert (task["task"], task["priority"], task["phase"], task["detached"]) == ("noon", 3, "running", False)
    head = run(capsys, "tasks", *where).out.splitlines()[0].split()
    assert head[:4] == ["task", "priority", "phase", "age"]  # of the task: `status` says how long the phase has lasted
    again = run(capsys, "run", TEMPLATE, *where, "--name", "noon")
    assert again.is_one_sentence("a task 'noon' lives already")
    assert run(capsys, "stop", "midnight", *where).is_one_sentence("no task or configurator 'midnight' answers")
    assert run(capsys, "stop", "noon", *where).code == 0
    assert program.ended() == 0


def test_a_task_of_the_sites_may_be_called_like_a_site(house: Home, capsys: pytest.CaptureFixture[str]) -> None:
    house.site("kitchen", CLOCK)
    where = house.arguments()
    handed_over = house.selfconf("run", TEMPLATE, "--detach", "--name", "kitchen", *where)
    assert handed_over.ended() == 0, handed_over.complaints
    assert run(capsys, "stop", "kitchen", *where).code == 0


@pytest.mark.parametrize("command", ["tasks", "status"])
def test_no_command_says_that_there_is_no_task_where_a_run_of_this_machine_is_suspended(
    house: Home, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, command: str
) -> None:
    house.site("kitchen", CLOCK)
    where = house.arguments()
    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", str(house.runtime))
    with suspended_run(house.ecology, "noon", house.endpoint()) as program:
        said = f"process {program.pid} of this machine, which runs the task 'noon', is suspended;"
        for form, out in (("text", ""), ("json", "[]\n")):
            found = run(capsys, command, "--format", form, *where)
            assert (found.code, found.out, found.err.startswith(said)) == (2, out, True)
    assert run(capsys, command, *where).code == 0


@pytest.mark.parametrize("how", ["--detach", "--wait"])
def test_observers_learn_what_would_mend_a_task_that_waits_whatever_runs_it(
    house: Home, capsys: pytest.CaptureFixture[str], how: str
) -> None:
    house.site("kitchen", CLOCK)
    where = house.arguments()
    program = house.selfconf("run", TEMPLATE, how, "--bind", "room=:cellar", "--format", "json", *where)
    assert program.act("detached" if how == "--detach" else "waiting")

    def told() -> list[dict[str, Any]]:
        """The refusals that the configurator of the task tells observers."""
        notices = (decode(sample.payload, Notice) for sample in house.ask(house.keys.notices()).samples)
        return [notice.event["refusal"] for notice in notices if notice.event["act"] == "waiting"]

    assert house.until(lambda: any(refusal["repairs"] for refusal in told()))
    (refusal,) = told()
    outcome = run(capsys, "configure", TEMPLATE, "--bind", "room=:cellar", "--format", "json", *where)
    for facts, fact in (("repairs", "message"), ("near_misses", "component")):
        assert [one[fact] for one in refusal[facts]] == [one[fact] for one in outcome.body[facts]]
    assert run(capsys, "stop", *where).code == 0


def test_two_runs_of_one_template_have_names_of_their_own(house: Home, capsys: pytest.CaptureFixture[str]) -> None:
    house.site("kitchen", CLOCK)
    where = house.arguments()
    first = house.selfconf("run", TEMPLATE, *where, "--format", "json")
    first.act("running")
    second = house.selfconf("run", TEMPLATE, *where, "--format", "json", "--wait")
    second.act("waiting")
    assert "a task 'tell-the-time' lives already, so this one is 'tell-the-time-2'" in second.complaints
    tasks = run(capsys, "tasks", "--format", "json", *where).body
    assert [task["task"] for task in tasks] == ["tell-the-time", "tell-the-time-2"]
    assert run(capsys, "stop", "tell-the-time", *where).code == 0
    assert first.ended() == 0
    second.act("running")
    assert run(capsys, "stop", "tell-the-time-2", *where).code == 0
    assert second.ended() == 0


def test_runs_of_one_template_that_begin_at_once_have_names_of_their_own(
    house: Home, capsys: pytest.CaptureFixture[str]
) -> None:
    house.site("kitchen", CLOCK)
    where = house.arguments()
    runs = [house.selfconf("run", TEMPLATE, *where, "--format", "json", "--wait") for _ in range(3)]
    for program in runs:
        program.act("query")
    named = sorted(task["task"] for task in run(capsys, "tasks", "--format", "json", *where).body)
    assert named == ["tell-the-time", "tell-the-time-2", "tell-the-time-3"]


def test_a_detached_task_runs_without_the_command_that_began_it(
    house: Home, capsys: pytest.CaptureFixture[str]
) -> None:
    house.site("kitchen", CLOCK)
    where = house.arguments()
    outcome = run(capsys, "run", TEMPLATE, "--detach", "--format", "json", *where)
    assert (outcome.code, outcome.body["act"], outcome.body["task"]) == (0, "detached", "tell-the-time")

    def phases() -> list[tuple[str, bool]]:
        return [(task["phase"], task["detached"]) for task in run(capsys, "tasks", "--format", "json", *where).body]

    assert house.until(lambda: phases() == [("running", True)])
    assert run(capsys, "run", TEMPLATE, "--detach", *where).is_one_sentence("a task 'tell-the-time' lives already")
    assert run(capsys, "stop", "tell-the-time", *where).code == 0
    assert phases() == []


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no device that is always full")
@pytest.mark.parametrize(("form", "stream", "code"), [("text", "stderr", 0), ("json", "stdout", 2)])
def test_a_detached_task_of_which_nothing_can_be_written_is_not_said_to_have_failed(
    house: Home, form: str, stream: str, code: int
) -> None:
    house.site("kitchen", CLOCK)
    command = [sys.executable, "-m", "selfconf", "run", TEMPLATE, "--detach", *house.arguments()]
    with Path("/dev/full").open("w") as full:
        streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, stream: full}
        done = subprocess.run(
            [*command, "--format", form], env=house.environment, text=True, check=False, timeout=60.0, **streams
        )
    assert done.returncode == code
    if form == "json":
        said = "the task 'tell-the-time' lives in the sites now, but that cannot be written (No space left on device)"
        assert done.stderr == f"selfconf run: {said}\n"


def test_a_detached_task_that_no_site_can_keep_does_not_run(house: Home, capsys: pytest.CaptureFixture[str]) -> None:
    """As on a disk that is full: here a file stands where the folder of the tasks is to be."""
    (house.folder / "state").touch()
    house.site("kitchen", CLOCK, options=("--state", "state"))
    where = house.arguments()
    assert run(capsys, "run", TEMPLATE, "--detach", *where).is_one_sentence(
        "site kitchen cannot keep the task on its disk: Not a directory; mend that"
    )
    # A site looks every second what it is to run.
    assert not house.until(lambda: "tell-the-time" in run(capsys, "tasks", *where).out, 2.5)


def test_a_detached_task_needs_sites_that_are_there_already(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(capsys, "run", TEMPLATE, "--ads", CLOCK, "--detach").is_one_sentence(
        "a detached task lives in the sites"
    )


def test_what_a_project_file_begins_an_ecology_from_has_no_part_in_a_detached_task(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", str(tmp_path))
    for source in ('ads = ["."]', 'endpoint = "http://127.0.0.1:1/sparql"'):
        (tmp_path / "selfconf.toml").write_text(source)
        assert run(capsys, "run", TEMPLATE, "--detach").is_one_sentence("no site runs on this machine")


def test_a_run_of_this_machine_that_is_suspended_leaves_the_tasks_unknown(
    home: Home, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", str(home.runtime))
    home.site("attic", "ads")
    with join(home.ecology, connect=[home.endpoint()]) as living:
        assert living.tasks == ()
        assert code_of_tasks(living) == 0
        with suspended_run(home.ecology, "patrol", home.endpoint()):
            assert living.tasks == ()
            assert code_of_tasks(living) == 2
        assert living.tasks == ()
        assert code_of_tasks(living) == 0

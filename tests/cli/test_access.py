"""`access`: who may do what, in words; what a task needs; whose a component is. The rest is the table of attacks."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from selfconf.access import Principal, PrincipalKind, believed
from tests.cli.command import run
from tests.cli.processes import Home, component_of, dormant
from tests.harness.effort import of_keys
from tests.suspended_run import suspended_run

pytestmark = pytest.mark.process


@pytest.fixture(scope="module")
def running(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Home]:
    """The paper's task, run with keys by components that their site has started."""
    home = Home(tmp_path_factory.mktemp("keys"), keys=True)
    for name in ("sonar", "encoder", "tracker", "odometry", "control", "drive"):
        dormant(home, name)
    home.site("home", "ads")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SELFCONF_RUNTIME_DIR", str(home.runtime))
        task = home.run("--name", "walk")
        task.act("running")
        yield home
    home.close()


@pytest.fixture(scope="module")
def alice(running: Home) -> Path:
    """The keys of a reader."""
    assert running.authority is not None
    running.authority.issue(Principal(PrincipalKind.READER, "alice"), running.folder / "alice")
    return running.folder / "alice"


@pytest.fixture(autouse=True)
def its_keys(running: Home, monkeypatch: pytest.MonkeyPatch) -> None:
    """Commands of a test have the keys of the home."""
    monkeypatch.setenv("SELFCONF_KEYS", running.environment["SELFCONF_KEYS"])


def test_a_task_with_keys_is_repaired_and_nobody_is_refused(running: Home, capsys: pytest.CaptureFixture[str]) -> None:
    (running.folder / "tracker.fail").touch()
    assert running.until(lambda: "odometry" in running.active("odometry"))
    assert running.until(lambda: "running for" in run(capsys, "status", *running.arguments()).out)
    (site,) = run(capsys, "access", *running.arguments(), "--format", "json").body["sites"]
    assert site["refused"] == []
    shown = run(capsys, "access", *running.arguments())
    assert shown.code == 0
    assert f"({component_of('drive')}): speaks on its own outputs" in shown.out
    assert "conf.main: may run and stop tasks" in shown.out
    assert "refused: nothing" in shown.out


def test_a_task_says_whom_each_component_hears(running: Home, capsys: pytest.CaptureFixture[str]) -> None:
    body = run(capsys, "access", *running.arguments(), "--task", "walk", "--format", "json").body
    hears = {one["component"]: one["of"] for one in body["hears"]}
    assert hears[component_of("drive")] == [component_of("control")]
    assert hears[component_of("sonar")] == []
    assert "hears" in run(capsys, "access", *running.arguments(), "--task", "walk").out
    nobody = run(capsys, "access", *running.arguments(), "--task", "sleep")
    assert (nobody.code, nobody.out) == (1, "")


def test_a_task_of_a_run_that_is_suspended_is_not_taken_for_none(
    running: Home, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SELFCONF_RUNTIME_DIR", str(running.runtime))
    with suspended_run(running.ecology, "sleep", running.endpoint()) as program:
        found = run(capsys, "access", *running.arguments(), "--task", "sleep")
    suspended, none = found.err.splitlines()
    assert (found.code, found.out, none) == (2, "", "no configurator that answers runs a task 'sleep'")
    assert suspended.startswith(f"process {program.pid} of this machine, which runs the task 'sleep', is suspended;")


def test_a_reader_looks_on_and_is_told_that_it_may_do_no_more(
    running: Home, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    keys = ("--keys", str(tmp_path / "alice"))
    run(capsys, "keys", "issue", "read.alice", "--out", str(tmp_path / "alice"))
    assert "person-tracker" in run(capsys, "discover", *running.arguments(), *keys).out
    shown = run(capsys, "top", "--every", "0.1", "--format", "json", *running.arguments(), *keys).body["components"]
    assert {one["task"] for one in shown if one["component"] == component_of("drive")} == {"walk"}
    assert " live, 5 held by tasks" in run(capsys, "top", "--every", "0.1", *running.arguments(), *keys).out
    assert run(capsys, "stop", "walk", *running.arguments(), *keys).is_one_sentence("read.alice may look on only")


@pytest.mark.parametrize(
    ("command", "code", "words"),
    [
        (("discover",), 0, ("person-tracker", "walk", "takes keys of conf.NAME")),
        (("top", "--format", "json"), 0, ("person-tracker", '"task": "walk"', "takes keys of conf.NAME")),
        (("top", "--once"), 0, (" live, 5 held by tasks", "walk", "takes keys of conf.NAME")),
        (("status",), 0, ("running for",)),
        (("tasks",), 0, ("walk",)),
        (("why", "person-tracker"), 0, ("person-tracker", "walk")),
        (("query", "SELECT (COUNT(?c) AS ?n) { ?c a sc:Component }"), 0, ("7",)),
        (("echo", "person-tracker", "pose"), 2, ("keys of conf.NAME",)),
        (("run", "navigate.ttl", "--bind", "robot=:Astrid", "--bind", "goal=x"), 2, ("read.alice may look on only",)),
        (("site", "restart", "person-tracker"), 2, ("read.alice may look on only",)),
    ],
    ids=lambda value: value[0] if isinstance(value, tuple) else "",
)
@of_keys
def test_each_command_of_a_reader_shows_what_it_may_see_or_says_what_it_takes(
    command: tuple[str, ...], code: int, words: tuple[str, ...], running: Home, alice: Path
) -> None:
    program = running.selfconf(*command, *running.arguments(), "--keys", str(alice))
    said = program.rest()
    assert program.ended() == code, program.complaints
    assert all(word in said + program.complaints for word in words), said + program.complaints


@of_keys
def test_a_reader_that_uses_these_commands_is_accused_of_nothing(
    running: Home, alice: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (site,) = run(capsys, "access", *running.arguments(), "--format", "json").body["sites"]
    assert [one for one in site["refused"] if one["principal"] == "read.alice"] == []


def test_whose_a_component_is_is_noted(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run(capsys, "keys", "init", str(tmp_path / "keys"))
    said = run(capsys, "access", "--keys", str(tmp_path / "keys"), "--believe", "attic", "urn:lamp")
    assert said.code == 0
    assert said.out == f"programs with the folder {tmp_path / 'keys'} believe that urn:lamp is that of site attic\n"
    assert believed(tmp_path / "keys") == {"urn:lamp": "attic"}
    said = run(capsys, "access", "--keys", str(tmp_path / "keys"), "--believe", "attic", "lamp")
    assert said.is_one_sentence("write it in full")
    said = run(capsys, "access", "--keys", str(tmp_path / "keys"), "--believe", "", "urn:lamp")
    assert said.is_one_sentence("'' cannot name a site")  # of which it would be then, and so of none that there is
    assert believed(tmp_path / "keys") == {"urn:lamp": "attic"}


def test_without_keys_there_is_nothing_to_show(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    open_to_all = Home(tmp_path, keys=False)
    try:
        open_to_all.site("home", "ads")
        monkeypatch.setenv("SELFCONF_RUNTIME_DIR", str(open_to_all.runtime))
        monkeypatch.delenv("SELFCONF_KEYS", raising=False)
        assert run(capsys, "access", *open_to_all.arguments()).is_one_sentence("everybody who reaches it")
    finally:
        open_to_all.close()

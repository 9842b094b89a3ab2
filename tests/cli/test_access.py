"""`access`: who may do what, in words; what a task needs; whose a component is. The rest is the table of attacks."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from selfconf.access import believed
from tests.cli.command import run
from tests.cli.processes import Home, component_of, dormant

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


@pytest.fixture(autouse=True)
def its_keys(running: Home, monkeypatch: pytest.MonkeyPatch) -> None:
    """Commands of a test have the keys of the home."""
    monkeypatch.setenv("SELFCONF_KEYS", running.environment["SELFCONF_KEYS"])


def test_a_task_with_keys_is_repaired_and_nobody_is_refused(running: Home, capsys: pytest.CaptureFixture[str]) -> None:
    (running.folder / "tracker.fail").touch()
    assert running.until(lambda: "odometry" in running.active("odometry"))
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


def test_a_reader_looks_on_and_is_told_that_it_may_do_no_more(
    running: Home, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    keys = ("--keys", str(tmp_path / "alice"))
    run(capsys, "keys", "issue", "read.alice", "--out", str(tmp_path / "alice"))
    assert "person-tracker" in run(capsys, "discover", *running.arguments(), *keys).out
    assert run(capsys, "stop", "walk", *running.arguments(), *keys).is_one_sentence("read.alice may look on only")


def test_whose_a_component_is_is_noted(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run(capsys, "keys", "init", str(tmp_path / "keys"))
    said = run(capsys, "access", "--keys", str(tmp_path / "keys"), "--believe", "attic", "urn:lamp")
    assert said.code == 0
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

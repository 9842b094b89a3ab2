"""Insiders that turn bad, each a process of its own, against a task of real processes: nothing happens to it."""

from __future__ import annotations

import json
import signal
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from selfconf.access import HostAuthority, Principal, PrincipalKind, open_keys
from tests.access import intruder
from tests.access.attacks import refused
from tests.cli.command import run
from tests.cli.processes import Home, Program, component_of, dormant
from tests.harness.effort import of_keys

pytestmark = pytest.mark.process
TASK = ("sonar", "encoder", "tracker", "control", "drive")


@pytest.fixture(scope="module")
def attacked(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Home, Program]]:
    """The paper's task, with keys, by components that their site has started."""
    home = Home(tmp_path_factory.mktemp("attacked"), keys=True)
    for name in (*TASK, "odometry"):
        dormant(home, name)
    home.site(intruder.SITE, "ads")
    task = home.run()
    task.act("running")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SELFCONF_RUNTIME_DIR", str(home.runtime))
        patch.setenv("SELFCONF_KEYS", home.environment["SELFCONF_KEYS"])
        yield home, task
    home.close()


def folder_of(home: Home, kind: str) -> Path:
    """Good keys of a kind: of a component that is not in the task, or of a person or site that nobody has met."""
    assert home.authority is not None
    if kind == "comp":
        return HostAuthority(home.authority).component(Principal.component(component_of("pippi")))
    folder = home.folder / kind
    home.authority.issue(Principal(PrincipalKind(kind), "eve"), folder)
    return folder


@of_keys
@pytest.mark.parametrize("kind", sorted(intruder.MAY))
def test_an_insider_that_turns_bad_comes_to_nothing_and_is_named(
    kind: str, attacked: tuple[Home, Program], capsys: pytest.CaptureFixture[str]
) -> None:
    home, task = attacked
    folder = folder_of(home, kind)
    name = open_keys(folder).own().common_name
    assert home.until(lambda: home.active(*TASK) == set(TASK))
    before = {one: home.state(component_of(one)) for one in TASK}
    bad = home.program(sys.executable, "-m", "tests.access.intruder", kind, str(folder), home.ecology, home.endpoint())
    assert json.loads(bad.line() or "null") == [], bad.complaints
    tried = {
        (name, one.message, one.key(home.keys)) for one in map(intruder.ATTACKS.get, intruder.attempts(kind)) if one
    }

    def missing() -> set[tuple[str, str, str]]:
        return tried - set(refused(run(capsys, "access", *home.arguments(), "--format", "json").out))

    assert home.until(lambda: not missing()), missing()
    assert home.active(*TASK) == set(TASK)
    assert home.state(component_of("odometry")) is None, "nobody has woken it"
    for one in TASK:
        after = home.state(component_of(one))
        assert after is not None
        assert before[one] is not None
        assert (after.life, after.task) == (before[one].life, before[one].task)  # type: ignore[union-attr]  # looked at
    bad.end(signal.SIGKILL)
    assert not task.over


@of_keys
def test_the_task_has_noticed_nothing(attacked: tuple[Home, Program]) -> None:
    home, task = attacked
    (home.folder / "tracker.fail").touch()
    assert task.act("lost")["component"] == component_of("tracker"), "the first that was lost, and truly"
    task.act("running")

"""Tasks that change hands when something was lost: the next site neither gives up nor takes more than the first."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import pytest

from selfconf.bus.memory import Faults, MemoryBus
from selfconf.bus.port import Bus
from selfconf.configurator.state import Phase
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import TaskRecord
from selfconf.sdk.runtime.supervision import GRACE
from tests.deployment.keepers import RECORD, Keepers, keepers_in_turn
from tests.deployment.simulated import home, living_room
from tests.deployment.tasks import DRIVEN, SPARE, TASK
from tests.lab import Lab, request_for

DRIVES = partial(request_for, template=DRIVEN, bound=())
"""The request for a task for which either of two components will do."""


@pytest.mark.parametrize("ends", ["before", "after", "with its site"])
def test_the_next_site_has_what_was_lost_before_started_if_its_life_has_ended_meanwhile(
    tmp_path: Path, ends: str
) -> None:
    """The record of the task names the loss, with the life, which ends before or after the next site goes on."""
    lab = home(tmp_path, "odometry")
    room = living_room(lab, "1", lambda node: lab.component("tracker"))
    lab.component("tracker")
    keepers = Keepers(lab, tmp_path / "disks")
    keeper = keepers.settled()
    lab.components["tracker"].fail("lost")
    lab.let_pass(1.0)
    assert lab.active() == TASK | {"odometry"}
    keepers.end(keeper)
    lab.let_pass(2.0 if ends == "after" else 0.0)
    lab.crash("tracker")
    if ends == "with its site":
        room.close()
        lab.let_pass(2.0)
        living_room(lab, "2", lambda node: lab.component("tracker"))
    lab.let_pass(3.0)
    lab.components["odometry"].fail("wheels slip")
    lab.let_pass(1.0)
    assert lab.active() == TASK | {"tracker"}


def test_what_was_lost_and_ended_with_its_site_is_started_as_soon_as_that_is_back(tmp_path: Path) -> None:
    lab = home(tmp_path)
    room = living_room(lab, "1", lambda node: lab.component("tracker"))
    keepers = Keepers(lab, tmp_path / "disks")
    keeper = keepers.settled()
    lab.components["tracker"].fail("lost")
    lab.let_pass(0.02)
    keepers.end(keeper)
    lab.crash("tracker")
    room.close()
    lab.let_pass(3.0)
    assert not keepers.running()
    living_room(lab, "2", lambda node: lab.component("tracker"))
    assert lab.until(lambda: bool(keepers.running()), 1.0)
    assert lab.active() == TASK | {"tracker"}


def kept_beside_a_slow_tracker(tmp_path: Path) -> tuple[Keepers, str, Bus]:
    """A task that runs with odometry, the site that keeps it, and that of odometry.

    The tracker, which can take its place, is dormant, and takes longer to start than the grace of the components.
    """
    lab = home(tmp_path)
    cellar = lab.site("cellar", "odometry").bus
    lab.component("odometry")
    keepers = Keepers(lab, tmp_path / "disks")
    keepers.hand_over(RECORD)
    assert lab.until(lambda: bool(keepers.running()))
    (keeper,) = keepers.running()
    woken: list[MemoryBus] = []

    def wake(node: MemoryBus) -> None:
        if not woken:
            node.later(GRACE + 1.0, lambda: lab.component("tracker"))
        woken.append(node)

    living_room(lab, "1", wake)
    lab.let_pass(1.0)
    return keepers, keeper, cellar


@pytest.mark.parametrize("how", ["ended", "frozen"])
def test_nothing_else_stops_while_the_next_site_wakes_what_takes_the_place_of_another(tmp_path: Path, how: str) -> None:
    """That takes longer than the grace of the components; and the first site may be back before it is done."""
    keepers, keeper, cellar = kept_beside_a_slow_tracker(tmp_path)
    lab = keepers.lab
    said = {name: list(lab.components[name].said) for name in ("sonar", "encoder")}
    node = keepers.buses[keeper]
    assert isinstance(node, MemoryBus)
    cellar.close()
    lab.crash("odometry")
    if how == "ended":
        keepers.end(keeper)
    else:
        lab.network.pause(node)
    lab.let_pass(1.5)
    lab.network.resume(node)
    assert lab.until(lambda: lab.active() == TASK | {"tracker"}, 10.0)
    lab.let_pass(3.0)
    assert {name: list(lab.components[name].said) for name in said} == said
    assert lab.active() == TASK | {"tracker"}


@pytest.mark.parametrize("lives_anew", [False, True])
def test_the_next_site_does_without_what_had_failed_until_it_lives_anew(tmp_path: Path, lives_anew: bool) -> None:
    """The site ends in the midst of the repair, while what takes the place of the failed one is being started."""
    keepers, keeper, _ = kept_beside_a_slow_tracker(tmp_path)
    lab = keepers.lab
    failed = lab.components["odometry"]
    failed.fail("lost")
    lab.let_pass(0.5)
    keepers.end(keeper)
    if lives_anew:
        lab.crash("odometry")
        lab.component("odometry")
    awaited = "odometry" if lives_anew else "tracker"
    assert lab.until(lambda: lab.active() == TASK | {awaited}, 10.0)
    lab.let_pass(3.0)
    assert lab.active() == TASK | {awaited}
    assert failed.said.count(("started",)) == 1


def test_a_failure_that_nobody_heard_is_found_by_the_next_site(keepers: Keepers) -> None:
    keeper = keepers.settled()
    keepers.lab.isolate(keepers.keepers[keeper].runners[RECORD.task])
    keepers.lab.components["tracker"].fail("lost")
    keepers.lab.let_pass(0.01)
    keepers.end(keeper)
    assert keepers.lab.until(lambda: keepers.lab.active() == TASK | {"odometry"}, 5.0)
    assert [said for said in keepers.lab.components["tracker"].said if said == ("started",)] == [("started",)]


@pytest.mark.parametrize("keepers_are", ["one", "two"])
@pytest.mark.parametrize("priority", [0, 2])
@pytest.mark.parametrize("seed", range(3))
def test_a_task_that_has_lost_something_takes_nothing_from_one_that_changes_hands_with_it(
    tmp_path: Path, keepers_are: str, priority: int, seed: int
) -> None:
    """A site ends that runs both, and with it a component of the one that has begun first."""
    lab = Lab(tmp_path, seed, Faults(most_delay=0.1), SPARE)
    lab.site("shared", *SPARE)
    lab.component("right")
    keepers = Keepers(lab, tmp_path / "disks", DRIVES)
    named = {task: keepers_in_turn(task, "shared", *"abc") for task in (f"task~{number}" for number in range(99))}
    (first, (ended, next_of_first)), *rest = ((t, sites) for t, sites in named.items() if "shared" not in sites)
    second = next(
        task for task, (keeper, then) in rest if keeper == ended and (then == next_of_first) == (keepers_are == "one")
    )
    keepers.hand_over(TaskRecord(first, 1, beginning=5.0))
    assert lab.until(lambda: lab.active() == {"right"})
    lab.component("left")
    keepers.hand_over(TaskRecord(second, 1, beginning=6.0, priority=priority))
    assert lab.until(lambda: lab.active() == {"left", "right"})
    lab.let_pass(5.0)
    keepers.end(ended)
    lab.crash("right")
    lab.let_pass(10.0)
    assert lab.components["left"].said == [("started",)]
    tasks = {task: runner for keeper in keepers.keepers.values() for task, runner in keeper.runners.items()}
    assert tasks[second].state.phase is Phase.RUNNING
    assert tasks[first].state.phase is Phase.REFUSED
    keepers.hand_over(TaskRecord(second, 100, ended=True))
    assert lab.until(lambda: tasks[first].state.phase is Phase.RUNNING), "it has waited for what the other has held"


@pytest.mark.parametrize("seconds", [1.05, 1.5, 2.0, 4.0])
def test_a_site_that_hears_of_a_failure_as_it_wakes_gives_up_nothing_that_the_next_one_runs(
    keepers: Keepers, seconds: float
) -> None:
    """The FAIL came while it was frozen, and lies before it now, when nothing else reaches it yet."""
    keeper = keepers.settled()
    network, node = keepers.lab.network, keepers.buses[keeper]
    assert isinstance(node, MemoryBus)
    said = {name: list(keepers.lab.components[name].said) for name in TASK}
    network.pause(node)
    keepers.lab.let_pass(0.3)
    keepers.lab.components["tracker"].fail("lost")
    keepers.lab.let_pass(seconds - 0.3)
    network.resume(node)
    keepers.lab.let_pass(5.0)
    assert {name: list(keepers.lab.components[name].said) for name in TASK} == said
    assert (keepers.running(), keepers.lab.active()) == ([keeper], TASK | {"odometry"})
    assert len({encode(one.folder.records[RECORD.task]) for one in keepers.keepers.values()}) == 1

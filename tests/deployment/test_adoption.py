"""Tasks that change hands: another site goes on with what one has run, and nothing stops."""

from __future__ import annotations

import random
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from selfconf.bus.memory import Faults, MemoryBus
from selfconf.configurator import ApplyTo
from selfconf.configurator.state import Phase
from selfconf.deployment import RunRequest, TaskRunner
from selfconf.deployment.configuration_record import recorded_configuration
from selfconf.deployment.keeper import KEEPER_AGAIN, keeper_of
from selfconf.errors import TemplateError
from selfconf.model.configuration import Configuration
from selfconf.protocol.messages import TaskRecord
from selfconf.sdk.inputs import Inputs
from tests.deployment.keepers import RECORD, Keepers, keepers_in_turn
from tests.deployment.tasks import DRIVEN, TASK
from tests.faults.ecologies import COMPOSED
from tests.lab import Lab, iri, request_for

DRIVES = partial(request_for, template=DRIVEN, bound=())
"""The request for a task for which either of two components will do."""


def test_the_next_site_goes_on_without_stopping_anything(keepers: Keepers) -> None:
    keeper = keepers.settled()
    said = {name: list(recorder.said) for name, recorder in keepers.lab.components.items()}
    keepers.end(keeper)
    assert keepers.lab.until(lambda: bool(keepers.running()), 0.9)
    keepers.lab.let_pass(5.0)
    assert {name: list(recorder.said) for name, recorder in keepers.lab.components.items()} == said
    assert keepers.lab.active() == TASK | {"tracker"}
    keepers.lab.components["tracker"].fail("lost")
    assert keepers.lab.until(lambda: keepers.lab.active() == TASK | {"odometry"})


@pytest.mark.parametrize("ends", ["", "tracker"])
def test_the_next_site_goes_on_with_what_lives_though_no_site_advertises_it_any_more(tmp_path: Path, ends: str) -> None:
    """The site that advertises it ends with the first, and has not started it; what has ended as well is missed."""
    lab = Lab(tmp_path)
    astrid = lab.site("astrid", *TASK, "tracker")
    for name in (*TASK, "tracker"):
        lab.component(name)
    keepers = Keepers(lab, tmp_path / "disks")
    keeper = keepers.settled()
    said = {name: list(recorder.said) for name, recorder in lab.components.items()}
    keepers.end(keeper)
    lab.crash(astrid)
    if ends:
        lab.crash(ends)
    lab.let_pass(10.0)
    if ends:
        assert not lab.active()
        assert not keepers.running()
        lab.component(ends)
    else:
        assert {name: list(recorder.said) for name, recorder in lab.components.items()} == said
    lab.site("astrid", *TASK, "tracker")
    assert lab.until(lambda: bool(keepers.running()) and lab.active() == TASK | {"tracker"})


@pytest.mark.parametrize("repaired", [False, True])
@pytest.mark.parametrize("how", ["frozen", "cut off"])
@pytest.mark.parametrize("seconds", [1.1, 1.5, 2.0, 5.0, 15.0])
def test_a_site_that_was_away_goes_on_again_without_stopping_anything(
    keepers: Keepers, seconds: float, how: str, repaired: bool
) -> None:
    """While it was away the next site went on with the task, and perhaps repaired it."""
    keeper = keepers.settled()
    network, node = keepers.lab.network, keepers.buses[keeper]
    assert isinstance(node, MemoryBus)
    others = [one for one in network.nodes if one is not node and one.open]
    if how == "frozen":
        network.pause(node)
    else:
        for other in others:
            network.cut(node, other)
    keepers.lab.let_pass(seconds - 0.1)
    if repaired:
        keepers.lab.components["tracker"].fail("lost")
    keepers.lab.let_pass(0.1)
    said = {name: list(recorder.said) for name, recorder in keepers.lab.components.items()}
    if how == "frozen":
        network.resume(node)
    else:
        for other in others:
            network.reconnect(node, other)
    keepers.lab.let_pass(5.0)
    assert {name: list(recorder.said) for name, recorder in keepers.lab.components.items()} == said
    assert keepers.running() == [keeper]
    assert keepers.lab.active() == TASK | {"odometry" if repaired else "tracker"}


def test_a_site_that_wakes_goes_on_with_a_task_if_the_one_that_runs_it_ends_in_that_moment(keepers: Keepers) -> None:
    """As long as it is cut off it seems to be the only site, and would find that nothing is there."""
    keeper = keepers.settled()
    woken = keeper_of(RECORD.task, {*"abc"} - {keeper})
    keepers.end(*({*"abc"} - {keeper, woken}))
    said = {name: list(recorder.said) for name, recorder in keepers.lab.components.items()}
    node = keepers.buses[woken]
    assert isinstance(node, MemoryBus)
    keepers.lab.network.pause(node)
    keepers.lab.let_pass(5.0)
    keepers.lab.network.resume(node)
    keepers.lab.let_pass(0.3)
    keepers.end(keeper)
    assert keepers.lab.until(lambda: keepers.running() == [woken], 0.9)
    keepers.lab.let_pass(5.0)
    assert {name: list(recorder.said) for name, recorder in keepers.lab.components.items()} == said


def test_of_two_records_of_one_revision_that_counts_by_which_the_components_act(keepers: Keepers) -> None:
    keeper = keepers.settled()
    record, runner = keepers.keepers[keeper].folder.records[RECORD.task], keepers.keepers[keeper].runners[RECORD.task]
    keepers.hand_over(replace(record, epoch=record.epoch - 1, lost=()))
    keepers.lab.let_pass(1.0)
    assert keepers.keepers[keeper].runners[RECORD.task] is runner
    keepers.hand_over(replace(record, epoch=record.epoch + 1))
    assert keepers.lab.until(lambda: keepers.keepers[keeper].runners.get(RECORD.task) not in (None, runner))
    assert keepers.lab.until(lambda: keepers.running() == [keeper])
    assert keepers.lab.active() == TASK | {"tracker"}


def test_the_next_site_goes_on_in_time_though_it_has_lost_its_hub_with_the_first(
    keepers: Keepers, monkeypatch: pytest.MonkeyPatch
) -> None:
    keeper, lab = keepers.settled(), keepers.lab
    said = {name: list(recorder.said) for name, recorder in lab.components.items()}
    link, waits = MemoryBus.link, lab.network.time + 0.1
    assert isinstance(link, property)
    (first, second) = (bus for name, bus in keepers.buses.items() if name != keeper)

    def linked(bus: MemoryBus) -> str:
        cut_off = bus in (first, second) and lab.network.time < waits
        return "" if cut_off else str(link.__get__(bus))

    monkeypatch.setattr(MemoryBus, "link", property(linked))
    keepers.end(keeper)
    assert lab.until(lambda: bool(keepers.running()), 0.5)
    lab.let_pass(5.0)
    assert {name: list(recorder.said) for name, recorder in lab.components.items()} == said


def test_the_next_site_goes_on_though_its_clock_is_behind(keepers: Keepers) -> None:
    first = keeper_of(RECORD.task, "abc")
    keepers.end(first)
    keepers.ahead[first] = 300.0
    keepers.begin(first)
    keepers.lab.let_pass(1.0)
    keepers.hand_over(RECORD)
    assert keepers.lab.until(lambda: keepers.running() == [first])
    assert keepers.keepers[first].runners[RECORD.task].state.epoch >= 300_000
    keepers.lab.crash("drive")
    assert keepers.lab.until(lambda: keepers.keepers[first].runners[RECORD.task].state.phase is Phase.REFUSED)
    keepers.end(first)
    keepers.lab.let_pass(3.0)  # the next one has begun anew, and waits
    keepers.lab.component("drive")
    assert keepers.lab.until(lambda: keepers.lab.active() == TASK | {"tracker"}, 5.0)


def test_a_site_that_comes_and_is_to_run_the_task_gets_it_from_the_one_that_has_it(keepers: Keepers) -> None:
    first = keeper_of(RECORD.task, "abc")
    keepers.end(first)
    keepers.hand_over(RECORD)
    assert keepers.lab.until(lambda: bool(keepers.running()))
    keepers.lab.let_pass(1.0)
    said = {name: list(recorder.said) for name, recorder in keepers.lab.components.items()}
    keepers.begin(first)
    assert keepers.lab.until(lambda: keepers.running() == [first])
    assert {name: list(recorder.said) for name, recorder in keepers.lab.components.items()} == said


def test_no_component_is_without_a_configurator_while_a_task_goes_to_the_site_that_comes(keepers: Keepers) -> None:
    first = keeper_of(RECORD.task, "abc")
    keepers.end(first)
    keepers.hand_over(RECORD)
    assert keepers.lab.until(lambda: bool(keepers.running()))
    keepers.lab.let_pass(1.0)
    keepers.begin(first)
    without = [0.0]
    while keepers.running() != [first]:
        keepers.lab.let_pass(0.01)
        without.append(without[-1] + 0.01 if keepers.lab.runtimes["drive"].supervision.gone else 0.0)
        assert keepers.lab.network.time < 60.0
    assert max(without) < 0.15  # of a second after which it comes to rest


def test_a_task_stays_where_it_runs_if_the_site_that_is_to_run_it_cannot_read_it(keepers: Keepers) -> None:
    first = keeper_of(RECORD.task, "abc")
    keepers.end(first)
    keepers.hand_over(RECORD)
    assert keepers.lab.until(lambda: bool(keepers.running()))
    running, said = keepers.running(), {name: list(one.said) for name, one in keepers.lab.components.items()}

    def unreadable(record: TaskRecord) -> RunRequest:
        raise TemplateError("a term that only newer programs know")

    keepers.request_for = unreadable
    keepers.begin(first)
    keepers.lab.let_pass(10.0)
    assert keepers.running() == running
    assert {name: list(one.said) for name, one in keepers.lab.components.items()} == said


def following(folder: Path, seed: int) -> tuple[Keepers, str, str, str]:
    """A task that needs a composite and runs, its name, the site that runs it, and the next one."""
    lab = Lab(folder, seed, Faults(most_delay=0.1), COMPOSED.advertisements)
    for site, names in COMPOSED.sites.items():
        lab.site(site, *names)
    for name in COMPOSED.processes:
        lab.component(name)
    keepers = Keepers(lab, folder / "disks", partial(request_for, template=COMPOSED.whole, bound=()))
    sites = (*COMPOSED.sites, *"abc")
    task = next(
        one
        for one in (f"task~{number}" for number in range(99))
        if not {*keepers_in_turn(one, *sites)} & {*COMPOSED.sites}
    )
    keepers.hand_over(TaskRecord(task, 1, beginning=5.0))
    assert lab.until(lambda: bool(keepers.running()))
    lab.let_pass(3.0)
    return keepers, task, *keepers_in_turn(task, *sites)


@pytest.mark.parametrize("seed", range(3))
def test_who_follows_a_composite_goes_on_when_the_next_site_goes_on(tmp_path: Path, seed: int) -> None:
    keepers, _, keeper, _ = following(tmp_path, seed)
    lab = keepers.lab
    drive, said = lab.components["drive"], list(lab.components["drive"].said)
    lost: list[str] = []
    inputs = lab.runtimes["drive"].inputs
    assert isinstance(inputs, Inputs)
    for one in inputs._inputs.values():
        one._events = replace(one._events, unfed=lost.append)
    keepers.end(keeper)
    lab.let_pass(10.0)
    assert (lost, drive.said) == ([], said)
    lab.components["tracker-1"].emit("track", "here")
    drive.ask("start")
    lab.let_pass(1.0)
    assert sorted(drive.said[len(said) :]) == [("position", "here"), ("start", "answered", iri("tracker-1"))]


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("after", [0.15, 0.2, 0.25, 0.3])
def test_nothing_stops_when_the_first_site_is_back_while_the_next_one_takes_over(
    tmp_path: Path, seed: int, after: float
) -> None:
    """The calls of that one are on their way when it lets go of the task, or are held back."""
    keepers, task, first, following_one = following(tmp_path, seed)
    lab = keepers.lab
    said = {name: list(recorder.said) for name, recorder in lab.components.items()}
    keepers.end(first)
    assert lab.until(lambda: task in keepers.keepers[following_one].runners)
    between = keepers.keepers[following_one].runners[task]
    lab.let_pass(after)
    keepers.begin(first)
    assert lab.until(lambda: between.state.ended, 1.0)
    calls: list[ApplyTo] = []
    between._components.calls._apply = calls.append  # type: ignore[method-assign]
    lab.let_pass(10.0)
    assert {name: list(recorder.said) for name, recorder in lab.components.items()} == said
    assert (keepers.running(), calls) == ([first], [])


def test_the_time_to_go_on_with_tasks_does_not_grow_with_their_square(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    named = [f"task~{n}" for n in range(99) if "shared" not in keepers_in_turn(f"task~{n}", "shared", *"abc")][:12]
    many = {f"drive-{n}": f":drive-{n} a sc:Component, :Drive ; sc:shareable false ." for n in range(len(named))}
    lab = Lab(tmp_path, advertised=many)
    lab.site("shared", *many)
    for name in many:
        lab.component(name)
    keepers = Keepers(lab, tmp_path / "disks", DRIVES)
    for number, task in enumerate(named):
        keepers.hand_over(TaskRecord(task, 1, beginning=float(number)))
    assert lab.until(lambda: lab.active() == {*many}, 60.0)
    lab.let_pass(5.0)
    name, ended = max(keepers.keepers.items(), key=lambda one: len(one[1].runners))
    tasks, read = {*ended.runners}, list[object]()
    assert len(tasks) > 2

    def counted(record: Mapping[str, Any]) -> Configuration:
        read.append(record)
        return recorded_configuration(record)

    monkeypatch.setattr("selfconf.deployment.keeper.recorded_configuration", counted)
    keepers.end(name)
    lab.let_pass(5.0)
    assert tasks <= {task for one in keepers.keepers.values() for task in one.runners}
    assert len(read) <= 3 * len(tasks), "of what others go on with at the same moment some is read as well"
    assert all(recorder.said == [("started",)] for recorder in lab.components.values())


@pytest.mark.parametrize("seed", [3, 19, 65])
def test_several_configurators_that_begin_one_task_in_the_same_moment_settle_at_once(tmp_path: Path, seed: int) -> None:
    """Of those that find another one in their way none leaves reservations behind by which others are in the way."""
    lab, chance = Lab(tmp_path, seed, Faults(most_delay=0.005)), random.Random(seed)
    lab.navigation()
    lab.let_pass(2.5)
    begun: list[TaskRunner] = []

    def begin(number: int) -> None:
        node = lab.network.node()
        request = replace(request_for(RECORD), ended=lambda _: node.later(KEEPER_AGAIN, partial(begin, number)))
        name, clock = f"agent{number}-{len(lab.network.nodes)}", lambda: lab.network.time
        begun.append(TaskRunner(node, "lab", request, name, clock, RECORD.task, RECORD.beginning))
        begun[-1].start()

    for number in range(3):
        lab.network.node().later(chance.uniform(0.0, 0.02), partial(begin, number))
    assert lab.until(lambda: any(one.state.phase is Phase.RUNNING for one in begun), 0.5)
    assert lab.active() == TASK | {"tracker"}

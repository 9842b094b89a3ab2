"""Tasks that live in the sites: who runs them, and how they change hands."""

from __future__ import annotations

import itertools
import logging
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from selfconf.bus.memory import Faults, MemoryBus
from selfconf.bus.port import Bus, Replies, Request, Undo, Urgency
from selfconf.configurator import ApplyTo
from selfconf.configurator.state import Phase
from selfconf.deployment import Keeper, RunRequest, TaskFolder
from selfconf.deployment.configuration_record import recorded_configuration
from selfconf.deployment.keeper import ASKED_AT_ONCE, keeper_of
from selfconf.model.configuration import Configuration
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.messages import TaskRecord
from selfconf.sdk.runtime.supervision import GRACE
from tests.deployment.simulated import home, living_room
from tests.deployment.tasks import DRIVEN, SPARE, TASK
from tests.faults.ecologies import COMPOSED
from tests.lab import Lab, iri, request_for

RECORD = TaskRecord("patrol~1", 1, priority=1, beginning=5.0)
DRIVES = partial(request_for, template=DRIVEN, bound=())
"""The request for a task for which either of two components will do."""


class Keepers:
    """The paper's ecology, with a keeper at each of three more sites."""

    def __init__(self, lab: Lab, folder: Path, request_for: Callable[[TaskRecord], RunRequest] = request_for) -> None:
        self.lab, self.folder, self.request_for = lab, folder, request_for
        self.buses: dict[str, Bus] = {}
        self.keepers: dict[str, Keeper] = {}
        self.ahead: dict[str, float] = {}
        """By how many seconds the clock of a site is ahead of the others, from when it begins on."""
        for name in ("a", "b", "c"):
            self.begin(name)
        lab.let_pass(0.1)

    def begin(self, name: str) -> None:
        """Start a site that keeps tasks, with the disk that it had."""
        bus = self.buses[name] = self.lab.network.node()
        kept, ahead = TaskFolder(self.folder / name), self.ahead.get(name, 0.0)
        self.keepers[name] = Keeper(bus, "lab", name, kept, self.request_for, lambda: self.lab.network.time + ahead)
        bus.announce(self.lab.keys.site_life(name, f"{name}{len(self.lab.network.nodes)}"))

    def end(self, name: str) -> None:
        """End a site as kill -9 does."""
        del self.keepers[name]
        self.buses[name].close()

    def hand_over(self, record: TaskRecord) -> None:
        """Give a record to all sites, as `run --detach` does."""
        self.lab.network.node().ask(self.lab.keys.keep(), encode(record), 1.0, lambda replies: None)

    def running(self) -> list[str]:
        """The sites that run the task."""
        return [
            name
            for name, keeper in self.keepers.items()
            if any(runner.state.phase is Phase.RUNNING for runner in keeper.runners.values())
        ]

    def settled(self) -> str:
        """Give the record to all sites, and return the one that has run its task for a second."""
        self.hand_over(RECORD)
        assert self.lab.until(lambda: bool(self.running()))
        self.lab.let_pass(1.0)
        (keeper,) = self.running()
        return keeper


@pytest.fixture
def keepers(lab: Lab, tmp_path: Path) -> Keepers:
    """Three sites that keep tasks."""
    return Keepers(lab, tmp_path / "disks")


def test_the_keeper_is_the_same_for_all_and_few_tasks_move_when_a_site_goes() -> None:
    tasks = [f"t~{number}" for number in range(200)]
    before = {task: keeper_of(task, ["a", "b", "c"]) for task in tasks}
    after = {task: keeper_of(task, ["c", "a"]) for task in tasks}
    assert set(before.values()) == {"a", "b", "c"}
    assert all(after[task] == site for task, site in before.items() if site != "b")
    assert keeper_of("t", []) == ""


def test_a_task_that_is_handed_over_runs_at_one_site_and_is_kept_by_all(keepers: Keepers) -> None:
    keepers.hand_over(RECORD)
    assert keepers.lab.until(lambda: bool(keepers.running()))
    keepers.lab.let_pass(2.0)
    assert keepers.running() == [keeper_of(RECORD.task, "abc")]
    assert {name: list(k.folder.records) for name, k in keepers.keepers.items()} == {
        name: [RECORD.task] for name in "abc"
    }


def test_a_site_sleeps_that_keeps_no_task_and_a_task_wakes_it(
    keepers: Keepers, monkeypatch: pytest.MonkeyPatch
) -> None:
    keepers.lab.let_pass(3.0)
    bus, looks = keepers.buses["a"], []
    later = bus.later

    def counted(seconds: float, action: Callable[[], None]) -> Undo:
        looks.append(keepers.lab.network.time)
        return later(seconds, action)

    monkeypatch.setattr(bus, "later", counted)
    keepers.lab.let_pass(10.0)
    assert not looks
    keepers.settled()
    assert looks


@pytest.fixture
def asked(keepers: Keepers, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The keys of the questions that the site a asks."""
    bus, keys = keepers.buses["a"], list[str]()
    ask = bus.ask

    def noted(key: str, payload: bytes, seconds: float, done: Callable[[Replies], None]) -> None:
        keys.append(key)
        ask(key, payload, seconds, done)

    monkeypatch.setattr(bus, "ask", noted)
    return keys


def test_sites_that_come_are_asked_at_once_and_once_more_but_of_many_most_are_asked_later(
    keepers: Keepers, asked: list[str]
) -> None:
    def begin(*numbers: int) -> list[str]:
        for number in numbers:
            keepers.begin(f"s{number}")
        return [keepers.lab.keys.kept_tasks(f"s{number}") for number in numbers]

    keepers.lab.let_pass(3.0)
    asked.clear()
    few = begin(*range(5))
    keepers.lab.let_pass(0.5)
    assert asked == few
    keepers.lab.let_pass(5.0)
    assert sorted(asked) == sorted(2 * few)
    asked.clear()
    many = begin(*range(5, 30))
    keepers.lab.let_pass(0.5)
    assert sorted(asked) == sorted(many[:ASKED_AT_ONCE])
    keepers.lab.let_pass(5.0)
    assert sorted(asked) == sorted(many + many[:ASKED_AT_ONCE])


def test_of_several_that_come_the_one_that_does_not_answer_is_asked_again(keepers: Keepers, asked: list[str]) -> None:
    answering = {"x", "z"}

    def answer(site: str, request: Request) -> None:
        if site in answering:
            request.finish()

    keys = keepers.lab.keys
    for site in ("x", "y", "z"):
        node = keepers.lab.network.node()
        node.serve(keys.kept_tasks(site), partial(answer, site))
        node.announce(keys.site_life(site, "1"))
    keepers.lab.let_pass(8.0)
    asked.clear()
    keepers.lab.let_pass(10.0)
    assert {*asked} == {keys.kept_tasks("y")}
    answering.add("y")
    keepers.lab.let_pass(4.0)
    asked.clear()
    keepers.lab.let_pass(10.0)
    assert not asked


def test_a_record_that_is_known_is_not_read_again_and_one_that_is_outdated_is_answered(
    keepers: Keepers, monkeypatch: pytest.MonkeyPatch
) -> None:
    keepers.settled()
    record = keepers.keepers["a"].folder.records[RECORD.task]
    read, told = list[bytes](), list[bytes]()

    def noted(payload: bytes, kind: type[TaskRecord]) -> TaskRecord:
        read.append(payload)
        return decode(payload, kind)

    monkeypatch.setattr("selfconf.deployment.keeper.decode", noted)
    node = keepers.lab.network.node()
    node.subscribe(keepers.lab.keys.task(), lambda sample: told.append(sample.payload), Urgency.EVENT)
    node.publisher(keepers.lab.keys.task(RECORD.task), Urgency.EVENT).put(encode(record))
    keepers.lab.let_pass(1.0)
    assert not read
    told.clear()
    node.publisher(keepers.lab.keys.task(RECORD.task), Urgency.EVENT).put(encode(RECORD))
    keepers.lab.let_pass(1.0)
    assert encode(record) in told
    assert {*read} == {encode(RECORD)}


def test_while_all_sites_find_each_other_again_hardly_another_takes_a_task(
    keepers: Keepers, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each sees the others come one by one; only where the last that is missing has the task, the next one takes it."""
    for name in "defgh":
        keepers.begin(name)
    keeper, begun = keepers.settled(), list[str]()
    run = Keeper._run

    def noted(self: Keeper, record: TaskRecord) -> None:
        begun.append(self.site)
        run(self, record)

    monkeypatch.setattr(Keeper, "_run", noted)
    network = keepers.lab.network
    nodes = [bus for bus in keepers.buses.values() if isinstance(bus, MemoryBus)]
    assert len(nodes) == 8
    others = [node for node in network.nodes if node not in nodes]
    pairs = [*itertools.combinations(nodes, 2), *itertools.product(nodes, others)]
    for left, right in pairs:
        network.cut(left, right)
    keepers.lab.let_pass(0.05)
    for left, right in pairs:
        network.reconnect(left, right)
        keepers.lab.let_pass(0.05 if right in nodes else 0.0)
    keepers.lab.let_pass(5.0)
    assert len(begun) <= 1
    assert keepers.running() == [keeper]


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


def test_a_failure_that_nobody_heard_is_found_by_the_next_site(keepers: Keepers) -> None:
    keeper = keepers.settled()
    keepers.lab.isolate(keepers.keepers[keeper].runners[RECORD.task])
    keepers.lab.components["tracker"].fail("lost")
    keepers.lab.let_pass(0.01)
    keepers.end(keeper)
    assert keepers.lab.until(lambda: keepers.lab.active() == TASK | {"odometry"}, 5.0)
    assert [said for said in keepers.lab.components["tracker"].said if said == ("started",)] == [("started",)]


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


def test_after_all_sites_were_restarted_the_task_comes_back_from_their_disks(keepers: Keepers) -> None:
    keepers.hand_over(RECORD)
    assert keepers.lab.until(lambda: bool(keepers.running()))
    for name in "abc":
        keepers.end(name)
    keepers.lab.let_pass(5.0)
    assert keepers.lab.active() == set()
    for name in "abc":
        keepers.begin(name)
    assert keepers.lab.until(lambda: bool(keepers.running()))
    assert keepers.lab.until(lambda: keepers.lab.active() == TASK | {"tracker"})


def test_a_site_that_hears_the_others_and_was_not_heard_as_it_asked_them_is_told_what_has_ended(
    keepers: Keepers,
) -> None:
    network, lone = keepers.lab.network, keepers.buses["b"]
    keepers.hand_over(RECORD)
    assert keepers.lab.until(lambda: bool(keepers.running()))
    assert isinstance(lone, MemoryBus)
    others = [node for node in network.nodes if node is not lone]
    for node in others:
        network.cut(lone, node)
    keepers.lab.let_pass(0.1)
    ended = encode(replace(RECORD, revision=9, ended=True))
    keepers.buses["a"].ask(keepers.lab.keys.keep(), ended, 1.0, lambda replies: None)
    keepers.lab.let_pass(0.1)
    for node in others:
        network.reconnect(lone, node)
        network.mute(lone, node)
    keepers.lab.let_pass(3.0)
    assert not keepers.keepers["b"].folder.records[RECORD.task].ended
    for node in others:
        network.reconnect(lone, node)
    keepers.lab.let_pass(3.0)
    assert all(one.folder.records[RECORD.task].ended for one in keepers.keepers.values())


def keepers_in_turn(task: str, *sites: str) -> tuple[str, str]:
    """Which site is to run a task, and which one after its end."""
    first = keeper_of(task, sites)
    return first, keeper_of(task, {*sites} - {first})


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
    lab.runtimes["drive"].inputs._events = replace(lab.runtimes["drive"].inputs._events, unfed=lost.append)
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
    between._calls._apply = calls.append  # type: ignore[method-assign]
    lab.let_pass(10.0)
    assert {name: list(recorder.said) for name, recorder in lab.components.items()} == said
    assert (keepers.running(), calls) == ([first], [])


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
    tasks[second].stop()
    assert lab.until(lambda: tasks[first].state.phase is Phase.RUNNING), "it has waited for what the other has held"


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


def test_a_task_that_was_ended_comes_to_rest_and_does_not_come_back(keepers: Keepers) -> None:
    keepers.hand_over(RECORD)
    assert keepers.lab.until(lambda: bool(keepers.running()))
    keepers.hand_over(TaskRecord(RECORD.task, 100, ended=True))
    assert keepers.lab.until(lambda: not keepers.lab.active())
    keepers.end("a")
    keepers.begin("a")
    keepers.lab.let_pass(5.0)
    assert (keepers.running(), keepers.lab.active()) == ([], set())


def test_a_site_that_was_cut_off_when_it_began_hears_later_of_the_task_that_it_is_to_run(keepers: Keepers) -> None:
    first = keeper_of(RECORD.task, "abc")
    keepers.end(first)
    keepers.hand_over(RECORD)
    assert keepers.lab.until(lambda: bool(keepers.running()))
    keepers.begin(first)
    late = keepers.lab.network.nodes[-1]
    others = keepers.lab.network.nodes[:-1]
    for other in others:
        keepers.lab.network.cut(late, other)
    keepers.lab.let_pass(5.0)
    assert not keepers.keepers[first].folder.records
    for other in others:
        keepers.lab.network.reconnect(late, other)
    assert keepers.lab.until(lambda: keepers.running() == [first])
    assert keepers.lab.until(lambda: keepers.lab.active() == TASK | {"tracker"})


def test_a_task_that_cannot_be_read_keeps_no_site_from_its_other_tasks(
    keepers: Keepers, monkeypatch: pytest.MonkeyPatch
) -> None:
    def request_or_not(record: TaskRecord) -> RunRequest:
        if record.task != RECORD.task:
            raise OSError("no space left on the device")
        return request_for(record)

    for keeper in keepers.keepers.values():
        monkeypatch.setattr(keeper, "_request_for", request_or_not)
    keepers.hand_over(TaskRecord("another~1", 1))
    keepers.lab.let_pass(3.0)
    keepers.hand_over(RECORD)
    assert keepers.lab.until(lambda: bool(keepers.running()))


def test_what_a_site_cannot_keep_of_what_others_send_is_said_to_people_once(
    keepers: Keepers, caplog: pytest.LogCaptureFixture
) -> None:
    publisher = keepers.lab.network.node().publisher(keepers.lab.keys.task("odd~1"), Urgency.EVENT)
    with caplog.at_level(logging.ERROR):
        for payload in (b"{", b"{", b"["):
            publisher.put(payload)
            keepers.lab.let_pass(0.1)
    said = [record.getMessage() for record in caplog.records if "does not keep the task" in record.getMessage()]
    assert len(said) == 2 * len(keepers.keepers)
    assert all(keepers.lab.keys.task("odd~1") in one for one in said)


def test_a_task_whose_configuration_cannot_be_read_begins_anew_and_that_is_said(
    keepers: Keepers, caplog: pytest.LogCaptureFixture
) -> None:
    with caplog.at_level(logging.ERROR):
        keepers.hand_over(replace(RECORD, configuration={"nonsense": 1}, epoch=3))
        assert keepers.lab.until(lambda: len(keepers.running()) == 1)
    assert "the task patrol~1 begins anew, as its configuration is not to be read" in caplog.text

"""Tasks that want the same components at once: nobody blocks, somebody wins, no actuator acts on a part."""

from __future__ import annotations

from pathlib import Path
from random import Random
from statistics import median

import pytest

from selfconf.configurator.state import Phase
from selfconf.deployment.retries import TRY_AGAIN
from selfconf.model.configuration import Configuration
from tests.faults.contention import SENSORS, Contention, Settled
from tests.harness.effort import NIGHTLY, examples

SEEDS = 1_000 if NIGHTLY else examples(4)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One folder of advertisements for all contentions."""
    return tmp_path_factory.mktemp("contentions")


def begun(seed: int, folder: Path, patient: bool, priorities: bool) -> Contention:
    """Two to eight tasks that begin at once."""
    return Contention(seed, folder, 2 + seed % 7, patient, priorities)


def deprived(contention: Contention) -> list[str]:
    """The tasks that do not run, although they could without what tasks of the same or a higher priority hold."""
    found = {a.profile.component: a for a in contention.shelf.advertisements.values()}
    names = []
    for agent in contention.agents:
        if agent.state.phase is not Phase.RUNNING:
            taken = {
                runtime.profile.component
                for runtime in contention.lab.runtimes.values()
                for hold in runtime.activation.holds
                if hold.claim.priority >= agent.identity.priority
            }
            if isinstance(agent.request.compose(found, frozenset(taken), None), Configuration):
                names.append(agent.name)
    return names


@pytest.mark.slow
@pytest.mark.parametrize("patient", [True, False], ids=["patient", "hasty"])
@pytest.mark.parametrize("priorities", [False, True], ids=["equal", "ranked"])
def test_of_tasks_that_begin_at_once_some_run_and_none_acts_on_a_part(
    priorities: bool, patient: bool, folder: Path
) -> None:
    settled: list[Settled] = []
    for seed in range(SEEDS):
        contention = begun(seed, folder, patient, priorities)
        settled.append(contention.settle())
        said = f"seed {seed}: {settled[-1]}"
        assert settled[-1].running, said
        assert not settled[-1].undecided, said
        assert not contention.wrong, said + "\n" + "\n".join(contention.wrong[:5])
        if patient:  # a hasty task that is refused does not come back when what it lacked is free again
            assert not deprived(contention), said
    assert median(one.seconds for one in settled) < 0.1


@pytest.mark.parametrize(
    ("seed", "priorities"),
    [
        pytest.param(34, True, id="what a task does not wait for any more is not taken from another for it"),
        pytest.param(157, True, id="what is kept for a task stays free for it until it has the rest"),
    ],
)
def test_nobody_waits_for_the_time_at_which_tasks_look_again(seed: int, priorities: bool, folder: Path) -> None:
    assert begun(seed, folder, True, priorities).settle().seconds < TRY_AGAIN / 4


@pytest.mark.slow
@pytest.mark.parametrize("priorities", [False, True], ids=["equal", "ranked"])
@pytest.mark.parametrize("seed", range(max(1, SEEDS // 8)))
def test_tasks_that_wait_run_one_after_the_other_as_others_end(seed: int, priorities: bool, folder: Path) -> None:
    contention = begun(seed, folder, True, priorities)
    ran: set[str] = set()
    for _ in contention.agents:
        running = contention.settle().running
        ran.update(running)
        for agent in contention.agents:
            if agent.name in running:
                agent.stop()
    assert len(ran) == len(contention.agents)
    assert not contention.wrong


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4 * SEEDS))
def test_of_tasks_that_wait_for_the_same_the_one_that_began_first_runs_first(seed: int, folder: Path) -> None:
    """They want components that all become free at once, in whatever order, and can have any of the drives."""
    contention, chance = Contention(seed, folder, 0, True, False), Random(seed)
    contention.begin(0, range(SENSORS), True, 0)
    contention.settle(1.0)
    shared = chance.randrange(SENSORS)
    for number in range(1, chance.randint(3, 5)):
        wanted = chance.sample(range(SENSORS), chance.randint(1, SENSORS))
        contention.begin(number, wanted if shared in wanted else [*wanted, shared], True, 0)
        contention.settle(1.0)
    holder, oldest, *_ = contention.agents
    holder.stop()
    assert contention.settle(3.0).running == [oldest.name]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "value", "seed", "wrong"),
    [
        ("selfconf.sdk.runtime.waiting_tasks.YIELDING", 0.0, 116, "acts for"),
        ("selfconf.protocol.activation._blocked", lambda *_: False, 0, "is held for"),
        ("selfconf.configurator.phases.resting_waves", lambda wires, left: (tuple(left),), 20, "acts for"),
        ("selfconf.configurator.deploying._may_begin", lambda *_: True, 0, "is started before"),
    ],
    ids=["taken without asking", "held by all", "all rest at once", "all start at once"],
)
def test_a_rule_that_is_broken_on_purpose_is_noticed(
    name: str, value: object, seed: int, wrong: str, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """From a seed on at which it once was; what is changed later may shift by a little at which one it is."""
    monkeypatch.setattr(name, value)
    for each in range(seed, seed + 70):
        contention = begun(each, folder, True, True)
        contention.settle(3.0)
        if any(wrong in what for what in contention.wrong):
            return
    pytest.fail("nothing was noticed")

"""Hundreds of histories in which everything goes wrong; at every step of each the invariants hold.

How to play one again is said at the head of `tests/faults/replay.py`.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.faults.actions import Actions
from tests.faults.ecologies import COMPOSED, PAPER, FaultyEcology
from tests.faults.histories import SETTLED, History
from tests.faults.replay import account, played, shrink, told
from tests.faults.script import KINDS, Action, Recipe, Script, write
from tests.faults.watch import ENDS, STEPS
from tests.harness.effort import NIGHTLY, batches, examples

HISTORIES = 10_000 if NIGHTLY else examples(750)  # 300 for every push
BUSY = HISTORIES // 5
"""In so many of these, code is busy or hangs on; at night so many more."""
BATCH = 20


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One folder of advertisements for all histories."""
    return tmp_path_factory.mktemp("advertisements")


def play_well(recipe: Recipe, folder: Path) -> None:
    """Play a history in which nothing may be wrong; else say how to play it again."""
    history = played(recipe.script, folder / recipe.ecology.name)
    assert not history.broken, told(recipe, history)


@pytest.mark.slow
@pytest.mark.parametrize("batch", batches(HISTORIES if NIGHTLY else HISTORIES - BUSY, BATCH, usual=2))
def test_no_history_breaks_an_invariant(batch: int, folder: Path) -> None:
    for seed in range(batch, batch + BATCH):
        play_well(Recipe(seed, COMPOSED if seed % 4 == 3 else PAPER, large=seed % 3 == 2), folder)


@pytest.mark.slow
@pytest.mark.parametrize("batch", batches(BUSY, BATCH))
def test_no_history_in_which_code_is_busy_or_hangs_on_breaks_an_invariant(batch: int, folder: Path) -> None:
    """As components do that somebody has started by hand: nothing ends them."""
    for seed in range(batch, batch + BATCH):
        play_well(Recipe(seed, COMPOSED if seed % 4 == 3 else PAPER, busy=True), folder)


@pytest.mark.parametrize(
    ("seed", "ecology"),
    [
        pytest.param(102905, COMPOSED, id="what stood behind an output rests, and is replaced late"),
        pytest.param(106261, COMPOSED, id="what stood behind an output is released, as the inside begins anew"),
        pytest.param(103267, COMPOSED, id="who calls from inside is told while the task outside looks anew"),
        pytest.param(104138, PAPER, id="a task that waits looks again at the end, with slow components"),
        pytest.param(403221, COMPOSED, id="what was frozen goes on, after another life of it was released"),
        pytest.param(501893, COMPOSED, id="what an input follows was never in reach, and promises no rate"),
        pytest.param(408769, COMPOSED, id="an inside that has come to rest hears late that a component is released"),
        pytest.param(615203, COMPOSED, id="an answer of before the task began anew comes just before that of after"),
        pytest.param(618476, PAPER, id="a source is released that was thought to be dead, and its sink is kept"),
        pytest.param(704721, PAPER, id="a slow component is called, and another life of it answers at once"),
        pytest.param(408360, PAPER, id="a site is back while the others are asked, before lives are followed"),
        pytest.param(742181, PAPER, id="an actuator is in `started` for longer than it may be blind"),
        pytest.param(930019, COMPOSED, id="what is outside changes while the inside is repaired"),
        pytest.param(5001337, COMPOSED, id="the answer of what a task has reserved is lost, as another component ends"),
        pytest.param(403772, PAPER, id="a site is cut off after its answer, while another has not answered"),
        pytest.param(9308178, PAPER, id="a life that has ended since answers an earlier call when the next is held"),
        pytest.param(997001605, PAPER, id="what has crashed, and one task waits for, another has its site end"),
    ],
)
def test_a_history_that_was_broken_once_is_not_any_more(seed: int, ecology: FaultyEcology, folder: Path) -> None:
    play_well(Recipe(seed, ecology), folder)


@pytest.mark.parametrize(
    "seed",
    [
        pytest.param(31003940, id="a task waits whose clock is behind, for what is slow to start"),
        pytest.param(51000070, id="two tasks take turns with an actuator that takes too long to start"),
    ],
)
def test_a_large_history_with_busy_code_that_was_broken_once_is_not_any_more(seed: int, folder: Path) -> None:
    play_well(Recipe(seed, busy=True, large=True), folder)


def test_a_history_is_replayed_by_its_seed(folder: Path) -> None:
    one, other = (played(write(7), folder) for _ in range(2))
    assert account(one) == account(other)
    assert [life.recorder.said for life in one.lives] == [life.recorder.said for life in other.lives]


def test_a_history_lasts_until_all_that_waits_has_come_and_each_fifth_to_the_end(folder: Path) -> None:
    quiet, late, fifth = (History(Script(seed, tasks=write(0).tasks), folder) for seed in (1, 1, 5))
    came: list[float] = []
    late.network.after(SETTLED - 1.0, lambda: came.append(late.network.time))
    for history in (quiet, late, fifth):
        history.run()
        assert not history.broken
    assert quiet.network.time < SETTLED / 2
    assert came
    assert min(late.network.time, fifth.network.time) > SETTLED


def test_every_kind_of_action_can_be_done_and_some_of_them_are_in_the_first_scripts(folder: Path) -> None:
    written = {action.kind for seed in range(300) for action in write(seed, ecology=COMPOSED).actions}
    assert written == set(KINDS)
    assert all(callable(getattr(Actions, f"_{kind}")) for kind in KINDS)


def test_an_action_that_is_not_possible_does_nothing(folder: Path) -> None:
    history = History(Script(0, tasks=write(0).tasks), folder)
    impossible = [
        Action(0.0, "start", "drive"),
        Action(0.0, "start_site", "astrid"),
        Action(0.0, "rejoin", "drive"),
        *(Action(0.0, kind, "task-1", "drive") for kind in ("crash_task", "stop_task", "cut", "mute", "mend", "pause")),
    ]
    assert not any(map(history.perform, impossible))


@pytest.mark.slow
def test_a_history_that_goes_wrong_is_shrunk_to_what_is_needed(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A component that is deaf to the end of its supervisor acts for nobody."""
    monkeypatch.setattr("selfconf.sdk.runtime.supervision.GRACE", 1e9)
    seed = next(seed for seed in range(100) if played(write(seed), folder).watch.names)
    script = shrink(write(seed), folder)
    assert 1 < len(script.actions) < len(write(seed).actions)
    history = played(script, folder)
    assert "nobody acts for nobody" in history.watch.names
    for number in range(len(script.actions)):
        less = Script(
            seed,
            script.ecology,
            script.faults,
            tasks=script.tasks,
            actions=script.actions[:number] + script.actions[number + 1 :],
        )
        assert "nobody acts for nobody" not in played(less, folder).watch.names


def test_invariants_have_names_of_their_own_and_say_what_they_are_about() -> None:
    names = [invariant.name for invariant in (*STEPS, *ENDS)]
    assert len(set(names)) == len(names)
    assert all(invariant.conditions.__doc__ for invariant in (*STEPS, *ENDS))

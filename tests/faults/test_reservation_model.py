"""The scheme by which tasks reserve components, over every interleaving; and that each of its rules is needed."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.faults.exploration import Bounds, Findings, explore
from tests.faults.reservation_state import Claim, Mask, Scheme
from tests.harness.effort import examples, thorough

STATES = 20_000 * examples(100) // 100
"""How many states of a case are explored at most; at night fifty times as many."""
ENOUGH = 10_000
"""States of a case among which is what goes wrong without a rule."""


def components(letters: str) -> Mask:
    """A set of components, each a letter; `a` comes first in the order."""
    return sum(1 << "abcdefgh".index(letter) for letter in letters)


def claim(*targets: str, priority: int = 0, patient: bool = True, actuators: str = "", dormant: str = "") -> Claim:
    """What a task wants; by default the last component of its first target is an actuator."""
    acting = components(actuators or targets[0][-1])
    return Claim(tuple(map(components, targets)), priority, patient, acting, components(dormant))


HASTY = {"patient": False}
ONE_TARGET = [claim("ab"), claim("ab")]
ONE_TARGET_URGENT = [claim("abc"), claim("abc", priority=1)]
RING = [claim("ab"), claim("bc"), claim("ac")]
CHAIN = [claim("bc"), claim("ab"), claim("a")]
STARTING = [claim("abc", dormant="c"), claim("abd", priority=1, dormant="d")]
YIELDING = [claim("bc", "ac"), claim("ac", actuators="a"), claim("b", priority=1)]

CASES: dict[str, list[Claim]] = {
    "two tasks with one target": ONE_TARGET,
    "two tasks with one target, one urgent": ONE_TARGET_URGENT,
    "three tasks in a ring": RING,
    "three tasks in a ring, the last urgent": [claim("ab"), claim("bc", priority=1), claim("ac", priority=2)],
    "three tasks in a ring, the first urgent": [claim("ab", priority=2), claim("bc", priority=1), claim("ac")],
    "a task that waits in the way of a third": CHAIN,
    "a task that yields and has an alternative": YIELDING,
    "three tasks with alternatives": [claim("cd", "ad"), claim("ac", actuators="a"), claim("bc", "ab", priority=1)],
    "two tasks with one target that is started": [claim("ab", dormant="a")] * 2,
    "the first of two has to start what only it wants": [claim("abc", dormant="c"), claim("ab")],
    "the second of two has to start what only it wants": [claim("ab"), claim("abc", dormant="c")],
    "one of two that start something is urgent": STARTING,
    "three tasks in a ring that start something": [
        claim("abd", dormant="d"),
        claim("bc"),
        claim("ac", dormant="a"),
    ],
    "three hasty tasks with one target": [claim("abc", **HASTY)] * 3,
    "three hasty tasks in a ring": [claim("ab", **HASTY), claim("bc", **HASTY), claim("ac", **HASTY)],
    "hasty tasks with alternatives": [claim("cd", "ad", **HASTY), claim("ac", "bd", actuators="a", **HASTY)],
    "hasty and patient tasks": [
        claim("cd", "ad", **HASTY),
        claim("ac", "bc", actuators="a"),
        claim("bd", "ab", actuators="b", **HASTY),
    ],
}
BOTH = "a crash and a false suspicion"
FAULTS = {
    "a crash": Bounds(crashes=1),
    "a false suspicion": Bounds(cuts=1),
    "a preemption": Bounds(preemptions=1),
    BOTH: Bounds(crashes=1, cuts=1),
}


def check(found: Findings) -> None:
    """Nothing is wrong, or the actions that lead there are shown."""
    assert not found.wrong, "\n".join(f"{name}:\n    " + "\n    ".join(way) for name, way in found.wrong.items())


@pytest.mark.parametrize("case", CASES)
def test_no_interleaving_acts_on_part_or_blocks(case: str) -> None:
    check(explore(CASES[case], bounds=Bounds(states=STATES)))


@pytest.mark.parametrize("case", ["two tasks with one target", "three tasks in a ring"])
def test_waiting_tasks_run_when_running_ones_end(case: str) -> None:
    check(explore(CASES[case], bounds=Bounds(states=STATES, ends=True)))


@pytest.mark.slow
@pytest.mark.parametrize("faults", [BOTH, *(pytest.param(one, marks=thorough) for one in FAULTS if one != BOTH)])
@pytest.mark.parametrize(
    "claims",
    [ONE_TARGET, [claim("ab"), claim("ab", priority=1)], CHAIN, YIELDING, STARTING],
    ids=["equal", "urgent", "chain", "yielding", "starting"],
)
def test_after_a_fault_nothing_acts_on_part_and_nobody_waits_in_vain(claims: list[Claim], faults: str) -> None:
    check(explore(claims, bounds=replace(FAULTS[faults], states=STATES)))


@pytest.mark.parametrize(
    ("rule", "claims", "bounds", "wrong"),
    [
        ("one_by_one", ONE_TARGET, Bounds(), "livelock"),
        ("asks_to_yield", ONE_TARGET_URGENT, Bounds(), "acts on part"),
        ("rests_first", ONE_TARGET_URGENT, Bounds(), "acts on part"),
        ("tells_waiting", CHAIN, Bounds(), "deadlock"),
        ("keeps_order", YIELDING, Bounds(), "deadlock"),
        ("offers_end", [claim("a"), claim("ab"), claim("b")], Bounds(cuts=1), "deadlock"),
        ("asks_again", ONE_TARGET, Bounds(cuts=1), "deadlock"),
        ("asks_again", ONE_TARGET, Bounds(cuts=1), "acts on part"),
    ],
)
def test_each_rule_is_needed(rule: str, claims: list[Claim], bounds: Bounds, wrong: str) -> None:
    without = replace(Scheme(), **{rule: False})
    assert wrong in explore(claims, without, replace(bounds, states=ENOUGH)).wrong

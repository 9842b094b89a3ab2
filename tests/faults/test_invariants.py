"""Every invariant of the histories is broken on purpose, by a change of the code, and it is noticed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from selfconf.bus.memory import Faults
from selfconf.composites import InsideOfComposite
from selfconf.configurator import losing
from selfconf.configurator.deploying import Reaction
from selfconf.configurator.effects import ReleaseFrom
from selfconf.configurator.events import Answered, Call
from selfconf.configurator.state import Loss, State
from selfconf.deployment.components.calling import Calling
from selfconf.deployment.components.calls import Calls
from selfconf.model.run_event import ComponentLost, RunEvent
from selfconf.model.term import IRI
from selfconf.protocol.activation import ActivationPhase, ActivationStep
from selfconf.protocol.messages import Apply, Verdict, Wire
from selfconf.sdk.component_code import ComponentCode
from selfconf.sdk.inputs import Inputs
from selfconf.sdk.operations import NeededOperations
from selfconf.sdk.runtime import ComponentRuntime
from tests.faults.ecologies import COMPOSED, LATCHED, PAPER, FaultyEcology
from tests.faults.histories import History
from tests.faults.script import PERIOD, Action, Script, TaskPlan
from tests.faults.watch import ENDS, NOTED, STEPS
from tests.lab import iri

CLAIM, FOLLOW, SET, START = Calling.claim, Inputs.follow, ComponentCode._set, ComponentCode._start
LOSE = losing.lose
FOLLOW_CALLS, REPORT = NeededOperations.follow, InsideOfComposite._report
LATER = Action(20.0, "emit", "sonar")
"""Until then the faults go on."""


def nothing(*_: Any) -> None:
    """Do nothing, whatever was to be done."""


def claims_to_release(self: Calls, effect: ReleaseFrom) -> None:
    """A configurator that counts a component as released without a call."""
    self._step(Answered(effect.component, Call.RELEASE, effect.epoch, Verdict.DONE))


def means_any_life(self: Calling, *arguments: Any) -> Any:
    """A configurator whose calls name no life, as those of an older one."""
    return {**CLAIM(self, *arguments), "life": ""}


def follows_once(self: Inputs, message: Apply) -> None:
    """A component that keeps its first connections."""
    if not self.followed:
        FOLLOW(self, message)


def sets_late(self: ComponentCode, *arguments: Any) -> str | None:
    """A component that is told its parameters after it was started."""
    return START(self, *arguments) or SET(self, self._values)


def lets_go_silently(self: ComponentRuntime, tasks: Sequence[str], why: str) -> None:
    """A component that does not tell that it has let go of a task, as an older one."""
    self._drop(tasks)
    self._when_at_rest(self._waiting.offer)


def calls_a_stranger(self: NeededOperations, message: Apply) -> None:
    """A component that calls one that it is not connected to."""
    FOLLOW_CALLS(self, message)
    self._wires = {name: (Wire(iri("odometry"), "where()"),) for name in self._wires}


def fails_at_once(self: InsideOfComposite, beginning: int, event: RunEvent) -> None:
    """A composite that fails when a component inside of it is lost."""
    REPORT(self, beginning, event)
    if isinstance(event, ComponentLost):
        self.runtime.fail("something inside of it is lost")


def follows_new_sources_late(self: Inputs, message: Apply) -> None:
    """A component that lets go of what it follows at once, and follows what it is told a second later."""
    if message.gently and message.inputs:
        self.end()
        self._bus.later(1.0, lambda: FOLLOW(self, message))
    else:
        FOLLOW(self, message)


def forgets_what_ran(state: State, component: IRI, loss: Loss) -> Reaction:
    """A configurator that searches anew when a change for the better fails."""
    return LOSE(replace(state, fallback=None), component, loss)


def breaks(*_: Any) -> None:
    """A program with a mistake in it."""
    raise RuntimeError("a mistake")


class Mutation(NamedTuple):
    """A change of the code, and what happens then."""

    changes: dict[str, Any]
    actions: tuple[Action, ...] = ()
    faults: Faults = Faults()
    ecology: FaultyEcology = PAPER
    upgrades: bool = False


INPUTS = "selfconf.sdk.inputs.Inputs"
AUDITS, CALLING, CALLS, LIVENESS = (
    f"selfconf.deployment.components.{name}" for name in ("audits", "calling", "calls", "liveness")
)
RUNTIME = "selfconf.sdk.runtime.ComponentRuntime"
GRACE = "selfconf.sdk.runtime.supervision.GRACE"
RELEASES_NOTHING = Mutation({f"{CALLS}.Calls.release": claims_to_release}, (Action(2.0, "crash", "drive"),))
RESERVES_NOTHING = Mutation({f"{CALLS}.Calls.reserve": nothing})
SHARES_ALL = {
    "selfconf.protocol.activation._blocked": lambda *_: False,
    "selfconf.deployment.task_discovery.ask_holders": lambda bus, keys, name, answered, kept: answered({}),
}
SILENT = {f"{AUDITS}.Audits.go_on": nothing, f"{RUNTIME}._let_go": lets_go_silently}
"""Nobody tells, and nobody asks, whether a component has let go."""
LETS_GO_SILENTLY = Mutation(
    {
        **SILENT,
        "selfconf.deployment.task_discovery.ask_holders": lambda bus, keys, name, answered, kept: answered({}),
    },
    (Action(2.0, "begin", "task-3"), Action(4.0, "mute", "task-1", "control"), LATER),
)
"""What has let go of one task is taken by another."""
SECOND = Action(2.0, "begin", "task-2")
BETTER = (Action(0.0, "crash", "tracker"), Action(5.0, "start", "tracker"))
"""The tracker would rather be had than odometry."""
MUTATIONS = {
    "one life acts": Mutation(
        {
            f"{RUNTIME}._outlived": nothing,
            f"{CALLING}.Calling.claim": means_any_life,
        },
        (Action(1.0, "crash", "drive"), Action(2.0, "twins", "drive")),
    ),
    "nobody acts for nobody": Mutation({GRACE: 1e9}, (Action(2.0, "crash_task", "task-1"),)),
    "who acts is known": RELEASES_NOTHING,
    "running means running": Mutation(SILENT, (LATER,), Faults(most_event_delay=2.0)),
    "each runs with its own": Mutation(SHARES_ALL, (SECOND,)),
    "held is known": RELEASES_NOTHING,
    "nobody obeys two": Mutation(SHARES_ALL, (SECOND, Action(4.0, "fail", "tracker"))),
    "no actuator acts on part": LETS_GO_SILENTLY,
    "nobody heeds a stranger": LETS_GO_SILENTLY,
    "no actuator acts blind": Mutation(
        {"selfconf.sdk.component_code.TOLERATES": 1e9}, (Action(2.0, "mute", "control", "drive"), LATER)
    ),
    "who hangs has failed": Mutation({f"{RUNTIME}.hung": nothing}, (Action(0.0, "slow", "drive", "", 12.0),)),
    "what waits is bounded": Mutation({f"{AUDITS}.AUDIT": 0.05, f"{CALLING}.CALL": 100.0}),
    "every task is soon decided": RESERVES_NOTHING,
    "every task is decided": RESERVES_NOTHING,
    "nobody waits in vain": Mutation(
        {
            "selfconf.deployment.components.component_messages.ComponentMessages._freed": nothing,
            "selfconf.deployment.retries.RetriesWhileRefused._try_again": nothing,
        },
        (SECOND, Action(4.0, "stop_task", "task-1")),
    ),
    "what acts is wanted": RELEASES_NOTHING,
    "wired as composed": Mutation(
        {"selfconf.sdk.inputs.Inputs.follow": follows_once}, (Action(2.0, "fail", "tracker"),)
    ),
    "parameters are set": Mutation({"selfconf.sdk.component_code.ComponentCode._set": nothing}),
    "parameters come first": Mutation(
        {
            "selfconf.sdk.component_code.ComponentCode._set": nothing,
            "selfconf.sdk.component_code.ComponentCode._start": sets_late,
        }
    ),
    "the last signal is heard": Mutation({"selfconf.sdk.inputs.input_subscription.InputSubscription._read": nothing}),
    "who calls is connected": Mutation(
        {
            "selfconf.sdk.operations.NeededOperations.follow": calls_a_stranger,
            f"{RUNTIME}.callers": lambda self, operation: frozenset((iri("drive"), iri("screen"))),
        },
        (Action(2.0, "begin", "task-3"), Action(5.0, "ask", "drive")),
        ecology=COMPOSED,
    ),
    "a composite tries first": Mutation(
        {"selfconf.composites.inside_of_composite.InsideOfComposite._report": fails_at_once},
        (Action(2.0, "crash", "camera-1"),),
        ecology=COMPOSED,
    ),
    "what is needed is answered": Mutation(
        {"selfconf.sdk.operations.NeededOperations._ask": nothing}, ecology=COMPOSED
    ),
    "nothing rests for nothing": Mutation(
        {"selfconf.sdk.inputs.source_watch.SourceWatch._ask_if_lost": nothing},
        (Action(2.0, "mute", "planner", "mower"), Action(3.0, "mend", "planner", "mower")),
        ecology=LATCHED,
    ),
    "an upgrade starves nobody": Mutation({f"{INPUTS}.follow": follows_new_sources_late}, BETTER, upgrades=True),
    "what is new delivers first": Mutation(
        {"selfconf.sdk.inputs.signal_input.SignalInput._fed_by": lambda self: frozenset()},
        (*BETTER, Action(5.5, "hush", "tracker"), LATER),
        upgrades=True,
    ),
    "what runs on does not stop": Mutation(
        {"selfconf.protocol.activation._START": dict.fromkeys(ActivationPhase, ActivationStep.RESTART)},
        (*BETTER, LATER),
        upgrades=True,
    ),
    "a failed upgrade leaves what ran": Mutation(
        {"selfconf.configurator.losing.lose": forgets_what_ran},
        (*BETTER, Action(5.5, "refuse", "tracker"), LATER),
        upgrades=True,
    ),
    "the better is reached": Mutation(
        {"selfconf.deployment.improvement.Improvement.settle": nothing}, BETTER, upgrades=True
    ),
    "nothing breaks": Mutation({f"{LIVENESS}.Liveness._ended": breaks}, (Action(2.0, "crash", "pippi"),)),
}


def played(mutation: Mutation, folder: Path, seed: int = 1) -> History:
    """What becomes of patient tasks."""
    tasks = {"task-1": TaskPlan(), "task-2": TaskPlan(), "task-3": TaskPlan(drives=False)}
    actions = tuple(sorted((Action(0.0, "begin", "task-1"), *mutation.actions), key=lambda action: action.time))
    script = Script(seed, mutation.ecology, mutation.faults, tasks=tasks, actions=actions)
    if mutation.upgrades:
        upgrading = {name: replace(plan, upgrade=1.0) for name, plan in tasks.items()}
        script = replace(script, tasks=upgrading, period=PERIOD)
    history = History(script, folder)
    history.run()
    return history


@pytest.mark.parametrize("name", MUTATIONS)
def test_an_invariant_that_is_broken_on_purpose_is_noticed(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for path, value in MUTATIONS[name].changes.items():
        monkeypatch.setattr(path, value)
    assert any(name in played(MUTATIONS[name], tmp_path, seed).watch.names for seed in range(5))


@pytest.mark.parametrize("name", MUTATIONS)
def test_nothing_is_wrong_where_nothing_was_changed(name: str, tmp_path: Path) -> None:
    assert played(MUTATIONS[name], tmp_path).broken == []


def test_every_invariant_has_its_mutation() -> None:
    assert set(MUTATIONS) == {invariant.name for invariant in (*STEPS, *ENDS)} | {*NOTED, "nothing breaks"}

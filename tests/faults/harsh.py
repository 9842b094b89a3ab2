"""A second way to make scripts from seeds, with more kinds of faults; those of `script.py` stay what they are.

Whole machines stall and hosts freeze, lose their power and begin again; links flap; nodes are deaf or mute; messages
are doubled and overtake each other in storms; clocks are set while tasks run; sites begin again with the disk that they
had before; answers come late, twice, or after the end of what gives them; authors begin a task again that they have
just stopped, or another one of the same name. `KINDS` are these kinds; a seed decides whether one of them comes alone,
two of them, or any of them among all that there are. What each does is in `harsh_actions.py`.
"""

from __future__ import annotations

import random
from dataclasses import replace

from selfconf.bus.memory import Faults
from tests.faults import script
from tests.faults.ecologies import PAPER, FaultyEcology
from tests.faults.script import MOMENTS, PAIRED, Action, Script, TaskPlan, targets

STALLS = (0.3, 0.5, 0.9, 1.5, 3.0)
"""For how many seconds a process or a machine stands still."""
AWHILE = (0.05, 0.3, 1.5, 3.0, 8.0)
"""For how many seconds something is the matter."""
LATE = (0.2, 1.0, 2.1, 3.0, 6.0)
"""By how many seconds answers are late."""
STEPS = (-3600.0, -300.0, -2.0, 2.0, 300.0, 3600.0)
"""By how many seconds a clock is set."""
BEGUN_AGAIN = (0.0, 0.001, 0.05, 0.5, 2.0)
"""Seconds after which a task is begun again that was stopped."""
KINDS = {
    "flap": ("all", AWHILE),
    "flap_all": ("all", AWHILE),
    "stall": ("all", STALLS),
    "stall_machine": ("", STALLS),
    "freeze_host": ("sites", (*STALLS, 12.0)),
    "lose_host": ("sites", (1.5, 3.0, 8.0)),
    "deafen": ("all", AWHILE),
    "silence": ("all", AWHILE),
    "set_clock": ("tasks", STEPS),
    "roll_back": ("sites", AWHILE),
    "storm": ("", AWHILE),
    "answer_late": ("components", LATE),
    "answer_twice": ("components", LATE),
    "end_before_answer": ("components", LATE),
    "begin_again": ("tasks", BEGUN_AGAIN),
    "begin_namesake": ("tasks", (0.0,)),
}
"""The kinds of actions: whom each may be done to (nobody, or see `targets`), and the seconds that belong to it."""
TWO = ("flap",)
"""The kinds that are done to a link between two."""
LONGEST = 1.0
"""Seconds that a message may take in a storm."""


def write(seed: int, ecology: FaultyEcology = PAPER, only: tuple[str, ...] = ()) -> Script:
    """Make the harsh script of a seed, of the kinds of actions that are named, if any are, beside what tasks need.

    One kind after the other is the first of a seed, and comes at least twice.
    """
    chance = random.Random(f"harsh {seed}")
    first, many = (only or tuple(KINDS))[seed % len(only or KINDS)], chance.random()
    others = [kind for kind in only or KINDS if kind != first]
    kinds = [first, *(others if only or many > 0.6 else chance.sample(others, 1 if many > 0.3 else 0))]
    usual = [] if only or many < 0.15 else [kind for kind in script.KINDS if targets(ecology)[script.KINDS[kind][1]]]
    faults = _faults(chance, first == "storm" or ("storm" in kinds and chance.random() < 0.5))
    tasks = {name: TaskPlan(chance.choice((0, 0, 1, 2)), chance.random() < 0.7) for name in ecology.tasks}
    share = chance.choice((0.0, 0.5, 1.0))
    starts = frozenset(name for name in ecology.processes if chance.random() < share)
    time, actions = 0.0, [Action(0.0, "begin", ecology.tasks[0])]
    weights = [script.KINDS[kind][0] for kind in usual]
    for number in range(chance.randint(4, 14)):
        time += chance.choice(MOMENTS)
        if usual and number > 1 and chance.random() < 0.4:
            (kind,) = chance.choices(usual, weights)
            actions.append(_usual(chance, time, kind, targets(ecology)[script.KINDS[kind][1]]))
        elif number > 1 and chance.random() < 0.2:  # another task: without any there would be none to compete with
            actions.append(Action(time, "begin", chance.choice(ecology.tasks)))
        else:
            actions.append(_harsh(chance, time, first if number < 2 else chance.choice(kinds), ecology))
    promised = not ecology.latched and chance.random() < 0.25
    return Script(
        seed,
        ecology,
        faults,
        tasks=tasks,
        startable=starts,
        actions=tuple(actions),
        stormy=faults.doubling == 1.0,
        promised=promised,
        period=script.PERIOD if promised else None,
    )


def _faults(chance: random.Random, stormy: bool) -> Faults:
    """What goes wrong with messages all the time, or in storms: then all of them come twice."""
    return Faults(
        loss=chance.choice((0.0, 0.02, 0.3) if stormy else (0.0, 0.0, 0.02)),
        doubling=1.0 if stormy else chance.choice((0.0, 0.1)),
        most_delay=LONGEST if stormy else chance.choice((0.0005, 0.02, 0.2)),
        most_event_delay=chance.choice((0.0, 0.0, 0.1)),
    )


def _usual(chance: random.Random, time: float, kind: str, some: tuple[str, ...]) -> Action:
    who = chance.choice(some)
    other = chance.choice([one for one in some if one != who]) if kind in PAIRED else ""
    seconds = {"pause": script.PAUSES, "slow": script.SLOWNESS}.get(kind, (0.0,))
    return Action(time, kind, who, other, chance.choice(seconds))


def _harsh(chance: random.Random, time: float, kind: str, ecology: FaultyEcology) -> Action:
    group, seconds = KINDS[kind]
    some = targets(ecology)[group] if group else ("",)
    who = chance.choice(some)
    other = chance.choice([one for one in some if one != who]) if kind in TWO else ""
    return Action(time, kind, who, other, chance.choice(seconds))


def promising(advertisement: str) -> str:
    """An advertisement whose outputs promise the rate at which components issue signals, or a little less."""
    promise = f"sc:hasOutput [ sc:rate [ sc:value {1 / script.PERIOD - 0.5:g} ; sc:unit unit:HZ ] ;"
    return advertisement.replace("sc:hasOutput [", promise)


def calm(faults: Faults) -> Faults:
    """The faults of the network between storms: none but the delays of events."""
    return replace(Faults(), most_event_delay=faults.most_event_delay)

"""What goes wrong in a history: a list of timed actions, made from a seed, that can be printed, played and shortened.

An action names whom it is done to; it does nothing where that is not possible, so that any action may be left out and
the rest can still be played. `KINDS` are the kinds of actions, each with its weight and what it is done to.
"""

from __future__ import annotations

import random
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from selfconf.bus.memory import Faults
from tests.faults.ecologies import PAPER, FaultyEcology


@dataclass(frozen=True, slots=True)
class Action:
    """Something that is done at a time of a history."""

    time: float
    kind: str
    who: str = ""
    other: str = ""
    seconds: float = 0.0

    def __str__(self) -> str:
        words = [self.kind.replace("_", " "), self.who]
        words += [f"and {self.other}"] if self.other else []
        words += [f"for {self.seconds:g} s"] if self.seconds else []
        return f"{self.time:8.3f}  {' '.join(words)}"


@dataclass(frozen=True, slots=True)
class TaskPlan:
    """How a task of a history is run."""

    priority: int = 0
    patient: bool = True
    dismantles: bool = False
    drives: bool = True
    """Whether it is of the template of most tasks; else of the other one, without the actuator."""
    upgrade: float | None = None
    """After how many seconds it changes to what it would rather have; None: never."""


@dataclass(frozen=True, slots=True)
class Script:
    """Everything that decides a history."""

    seed: int
    ecology: FaultyEcology = PAPER
    faults: Faults = field(default_factory=Faults)
    clocks: Mapping[str, float] = field(default_factory=dict)
    """By how many seconds the clock of a task's node is wrong."""
    tasks: Mapping[str, TaskPlan] = field(default_factory=dict)
    startable: frozenset[str] = frozenset()
    """The components that their sites start on demand, and again when they crash."""
    actions: tuple[Action, ...] = ()
    large: bool = False
    """Whether the ecology counts as so large that a configurator follows only the lives that it has selected."""
    hangs_on: bool = False
    """Whether a process whose code hangs, and that no site has started, goes on; else it ends as all others do."""
    period: float | None = None
    """After how many seconds each component that acts issues its signals again; None: only when it is told to."""
    mended: bool = False
    """Whether in the end every component lives and is able to act, so that each task changes to the best there is."""
    stormy: bool = False
    """Whether the faults of the network come in storms, and not between these."""
    promised: bool = False
    """Whether outputs promise a rate, so that one that issues nothing counts as failed."""
    kept: bool = False
    """Whether the sites keep the tasks (`keeping.py`); else each has a program of its own."""

    def __str__(self) -> str:
        lines = [f"seed {self.seed} in the ecology {self.ecology.name}: {self.faults}"]
        lines += [f"    {name}: {plan}, clock {self.clocks.get(name, 0.0):+g} s" for name, plan in self.tasks.items()]
        lines += [f"    started by their sites: {', '.join(sorted(self.startable))}"] if self.startable else []
        return "\n".join([*lines, *map(str, self.actions)])


KINDS = {
    "fail": (2, "components"),
    "crash": (2, "components"),
    "start": (4, "components"),
    "lose_power": (1, "components"),
    "duplicate": (1, "components"),
    "twins": (1, "components"),
    "refuse": (1, "components"),
    "slow": (1, "components"),
    "emit": (1, "components"),
    "ask": (6, "callers"),
    "crash_site": (1, "sites"),
    "start_site": (2, "sites"),
    "begin": (3, "tasks"),
    "crash_task": (2, "tasks"),
    "stop_task": (1, "tasks"),
    "isolate": (2, "all"),
    "rejoin": (3, "all"),
    "cut": (2, "all"),
    "mute": (1, "all"),
    "mend": (2, "all"),
    "pause": (2, "all"),
}
"""The kinds of actions: how often each comes, and whom it may be done to; see `targets`."""
PAIRED = ("cut", "mute", "mend")
"""The kinds that are done to a link between two."""
PAUSES = (0.5, 2.0, 10.0)
SLOWNESS = (0.3, 3.0, 6.0, 12.0)
BUSYNESS = (0.05, 1.0, 1.9, 3.0, 12.0, 30.0)
"""For how many seconds the code of a component may be busy while it acts; it hangs if that is longer than it may."""
SETTLES = (0.5, 2.0, 5.0)
"""After how many seconds tasks change to what they would rather have."""
AWAY = (0.5, 2.0, 6.0)
"""For how many seconds a component is gone that a task would rather have."""
BEGINNING = 1.1
"""Seconds after which a process that was started lives."""
UNFIT = ("hush", "refuse", "slow")
"""Why a task may not come to run with what it would rather have."""
DISTURBING = ("fail", "crash", "hush", "refuse", "slow", "lose_power", "pause", "cut", "mute", "crash_task", "begin")
"""What may happen while a task changes to what it would rather have, beside nothing."""
PERIOD = 0.4
"""After how many seconds components issue signals again where tasks change for the better."""
AT_ONCE = (0.0, 0.0, 0.001, 0.01, 0.5)
"""Seconds after which the tasks of a crowd begin."""
MOMENTS = (0.0, 0.001, 0.01, 0.1, 0.5, 1.5, 5.0)


def targets(ecology: FaultyEcology) -> dict[str, tuple[str, ...]]:
    """Whom the kinds of actions may be done to in an ecology."""
    components, sites = ecology.processes, tuple(ecology.sites)
    return {
        "components": components,
        "callers": tuple(name for name in components if "sc:needsOperation" in ecology.advertisements[name]),
        "sites": sites,
        "tasks": ecology.tasks,
        "all": (*components, *sites, *ecology.tasks),
    }


def write(seed: int, without: tuple[str, ...] = (), ecology: FaultyEcology = PAPER) -> Script:
    """Make the script of a seed.

    `without` are kinds of actions that are left out; `late` stands for events that are delayed beyond the grace.
    """
    chance = random.Random(seed)
    faults = Faults(
        loss=chance.choice((0.0, 0.0, 0.02, 0.1, 0.3)),
        doubling=chance.choice((0.0, 0.1, 0.5)),
        least_delay=0.0005,
        most_delay=chance.choice((0.0005, 0.02, 0.2, 1.0)),
        most_event_delay=chance.choice((0.0, 0.0, 0.0, 0.1, 0.0 if "late" in without else 1.5)),
    )
    clocks = {name: chance.choice((0.0, 0.0, -300.0, 300.0)) for name in ecology.tasks}
    dismantles = chance.random() < 0.3
    tasks = {
        name: TaskPlan(chance.choice((0, 0, 0, 1, 2)), chance.random() < 0.7, dismantles) for name in ecology.tasks
    }
    starts = frozenset(name for name in ecology.processes if chance.random() < chance.choice((0.0, 0.5, 1.0)))
    time, actions = 0.0, [Action(0.0, "begin", ecology.tasks[0])]
    whom = targets(ecology)
    kinds = [kind for kind, (_, group) in KINDS.items() if kind not in without and whom[group]]
    weights = [KINDS[kind][0] for kind in kinds]
    for _ in range(chance.randint(2, 14)):
        time += chance.choice(MOMENTS)
        (kind,) = chance.choices(kinds, weights)
        some = whom[KINDS[kind][1]]
        who = chance.choice(some)
        other = chance.choice([one for one in some if one != who]) if kind in PAIRED else ""
        seconds = chance.choice(PAUSES if kind == "pause" else SLOWNESS) if kind in ("pause", "slow") else 0.0
        actions.append(Action(time, kind, who, other, seconds))
    return Script(seed, ecology, faults, clocks, tasks, starts, tuple(actions))


def with_crowd(script: Script) -> Script:
    """The same script, in which most tasks begin at once, and each is of either template."""
    chance, ecology = random.Random(f"crowd {script.seed}"), script.ecology
    begins = [Action(chance.choice(AT_ONCE), "begin", task) for task in ecology.tasks[1:] if chance.random() < 0.6]
    tasks = {name: replace(plan, drives=chance.random() < 0.6) for name, plan in script.tasks.items()}
    actions = sorted((*script.actions, *begins), key=lambda action: action.time)
    return replace(script, actions=tuple(actions), tasks=tasks)


def with_upgrades(script: Script) -> Script:
    """The same script, whose tasks change for the better: more components are lost and come back, and disturb that.

    Outputs that tasks change to are expected to issue signals, and some of them issue none.
    """
    chance = random.Random(f"upgrades {script.seed}")
    settle = chance.choice(SETTLES)
    whom, processes = targets(script.ecology), script.ecology.processes
    time, more = script.actions[-1].time + chance.choice(AWAY), []
    for _ in range(chance.randint(1, 3)):
        who = chance.choice(processes if chance.random() < 0.2 else script.ecology.preferred)
        more.append(Action(time, chance.choice(("crash", "crash", "lose_power", "fail")), who))
        time += chance.choice(AWAY)
        more += [Action(time, "crash", who), Action(time, "start", who)]
        time += BEGINNING
        if chance.random() < 0.5:
            kind = chance.choice(UNFIT)
            more.append(Action(time, kind, who, seconds=chance.choice(SLOWNESS) if kind == "slow" else 0.0))
        time += settle + chance.choice(MOMENTS)
        if chance.random() < 0.7:
            kind = chance.choice(DISTURBING)
            some = whom[KINDS[kind][1]] if kind in KINDS else processes
            victim = who if who in some and chance.random() < 0.4 else chance.choice(some)
            other = chance.choice([one for one in some if one != victim]) if kind in PAIRED else ""
            seconds = chance.choice(PAUSES if kind == "pause" else SLOWNESS) if kind in ("pause", "slow") else 0.0
            more.append(Action(time, kind, victim, other, seconds))
        time += chance.choice(MOMENTS)
    tasks = {name: replace(plan, upgrade=settle) for name, plan in script.tasks.items()}
    return replace(script, actions=(*script.actions, *more), tasks=tasks, period=PERIOD, mended=True)


def with_busy_code(script: Script) -> Script:
    """The same script, in which code is also busy while it acts, so that calls and signals wait for it."""
    chance = random.Random(f"busy {script.seed}")
    more = []
    for _ in range(chance.randint(1, 4)):
        time = chance.choice(script.actions).time + chance.choice(MOMENTS)
        who = chance.choice(script.ecology.processes)
        more.append(Action(time, "busy", who, seconds=chance.choice(BUSYNESS)))
    actions = sorted((*script.actions, *more), key=lambda action: action.time)
    return replace(script, actions=tuple(actions), hangs_on=True)


@dataclass(frozen=True, slots=True)
class Recipe:
    """All that a script is made of, by the options of `tests.faults.replay`."""

    seed: int
    ecology: FaultyEcology = PAPER
    busy: bool = False
    """Whether code is also busy while it acts, and hangs on."""
    large: bool = False
    """Whether the ecology counts as so large that not all lives are followed."""
    upgrades: bool = False
    """Whether tasks change to what they would rather have."""
    harsh: bool = False
    """Whether the script is one of `tests.faults.harsh`."""
    kept: bool = False
    """Whether the sites keep the tasks."""
    only: str = ""
    """The kinds of harsh actions that it is made of, apart by commas, if not any of them."""

    @property
    def script(self) -> Script:
        """The script that is made."""
        written = self._written
        if self.ecology.latched:  # a signal that is lost on its way is not said again
            written = replace(written, faults=replace(written.faults, loss=0.0))
        crowded = with_crowd(written) if self.ecology.crowd else written
        upgrading = with_upgrades(crowded) if self.upgrades else crowded
        busy = with_busy_code(upgrading) if self.busy else upgrading
        return replace(self._kept_by_sites(busy) if self.kept else busy, large=self.large)

    @staticmethod
    def _kept_by_sites(script: Script) -> Script:
        from tests.faults.keeping import with_site_faults

        return with_site_faults(script)

    @property
    def _written(self) -> Script:
        if not self.harsh:
            return write(self.seed, ecology=self.ecology)
        from tests.faults import harsh

        return harsh.write(self.seed, self.ecology, tuple(filter(None, self.only.split(","))))

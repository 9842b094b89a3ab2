"""The plan of a trial, which its seed decides: in which phase of a run the faults come, when, and to which process."""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import dataclass

from benchmarks.faults.actor import OUTPUTS, RIVAL_OUTPUTS
from benchmarks.faults.ecology import HUB, SITES

PHASES = {
    "discovery": ("query",),
    "reservation": ("watching",),
    "activation": ("activating",),
    "running": ("running",),
    "repair": ("running", "lost"),
}
"""The phases of a run, each with the acts that are waited for; before `lost` a position sensor is made to fail.

A component is watched at once before it is reserved, or before its site is asked to start it where it is dormant.
"""
KINDS = {"kill": 0.0, "end": 0.0, "stop 0.5 s": 0.5, "stop 2 s": 2.0, "stop 10 s": 10.0}
"""What happens to a process, and for how many seconds it stands still."""
VICTIMS = ("component", "component", "site", "configurator", "configurator")
ROUTED_VICTIMS = ("router", "router", *VICTIMS)
"""Whom it happens to where all go through a router."""
LEADS = (0.0, 0.03, 0.2, 0.5, 1.5)
"""By how many seconds a rival of the task may begin before the first fault."""


@dataclass(frozen=True, slots=True)
class Fault:
    """Something that happens to a process of the ecology."""

    victim: str
    kind: str
    name: str
    delay: float
    """Seconds after the phase, or after the first fault."""

    def __str__(self) -> str:
        return f"{self.kind} {self.name}"


@dataclass(frozen=True, slots=True)
class Plan:
    """What happens in a trial."""

    trial: str
    phase: str
    faults: tuple[Fault, ...]
    lead: float | None = None
    """The seconds by which a rival of the task begins before the first fault, if one does."""

    def __str__(self) -> str:
        rival = "" if self.lead is None else f"a rival {self.lead:g} s before "
        return f"{self.phase}: {rival}{', then '.join(map(str, self.faults))}"

    def ends(self, victim: str) -> bool:
        """Whether a victim is killed, or told to end."""
        return any(fault.victim == victim and not KINDS[fault.kind] for fault in self.faults)


def plan(seed: int, number: int, longest: float, victims: Sequence[str] = VICTIMS, rival: bool = False) -> Plan:
    """The plan of a trial; nobody stands still for longer than `longest` seconds."""
    chance = random.Random(f"{seed}/{number}")
    actors = sorted(OUTPUTS | RIVAL_OUTPUTS if rival else OUTPUTS)
    victims = (*victims, "rival", "rival") if rival else victims

    def fault(delay: float) -> Fault:
        victim = chance.choice(victims)
        names = {"component": chance.choice(actors), "site": chance.choice(SITES), "router": HUB}
        name = names.get(victim, victim)
        kind = chance.choice([kind for kind, seconds in KINDS.items() if seconds <= longest])
        return Fault(victim, kind, name, delay)

    faults = [fault(chance.choice((0.0, 0.001, 0.005, 0.03, 0.2)))]
    if chance.random() < 0.25:
        faults.append(fault(chance.choice((0.0, 0.05, 0.5, 1.5))))
    phase = chance.choice(sorted(PHASES))
    return Plan(f"{seed}/{number}", phase, tuple(faults), chance.choice(LEADS) if rival else None)

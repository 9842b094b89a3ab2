"""A program that a site starts, and what is seen of it: its runs, its lives, and what is said of its end."""

from __future__ import annotations

from pathlib import Path

from selfconf.bus.memory import Network
from selfconf.protocol.codec import decode
from selfconf.protocol.messages import Fail
from selfconf.site import Site
from selfconf.site.component_program import ComponentProgram
from tests.site.served import KEYS, SLEEPER

NUMBERED = 'import os; open("run-%d" % len(os.listdir()), "w").write(str(os.getpid()))'
"""Leaves a file with the process id for each time it is started."""


def runs(tmp_path: Path) -> list[int]:
    """The processes that have been started and have said so, in order."""
    files = sorted(path for path in (tmp_path / "here").glob("run-*") if path.read_text())
    return [int(path.read_text()) for path in files]


def fails(network: Network) -> list[Fail]:
    """What is said on all FAIL keys from now on."""
    heard: list[Fail] = []
    network.node().subscribe(KEYS.any_fail(), lambda sample: heard.append(decode(sample.payload, Fail)))
    return heard


def program(site: Site) -> ComponentProgram:
    """The program of the sleeper."""
    return site.processes.by_component[SLEEPER]


def given_life(site: Site) -> str:
    """The name of a life that the process of the sleeper was given."""
    process = program(site)._process
    assert process is not None
    return process.life

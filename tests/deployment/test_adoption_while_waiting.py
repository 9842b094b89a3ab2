"""Tasks that change hands while they wait: the next site starts nothing and takes nothing."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import pytest

from selfconf.configurator.state import Phase
from selfconf.deployment.keeper import keeper_of
from tests.deployment.keepers import RECORD, Keepers
from tests.deployment.simulated import home
from tests.lab import PREFIXES, Lab, request_for

PACKING = {
    "camera": ":camera a sc:Component, :Camera ; sc:shareable false ;"
    ' sc:hasOutput [ sc:name "parcels" ; sc:signalType :Parcels ] .',
    "conveyor": ":conveyor a sc:Component, :Conveyor ; sc:shareable false .",
    "gripper": ':gripper a sc:Component, :Gripper ; sc:hasInput [ sc:name "parcels" ; sc:signalType :Parcels ] .',
}
PACK = (
    PREFIXES
    + """:pack a sc:Template ; sc:roles ( :sees :moves :grips ) .
:sees a sc:Role ; sh:class :Camera ; sc:feeds :grips .
:moves a sc:Role ; sh:class :Conveyor .
:grips a sc:Role ; sh:class :Gripper .
"""
)
ALONE = PREFIXES + ":alone a sc:Template ; sc:roles ( :one ) . :one a sc:Role ; sh:class CLASS ."


@pytest.mark.parametrize("how", ["a site ends", "a site comes"])
def test_a_task_that_waits_starts_nothing_and_takes_nothing_as_it_changes_hands(tmp_path: Path, how: str) -> None:
    lab = Lab(tmp_path, advertised=PACKING)
    lab.site("shared", *PACKING)
    for name in PACKING:
        lab.component(name)
    keepers = Keepers(lab, tmp_path / "disks", partial(request_for, template=PACK, bound=()))
    first = keeper_of(RECORD.task, "abc")
    if how == "a site comes":
        keepers.end(first)
    keeper = keepers.settled()
    assert lab.running(lab.agent(ALONE.replace("CLASS", ":Conveyor"), (), priority=RECORD.priority + 1))
    other = lab.agent(ALONE.replace("CLASS", ":Camera"), (), priority=RECORD.priority - 1, patient=True)
    assert lab.running(other), "the task waits, and holds nothing"
    said = {name: list(recorder.said) for name, recorder in lab.components.items()}
    if how == "a site comes":
        keepers.begin(first)
    else:
        keepers.end(keeper)
    lab.let_pass(5.0)
    assert [name for name, one in keepers.keepers.items() if one.runners] != [keeper]
    assert {name: list(recorder.said) for name, recorder in lab.components.items()} == said
    lab.crash(other)
    lab.let_pass(5.0)
    assert lab.active() == {"conveyor"}


def test_the_next_site_starts_nothing_of_a_task_that_was_letting_go_as_its_site_ended(tmp_path: Path) -> None:
    lab = Lab(tmp_path, advertised=PACKING)
    lab.site("shared", *PACKING)
    for name in PACKING:
        lab.component(name)
    keepers = Keepers(lab, tmp_path / "disks", partial(request_for, template=PACK, bound=()))
    keeper = keepers.settled()
    lab.agent(ALONE.replace("CLASS", ":Conveyor"), (), priority=RECORD.priority + 1)
    assert lab.until(lambda: lab.components["camera"].said[-1] == ("stopped",))
    keepers.end(keeper)
    lab.let_pass(5.0)
    assert [one for one in keepers.keepers.values() if one.runners]
    assert lab.components["camera"].said == [("started",), ("stopped",)]


def test_the_next_site_does_without_what_a_task_that_waits_had_lost(tmp_path: Path) -> None:
    lab = home(tmp_path, "odometry")
    keepers = Keepers(lab, tmp_path / "disks")
    keeper = keepers.settled()
    lab.components["odometry"].fail("lost")
    lab.let_pass(0.5)
    keepers.end(keeper)
    lab.let_pass(3.0)
    (runner,) = (runner for one in keepers.keepers.values() for runner in one.runners.values())
    assert runner.state.phase is Phase.REFUSED
    assert lab.components["odometry"].said.count(("started",)) == 1

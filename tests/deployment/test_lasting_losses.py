"""Whether a loss lasts: actuators rest while what runs is incomplete for more than a moment."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from selfconf.configurator.events import Event, LossLasts
from selfconf.configurator.state import Phase
from selfconf.deployment.lasting_losses import LASTS_LONG
from tests.deployment.simulated import slow_code
from tests.lab import ADVERTISEMENTS, PREFIXES, Lab, iri


@pytest.mark.parametrize("offers", ["", ' ; sc:hasOperation [ sc:name "home" ; sc:response :Reached ]'])
@pytest.mark.parametrize(("seconds", "rests"), [(0.5, False), (4.0, True)])
def test_the_drive_rests_for_as_long_as_a_repair_takes_more_than_a_moment(
    tmp_path: Path, seconds: float, rests: bool, offers: str
) -> None:
    """The controller acts on, and could go on driving without a position; an operation makes no other drive of it."""
    drives = ADVERTISEMENTS["drive"]
    lab = Lab(tmp_path, advertised=ADVERTISEMENTS | {"drive": drives.removesuffix(" .") + offers + " ."})
    lab.navigation()
    slow_code(lab, "odometry")
    lab.components["odometry"].slow = seconds
    lab.running(agent := lab.agent())
    control, drive = lab.components["control"], lab.components["drive"]
    lab.components["tracker"].fail("Astrid has left the picture")
    for _ in range(16):
        control.emit("set.velocity", {"v": 0.3})
        lab.let_pass(0.1)
    assert drive.said[-1] == (("stopped",) if rests else ("velocity", {"v": 0.3}))
    assert ("stopped",) not in control.said
    assert agent.state.held[iri("astrid-drive")].reserved, "it is held on"
    acting = [event.component for event in lab.acts("activated")]
    assert acting.count(iri("astrid-drive")) == 1, "and what has come to rest is not said to be active"
    lab.until(lambda: agent.state.phase is Phase.RUNNING)
    control.emit("set.velocity", {"v": 0.1})
    lab.let_pass(0.1)
    assert drive.said[-1] == ("velocity", {"v": 0.1})
    assert drive.said.count(("started",)) == 1 + rests


def test_a_drive_whose_site_has_gone_rests_as_any_other(tmp_path: Path) -> None:
    """The ecology is asked again as something appears, and answers without the drive, which lives on."""
    lab = Lab(tmp_path)
    lab.site("sensors", "tracker", "sonar", "encoder", "control")
    drives = lab.site("drives", "drive", "pippi")
    for name in ("tracker", "sonar", "encoder", "control", "drive", "pippi"):
        lab.component(name)
    lab.running(agent := lab.agent())
    lab.crash(drives)
    lab.let_pass(1.0)
    lab.crash("tracker")
    lab.crash("pippi")
    lab.let_pass(LASTS_LONG / 2)
    lab.component("pippi")
    lab.let_pass(LASTS_LONG / 2 + 0.1)
    assert iri("astrid-drive") not in agent.ecology.discovery.found
    assert agent.state.held[iri("astrid-drive")].rests
    assert lab.components["drive"].said[-1] == ("stopped",)


_TWO_SINKS = {
    "left": ':left a sc:Component, :Left ; sc:hasOutput [ sc:name "out" ; sc:signalType :X ] .',
    **{
        f"right{n}": f":right{n} a sc:Component, :Right ; sc:preference -{n} ;"
        ' sc:hasOutput [ sc:name "out" ; sc:signalType :Y ] .'
        for n in range(3)
    },
    "wheels": ':wheels a sc:Component, :Wheels ; sc:hasInput [ sc:name "x" ; sc:signalType :X ] ,'
    ' [ sc:name "y" ; sc:signalType :Y ] .',
    **{
        f"arm{n}": f":arm{n} a sc:Component, :Arm ; sc:preference -{n} ;"
        ' sc:hasInput [ sc:name "x" ; sc:signalType :X ] .'
        for n in range(2)
    },
}


_TWO_SINKS_TASK = (
    PREFIXES
    + """:t a sc:Template ; sc:roles ( :left-role :right-role :wheels-role :arm-role ) .
:left-role a sc:Role ; sh:class :Left ; sc:feeds :wheels-role , :arm-role .
:right-role a sc:Role ; sh:class :Right ; sc:feeds :wheels-role .
:wheels-role a sc:Role ; sh:class :Wheels .
:arm-role a sc:Role ; sh:class :Arm .
"""
)


class _TwoSinks:
    """Two actuators with sources that issue signals all the time, and a task that runs with the first of each."""

    def __init__(self, folder: Path, *slow: str) -> None:
        """`slow` are the components of which `started` takes four seconds from now on."""
        self.lab = Lab(folder, advertised=_TWO_SINKS)
        self.lab.site("shared", *_TWO_SINKS)
        for name in _TWO_SINKS:
            self.lab.component(name)
        for name in slow:
            slow_code(self.lab, name)
        self.agent = self.lab.agent(_TWO_SINKS_TASK, ())
        assert self.lab.running(self.agent)
        self.goes_on(1.0)
        for name in slow:
            self.lab.components[name].slow = 4.0

    def goes_on(self, seconds: float) -> None:
        for _ in range(round(10 * seconds)):
            for name in _TWO_SINKS:
                if name.startswith(("left", "right")):
                    self.lab.components[name].emit("out", 1)
            self.lab.let_pass(0.1)

    def turns(self, name: str) -> list[str]:
        """How a component was started and stopped."""
        return [said[0] for said in self.lab.components[name].said if said[0] in ("started", "stopped")]


def test_an_actuator_is_not_disturbed_while_another_one_is_replaced(tmp_path: Path) -> None:
    home = _TwoSinks(tmp_path, "arm1")
    home.lab.components["arm0"].fail("it is stuck")
    home.goes_on(3.0)
    assert home.agent.state.phase is Phase.DEPLOYING
    home.goes_on(3.0)
    assert home.agent.state.phase is Phase.RUNNING
    assert home.turns("wheels") == ["started"]


def test_a_drive_that_did_not_hear_that_it_is_to_rest_is_told_again_whatever_has_been_decided_since(lab: Lab) -> None:
    slow_code(lab, "odometry")
    lab.components["odometry"].slow = 7.0
    lab.running(agent := lab.agent())
    control, drive = lab.components["control"], lab.components["drive"]
    lab.components["tracker"].fail("Astrid has left the picture")
    lab.let_pass(LASTS_LONG - 0.1)
    faults = lab.network.faults
    lab.network.faults = replace(faults, loss=1.0)
    lab.let_pass(0.2)
    lab.network.faults = faults
    assert agent.state.held[iri("astrid-drive")].rests
    lab.let_pass(0.1)
    assert drive.said[-1] != ("stopped",), "it was not heard"
    for _ in range(25):
        control.emit("set.velocity", {"v": 0.3})
        lab.let_pass(0.1)
    assert agent.state.phase is not Phase.RUNNING
    assert drive.said[-1] == ("stopped",)


def test_an_actuator_that_has_started_again_rests_again_if_more_is_lost_meanwhile(tmp_path: Path) -> None:
    home = _TwoSinks(tmp_path, "right1", "right2", "arm1")
    home.lab.components["right0"].fail("it is dark")
    home.lab.components["arm0"].fail("it is stuck")
    home.goes_on(4.5)
    assert home.turns("wheels") == ["started", "stopped", "started"]
    assert home.agent.state.phase is Phase.DEPLOYING, "the arm takes four seconds to start"
    home.lab.components["right1"].fail("it is dark here, too")
    home.goes_on(1.5)
    assert home.turns("wheels")[-1] == "stopped"
    home.goes_on(10.0)
    assert home.agent.state.phase is Phase.RUNNING
    assert home.turns("wheels")[-1] == "started"


def test_it_is_looked_once_whether_what_was_lost_within_a_moment_is_replaced(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It may be thousands of components, and each look is at all that is held."""
    home = _TwoSinks(tmp_path)
    looks, hear = list[float](), home.agent._lasting_losses._step

    def heard(event: Event) -> None:
        if isinstance(event, LossLasts):
            looks.append(home.lab.network.time)
        hear(event)

    monkeypatch.setattr(home.agent._lasting_losses, "_step", heard)
    began = home.lab.network.time
    home.lab.components["right0"].fail("it is dark")
    home.lab.components["arm0"].fail("it is stuck")
    home.lab.let_pass(0.03)
    home.lab.components["right1"].fail("it is dark here, too")
    home.lab.let_pass(0.5)
    assert [round(time - began, 2) for time in looks] == [0.05, 0.1]

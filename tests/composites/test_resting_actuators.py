"""An actuator rests while what feeds it lacks a part, though a composite stands between the two."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf.configurator import Phase
from tests.composites.eye import HINTED
from tests.deployment.simulated import slow_code
from tests.lab import PREFIXES as LAB_PREFIXES
from tests.lab import Lab

BASE = {
    "base": """:base a sc:Component, :Base ; sc:hasInput [ sc:name "go" ; sc:signalType :Go ] ;
        sc:grounding [ sc:template :driving ] .
        :driving a sc:Template ; sc:roles ( :motor ) ;
            sc:hasInput [ sc:name "go" ; sc:signalType :Go ; sc:of :motor ] .
        :motor a sc:Role ; sh:class :Motor .""",
    "motor": ':motor-1 a sc:Component, :Motor ; sc:hasInput [ sc:name "go" ; sc:signalType :Go ] .',
    "control": ':control a sc:Component, :Control ; sc:hasInput [ sc:name "hint" ; sc:signalType :Hint ] ;'
    ' sc:hasOutput [ sc:name "go" ; sc:signalType :Go ] .',
} | {name: HINTED[name] for name in ("hinter0", "hinter1")}
"""An actuator inside of a composite, and what drives it."""
DRIVE_BASE = f"""{LAB_PREFIXES}
:drive a sc:Template ; sc:roles ( :hints :control-role :base-role ) .
:hints a sc:Role ; sh:class :Hinter ; sc:feeds :control-role .
:control-role a sc:Role ; sh:class :Control ; sc:feeds :base-role . :base-role a sc:Role ; sh:class :Base ."""
PILOTED = BASE | {
    "base": """:base a sc:Component, :Base ; sc:hasInput [ sc:name "go" ; sc:signalType :Go ] ;
        sc:grounding [ sc:template :driving ] .
        :driving a sc:Template ; sc:roles ( :pilot :motor ) ;
            sc:hasInput [ sc:name "go" ; sc:signalType :Go ; sc:of :pilot ] .
        :pilot a sc:Role ; sh:class :Pilot ; sc:feeds :motor .
        :motor a sc:Role ; sh:class :Motor .""",
    "pilot": ':pilot-1 a sc:Component, :Pilot ; sc:hasInput [ sc:name "go" ; sc:signalType :Go ] ;'
    ' sc:hasOutput [ sc:name "turn" ; sc:signalType :Turn ] .',
    "motor": ':motor-1 a sc:Component, :Motor ; sc:hasInput [ sc:name "turn" ; sc:signalType :Turn ] .',
}
"""An actuator inside of a composite that is driven by another component inside, and not from outside."""
SECOND = {"second-pilot": PILOTED["pilot"].replace(":pilot-1 a", ":pilot-2 sc:preference -1 ; a")}
"""Another component that may drive it."""


@pytest.mark.parametrize(
    ("advertised", "driver", "output"),
    [(BASE, "control", "go"), (PILOTED, "pilot", "turn"), (PILOTED | SECOND, "pilot", "turn")],
    ids=["from outside", "from inside", "from inside, where two may"],
)
def test_an_actuator_inside_rests_as_soon_as_one_outside_would(
    advertised: dict[str, str], driver: str, output: str, tmp_path: Path
) -> None:
    lab = Lab(tmp_path, advertised=advertised)
    lab.site("home", *advertised)
    for name in sorted(advertised.keys() - {"base"}):
        lab.component(name)
    lab.let_pass(3.0)
    slow_code(lab, "hinter1")
    lab.components["hinter1"].slow = 4.0
    agent = lab.agent(DRIVE_BASE, ())
    assert lab.running(agent)
    lab.components["hinter0"].fail("it has no idea")
    turns = dict[float, list[str]]()
    for tenth in range(60):
        lab.components[driver].emit(output, tenth)
        lab.let_pass(0.1)
        turns[tenth / 10] = [said[0] for said in lab.components["motor"].said if said[0] != output]
    assert (turns[0.8], turns[1.3]) == (["started"], ["started", "stopped"])
    assert agent.state.phase is Phase.RUNNING
    assert turns[5.9] == ["started", "stopped", "started"]


SEEN = {
    "sight": """:sight a sc:Component, :Sight ; sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ] ;
        sc:grounding [ sc:template :seeing ] .
        :seeing a sc:Template ; sc:roles ( :eye :tracker-role ) ;
            sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ; sc:of :tracker-role ] .
        :eye a sc:Role ; sh:class :Camera ; sc:feeds :tracker-role .
        :tracker-role a sc:Role ; sh:class :Tracker .""",
    "tracker": ':tracker a sc:Component, :Tracker ; sc:hasInput [ sc:name "image" ; sc:signalType :Image ] ;'
    ' sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ] .',
    "motor": ':motor-1 a sc:Component, :Motor ; sc:hasInput [ sc:name "pose" ; sc:signalType :Pose ] .',
} | {
    f"camera{number}": f":camera{number} sc:preference {-number} ; a sc:Component, :Camera ;"
    ' sc:hasOutput [ sc:name "image" ; sc:signalType :Image ] .'
    for number in (0, 1)
}
"""A composite that finds positions by a camera, and an actuator outside of it that follows these."""


def test_an_actuator_outside_rests_while_what_feeds_it_inside_of_a_composite_lacks_a_part(tmp_path: Path) -> None:
    lab = Lab(tmp_path, advertised=SEEN)
    lab.site("home", *SEEN)
    for name in sorted(SEEN.keys() - {"sight"}):
        lab.component(name)
    lab.let_pass(3.0)
    slow_code(lab, "camera1")
    lab.components["camera1"].slow = 4.0
    agent = lab.agent(
        f"""{LAB_PREFIXES}
        :drive a sc:Template ; sc:roles ( :sight-role :motor-role ) .
        :sight-role a sc:Role ; sh:class :Sight ; sc:feeds :motor-role . :motor-role a sc:Role ; sh:class :Motor .""",
        (),
    )
    assert lab.running(agent)
    lab.components["tracker"].emit("pose", 0)
    lab.components["camera0"].fail("a cloth covers the lens")
    turns = dict[float, list[str]]()
    for tenth in range(70):
        lab.let_pass(0.1)
        turns[tenth / 10] = [said[0] for said in lab.components["motor"].said if said[0] != "pose"]
    assert (turns[0.9], turns[1.8]) == (["started"], ["started", "stopped"])
    assert turns[6.9] == ["started", "stopped", "started"]
    assert agent.state.phase is Phase.RUNNING

"""A composite on one site and who needs it on another, with real processes: repaired inside, and lost as a whole."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import pytest

from selfconf.model.term import IRI
from tests.cli.processes import Home

pytestmark = pytest.mark.process

PREFIXES = (
    "@prefix sc: <https://w3id.org/selfconf#> .\n@prefix sh: <http://www.w3.org/ns/shacl#> .\n@prefix : <urn:c:> .\n"
)
PROGRAM = '''
import sys
from pathlib import Path
from selfconf.sdk import Component, main


class Part(Component):
    """Issues its name five times a second, or tells what it hears."""

    heard = ""

    def started(self):
        self.every(0.2, self.act)

    def act(self):
        if self.issues:
            self.emit(self.issues, [type(self).__name__, self.heard])

    def received(self, port, signal):
        self.heard = signal.value
        if not self.issues:
            print("heard", signal.value, flush=True)


name, issues = sys.argv[1].partition(":")[::2]
members = {"advertisement": Path(__file__).parent / f"{name}.ttl", "issues": issues}
main(type(name, (Part,), members), arguments=sys.argv[2:])
'''
SERVICE = f"""{PREFIXES}
:service a sc:Component, :Positions ; sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ] ;
    sc:grounding [ sc:template :localise ] .
:localise a sc:Template ; sc:roles ( :eye :tracker ) ;
    sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ; sc:of :tracker ] .
:eye a sc:Role ; sh:class :Camera ; sc:feeds :tracker .
:tracker a sc:Role ; sh:class :Tracker .
"""
TASK = f"""{PREFIXES}
:task a sc:Template ; sc:roles ( :positions :navigator ) .
:positions a sc:Role ; sh:class :Positions ; sc:feeds :navigator .
:navigator a sc:Role ; sh:class :Nav ."""
CAMERA = 'a sc:Component, :Camera ; sc:hasOutput [ sc:name "image" ; sc:signalType :Image ]'
TRACKER = (
    'a sc:Component, :Tracker ; sc:hasInput [ sc:name "image" ; sc:signalType :Image ] ; '
    'sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ]'
)
NAVIGATOR = 'a sc:Component, :Nav ; sc:hasInput [ sc:name "pose" ; sc:signalType :Pose ]'


def described(folder: Path, name: str, says: str, issues: str = "") -> None:
    """Advertise a component that its site starts, and does not start again."""
    folder.mkdir(exist_ok=True)
    (folder / "parts.py").write_text(PROGRAM)
    command = f'sc:restarts 0 ; sc:grounding [ sc:command "python parts.py {name}:{issues}" ]'
    (folder / f"{name}.ttl").write_text(f"{PREFIXES}:{name} {says} ; {command} .\n")


def kill(home: Home, name: str) -> None:
    """Kill the process of a component that lives."""
    answer = home.state(IRI(f"urn:c:{name}"))
    assert answer is not None
    os.kill(int(answer.place.split()[1]), signal.SIGKILL)


def test_a_composite_on_another_site_is_repaired_there_and_lost_when_it_cannot_be(home: Home) -> None:
    house, robot = home.folder / "house", home.folder / "robot"
    for name in ("eye1", "eye2"):
        described(house, name, CAMERA, "image")
    described(house, "tracker1", TRACKER, "pose")
    described(robot, "nav", NAVIGATOR)
    (house / "service.ttl").write_text(SERVICE)
    (home.folder / "task.ttl").write_text(TASK)
    home.site("house", str(house))
    home.site("robot", str(robot), connect=(home.endpoint("house"),), options=("--listen", "tcp/127.0.0.1:0"))
    run = home.selfconf(
        "run", "task.ttl", "--ecology", home.ecology, "--connect", home.endpoint("robot"), "--format", "json"
    )
    deployed = run.act("running")
    roles = deployed["configuration"]["roles"]
    assert [role["components"] for role in roles] == [["urn:c:service"], ["urn:c:nav"]]
    status = home.selfconf("status", *home.arguments(), "--format", "json")
    assert status.ended() == 0
    kill(home, "eye1")
    assert home.until(lambda: home.state(IRI("urn:c:eye2")) is not None)
    assert home.until(lambda: "eye2" in heard(home))
    kill(home, "tracker1")
    lost = run.act("lost")
    assert (lost["component"], lost["cause"]) == ("urn:c:service", "fail")
    assert "its inside is refused: no component is eligible for the role tracker" in lost["detail"]
    assert run.ended() == 1


def heard(home: Home) -> str:
    """What the navigator has told, as the log of its site has it."""
    return "".join(path.read_text() for path in (home.runtime / "log").glob("*robot*"))

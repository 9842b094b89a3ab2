"""`status` and `stop`: what is deployed, by which configurator, since when; and taking it down from another process."""

from __future__ import annotations

import signal
import sys

import pytest

from selfconf.api.tasks import released_components
from selfconf.cli import status
from selfconf.model.term import IRI
from selfconf.protocol.messages import Status
from selfconf.render import Names
from tests.cli.command import run
from tests.cli.processes import Home
from tests.lab import iri

pytestmark = pytest.mark.process

EVERYBODY = ("sonar", "encoder", "tracker", "odometry", "control", "drive")


def test_what_is_deployed_is_shown_and_taken_down_by_stop(inhabited: Home, capsys: pytest.CaptureFixture[str]) -> None:
    where = inhabited.arguments()
    program = inhabited.run()
    program.act("running")
    (told,) = run(capsys, "status", "--format", "json", *where).body
    assert (told["phase"], told["process"], told["template"]) == ("running", program.number, iri("navigate"))
    assert iri("person-tracker") in told["components"]
    assert len(told["components"]) == 5
    text = run(capsys, "status", *where).out
    assert f"process {program.number} on" in text
    assert "running" in text
    outcome = run(capsys, "stop", "--configurator", "nobody", *where)
    assert outcome.is_one_sentence("no task or configurator 'nobody' answers")
    assert inhabited.active("drive") == {"drive"}
    outcome = run(capsys, "stop", "--configurator", told["configurator"], *where)
    assert (outcome.code, outcome.out) == (0, f"took down {told['task']} in ecology {inhabited.ecology}\n")
    assert program.ended() == 0
    assert inhabited.active(*EVERYBODY) == set()


STUBBORN = """\
import threading
from selfconf.sdk import Component, main

class Drive(Component):
    advertisement = "ads/drive.ttl"

    def stopped(self):
        threading.Event().wait()

main(Drive)
"""


def test_a_component_that_does_not_come_to_rest_is_listed_when_its_task_has_ended(
    home: Home, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(released_components, "COMING_TO_REST", 0.3)
    home.site("peis-home", "ads")
    home.components("sonar", "encoder", "tracker", "control")
    (home.folder / "stubborn.py").write_text(STUBBORN)
    drive = home.program(sys.executable, "stubborn.py", "--ecology", home.ecology, "--connect", home.endpoint())
    assert home.until(lambda: home.state(iri("astrid-drive")) is not None)
    program, where = home.run(), home.arguments()
    program.act("running")
    program.end(signal.SIGINT)
    sentence = "out of control: :astrid-drive was turned off and has not obeyed: its code has not come to rest (process"
    assert sentence in run(capsys, "status", *where).out
    discovered = run(capsys, "discover", *where).out
    assert sentence in discovered
    assert [line.split()[3] for line in discovered.splitlines() if line.startswith(":astrid-drive")] == ["stopping"]
    states = {
        one["component"]: one["stopping"]
        for one in run(capsys, "discover", "--format", "json", *where).body["components"]
    }
    assert [component for component, stopping in states.items() if stopping] == [iri("astrid-drive")]
    drive.end(signal.SIGKILL)
    assert home.until(lambda: home.state(iri("astrid-drive")) is None)
    assert run(capsys, "status", *where).out == f"nothing is deployed in ecology {home.ecology}\n"


def test_where_nothing_is_deployed_both_say_so(inhabited: Home, capsys: pytest.CaptureFixture[str]) -> None:
    where = inhabited.arguments()
    for command in ("status", "stop"):
        outcome = run(capsys, command, *where)
        assert (outcome.code, outcome.out) == (0, f"nothing is deployed in ecology {inhabited.ecology}\n")
    assert run(capsys, "status", "--format", "json", *where).body == []


def test_where_a_configurator_does_not_answer_it_is_not_said_that_nothing_is_deployed(
    inhabited: Home, capsys: pytest.CaptureFixture[str]
) -> None:
    with inhabited.mute_configurator() as name:
        outcome = run(capsys, "status", *inhabited.arguments())
    assert outcome.is_one_sentence(f"the configurator '{name}' lives, but does not answer")


def test_the_name_of_a_port_or_parameter_forges_no_line() -> None:
    wire = {"from": {"component": "urn:x:a", "output": "o\n"}, "to": {"component": "urn:x:b", "input": "\x1b[2Ji"}}
    body = {"bindings": {"room\n": 5}, "roles": [], "recruits": [], "connections": [wire]}
    lines = status._configuration(body, Status("c", "running", IRI("urn:x:t"), 1, 0.0), Names({"": "urn:x:"}))
    assert list(lines) == [r"room\n = 5", r":a o\n -> :b \x1b[2Ji"]

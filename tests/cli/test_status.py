"""`status` and `stop`: what is deployed, by whom, since when; and taking it down from another process."""

from __future__ import annotations

import pytest

from tests.cli.command import run
from tests.cli.processes import Home
from tests.lab import iri

pytestmark = pytest.mark.process

EVERYBODY = ("sonar", "encoder", "tracker", "odometry", "control", "drive")


def test_what_is_deployed_is_shown_and_taken_down_by_stop(inhabited: Home, capsys: pytest.CaptureFixture[str]) -> None:
    where = inhabited.arguments()
    program = inhabited.run()
    program.act("running")
    (status,) = run(capsys, "status", "--format", "json", *where).body
    assert (status["phase"], status["process"], status["template"]) == ("running", program.number, iri("navigate"))
    assert iri("person-tracker") in status["components"]
    assert len(status["components"]) == 5
    text = run(capsys, "status", *where).out
    assert f"process {program.number} on" in text
    assert "running" in text
    outcome = run(capsys, "stop", "--configurator", "nobody", *where)
    assert outcome.is_one_sentence("no task or configurator 'nobody' answers")
    assert inhabited.active("drive") == {"drive"}
    outcome = run(capsys, "stop", "--configurator", status["configurator"], *where)
    assert (outcome.code, outcome.out) == (0, f"took down {status['task']} in ecology {inhabited.ecology}\n")
    assert program.ended() == 0
    assert inhabited.active(*EVERYBODY) == set()


def test_where_nothing_is_deployed_both_say_so(inhabited: Home, capsys: pytest.CaptureFixture[str]) -> None:
    where = inhabited.arguments()
    for command in ("status", "stop"):
        outcome = run(capsys, command, *where)
        assert (outcome.code, outcome.out) == (0, f"nothing is deployed in ecology {inhabited.ecology}\n")
    assert run(capsys, "status", "--format", "json", *where).body == []

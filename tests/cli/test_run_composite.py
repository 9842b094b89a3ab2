"""The example of a composite on one site and its user on another: repaired inside, and lost as a whole."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import pytest

from selfconf.model.term import IRI
from tests.cli.processes import Home

pytestmark = pytest.mark.process

EXAMPLE = Path(__file__).parents[2] / "examples" / "lookout"
HARBOUR = "https://example.org/harbour#"


def kill(home: Home, name: str) -> None:
    """Kill the process of a component that lives."""
    answer = home.state(IRI(HARBOUR + name))
    assert answer is not None
    os.kill(int(answer.place.split()[1]), signal.SIGKILL)


def heard(home: Home) -> str:
    """What the pilot has told, as the log of its site has it."""
    return "".join(path.read_text() for path in (home.runtime / "log").glob("*ferry*"))


def test_a_composite_on_another_site_is_repaired_there_and_lost_when_it_cannot_be(home: Home) -> None:
    home.site("harbour", str(EXAMPLE / "harbour"))
    connect = (home.endpoint("harbour"),)
    home.site("ferry", str(EXAMPLE / "ferry"), connect=connect, options=("--listen", home.anywhere))
    where = ("--ecology", home.ecology, "--connect", home.endpoint("ferry"), "--format", "json")
    run = home.selfconf("run", str(EXAMPLE / "approach.ttl"), *where)
    roles = run.act("running")["configuration"]["roles"]
    assert [role["components"] for role in roles] == [[HARBOUR + "lookout"], [HARBOUR + "pilot"]]
    assert home.until(lambda: "seen by pier-camera" in heard(home))
    status = home.selfconf("status", *home.arguments(), "--format", "json")
    assert status.ended() == 0
    kill(home, "pier-camera")
    assert home.until(lambda: "seen by crane-camera" in heard(home))
    kill(home, "boat-tracker")
    lost = run.act("lost")
    assert (lost["component"], lost["cause"]) == (HARBOUR + "lookout", "fail")
    assert "its inside is refused: no component is eligible for the role tracker" in lost["detail"]
    assert run.ended() == 1

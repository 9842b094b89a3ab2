"""The example of a composite on one site and its user on another: repaired inside, and lost as a whole."""

from __future__ import annotations

import os
import shutil
import signal
from pathlib import Path

import pytest

from selfconf.model.term import IRI
from tests.cli.command import run as run_command
from tests.cli.processes import Home

pytestmark = pytest.mark.process

EXAMPLE = Path(__file__).parents[2] / "examples" / "lookout"
HARBOUR = "https://example.org/harbour#"


INSIDE_OF = "SELECT ?composite { GRAPH ?g { ?configuration sc:insideOf ?composite } }"


def kill(home: Home, name: str) -> None:
    """Kill the process of a component that lives."""
    answer = home.state(IRI(HARBOUR + name))
    assert answer is not None
    os.kill(int(answer.place.split()[1]), signal.SIGKILL)


def heard(home: Home) -> str:
    """What the pilot has told, as the log of its site has it."""
    return "".join(path.read_text() for path in (home.runtime / "log").glob("*ferry*"))


def test_a_composite_on_another_site_is_repaired_there_and_lost_when_it_cannot_be(
    home: Home, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copytree(EXAMPLE / "harbour", home.folder / "harbour")
    home.site("harbour", str(home.folder / "harbour"))
    connect = (home.endpoint("harbour"),)
    home.site("ferry", str(EXAMPLE / "ferry"), connect=connect, options=("--listen", home.anywhere))
    where = ("--ecology", home.ecology, "--connect", home.endpoint("ferry"), "--format", "json")

    def advertised() -> dict[str, dict[str, object]]:
        body = run_command(capsys, "discover", "--format", "json", *where[:4]).body
        return {one["component"]: one for one in body["components"]}

    # With keys a hub is opened anew when it gets to know another, and hears nobody meanwhile.
    assert home.until(lambda: {HARBOUR + "lookout", HARBOUR + "pilot"} <= advertised().keys())
    run = home.selfconf("run", str(EXAMPLE / "approach.ttl"), *where)
    roles = run.act("running")["configuration"]["roles"]
    assert [role["components"] for role in roles] == [[HARBOUR + "lookout"], [HARBOUR + "pilot"]]
    assert home.until(lambda: "seen by pier-camera" in heard(home))
    status = run_command(capsys, "status", "--format", "json", *where[:4]).body
    assert {one["task"]: one["inside_of"] for one in status} == {"approach": None, "lookout": HARBOUR + "lookout"}
    shown = run_command(capsys, "status", *where[:4]).out.splitlines()
    assert [line for line in shown if line.startswith("    inside of :lookout: :look-out: running")]
    tasks = run_command(capsys, "tasks", "--format", "json", *where[:4]).body
    assert {one["task"]: one["inside_of"] for one in tasks} == {"approach": None, "lookout": HARBOUR + "lookout"}
    assert "composite lookout" in run_command(capsys, "tasks", *where[:4]).out
    within = run_command(capsys, "query", INSIDE_OF, "--format", "json", *where[:4]).body
    assert [one["composite"]["value"] for one in within["results"]["bindings"]] == [HARBOUR + "lookout"]
    kill(home, "pier-camera")
    assert home.until(lambda: "seen by crane-camera" in heard(home))
    kill(home, "boat-tracker")
    lost = run.act("lost")
    assert (lost["component"], lost["cause"]) == (HARBOUR + "lookout", "fail")
    assert "its inside is refused: no component is eligible for the role tracker" in lost["detail"]
    assert run.ended() == 1

    (home.folder / "harbour" / "parts.ttl").unlink()
    assert home.until(
        lambda: "no component is eligible for the role eye" in str(advertised()[HARBOUR + "lookout"]["reason"])
    )
    assert (
        "cannot act now: its inside cannot be configured now from what its site advertises"
        in run_command(capsys, "discover", *where[:4]).out
    )

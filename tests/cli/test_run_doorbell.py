"""The example of operations, with real processes: a doorbell has a camera look, and another one when that is gone."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import pytest

from selfconf.model.term import IRI
from tests.cli.processes import Home

pytestmark = pytest.mark.process

EXAMPLE = Path(__file__).parents[2] / "examples" / "doorbell"
FRONT = IRI("https://example.org/my-home#front-camera")


def test_a_doorbell_is_answered_by_another_camera_when_the_first_is_killed(home: Home) -> None:
    run = home.selfconf("run", str(EXAMPLE / "answer-the-door.ttl"), "--ads", str(EXAMPLE), "--ecology", home.ecology)
    assert home.until(lambda: "front-camera: the postman" in run.complaints), run.complaints
    answer = home.state(FRONT)
    assert answer is not None
    os.kill(int(answer.place.split()[1]), signal.SIGKILL)
    assert home.until(lambda: "garden-camera: the postman" in run.complaints), run.complaints
    assert run.end(signal.SIGINT) == 0

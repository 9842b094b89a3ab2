"""A question on stdin is answered on stdout, also where it asks for too much."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest

PROGRAM = """
from selfconf.api.tasks.judging import JUDGING_MEMORY, answer_question
from selfconf.errors import PeerError


def answer(question):
    if question == "no question":
        raise PeerError("it asks nothing")
    return {"octets": len(bytes(2 * JUDGING_MEMORY if question == "too much" else 7))}


answer_question(answer)
"""


@pytest.mark.process
@pytest.mark.parametrize(
    ("question", "told"),
    [
        ("a little", {"octets": 7}),
        ("no question", {"detail": "it asks nothing"}),
        ("too much", {"detail": "MemoryError"}),
    ],
)
def test_an_answer_or_why_there_is_none_is_written(question: str, told: dict[str, object]) -> None:
    command = [sys.executable, "-c", PROGRAM]
    done = subprocess.run(command, input=json.dumps(question), capture_output=True, text=True, check=True)
    assert json.loads(done.stdout) == told

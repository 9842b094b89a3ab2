"""A program that judges apart answers in JSON, or is ended when its time is over."""

from __future__ import annotations

import asyncio

import pytest

from selfconf.serve.judging_process import judged_apart

pytestmark = pytest.mark.process


def test_a_program_answers_ends_without_an_answer_or_is_ended() -> None:
    assert asyncio.run(judged_apart("json.tool", {"a": [1]}, 30.0)) == {"a": [1]}
    with pytest.raises(ValueError, match="Expecting value"):
        asyncio.run(judged_apart("no.such.module", {}, 30.0))
    with pytest.raises(asyncio.TimeoutError):
        asyncio.run(judged_apart("json.tool", {}, 0.001))

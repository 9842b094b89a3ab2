"""What a component answers of itself: whether it acts, for which task, and how it is."""

from __future__ import annotations

import os
import socket

from selfconf.protocol.messages import Verdict
from selfconf.sdk.runtime.supervision import GRACE
from tests.sdk.stage import (
    TASKS,
    THEM,
    US,
    Stage,
    apply,
)


def test_it_says_which_configurator_holds_it_and_a_busy_component_says_so_in_words() -> None:
    stage = Stage()
    assert stage.state().supervisor == ""
    assert stage.call(apply(1, US)).supervisor == US
    stage.others.announce(THEM)
    answer = stage.call(apply(2, THEM))
    assert (answer.verdict, answer.supervisor) == (Verdict.BUSY, US)
    assert answer.detail == "the task task (priority 0, configurator us) holds it"
    stage.component.fail("lost her")
    stage.let_pass(0.1)
    assert (stage.state().active, stage.state().supervisor) == (False, US)
    stage.leave()
    stage.let_pass(2 * GRACE)
    assert (stage.state().active, stage.state().supervisor) == (False, "")


def test_what_a_component_says_of_itself_names_its_process_and_who_holds_it_since_when() -> None:
    stage = Stage()
    stage.call(apply(1, US, priority=3, beginning=12.0))
    answer = stage.state()
    assert (answer.task, answer.priority, answer.beginning, answer.supervisor) == (TASKS[US], 3, 12.0, US)
    assert answer.place == f"process {os.getpid()} on {socket.gethostname()}"


def test_the_answer_to_state_says_how_long_it_has_lived_what_it_takes_and_what_it_has_issued() -> None:
    stage = Stage()
    stage.call(apply(1, US))
    stage.component.emit("velocity", 1)
    stage.let_pass(2.0)
    answer = stage.state()
    assert answer.age >= 2.0
    assert answer.memory > 0
    assert answer.issued == {"velocity": 1}
    assert stage.call(apply(2, US)).issued == {}

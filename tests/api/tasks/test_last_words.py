"""What configurators say as they end, heard over a simulated network."""

from __future__ import annotations

import pytest

from selfconf.api.synchronous_bus import SynchronousBus
from selfconf.api.tasks.last_words import OVERTAKEN, LastWords
from selfconf.bus.port import Urgency
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Notice
from tests.api.tasks.simulated_tasks import DRIVE, KEYS, Tasks


def said(tasks: Tasks, event: dict[str, object], on: str = "c1", of: str = "c1") -> frozenset[str]:
    """What configurator c1 was owed, as far as is heard, once something was said as its last words."""
    bus = SynchronousBus(tasks.network.node())
    last_words = LastWords(bus, KEYS, ["c1"])
    bus.pause(0.1)
    speaker = tasks.network.node().publisher(KEYS.notices(on), Urgency.EVENT)
    speaker.put(encode(Notice(of, 1, "patrol~1", event)))
    return last_words.owed()


@pytest.mark.parametrize("act", ["stopped", "refused"])
def test_what_a_configurator_says_at_its_end_is_heard_without_a_pause(tasks: Tasks, act: str) -> None:
    assert said(tasks, {"act": act, "owed": [DRIVE]}) == {DRIVE}
    assert tasks.network.time < 0.1 + OVERTAKEN


@pytest.mark.parametrize(
    "event", [{"act": "running"}, {"act": "stopped"}, {"act": "stopped", "owed": 3}, {"act": "stopped", "owed": [" "]}]
)
def test_what_names_nothing_is_passed_over(tasks: Tasks, event: dict[str, object]) -> None:
    assert said(tasks, event) == frozenset()


@pytest.mark.parametrize(("on", "of"), [("c2", "c1"), ("c1", "c2"), ("c2", "c2")])
def test_a_configurator_speaks_for_itself(tasks: Tasks, on: str, of: str) -> None:
    assert said(tasks, {"act": "stopped", "owed": [DRIVE]}, on, of) == frozenset()

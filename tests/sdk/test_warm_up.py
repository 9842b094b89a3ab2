"""What a program goes through before its first call: all that the call needs, and nothing of what the program holds."""

from __future__ import annotations

import subprocess
import sys
import threading
import time

import pytest

from selfconf.sdk import Component
from selfconf.sdk.host import WARM_UPS
from selfconf.sdk.warm_up import warm_up_calls
from tests.sdk.living import LivingStage, until

PROGRAM = """
from selfconf.model import immutable
from selfconf.sdk.host import WARM_UPS
from selfconf.sdk.warm_up import warm_up_calls

compiled, compile_it = [], immutable._initializer
immutable._initializer = lambda cls: compiled.append(cls.__name__) or compile_it(cls)

def made_ready():
    return len(compiled), immutable._copying.cache_info().misses

for _ in range(WARM_UPS):
    warm_up_calls()
before = made_ready()
warm_up_calls()
print(*before, made_ready() == before, *compiled)
"""
LAMP = ':lamp a sc:Component, :Lamp ; sc:hasOutput [ sc:name "light" ; sc:signalType :Light ] .'


class Lamp(Component):
    """A lamp."""


def test_once_a_program_is_warm_a_call_makes_nothing_ready_any_more() -> None:
    done = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, check=True, timeout=60)
    compiled, copied, warm, *names = done.stdout.split()
    assert (int(compiled) > 5, int(copied) > 1, warm) == (True, True, "True")
    assert {"Apply", "Reserve", "Release", "CallAnswer", "Hold", "Wire"} <= set(names)
    assert done.stderr == ""


def test_two_components_of_no_meaning_feed_each_other_and_come_to_rest(monkeypatch: pytest.MonkeyPatch) -> None:
    said: list[str] = []
    fail = Component.fail

    def failed(self: Component, reason: str) -> None:
        said.append("fails")
        fail(self, reason)

    monkeypatch.setattr(Component, "received", lambda self, port, signal: said.append(port))
    monkeypatch.setattr(Component, "stopped", lambda self: said.append("stopped"))
    monkeypatch.setattr(Component, "fail", failed)
    warm_up_calls()
    assert said == ["in", "fails", "stopped", "stopped"]


@pytest.fixture
def times(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """An entry, the name of its thread, for each time that the program warms up."""
    found: list[str] = []
    monkeypatch.setattr("selfconf.sdk.warm_up.warm_up_calls", lambda: found.append(threading.current_thread().name))
    return found


@pytest.mark.process
def test_a_host_of_which_no_component_is_held_warms_up(living: LivingStage, times: list[str]) -> None:
    living.component(living.advertised(Lamp, LAMP)())
    assert until(lambda: len(times) == WARM_UPS)
    assert set(times) == {"bus"}


@pytest.mark.process
def test_a_host_of_which_a_component_is_held_does_not(
    living: LivingStage, times: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("selfconf.sdk.host.AT_REST", 1.0)
    lamp = living.component(living.advertised(Lamp, LAMP)())
    began, answers = time.monotonic(), living.apply("urn:c:lamp")
    assert until(lambda: bool(answers))
    assert time.monotonic() - began < 1.0
    later: list[None] = []
    lamp._attached().bus.later(1.2, lambda: later.append(None))
    assert until(lambda: bool(later))
    assert times == []

"""The class that an author derives from, before and after it is part of an ecology."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest

from selfconf.errors import ProgrammerError
from selfconf.model.term import IRI
from selfconf.sdk.component import Component, Refused, Signal
from tests.sdk.stage import US, Stage, apply


class Lamp(Component):
    """A component with an advertisement, of which it overrides nothing."""

    advertisement = "lamp.ttl"


def test_a_relative_advertisement_lies_beside_the_file_of_the_class() -> None:
    assert Lamp.advertisement_path() == Path(__file__).parent / "lamp.ttl"


def test_an_absolute_advertisement_lies_where_it_says(tmp_path: Path) -> None:
    class Elsewhere(Lamp):
        advertisement = tmp_path / "lamp.ttl"

    assert Elsewhere.advertisement_path() == tmp_path / "lamp.ttl"


def test_a_class_without_an_advertisement_is_told_that_it_needs_one() -> None:
    class Nameless(Component):
        pass

    with pytest.raises(ProgrammerError, match=r"^Nameless needs an `advertisement`"):
        Nameless.advertisement_path()


def test_the_advertisement_of_a_class_in_no_file_is_in_the_current_folder(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "notebook", ModuleType("notebook"))
    typed = type("Typed", (Component,), {"__module__": "notebook", "advertisement": "lamp.ttl"})
    assert typed.advertisement_path() == Path("lamp.ttl")


@pytest.mark.parametrize(
    "act",
    [
        lambda lamp: lamp.emit("light", 1),
        lambda lamp: lamp.fail("broken"),
        lambda lamp: lamp.every(1.0, lamp.stopped),
    ],
    ids=["emit", "fail", "every"],
)
def test_outside_an_ecology_a_component_can_do_nothing_and_says_why(act: Callable[[Lamp], None]) -> None:
    with pytest.raises(
        ProgrammerError,
        match=r"^Lamp is not part of an ecology yet; hand it to `main` or a Host, and begin in `started`$",
    ):
        act(Lamp())


def test_a_component_is_active_once_it_was_applied_to() -> None:
    assert not Lamp().active
    stage = Stage(Lamp())
    assert not stage.component.active
    stage.call(apply(1, US))
    assert stage.component.active


def test_a_component_that_raises_refused_does_not_become_active() -> None:
    class Reluctant(Lamp):
        def started(self) -> None:
            raise Refused("the bulb is out")

    stage = Stage(Reluctant())
    assert stage.call(apply(1, US)).detail == "the bulb is out"
    assert not stage.component.active


def test_the_fields_of_a_signal_are_reached_by_their_names() -> None:
    signal = Signal({"x": 1.5}, IRI("urn:c:tracker"), 12.0, 1)
    assert signal["x"] == 1.5
    with pytest.raises(KeyError):
        signal["y"]


def test_a_message_of_ros_is_received_as_its_fields_and_everything_else_as_it_is() -> None:
    assert Component.signal_value({"on": True}, "") == {"on": True}
    assert Component.signal_value(b"\x89PNG", "image/png") == b"\x89PNG"
    unknown = f'application/cdr; type="lab_msgs/msg/Mood"; hash=RIHS01_{"0" * 64}'
    assert Component.signal_value(b"\x00\x01\x00\x00", unknown) == b"\x00\x01\x00\x00"

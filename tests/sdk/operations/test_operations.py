"""Operations in an ecology in memory: what comes of a call, and to whom the next one goes."""

from __future__ import annotations

import math
import threading
from concurrent.futures import Future
from typing import Any

import pytest

from selfconf.api.task import template
from selfconf.bus.memory import Faults
from selfconf.errors import ProgrammerError
from selfconf.model.refusal import Refusal
from selfconf.model.run_event import ComponentLost
from selfconf.sdk.component import CallStatus, Refused, Response, Signal
from selfconf.sdk.operations import MOST_PAYLOAD
from selfconf.testing import MemoryEcology
from selfconf.testing.memory_ecology import REPORT_LAG, MemoryRun
from tests.sdk.living import PATIENCE
from tests.sdk.operations.photographs import (
    ALBUM,
    ALBUM_SAYS,
    CAMERA,
    CAMERA_SAYS,
    PREFIXES,
    Album,
    Camera,
    Peer,
    refuses,
)
from tests.sdk.stage import apply

TASK = """
:task a sc:Template ; sc:roles ( :eye :user ) .
:eye a sc:Role ; sh:class :Camera ; sc:feeds :user .
:user a sc:Role ; sh:class :Album .
"""


class Darkroom:
    """An ecology in memory with an album and cameras."""

    def __init__(self, *cameras: Camera, seed: int = 0) -> None:
        self.ecology = MemoryEcology(seed)
        self.album = self.ecology.add(Album(), ALBUM_SAYS.replace("MORE", ""))
        for camera in cameras:
            self.ecology.add(camera, CAMERA_SAYS.replace("NAME", camera.name))
        self.run: MemoryRun = self.ecology.run(template(PREFIXES + TASK)).started()

    def photo(self, request: Any = None, seconds: float = 2.0) -> Response:
        """The answer to a request of the album."""
        known = len(self.album.answers)
        self.album.ask(request, seconds)
        assert self.ecology.until(lambda: len(self.album.answers) > known, 10.0)
        return self.album.answers[-1]


def breaks(request: Signal) -> Any:
    """A camera whose code is wrong."""
    return {}["nothing"]


def test_a_call_is_answered_with_what_the_other_component_returns() -> None:
    camera = Camera()
    answer = Darkroom(camera).photo({"width": 320})
    assert answer
    assert answer.status is CallStatus.ANSWERED
    assert (answer["by"], answer["sent"], answer.source) == ("camera", {"width": 320}, CAMERA)
    assert camera.requests[0].source == ALBUM


def test_bytes_are_sent_along_and_answered() -> None:
    assert Darkroom(Camera(reply=lambda request: request.value[::-1])).photo(b"\n\x00ab").value == b"ba\x00\n"


def test_a_component_that_refuses_says_why_and_acts_on() -> None:
    room = Darkroom(Camera(reply=refuses))
    answer = room.photo()
    assert not answer
    assert (answer.status, answer.detail) == (CallStatus.REFUSED, "the lens is covered")
    assert room.run.running


def test_code_that_breaks_in_a_call_is_a_failure_of_its_component() -> None:
    room = Darkroom(Camera(reply=breaks), Camera("spare"))
    assert room.photo().detail == "camera broke: KeyError: 'nothing'"
    assert room.ecology.until(lambda: bool(room.photo()))
    assert room.photo()["by"] == "spare"
    room.ecology.advance(REPORT_LAG)
    assert [event.component for event in room.run.events if isinstance(event, ComponentLost)] == [CAMERA]


def test_a_component_hears_that_it_is_connected_once_as_long_as_it_is() -> None:
    camera = Camera()
    room = Darkroom(camera, Camera("spare"))
    assert room.photo()["by"] == "camera"
    room.ecology.crash(camera)
    assert room.ecology.until(lambda: room.photo().status is CallStatus.ANSWERED)
    assert room.album.told == ["photo is connected"]


def test_an_operation_that_loses_whom_to_call_is_told() -> None:
    peer = Peer(lambda request: None)
    peer.stage.call(apply(2))
    assert peer.album.told == ["photo is connected", "photo is not connected"]


def test_the_next_call_goes_to_the_component_that_has_taken_the_place() -> None:
    camera = Camera()
    room = Darkroom(camera, Camera("spare"))
    assert room.photo()["by"] == "camera"
    room.ecology.crash(camera)
    assert room.photo().status is CallStatus.GONE
    assert room.ecology.until(lambda: room.photo().status is CallStatus.ANSWERED)
    assert room.photo()["by"] == "spare"


@pytest.mark.parametrize("seed", range(5))
def test_on_a_network_that_loses_and_doubles_each_call_comes_to_one_end_and_is_made_once(seed: int) -> None:
    camera = Camera()
    room = Darkroom(camera, seed=seed)
    room.ecology.network.faults = Faults(loss=0.1, doubling=0.3, least_delay=0.01, most_delay=0.3)
    for number in range(40):
        room.album.ask(number)
        room.ecology.advance(0.05 * seed)
    room.ecology.advance(5.0)
    assert len(room.album.answers) == 40
    assert {answer.status for answer in room.album.answers} == {CallStatus.ANSWERED, CallStatus.LATE}
    assert all(answer["sent"] in range(40) for answer in room.album.answers if answer)
    served = [request.value for request in camera.requests]
    assert len(served) == len(set(served))


def test_an_operation_that_is_optional_may_be_connected_to_nobody() -> None:
    ecology = MemoryEcology()
    album = ecology.add(Album(), ALBUM_SAYS.replace("MORE", "; sc:optional true"))
    alone = ":t a sc:Template ; sc:roles ( :user ) . :user a sc:Role ; sh:class :Album ."
    ecology.run(template(PREFIXES + alone)).started()
    assert album.told == []
    album.ask()
    ecology.advance(0.1)
    (answer,) = album.answers
    assert (answer.status, answer.detail) == (CallStatus.NOT_CONNECTED, "no component is connected to 'photo'")


def test_a_task_whose_operation_nobody_offers_is_refused_in_a_sentence() -> None:
    ecology = MemoryEcology()
    ecology.add(Album(), ALBUM_SAYS.replace("MORE", ""))
    ecology.advertise(PREFIXES + ":camera a sc:Component, :Camera .")
    run = ecology.run(template(PREFIXES + TASK))
    ecology.until(lambda: run.ended)
    assert isinstance(run.refusal, Refusal)
    assert str(run.refusal.reasons[0]) == (
        "the operation 'photo' (-> Image) that album needs cannot be called: "
        "no candidate of eye offers an operation -> Image for it"
    )


def test_while_a_component_does_not_act_nothing_is_called() -> None:
    album = Album()
    ecology = MemoryEcology()
    ecology.add(album, ALBUM_SAYS.replace("MORE", ""))
    album.ask()
    ecology.advance(5.0)
    assert album.answers == []


def test_what_cannot_be_called_or_sent_is_a_mistake_of_the_program() -> None:
    room = Darkroom(Camera())
    with pytest.raises(ProgrammerError, match="album advertises no need of an operation 'sound'"):
        room.album.call("sound", answered=room.album.answers.append)
    with pytest.raises(ProgrammerError, match="it is nothing that JSON can say"):
        room.album.ask(float("nan"))
    with pytest.raises(ProgrammerError, match=f"it has {MOST_PAYLOAD + 1} bytes, and {MOST_PAYLOAD} are allowed"):
        room.album.ask(bytes(MOST_PAYLOAD + 1))
    for seconds in (-0.01, 0.0, math.nan, "2", None):  # such as the rest of a time that is over
        with pytest.raises(ProgrammerError, match="`call` waits for more than zero seconds, not "):
            room.album.ask(seconds=seconds)
    with pytest.raises(ProgrammerError, match="`answered` is a function that takes the answer"):
        room.album.call("photo", answered=None)  # as by `answered=self.seen()`
    assert room.photo("all is well")


def test_an_answer_that_is_too_large_is_a_failure_of_the_component_that_gives_it() -> None:
    room = Darkroom(Camera(reply=lambda request: bytes(MOST_PAYLOAD + 1)))
    assert room.photo().detail == f"its answer has {MOST_PAYLOAD + 1} bytes, and {MOST_PAYLOAD} are allowed"
    assert room.ecology.until(lambda: any(isinstance(event, ComponentLost) for event in room.run.events))


def test_an_answer_may_come_later_from_any_thread() -> None:
    promises: list[Future[Any]] = []

    def later(request: Signal) -> Any:
        promises.append(Future())
        return promises[-1]

    room = Darkroom(Camera(reply=later))
    room.album.ask()
    room.album.ask()
    room.ecology.advance(0.1)
    assert room.album.answers == []
    threading.Thread(target=promises[1].set_result, args=({"by": "a thread"},)).start()
    promises[1].result(PATIENCE)
    assert room.ecology.until(lambda: len(room.album.answers) == 1, 5.0)
    promises[0].set_exception(Refused("the film is used up"))
    assert room.ecology.until(lambda: len(room.album.answers) == 2, 5.0)
    assert room.album.answers[0]["by"] == "a thread"
    assert room.album.answers[1].detail == "the film is used up"
    room.album.ask()
    room.ecology.advance(0.1)
    promises[2].set_exception(KeyError("lens"))
    assert room.ecology.until(lambda: len(room.album.answers) == 3, 5.0)
    assert room.album.answers[2].detail == "camera broke: KeyError: 'lens'"
    assert room.ecology.until(lambda: any(isinstance(event, ComponentLost) for event in room.run.events))

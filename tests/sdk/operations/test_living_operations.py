"""Operations on a real network, where each host has a thread for its bus and one for the code."""

from __future__ import annotations

import time

import pytest

from selfconf.bus.port import Replies
from selfconf.model.profile import CALL_MARK
from selfconf.protocol.messages import Cause, Reserve, Verdict
from selfconf.sdk.component import CallStatus
from selfconf.sdk.operations import MOST_PAYLOAD
from tests.harness.effort import thorough
from tests.sdk.living import PATIENCE, LivingStage, until
from tests.sdk.operations.photographs import (
    ALBUM,
    ALBUM_SAYS,
    CALLING,
    CAMERA,
    CAMERA_SAYS,
    DIARY,
    Album,
    Camera,
    refuses,
    request_of,
)


def connected(living: LivingStage, camera: Camera, album: Album, together: bool = False) -> None:
    """Let a camera and an album act, connected, in hosts of their own or in one."""
    living.advertised(Camera, CAMERA_SAYS.replace("NAME", "camera"))
    living.advertised(Album, ALBUM_SAYS.replace("MORE", ""))
    if together:
        host = living.host()
        host.add(camera)
        host.add(album)
        living.run(host)
    else:
        living.component(camera)
        living.component(album)
    served = living.apply("urn:c:camera", callers={"takePhoto" + CALL_MARK: (ALBUM,)})
    assert until(lambda: bool(served))
    held = living.call("urn:c:album", "reserve", Reserve(1, living.supervisor, "task~1", inputs=CALLING))
    assert until(lambda: bool(held))
    acting = living.apply("urn:c:album", inputs=CALLING)
    assert until(lambda: bool(acting))
    assert (served[0].verdict, held[0].verdict, acting[0].verdict) == (Verdict.DONE,) * 3


@thorough
@pytest.mark.parametrize("together", [False, True])
def test_a_mebibyte_goes_there_and_back_on_a_real_network(living: LivingStage, together: bool) -> None:
    album, photo = Album(), bytes(range(256)) * (MOST_PAYLOAD // 256)
    connected(living, Camera(reply=lambda request: request.value), album, together)
    album.ask(photo, PATIENCE)
    assert until(lambda: bool(album.answers))
    assert album.answers[0].value == photo


def test_a_refusal_and_the_caller_that_is_not_connected_are_told_on_a_real_network(living: LivingStage) -> None:
    album = Album()
    connected(living, Camera(reply=refuses), album)
    album.ask()
    assert until(lambda: bool(album.answers))
    assert (album.answers[0].status, album.answers[0].detail) == (CallStatus.REFUSED, "the lens is covered")
    errors: list[Replies] = []
    key = living.keys.operation(CAMERA, "takePhoto", DIARY)
    living.caller.wake_up(lambda: living.caller.ask(key, request_of(DIARY), PATIENCE, errors.append))
    assert until(lambda: bool(errors))
    assert errors[0].errors == ("diary is not connected to the operation 'takePhoto' of camera",)


@pytest.mark.slow
def test_a_caller_waits_no_longer_than_it_says_for_code_that_takes_long(living: LivingStage) -> None:
    album = Album()
    connected(living, Camera(reply=lambda request: living.release_code.wait(PATIENCE)), album)
    began = time.monotonic()
    album.ask(seconds=0.3)
    assert until(lambda: bool(album.answers))
    assert (album.answers[0].status, album.answers[0].source) == (CallStatus.LATE, CAMERA)
    assert 0.25 < time.monotonic() - began < PATIENCE
    assert until(lambda: any(fail.cause is Cause.HUNG and fail.component == CAMERA for _, fail in living.fails))

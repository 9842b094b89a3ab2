"""An album that has a camera take photos: two components with an operation, and peers that speak for them."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import Any

from selfconf.bus.port import Request
from selfconf.model.profile import CALL_MARK, Ports, Profile, needed_operation, offered_operation
from selfconf.model.term import IRI
from selfconf.protocol.messages import Wire
from selfconf.protocol.stamps import StampWriter
from selfconf.sdk.component import Component, Refused, Response, Signal
from tests.sdk.stage import KEYS, Stage, apply, reserve

PREFIXES = """@prefix sc: <https://w3id.org/selfconf#> .
@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix : <urn:c:> .
"""
ALBUM_SAYS = f"""{PREFIXES}
:album a sc:Component, :Album ; sc:needsOperation [ sc:name "photo" ; sc:response :Image MORE ] ."""
CAMERA_SAYS = f"""{PREFIXES}
:NAME a sc:Component, :Camera ; sc:hasOperation [ sc:name "takePhoto" ; sc:response :Image ] ."""
ALBUM, CAMERA, DIARY = IRI("urn:c:album"), IRI("urn:c:camera"), IRI("urn:c:diary")
IMAGE = IRI("urn:c:Image")


class Album(Component):
    """Asks for photos when it is told to, and keeps what has come of it."""

    def __init__(self) -> None:
        self.answers: list[Response] = []
        self.told: list[str] = []

    def connected(self, operation: str) -> None:
        self.told.append(f"{operation} is connected")

    def disconnected(self, operation: str) -> None:
        self.told.append(f"{operation} is not connected")

    def ask(self, request: Any = None, seconds: float = 2.0) -> None:
        """Ask for a photo."""
        self.call("photo", request, answered=self.answers.append, seconds=seconds)


class Camera(Component):
    """Answers with its name, and what was sent along."""

    def __init__(self, name: str = "camera", reply: Callable[[Signal], Any] | None = None) -> None:
        self.name, self.reply = name, reply
        self.requests: list[Signal] = []

    def called(self, operation: str, request: Signal) -> Any:
        self.requests.append(request)
        return {"by": self.name, "sent": request.value} if self.reply is None else self.reply(request)


def refuses(request: Signal) -> Any:
    """A camera that does not want to."""
    raise Refused("the lens is covered")


ALBUM_PROFILE = Profile(ALBUM, ports=Ports((needed_operation("photo", None, IMAGE),)))
CAMERA_PROFILE = Profile(CAMERA, ports=Ports(outputs=(offered_operation("takePhoto", None, IMAGE),)))
CALLING = {"photo" + CALL_MARK: (Wire(CAMERA, "takePhoto" + CALL_MARK),)}


class Peer:
    """An album on a stage, with a peer in the place of the camera that does what it is told with a request."""

    def __init__(self, answer: Callable[[Request], None]) -> None:
        self.album = Album()
        self.stage = Stage(self.album, ALBUM_PROFILE)
        self.stage.others.serve(KEYS.operation(CAMERA, "takePhoto", ALBUM), answer)
        self.stage.call(reserve(inputs=CALLING))
        self.stage.call(apply(inputs=CALLING))

    def answer(self) -> Response:
        """What comes of a call."""
        self.album.ask(seconds=1.0)
        self.stage.let_pass(2.0)
        (answer,) = self.album.answers
        return answer


def request_of(component: IRI, payload: bytes = b"null") -> bytes:
    """A request as it travels, each with a number of its own."""
    return StampWriter(component, "life").write(next(NUMBERS), 0.0) + b"\n" + payload


NUMBERS = itertools.count(1)

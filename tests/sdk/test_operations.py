"""Operations are served and called: an answer, a refusal, a time-out, an end; by those that are connected alone."""

from __future__ import annotations

import itertools
import json
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any

import pytest

from selfconf.api.task import template
from selfconf.bus.memory import Faults
from selfconf.bus.port import Replies, Request
from selfconf.errors import ProgrammerError
from selfconf.model.profile import CALL_MARK, Ports, Profile, needed_operation, offered_operation
from selfconf.model.refusal import Refusal
from selfconf.model.run_event import ComponentLost
from selfconf.model.signal_fields import SignalField, SignalFields
from selfconf.model.term import IRI, XSD_NAMESPACE
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Apply, Cause, Reserve, Verdict, Wire
from selfconf.protocol.stamps import StampWriter
from selfconf.sdk.code_thread import CodeThread
from selfconf.sdk.component import CallStatus, Component, Refused, Response, Signal
from selfconf.sdk.operations import MOST_CALLS, MOST_PAYLOAD
from selfconf.sdk.runtime import ComponentRuntime
from selfconf.testing import MemoryEcology
from selfconf.testing.memory_ecology import REPORT_LAG, MemoryRun
from tests.sdk.living import PATIENCE, LivingStage, until
from tests.sdk.stage import KEYS, THEM, Stage, apply, release, reserve

PREFIXES = """@prefix sc: <https://w3id.org/selfconf#> .
@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix : <urn:c:> .
"""
ALBUM_SAYS = f"""{PREFIXES}
:album a sc:Component, :Album ; sc:needsOperation [ sc:name "photo" ; sc:response :Image MORE ] ."""
CAMERA_SAYS = f"""{PREFIXES}
:NAME a sc:Component, :Camera ; sc:hasOperation [ sc:name "takePhoto" ; sc:response :Image ] ."""
TASK = """
:task a sc:Template ; sc:roles ( :eye :user ) .
:eye a sc:Role ; sh:class :Camera ; sc:feeds :user .
:user a sc:Role ; sh:class :Album .
"""
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


def refuses(request: Signal) -> Any:
    """A camera that does not want to."""
    raise Refused("the lens is covered")


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


# A component by itself, with peers that do what no component of this library would.

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


def replying(payload: bytes, attachment: bytes) -> Callable[[Request], None]:
    """A peer that replies something."""

    def reply(request: Request) -> None:
        request.reply(request.key, payload, attachment)
        request.finish()

    return reply


def test_an_answer_that_does_not_come_is_late() -> None:
    answer = Peer(lambda request: None).answer()
    assert (answer.status, answer.detail) == (CallStatus.LATE, "camera has not answered within 1 s")


def test_a_component_that_ends_with_the_request_in_its_hands_is_gone() -> None:
    answer = Peer(lambda request: request.finish()).answer()
    assert (answer.status, answer.detail) == (CallStatus.GONE, "camera ended before it answered")


@pytest.mark.parametrize(
    ("payload", "attachment", "detail"),
    [
        (b"{", StampWriter(CAMERA, "1").write(1, 0.0), "what it answers is no answer: "),
        (b"{}", b"{}", "what it answers is no answer: not a message of kind 'stamp'"),
        (bytes(MOST_PAYLOAD + 1), b"", f"its answer has {MOST_PAYLOAD + 1} bytes, and {MOST_PAYLOAD} are allowed"),
        (b"{}", StampWriter(ALBUM, "1").write(1, 0.0), "what it answers is no answer: it is one of album"),
    ],
)
def test_what_is_no_answer_is_a_refusal(payload: bytes, attachment: bytes, detail: str) -> None:
    answer = Peer(replying(payload, attachment)).answer()
    assert answer.status is CallStatus.REFUSED
    assert answer.detail.startswith(detail)


def test_a_component_that_was_stopped_hears_no_answer() -> None:
    peer = Peer(lambda request: None)
    peer.album.ask(seconds=1.0)
    peer.stage.call(release())
    peer.stage.call(apply(2, inputs=CALLING))
    peer.stage.let_pass(2.0)
    assert peer.album.answers == []


def test_a_component_that_calls_and_calls_is_told_to_wait() -> None:
    peer = Peer(lambda request: None)
    for _ in range(MOST_CALLS + 1):
        peer.album.ask()
    peer.stage.let_pass(0.5)
    (answer,) = peer.album.answers
    assert (answer.status, answer.detail) == (CallStatus.REFUSED, "64 calls wait for their answers already")


class Served:
    """A camera on a stage that acts, and may be called by the album."""

    def __init__(self, component: Component | None = None, fields: dict[IRI, SignalFields] | None = None) -> None:
        self.camera = component or Camera()
        self.stage = Stage(profile=ALBUM_PROFILE)
        self.runtime = ComponentRuntime(
            self.stage.network.node(), KEYS, CAMERA_PROFILE, self.camera, "life-c", fields=fields
        )
        self.stage.profile = CAMERA_PROFILE
        self.stage.call(apply(callers={"takePhoto" + CALL_MARK: (ALBUM,)}))

    def ask(self, request: bytes, operation: str = "takePhoto", caller: IRI = ALBUM) -> Replies:
        """The replies to a request of a component, whatever it says."""
        replies: list[Replies] = []
        self.stage.caller.ask(KEYS.operation(CAMERA, operation, caller), request, 1.0, replies.append)
        assert self.stage.network.run(lambda: bool(replies), 5.0)
        return replies[0]


def request_of(component: IRI, payload: bytes = b"null") -> bytes:
    """A request as it travels, each with a number of its own."""
    return StampWriter(component, "life").write(next(NUMBERS), 0.0) + b"\n" + payload


NUMBERS = itertools.count(1)


def test_a_request_that_comes_twice_is_served_once() -> None:
    served = Served()
    request = request_of(ALBUM)
    assert served.ask(request).samples
    assert served.ask(request) == Replies()


def test_only_who_is_connected_is_answered() -> None:
    served = Served()
    assert json.loads(served.ask(request_of(ALBUM)).samples[0].payload) == {"by": "camera", "sent": None}
    stranger = IRI("urn:c:stranger")
    refused = served.ask(request_of(stranger), caller=stranger)
    assert refused.samples == ()
    assert refused.errors == ("stranger is not connected to the operation 'takePhoto' of camera",)


def test_who_asks_in_the_name_of_another_is_refused() -> None:
    """The key says who asks, which rules can hold a component to; the stamp has to say the same."""
    served = Served()
    refused = served.ask(request_of(ALBUM), caller=DIARY)
    assert refused.samples == ()
    assert refused.errors == ("not a request: it is stamped by album, and asked by another component",)
    assert served.ask(request_of(ALBUM)).samples


def test_an_answer_that_was_promised_is_cancelled_when_the_component_is_stopped() -> None:
    promise: Future[Any] = Future()
    served = Served(Camera(reply=lambda request: promise))
    replies: list[Replies] = []
    served.stage.caller.ask(KEYS.operation(CAMERA, "takePhoto", ALBUM), request_of(ALBUM), 5.0, replies.append)
    served.stage.let_pass(0.1)
    served.stage.call(release())
    assert served.stage.network.run(lambda: bool(replies), 5.0)
    assert promise.cancelled()
    assert replies[0].errors == ("camera ended the call before it answered",)


@pytest.mark.parametrize("ended", ["the caller is connected no more", "the caller waits no longer"])
def test_an_answer_that_nobody_waits_for_is_cancelled(ended: str) -> None:
    promises: list[Future[Any]] = [Future(), Future()]
    unused = iter(promises)
    served = Served(Camera(reply=lambda request: next(unused)))
    served.stage.call(apply(2, callers={"takePhoto" + CALL_MARK: (ALBUM, DIARY)}))
    patience = b"0.5" if "longer" in ended else b""
    for caller, attachment in ((ALBUM, patience), (DIARY, b"50")):
        key = KEYS.operation(CAMERA, "takePhoto", caller)
        served.stage.caller.ask(key, request_of(caller), 60.0, lambda replies: None, attachment)
        served.stage.let_pass(0.1)
    if not patience:
        served.stage.call(apply(3, callers={"takePhoto" + CALL_MARK: (DIARY,)}))
    served.stage.let_pass(1.0)
    assert [promise.cancelled() for promise in promises] == [True, False]


@pytest.mark.parametrize("ended", ["the caller is connected no more", "the caller waits no longer"])
def test_a_request_that_has_waited_for_the_code_until_nobody_wanted_it_is_not_served(ended: str) -> None:
    stage, code, camera = Stage(profile=ALBUM_PROFILE), CodeThread(inline=False), Camera()
    ComponentRuntime(stage.network.node(), KEYS, CAMERA_PROFILE, camera, "life-c", code)

    def call(message: Apply) -> None:
        stage.caller.ask(KEYS.call(CAMERA, "apply"), encode(message), 5.0, lambda replies: None)
        stage.let_pass(0.1)

    def poll() -> None:
        code.poll()
        stage.let_pass(0.1)

    call(apply(callers={"takePhoto" + CALL_MARK: (ALBUM,)}))
    poll()
    replies: list[Replies] = []
    stage.caller.ask(KEYS.operation(CAMERA, "takePhoto", ALBUM), request_of(ALBUM), 9.0, replies.append, b"1.5")
    stage.let_pass(0.1)  # the code is busy
    if "connected" in ended:
        call(apply(2, callers={"takePhoto" + CALL_MARK: (DIARY,)}))
    else:
        stage.let_pass(2.0)
    poll()
    assert camera.requests == []
    connected = "album is not connected to the operation 'takePhoto' of camera"
    waited = "camera was busy for longer than album waits for 'takePhoto'"
    assert replies[0].errors == (connected if "connected" in ended else waited,)


@pytest.mark.parametrize("patience", [b"long", b"-1", b"inf", b"nan", b"\xff"])
def test_a_request_that_does_not_say_how_long_is_waited_is_refused(patience: bytes) -> None:
    served, replies = Served(), list[Replies]()
    key = KEYS.operation(CAMERA, "takePhoto", ALBUM)
    served.stage.caller.ask(key, request_of(ALBUM), 1.0, replies.append, patience)
    assert served.stage.network.run(lambda: bool(replies), 5.0)
    assert replies[0].errors[0].startswith("not a request: ")


def test_a_component_that_is_released_is_connected_to_nobody() -> None:
    served = Served()
    served.stage.call(release())
    assert served.ask(request_of(ALBUM)).errors == ("album is not connected to the operation 'takePhoto' of camera",)


def test_who_is_connected_no_more_is_refused_while_others_go_on() -> None:
    served = Served()
    served.stage.call(apply(2, callers={"takePhoto" + CALL_MARK: (DIARY,)}))
    assert served.ask(request_of(ALBUM)).errors
    assert served.ask(request_of(DIARY), caller=DIARY).samples


def test_each_task_that_shares_a_component_has_its_callers() -> None:
    served = Served()
    served.stage.call(apply(1, THEM, callers={"takePhoto" + CALL_MARK: (DIARY,)}))
    assert served.ask(request_of(ALBUM)).samples
    assert served.ask(request_of(DIARY), caller=DIARY).samples
    served.stage.call(release())
    assert not served.ask(request_of(ALBUM)).samples
    assert served.ask(request_of(DIARY), caller=DIARY).samples


@pytest.mark.parametrize(
    ("request_", "reason"),
    [
        (b"", "not a request: not a message"),
        (request_of(ALBUM, b"{"), "not a request: Expecting property name"),
        (
            request_of(ALBUM, bytes(MOST_PAYLOAD + 1)),
            f"not a request: a request of {MOST_PAYLOAD + 1} bytes is too large",
        ),
        (b'raw{"kind": "stamp"}\n1', "not a request: a message of kind 'stamp' lacks"),
    ],
)
def test_what_is_no_request_is_refused(request_: bytes, reason: str) -> None:
    (error,) = Served().ask(request_).errors
    assert error.startswith(reason)


def test_an_operation_that_there_is_not_is_refused() -> None:
    assert Served().ask(request_of(ALBUM), "develop film").errors == ("camera offers no operation 'develop film'",)


def test_a_component_without_a_method_for_its_operation_says_so() -> None:
    assert Served(Component()).ask(request_of(ALBUM)).errors == ("'takePhoto' is advertised, and not written yet",)


def test_an_answer_that_is_not_of_its_type_is_malformed() -> None:
    text = SignalFields(IRI("urn:c:Text"), (SignalField("text", IRI(XSD_NAMESPACE + "string")),))
    served = Served(Camera(reply=lambda request: {"text": 3}), {IRI("urn:c:Image"): text})
    (error,) = served.ask(request_of(ALBUM)).errors
    assert error.startswith("its answer ")
    served.stage.let_pass(0.1)
    assert [fail.cause for fail in served.stage.fails] == [Cause.MALFORMED]


def test_a_request_that_is_not_of_its_type_is_the_fault_of_the_caller() -> None:
    text = SignalFields(IRI("urn:c:Text"), (SignalField("text", IRI(XSD_NAMESPACE + "string")),))
    stage = Stage(Album(), Profile(ALBUM, ports=Ports((needed_operation("other", None, IMAGE),))))
    profile = Profile(DIARY, ports=Ports((needed_operation("photo", IRI("urn:c:Text"), None),)))
    diary = Album()
    ComponentRuntime(stage.network.node(), KEYS, profile, diary, "life-d", fields={IRI("urn:c:Text"): text})
    stage.profile = profile
    stage.call(reserve(inputs=CALLING))
    stage.call(apply(inputs=CALLING))
    diary.ask({"text": 3})
    stage.let_pass(0.1)
    assert [(fail.component, fail.cause) for fail in stage.fails] == [(DIARY, Cause.MALFORMED)]


# On a real network, where each host has a thread for its bus and one for the code.


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

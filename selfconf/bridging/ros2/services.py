"""Services of ROS 2 as operations, in both directions: a call is a query on the key of the service, with an attachment.

What the server of a service answers is the answer of an operation that its node offers. What the client of one asks is
answered by whatever the configuration has connected to the operation that its node needs: for that long the bridge is
a server of the service, as itself. Requests and responses travel as CDR from node to node, as messages do; where the
other end is no node they are objects with the fields of the `.srv` definition, if that is known.

No component answers in place of a server that ROS 2 has: as long as there is one, clients are not connected to another
one too. A call does not say which client it is of: of several clients of one service the first that is connected counts
for all.
"""

from __future__ import annotations

import time
from concurrent.futures import Future
from typing import Any

from selfconf import ros2
from selfconf.bridging.ros2.attachments import RosAttachment
from selfconf.bridging.ros2.domain import RosDomain, bridge_token
from selfconf.bridging.ros2.tokens import SERVER, RosEndpoint
from selfconf.bus.port import Replies, Request, Undo
from selfconf.errors import PeerError, ProgrammerError
from selfconf.ros2 import MessageError, MessageType
from selfconf.sdk import Component, Refused, Response, Signal

SERVICE_SECONDS = 60.0
"""How long a service may take; a caller of an operation that it is may wait for less."""


def call_service(domain: RosDomain, endpoint: RosEndpoint, request: Signal) -> Future[Any]:
    """Ask the server of a service; may be called from any thread, which it does not hold up.

    The future comes to the response, as an object or as CDR as the request was, or to Refused.
    """
    answer = Future[Any]()

    def heard(replies: Replies) -> None:
        if answer.set_running_or_notify_cancel():
            try:
                answer.set_result(_response(endpoint, replies, isinstance(request.value, bytes)))
            except Refused as refused:
                answer.set_exception(refused)

    def ask() -> None:
        try:
            payload = _request(endpoint.type, request)
        except Refused as refused:
            if answer.set_running_or_notify_cancel():
                answer.set_exception(refused)
            return
        domain.ask(endpoint, payload, SERVICE_SECONDS, heard)

    domain.bus.wake_up(ask)
    return answer


def _request(kind: MessageType, request: Signal) -> bytes:
    """A request as CDR. Raises Refused."""
    parts = ros2.service_parts(kind)
    if not isinstance(request.value, bytes):
        if parts is None:
            raise Refused(f"the fields of {kind.name} are not known, so that no object can be a request")
        try:
            return ros2.message({} if request.value is None else request.value, parts.request)
        except MessageError as error:
            raise Refused(f"what {request.source.short} asks {error}") from None
    said = ros2.read_media(request.media)
    if said is None or said.type != (kind if parts is None else parts.request):
        raise Refused(f"what {request.source.short} asks is no request of {kind.name} by its hash")
    return request.value


def _response(endpoint: RosEndpoint, replies: Replies, as_bytes: bool) -> Any:
    """What a server has answered. Raises Refused."""
    payload = response_payload(endpoint, replies, SERVICE_SECONDS)
    if ros2.service_parts(endpoint.type) is None:
        return payload
    fields = response_fields(endpoint, payload)
    return payload if as_bytes else fields


def response_payload(endpoint: RosEndpoint, replies: Replies, seconds: float) -> bytes:
    """The CDR that a service has answered, which had that long to do so. Raises Refused if it has not."""
    if replies.samples:
        return replies.samples[0].payload
    who = f"the service {endpoint.topic}"
    if replies.errors:
        raise Refused(f"{who} refuses: {replies.errors[0][:200]}")
    raise Refused(f"{who} does not answer" if replies.complete else f"{who} has not answered within {seconds:g} s")


def response_fields(endpoint: RosEndpoint, payload: bytes) -> dict[str, Any]:
    """The fields of a response of a service that is known, arrays as lists. Raises Refused if it is none."""
    parts = ros2.service_parts(endpoint.type)
    assert parts is not None, "a response is read only where its definition is known"
    try:
        fields = ros2.message_fields(payload, parts.response)
    except MessageError as error:
        raise Refused(f"what the service {endpoint.topic} answers {error}") from None
    return {name: _listed(value) for name, value in fields.items()}


def _listed(value: Any) -> Any:
    """An object with arrays of NumPy as lists, as JSON has them."""
    if isinstance(value, dict):
        return {name: _listed(each) for name, each in value.items()}
    if isinstance(value, list):
        return [_listed(each) for each in value]
    return value.tolist() if hasattr(value, "tolist") else value


class ServedService:
    """The bridge as the server of a service that a node is a client of; on the thread of the bus of the domain."""

    def __init__(self, domain: RosDomain, endpoint: RosEndpoint, name: str, component: Component) -> None:
        """`name` is that of the operation that the component of the node calls for its client."""
        self._domain, self._endpoint, self._name, self._component = domain, endpoint, name, component
        self._open: set[Request] = set()
        """The requests that wait for an answer."""
        self._declared: list[Undo] = []
        """What takes back that the bridge serves; nothing while a node does."""
        self._key = endpoint.key(domain.number)
        self._serving = domain.serving.setdefault(self._key, [])
        self._serving.append(self)
        if len(self._serving) > 1:
            domain.tell(
                f"{endpoint.topic}: several nodes call it, and which call is whose cannot be said; the first counts"
            )
        self.look()

    def look(self) -> None:
        """Serve where no node of ROS 2 does; servers may have come or gone.

        Of two bridges that serve already neither takes that back, or both would.
        """
        domain, is_serving = self._domain, bool(self._declared)
        if domain.has_server(self._key, of_bridges=not is_serving):
            domain.tell(
                f"{self._endpoint.topic}: a node of ROS 2 serves it, which its clients reach; no other is connected"
            )
            self._withdraw()
        elif not is_serving:
            self._declared.append(domain.bus.serve(self._key, self._asked, complete=True))
            self._declared.append(domain.bus.announce(bridge_token(domain, SERVER, self._endpoint).key()))

    def _withdraw(self) -> None:
        for undo in self._declared:
            undo()
        self._declared = []

    def end(self) -> None:
        """Serve no more; a client that waits for an answer hears that."""
        self._serving.remove(self)
        self._withdraw()
        for request in list(self._open):
            self._refuse(request, "what was connected to it is so no more")

    def _asked(self, request: Request) -> None:
        if self._serving[0] is not self:  # the call was made once, and is answered once
            request.finish()
            return
        self._open.add(request)
        try:
            attachment = RosAttachment.unpack(request.attachment)
        except PeerError as error:
            self._refuse(request, str(error))
            return
        parts = ros2.service_parts(self._endpoint.type)
        media = (self._endpoint.type if parts is None else parts.request).media()

        def answered(answer: Response) -> None:  # on the thread of the components' code
            self._domain.bus.wake_up(lambda: self._answer(request, attachment, answer))

        if not self._component.active:
            self._refuse(request, "what was connected to it is so no more")
            return
        try:
            self._component.call(self._name, request.payload, answered=answered, seconds=SERVICE_SECONDS, media=media)
        except ProgrammerError as error:  # it is longer than a request may be
            self._refuse(request, str(error))

    def _answer(self, request: Request, asked: RosAttachment, answer: Response) -> None:
        if request not in self._open:
            return
        try:
            payload = self._payload(answer)
        except MessageError as error:
            self._refuse(request, str(error))
            return
        self._open.discard(request)
        attachment = RosAttachment(asked.sequence, time.time_ns(), asked.publisher)
        request.reply(self._endpoint.key(self._domain.number), payload, attachment.pack())
        request.finish()

    def _payload(self, answer: Response) -> bytes:
        """An answer as CDR. Raises MessageError."""
        if not answer:
            raise MessageError(answer.detail)
        parts = ros2.service_parts(self._endpoint.type)
        if parts is None:
            if isinstance(answer.value, bytes):
                return answer.value
            raise MessageError(f"the fields of {self._endpoint.type.name} are not known")
        try:
            if isinstance(answer.value, bytes):
                ros2.check_message(answer.value, parts.response)
                return answer.value
            return ros2.message({} if answer.value is None else answer.value, parts.response)
        except MessageError as error:
            raise MessageError(f"what is answered {error}") from None

    def _refuse(self, request: Request, reason: str) -> None:
        self._domain.tell(f"{self._endpoint.topic}: a call came to nothing: {reason}")
        self._open.discard(request)
        request.refuse(reason)
        request.finish()

"""Actions of ROS 2 as operations: a call sends a goal, and its answer is the result of that.

An action is three services and two topics (the design "Actions" of ROS 2). A goal is sent under a UUID of its own; once
the server has accepted it, its result is asked for, which the server answers when the goal has come to an end. A goal
that no caller waits for any more is cancelled: its caller has waited long enough or is connected no more, the node is
stopped, or the time of the action is over. The feedback of all goals of an action is an output of its node. The topic
of the states of goals says nothing that is not answered as well.

A component offers an action to no client of ROS 2.
"""

from __future__ import annotations

import secrets
from collections.abc import Collection
from concurrent.futures import Future
from functools import partial
from typing import Any, NamedTuple

from selfconf import ros2
from selfconf.bridging.ros2.domain import RosDomain
from selfconf.bridging.ros2.services import SERVICE_SECONDS, response_fields, response_payload
from selfconf.bridging.ros2.tokens import PUBLISHER, SERVER, RosEndpoint
from selfconf.bus.port import Replies
from selfconf.model.setting_names import setting
from selfconf.ros2 import CANCEL_GOAL, FEEDBACK_MESSAGE, GET_RESULT, SEND_GOAL, MessageError
from selfconf.sdk import Refused, Signal

ACTION_SECONDS = 3600.0
"""How long a goal may take; a caller of an operation that is an action may wait for less."""
PART = "/_action/"
"""What stands between the name of an action and those of its services and topics."""
SUCCEEDED = 4
ENDS = {5: "was canceled", 6: "was aborted"}
"""The states in which a goal ends (`action_msgs/msg/GoalStatus`), besides the one in which it has succeeded."""
_PARTS = {
    "send_goal": (SERVER, SEND_GOAL),
    "get_result": (SERVER, GET_RESULT),
    "cancel_goal": (SERVER, CANCEL_GOAL),
    "feedback": (PUBLISHER, FEEDBACK_MESSAGE),
}
"""What a node that serves an action has for that, and what the names of their types end in."""


class RosAction(NamedTuple):
    """An action that a node serves, by the parts that are needed here."""

    send_goal: RosEndpoint
    get_result: RosEndpoint
    cancel_goal: RosEndpoint
    feedback: RosEndpoint

    @property
    def name(self) -> str:
        """The name of the action with namespaces, beginning with a slash."""
        return action_name(self.send_goal.topic)

    @property
    def type(self) -> str:
        """The name of its type, such as `example_interfaces/action/Fibonacci`."""
        return self.send_goal.type.name.removesuffix(SEND_GOAL)


def action_name(topic: str) -> str:
    """The name of the action that a topic or service is a part of; empty if it is part of none."""
    name, _, part = topic.rpartition(PART)
    return name if part in (*_PARTS, "status") else ""


def actions_of(endpoints: Collection[RosEndpoint]) -> dict[str, RosAction]:
    """The actions that a node serves with all their parts, by their names without the first slash."""
    found: dict[str, dict[str, RosEndpoint]] = {}
    for each in sorted(endpoints, key=lambda one: one.entity):
        name, part = action_name(each.topic), each.topic.rpartition(PART)[2]
        kind, ending = _PARTS.get(part, ("", ""))
        if name and each.kind == kind and each.type.name.endswith(ending):
            found.setdefault(name.strip("/"), {}).setdefault(part, each)
    return {name: RosAction(**parts) for name, parts in sorted(found.items()) if parts.keys() == _PARTS.keys()}


def call_action(domain: RosDomain, action: RosAction, request: Signal) -> Future[Any]:
    """Send a goal to the server of an action; may be called from any thread, which it does not hold up.

    The future comes to the result, as an object, or to Refused. If it is cancelled, so is the goal.
    """
    answer = Future[Any]()
    goal = ActionGoal(domain, action, answer)
    answer.add_done_callback(lambda ended: domain.bus.wake_up(goal.cancel) if ended.cancelled() else None)
    domain.bus.wake_up(partial(goal.send, request))
    return answer


class ActionGoal:
    """A goal from its sending to its end; on the thread of the bus of the domain."""

    def __init__(self, domain: RosDomain, action: RosAction, answer: Future[Any]) -> None:
        self._domain, self._action, self._answer = domain, action, answer
        self._named = {"uuid": list(secrets.token_bytes(16))}
        self._may_run = False
        """Whether the server may have accepted the goal, and not ended it."""

    def send(self, request: Signal) -> None:
        """Send what is asked for as a goal."""
        action = self._action
        parts = ros2.service_parts(action.send_goal.type)
        if self._answer.done():
            return
        if parts is None or ros2.service_parts(action.get_result.type) is None:
            self._refuse(f"the fields of {action.type} are not known; give its definition, by {setting('definitions')}")
            return
        if isinstance(request.value, bytes):
            self._refuse(f"what {request.source.short} asks is no object, as a goal of {action.name} is")
            return
        fields = {"goal_id": self._named, "goal": {} if request.value is None else request.value}
        try:
            payload = ros2.message(fields, parts.request)
        except MessageError as error:
            self._refuse(f"what {request.source.short} asks {error}")
            return
        self._domain.ask(action.send_goal, payload, SERVICE_SECONDS, self._sent)

    def _sent(self, replies: Replies) -> None:
        try:
            endpoint = self._action.send_goal
            accepted = response_fields(endpoint, response_payload(endpoint, replies, SERVICE_SECONDS))["accepted"]
        except Refused as refused:
            self._may_run = True  # it may have been accepted all the same, or be so later
            self._refuse(str(refused))
            return
        if not accepted:
            self._refuse(f"the action {self._action.name} does not accept the goal")
            return
        self._may_run = True
        if self._answer.cancelled():
            self.cancel()
            return
        endpoint = self._action.get_result
        parts = ros2.service_parts(endpoint.type)
        assert parts is not None, "no goal is sent whose result could not be read"
        payload = ros2.message({"goal_id": self._named}, parts.request)
        self._domain.ask(endpoint, payload, ACTION_SECONDS, self._ended)

    def _ended(self, replies: Replies) -> None:
        try:
            endpoint = self._action.get_result
            answer = response_fields(endpoint, response_payload(endpoint, replies, ACTION_SECONDS))
        except Refused as refused:
            self._refuse(str(refused))
            return
        self._may_run = False
        if answer["status"] != SUCCEEDED:
            end = ENDS.get(answer["status"], f"has ended in the unknown state {answer['status']}")
            self._refuse(f"the goal of the action {self._action.name} {end}")
        elif self._answer.set_running_or_notify_cancel():
            self._answer.set_result(answer["result"])

    def cancel(self) -> None:
        """Have the server end the goal, if it may still run; what comes of that is not waited for."""
        if not self._may_run:
            return
        self._may_run = False
        # By the name alone: its definition is older than hashes, and some implementations hash it in their way.
        kind = ros2.usual_type(CANCEL_GOAL)
        parts = None if kind is None else ros2.service_parts(kind)
        assert parts is not None, "the service that cancels goals is known"
        payload = ros2.message({"goal_info": {"goal_id": self._named}}, parts.request)
        self._domain.ask(self._action.cancel_goal, payload, SERVICE_SECONDS, lambda replies: None)

    def _refuse(self, reason: str) -> None:
        self.cancel()
        if self._answer.set_running_or_notify_cancel():
            self._answer.set_exception(Refused(reason))

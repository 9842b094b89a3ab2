"""A lifecycle node is really configured and activated by its activation here, and deactivated when its task ends.

The state of such a node is asked for, and changed step by step, by the services that every one of them has (the design
"Managed nodes" of ROS 2; `lifecycle_msgs`). A transition that fails or is not answered is FAIL of the node, and so is
one out of the active state that no component here has asked for. A node that was active already stays so in the end.
Where a task ends while the node is being activated, the answer to that is awaited, and the node put back then.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, NamedTuple

from selfconf import ros2
from selfconf.bridging.ros2.domain import RosDomain
from selfconf.bridging.ros2.tokens import RosEndpoint
from selfconf.bus.port import Replies, Sample, Undo
from selfconf.ros2 import MessageError, MessageType

CHANGE, STATE, EVENT = "change_state", "get_state", "transition_event"
"""The names of the services and of the topic, below that of the node."""
LIFECYCLE_TYPES = {
    CHANGE: "lifecycle_msgs/srv/ChangeState",
    STATE: "lifecycle_msgs/srv/GetState",
    EVENT: "lifecycle_msgs/msg/TransitionEvent",
}
INACTIVE, ACTIVE = 2, 3
STEPS = {1: (1, "configure"), INACTIVE: (3, "activate")}
"""The transition towards the active state from unconfigured and inactive, by the number of the state."""
DEACTIVATE = (4, "deactivate")
PASSING = range(10, 16)
"""The states that a node is in only while it makes a transition."""
TRANSITION_SECONDS = 30.0
"""How long a transition may take; `on_configure` may load a map."""
STATE_AGAIN = 0.2
"""Seconds after which a node is asked again that makes a transition already."""


class LifecycleEndpoints(NamedTuple):
    """What a lifecycle node is asked by, and what it tells; the topic may be missing."""

    change: RosEndpoint
    state: RosEndpoint
    event: RosEndpoint | None


def lifecycle_of(
    name: str, services: Mapping[str, RosEndpoint], topics: Mapping[str, RosEndpoint]
) -> LifecycleEndpoints | None:
    """By what a node of a full name is a lifecycle node; None if it is none."""
    below = name.strip("/")

    def endpoint(part: str, among: Mapping[str, RosEndpoint]) -> RosEndpoint | None:
        found = among.get(f"{below}/{part}")
        return found if found is not None and found.type.name == LIFECYCLE_TYPES[part] else None

    change, state = endpoint(CHANGE, services), endpoint(STATE, services)
    if change is None or state is None:
        return None
    return LifecycleEndpoints(change, state, endpoint(EVENT, topics))


class NodeLifecycle:
    """Brings one node into the active state and out of it; on the thread of the bus of the domain."""

    def __init__(self, domain: RosDomain, name: str, endpoints: LifecycleEndpoints, fail: Callable[[str], None]):
        """`fail` raises FAIL of the node of this full name."""
        self._domain, self._name, self._endpoints, self._fail = domain, name, endpoints, fail
        self._turn = 0
        """Counts activations and their ends: an answer that belongs to an earlier one is passed over."""
        self._activated = self._active = False
        """Whether the node was activated here; whether it is active, as far as is known."""
        self._resting = True
        """Whether no task wants the node to be active."""
        self._unfollow: Undo = lambda: None
        self._waits_until = 0.0
        """When a transition that the node is in, not by a request from here, has taken too long."""

    def activate(self) -> None:
        """Have the node be active."""
        self._turn += 1
        self._activated = self._active = self._resting = False
        self._waits_until = self._domain.bus.now() + TRANSITION_SECONDS
        event = self._endpoints.event
        if event is not None:
            key = event.key(self._domain.number)
            self._unfollow = self._domain.bus.subscribe(key, partial(self._transition, event))
        self._look()

    def rest(self) -> None:
        """Have the node be inactive again, if it was activated here; what comes of that is only told."""
        self._turn += 1
        self._resting = True
        self._unfollow()
        if self._activated:
            self._activated = self._active = False
            self._deactivate()

    def _deactivate(self) -> None:
        turn = self._turn

        def answered(_: bool, problem: str) -> None:
            if problem and turn == self._turn:
                self._domain.tell(problem)

        self._change(DEACTIVATE, answered)

    def _look(self, before: int | None = None) -> None:
        """Ask for the state, and go on from there; `before` is that before a transition which is said to be made."""
        turn = self._turn

        def answered(answer: Mapping[str, Any] | str) -> None:
            if turn != self._turn:
                return
            if isinstance(answer, str):
                self._fail(answer)
            else:
                self._in_state(before, answer["current_state"]["id"], answer["current_state"]["label"])

        self._ask(self._endpoints.state, {}, answered)

    def _in_state(self, before: int | None, state: int, label: str) -> None:
        if state == ACTIVE:
            self._active = True
        elif state in PASSING and self._domain.bus.now() < self._waits_until:
            turn = self._turn
            self._domain.bus.later(STATE_AGAIN, lambda: self._look(before) if turn == self._turn else None)
        elif state in STEPS and before is not None and state <= before:
            self._activated = False
            made = f"the transition {STEPS[before][1]!r} of the lifecycle node {self._name} is said to be made"
            self._fail(f"{made}, and it is {label or state}")
        elif state in STEPS:
            self._change(STEPS[state], partial(self._changed, self._turn, state))
        else:
            long = state in PASSING
            why = f"for longer than {TRANSITION_SECONDS:g} s" if long else "from where it cannot be activated"
            self._fail(f"the lifecycle node {self._name} is {label or state}, {why}")

    def _changed(self, turn: int, before: int, may_be_made: bool, problem: str) -> None:
        """A transition towards the active state was asked for; the activation may have ended since."""
        if before == INACTIVE and may_be_made:
            if self._resting:
                self._deactivate()
            else:
                self._activated = True
        if turn != self._turn:
            return
        if problem:
            self._fail(problem)
        else:
            self._waits_until = self._domain.bus.now() + TRANSITION_SECONDS
            self._look(before)

    def _change(self, transition: tuple[int, str], answered: Callable[[bool, str], None]) -> None:
        """Ask for a transition; `answered` receives whether it is made, or may be, and what is wrong, if anything."""
        number, label = transition

        def heard(answer: Mapping[str, Any] | str) -> None:
            if isinstance(answer, str):
                answered(True, answer)
            elif answer["success"]:
                answered(True, "")
            else:
                answered(False, f"the transition {label!r} of the lifecycle node {self._name} has failed")

        self._ask(self._endpoints.change, {"transition": {"id": number, "label": label}}, heard)

    def _ask(
        self, endpoint: RosEndpoint, fields: Mapping[str, Any], heard: Callable[[Mapping[str, Any] | str], None]
    ) -> None:
        """Ask one of the services; `heard` receives the fields of its answer, or why there are none."""
        parts = ros2.service_parts(_usual_type(endpoint))
        assert parts is not None, "the services of lifecycle nodes are known"
        answered = parts.response

        def done(replies: Replies) -> None:
            answer: Mapping[str, Any] | str
            try:
                answer = ros2.message_fields(replies.samples[0].payload, answered)
            except IndexError:
                answer = f"the service {endpoint.topic} of a lifecycle node does not answer"
            except MessageError as error:
                answer = f"what the service {endpoint.topic} answers {error}"
            heard(answer)

        self._domain.ask(endpoint, ros2.message(fields, parts.request), TRANSITION_SECONDS, done)

    def _transition(self, event: RosEndpoint, sample: Sample) -> None:
        """The node has told of a transition."""
        try:
            goal = ros2.message_fields(sample.payload, _usual_type(event))["goal_state"]
        except MessageError:
            return
        if self._active and goal["id"] != ACTIVE:
            self._active = self._activated = False
            self._fail(f"the lifecycle node {self._name} has become {goal['label'] or goal['id']}")


def _usual_type(endpoint: RosEndpoint) -> MessageType:
    """The type of what makes a node a lifecycle node, by its name alone.

    These definitions are older than hashes, and some implementations hash them in their way.
    """
    kind = ros2.usual_type(endpoint.type.name)
    assert kind is not None, "the types of lifecycle nodes are known"
    return kind

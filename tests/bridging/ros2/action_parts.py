"""What the server of an action has, as its tokens say it."""

from __future__ import annotations

from dataclasses import replace

from selfconf import ros2
from selfconf.bridging.ros2.tokens import RosEndpoint
from selfconf.ros2 import MessageType

ACTION = "example_interfaces/action/Fibonacci"
PARTS = {
    "send_goal": ("SS", "{}_SendGoal"),
    "get_result": ("SS", "{}_GetResult"),
    "cancel_goal": ("SS", "action_msgs/srv/CancelGoal"),
    "feedback": ("MP", "{}_FeedbackMessage"),
    "status": ("MP", "action_msgs/msg/GoalStatusArray"),
}


def parts_of(action: str, kind: str = ACTION) -> list[RosEndpoint]:
    """The endpoints of the server of an action of a type, with hashes that nobody knows."""
    return [
        RosEndpoint(number, end, f"{action}/_action/{part}", MessageType(name.format(kind), "RIHS01_" + "0" * 64))
        for number, (part, (end, name)) in enumerate(PARTS.items())
    ]


def known_parts_of(action: str, kind: str = ACTION) -> list[RosEndpoint]:
    """The endpoints of the server of an action of a type, with the hashes that its parts have."""
    kinds = {each.entity: ros2.usual_type(each.type.name) for each in parts_of(action, kind)}
    return [replace(each, type=kinds[each.entity] or each.type) for each in parts_of(action, kind)]

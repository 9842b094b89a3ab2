"""What the server of an action has, as its tokens say it."""

from __future__ import annotations

from dataclasses import replace

from selfconf import ros_messages
from selfconf.bridging.ros2.tokens import RosEndpoint
from selfconf.ros_messages import MessageType

ACTION = "example_interfaces/action/Fibonacci"
PARTS = {
    "send_goal": ("SS", f"{ACTION}_SendGoal"),
    "get_result": ("SS", f"{ACTION}_GetResult"),
    "cancel_goal": ("SS", "action_msgs/srv/CancelGoal"),
    "feedback": ("MP", f"{ACTION}_FeedbackMessage"),
    "status": ("MP", "action_msgs/msg/GoalStatusArray"),
}


def parts_of(action: str) -> list[RosEndpoint]:
    """The endpoints of the server of an action, with hashes that nobody knows."""
    return [
        RosEndpoint(number, kind, f"{action}/_action/{part}", MessageType(name, "RIHS01_" + "0" * 64))
        for number, (part, (kind, name)) in enumerate(PARTS.items())
    ]


def known_parts_of(action: str) -> list[RosEndpoint]:
    """The endpoints of the server of an action, with the hashes that their types have."""
    kinds = {each.entity: ros_messages.usual_type(each.type.name) for each in parts_of(action)}
    return [replace(each, type=kinds[each.entity] or each.type) for each in parts_of(action)]

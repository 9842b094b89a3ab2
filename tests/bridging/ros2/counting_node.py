"""A node that serves the action example_interfaces/action/Fibonacci, of services and a topic by zenoh-ros2-sdk.

python -m tests.bridging.ros2.counting_node ACTION PORT DOMAIN

A goal of a negative order is not accepted, one of the order 0 is aborted, and one of 100 and more has no end, which is
printed as each that is cancelled is. The definitions are written flat, which is octet by octet the same CDR, and the
hashes are those of the type descriptions that come with ROS 2 lyrical.
"""

from __future__ import annotations

import sys
from typing import Any

from zenoh_ros2_sdk import ROS2Publisher, ROS2ServiceServer

SEND, RESULT, FEEDBACK, CANCEL = (
    "RIHS01_d1a57fb2a4afe8c21e34fb10db206f16ce6729b28531141472df92277c55b557",
    "RIHS01_1b0de0d5d29dc955d92f546706568428632771db13ec84c15ec1c1a59f424a57",
    "RIHS01_c1de71afd52e49a89c53d8262366884185bc0a02f78ce051c4e46b0a7fe59bb2",
    "RIHS01_573d8b0a534451d7bc2ac8c5ffde8ac14b8593b7001175d0cd6516dcbeb8689a",
)
FIBONACCI, GOAL_ID = "example_interfaces/action/Fibonacci", "uint8[16] goal_id\n"
SUCCEEDED, CANCELED, ABORTED = 4, 5, 6


class Counting:
    """The server of the action."""

    def __init__(self, action: str, port: int, domain: int) -> None:
        said: dict[str, Any] = {"node_name": "counting", "router_port": port, "domain_id": domain}
        self._orders: dict[bytes, int] = {}
        self._waiting: dict[bytes, Any] = {}
        """The requests for results of goals that have no end."""
        self._feedback = ROS2Publisher(
            f"{action}/_action/feedback",
            f"{FIBONACCI}_FeedbackMessage",
            f"{GOAL_ID}int32[] sequence\n",
            type_hash=FEEDBACK,
            **said,
        )
        self._send = ROS2ServiceServer(
            f"{action}/_action/send_goal",
            f"{FIBONACCI}_SendGoal",
            self._accept,
            f"{GOAL_ID}int32 order\n",
            "bool accepted\nint32 sec\nuint32 nanosec\n",
            type_hash=SEND,
            **said,
        )
        self._cancel = ROS2ServiceServer(
            f"{action}/_action/cancel_goal",
            "action_msgs/srv/CancelGoal",
            self._end,
            f"{GOAL_ID}int32 sec\nuint32 nanosec\n",
            "int8 return_code\nint32[] goals_canceling\n",
            type_hash=CANCEL,
            **said,
        )
        self._result = ROS2ServiceServer(
            f"{action}/_action/get_result",
            f"{FIBONACCI}_GetResult",
            request_definition=GOAL_ID,
            response_definition="int8 status\nint32[] sequence\n",
            type_hash=RESULT,
            mode="queue",
            **said,
        )

    def run(self) -> None:
        """Answer with results until the process is ended."""
        while True:
            key, asked = self._result.take_request()
            goal = bytes(asked.goal_id)
            order = self._orders[goal]
            if order < 100:
                self._answer(key, SUCCEEDED if order else ABORTED, self._counted(goal, order))
            else:
                self._waiting[goal] = key
                print(f"counting {order}", flush=True)

    def _counted(self, goal: bytes, order: int) -> list[int]:
        found = [0, 1]
        while len(found) < order:
            found.append(found[-1] + found[-2])
            self._feedback.publish(goal_id=_octets(goal), sequence=_numbers(found))
        return found[:order]

    def _answer(self, key: Any, status: int, sequence: list[int]) -> None:
        answer: Any = self._result.response_msg_class
        self._result.send_response(key, answer(status=status, sequence=_numbers(sequence)))

    def _accept(self, asked: Any) -> Any:
        self._orders[bytes(asked.goal_id)] = asked.order
        answer: Any = self._send.response_msg_class
        return answer(accepted=asked.order >= 0, sec=0, nanosec=0)

    def _end(self, asked: Any) -> Any:
        goal = bytes(asked.goal_id)
        print(f"canceled {self._orders.get(goal)}", flush=True)
        key = self._waiting.pop(goal, None)
        if key is not None:
            self._answer(key, CANCELED, [])
        answer: Any = self._cancel.response_msg_class
        return answer(return_code=0, goals_canceling=_numbers([]))


def _numbers(values: list[int]) -> Any:
    import numpy

    return numpy.array(values, "int32")


def _octets(value: bytes) -> Any:
    import numpy

    return numpy.frombuffer(value, "uint8")


def main() -> None:
    """Be the node until the process is ended."""
    action, port, domain = sys.argv[1:]
    Counting(action, int(port), int(domain)).run()


if __name__ == "__main__":
    main()

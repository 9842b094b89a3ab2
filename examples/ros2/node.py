"""A ROS 2 node without ROS 2 installed, by the package `zenoh-ros2-sdk`: a talker or a listener.

    python examples/ros2/node.py talker /one/chatter --port 7447

It knows nothing of selfconf. With ROS 2 installed, `RMW_IMPLEMENTATION=rmw_zenoh_cpp ros2 run demo_nodes_cpp talker` is
one as well.
"""

from __future__ import annotations

import argparse
import threading
from typing import Any

from zenoh_ros2_sdk import ROS2Publisher, ROS2Subscriber

STRING = {"msg_type": "std_msgs/msg/String", "msg_definition": "string data\n"}
"""The type of what is said, with its definition, which the package would else fetch."""
PERIOD = 0.1
"""Seconds from one message of a talker to the next."""


def main() -> None:
    """Be a node until the process is ended."""
    parser = argparse.ArgumentParser(description="a ROS 2 node")
    parser.add_argument("kind", choices=["talker", "listener"])
    parser.add_argument("topic")
    parser.add_argument("--name", help="the name of the node; by default its kind")
    parser.add_argument("--port", type=int, default=7447, help="where the router of ROS 2 listens on this machine")
    parser.add_argument("--domain", type=int, default=0)
    given = parser.parse_args()
    where: dict[str, Any] = {"router_port": given.port, "domain_id": given.domain}
    named = {"node_name": given.name or given.kind, **where, **STRING}
    pause = threading.Event()
    if given.kind == "listener":
        node = ROS2Subscriber(given.topic, callback=lambda said: print(f"heard {said.data}", flush=True), **named)
        pause.wait()
        node.close()
    publisher, number = ROS2Publisher(given.topic, **named), 0
    while True:
        number += 1
        publisher.publish(data=f"{named['node_name']} {number}")
        pause.wait(PERIOD)


if __name__ == "__main__":
    main()

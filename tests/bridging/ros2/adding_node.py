"""A node by zenoh-ros2-sdk, which nobody here wrote, that serves or calls example_interfaces/srv/AddTwoInts.

python -m tests.bridging.ros2.adding_node server|client SERVICE PORT DOMAIN
"""

from __future__ import annotations

import sys
import threading
from typing import Any

from zenoh_ros2_sdk import ROS2ServiceClient, ROS2ServiceServer

PAUSE = 0.1
"""Seconds from one call of a client to the next."""


def main() -> None:
    """Be a node until the process is ended."""
    kind, service, port, domain = sys.argv[1:]
    said: dict[str, Any] = {
        "srv_type": "example_interfaces/srv/AddTwoInts",
        "request_definition": "int64 a\nint64 b\n",
        "response_definition": "int64 sum\n",
        "node_name": kind,
        "router_port": int(port),
        "domain_id": int(domain),
    }
    pause = threading.Event()
    if kind == "server":
        server: Any = None

        def add(asked: Any) -> Any:
            return server.response_msg_class(sum=asked.a + asked.b)

        server = ROS2ServiceServer(service, callback=add, **said)
        pause.wait()
    client = ROS2ServiceClient(service, timeout=5.0, **said)
    while True:
        answer: Any = client.call(a=20, b=22)
        print("no answer" if answer is None else f"answered {answer.sum}", flush=True)
        pause.wait(PAUSE)


if __name__ == "__main__":
    main()

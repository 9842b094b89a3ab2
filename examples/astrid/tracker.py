"""A ROS 2 node that finds Astrid in pictures, without ROS 2 installed, by the package `zenoh-ros2-sdk`.

    python examples/astrid/tracker.py --port 7447

It knows nothing of selfconf. It takes `sensor_msgs/msg/Image` on `/ceiling/image`, and publishes where Astrid is on
`/astrid/pose`, as `geometry_msgs/msg/Pose2D`, with a deadline of 0.5 s. Where it is too dark to see her, or where she
has left the picture, it has nothing to publish.
"""

from __future__ import annotations

import argparse
import threading
from typing import Any

import numpy
from rosbags.typesys import Stores, get_typestore
from zenoh_ros2_sdk import ROS2Publisher, ROS2Subscriber
from zenoh_ros2_sdk.qos import Duration, QosProfile

METRES = 1 / 30
"""How many metres a pixel is wide; where the camera hangs is what a calibration would tell."""
FLOOR, PLATE = 100, 200
"""Brighter than the first is a plate of Astrid's, brighter than the second the one on her front."""
FEWEST = 6
"""Pixels of a plate that are enough to say where it is."""


def main() -> None:
    """Be a node until the process is ended."""
    parser = argparse.ArgumentParser(description="a ROS 2 node that finds Astrid in pictures")
    parser.add_argument("--port", type=int, default=7447, help="where the router of ROS 2 listens on this machine")
    parser.add_argument("--domain", type=int, default=0)
    given = parser.parse_args()
    node: dict[str, Any] = {"node_name": "tracker", "router_port": given.port, "domain_id": given.domain}
    deadline = QosProfile(deadline=Duration(0, 500_000_000))
    pose = ROS2Publisher("/astrid/pose", qos=deadline, **kind("geometry_msgs/msg/Pose2D"), **node)

    def seen(image: Any) -> None:
        found = place(numpy.asarray(image.data, numpy.uint8).reshape(image.height, image.step))
        if found is not None:
            pose.publish(**dict(zip(("x", "y", "theta"), found, strict=True)))

    ROS2Subscriber("/ceiling/image", callback=seen, **kind("sensor_msgs/msg/Image"), **node)
    print("looking for Astrid", flush=True)
    threading.Event().wait()


def kind(name: str) -> dict[str, Any]:
    """A type of messages, with its definition and hash, which the package would else fetch."""
    store = get_typestore(Stores.ROS2_JAZZY)
    definition, _ = store.generate_msgdef(name, ros_version=2)
    return {"msg_type": name, "msg_definition": definition, "type_hash": store.hash_rihs01(name)}


def place(picture: Any) -> tuple[float, float, float] | None:
    """Where Astrid is in a picture, in metres and radians; None if she is not seen."""
    plates = [numpy.argwhere((picture > FLOOR) & (picture <= PLATE)), numpy.argwhere(picture > PLATE)]
    if min(map(len, plates)) < FEWEST:
        return None
    back, front = (tuple((plate.mean(axis=0) + 0.5) * METRES) for plate in plates)
    along, across = front[1] - back[1], front[0] - back[0]
    return (front[1] + back[1]) / 2, (front[0] + back[0]) / 2, float(numpy.arctan2(across, along))


if __name__ == "__main__":
    main()

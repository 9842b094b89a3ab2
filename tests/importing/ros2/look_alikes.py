"""Random systems of ROS 2 nodes as RosTooling models, with the connections that they have."""

from __future__ import annotations

import random
from dataclasses import dataclass, field

MESSAGES = ("sensor_msgs/msg/LaserScan", "geometry_msgs/msg/Twist", "std_msgs/msg/String", "nav_msgs/msg/Odometry")


@dataclass
class System:
    """A system as its models, and its connections: from node and interface to node and interface."""

    texts: dict[str, str] = field(default_factory=dict)
    connections: set[tuple[str, str, str, str]] = field(default_factory=set)


def system(seed: int) -> System:
    """A system of some nodes, of which each publishes and subscribes under names that the system gives them."""
    random_ = random.Random(seed)
    outputs: list[tuple[int, str, str]] = []
    inputs: list[tuple[int, str, str]] = []
    package, whole = ["look_alike:", "  artifacts:"], ["robot:", "  subSystems:", "    base", "  nodes:"]
    base = ["base:", "  nodes:"]
    number = random_.randint(2, 9)
    for node in range(number):
        kind = f"kind{node}"
        package += [f"    {kind}:", f"      node: {kind}_node"]
        exposed = []
        for block, arrow, into in (("publishers", "pub", outputs), ("subscribers", "sub", inputs)):
            package.append(f"      {block}:")
            for port in range(random_.randint(0, 4)):
                message = random_.choice(MESSAGES)
                package += [f"        {arrow}{port}:", f'          type: "{message}"']
                if random_.random() < 0.4:
                    package += ["          qos:", "            depth: 7", "            reliability: best_effort"]
                if random_.random() < 0.8:
                    label = f"{arrow}_{node}_{port}"
                    exposed.append(f'        - {label}: {arrow}-> "{kind}::{arrow}{port}"')
                    into.append((node, label, message))
        part = base if node % 3 == 2 else whole
        part += [f"    node{node}:", f'      from: "look_alike.{kind}_node"']
        part += ["      interfaces:", *exposed] if exposed else []
    pairs = {
        (source, output, sink, input_)
        for source, output, sent in outputs
        for sink, input_, wanted in inputs
        if sent == wanted and source != sink and random_.random() < 0.3
    }
    found = System()
    whole.append("  connections:")
    for source, output, sink, input_ in sorted(pairs):
        ends = (output, input_) if random_.random() < 0.8 else (input_, output)
        whole.append(f"    -[ {ends[0]} , {ends[1]} ]" if random_.random() < 0.5 else f'    - ["{ends[0]}", {ends[1]}]')
        found.connections.add((f"node{source}", output, f"node{sink}", input_))
    found.texts = {
        "nodes.ros2": "\n".join(package) + "\n",
        "robot.rossystem": "\n".join(whole) + "\n",
        "base.rossystem": "\n".join(base) + "\n",
    }
    return found

"""The side of the nodes of ROS 2: found by their tokens in a domain over rmw_zenoh, relayed as CDR.

`RosWorld` is the world of the nodes of one domain; `living_graph` describes the nodes that live there now.
"""

from selfconf.bridging.ros2.node_graph import living_graph
from selfconf.bridging.ros2.ros_world import RosWorld

__all__ = ["RosWorld", "living_graph"]

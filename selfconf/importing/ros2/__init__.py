"""ROS 2 nodes and systems as components and templates: models of the RosTooling project, and NoDL.

`import_nodes` reads `.ros2` and `.rossystem` models and NoDL in XML, all at once, because systems refer to nodes. A
`NodeReader` makes a component of what a node is said to have: each `NodeInterface`, of an `InterfaceKind`. `ROS2` are
the terms for it, and `feedback_port` is the name of the output that the feedback of an action is.
"""

from selfconf.importing.ros2.components import NodeReader
from selfconf.importing.ros2.interfaces import ROS2, InterfaceKind, NodeInterface, feedback_port
from selfconf.importing.ros2.nodes import import_nodes

__all__ = ["ROS2", "InterfaceKind", "NodeInterface", "NodeReader", "feedback_port", "import_nodes"]

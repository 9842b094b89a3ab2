"""ROS 2 nodes and systems as components and templates: models of the RosTooling project, and NoDL.

`import_nodes` reads `.ros2` and `.rossystem` models and NoDL in XML, all at once, because systems refer to nodes.
"""

from selfconf.importing.ros2.nodes import import_nodes

__all__ = ["import_nodes"]

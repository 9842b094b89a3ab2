"""Bridges: sites whose components are foreign, and know nothing of selfconf.

A `ForeignWorld` finds what lives on the other side, by a protocol of its own. A `Bridge` advertises each by a file in
the folder that its site serves, and lives as each by a component of the SDK. So configurators, other components and the
search meet nothing that they do not know: what is foreign is activated, connected and watched for failure as usual.
`selfconf.bridging.wot` is the side of the W3C's Things, `selfconf.bridging.ros2` that of the nodes of ROS 2.
"""

from selfconf.bridging.bridge import Bridge, ForeignWorld

__all__ = ["Bridge", "ForeignWorld"]

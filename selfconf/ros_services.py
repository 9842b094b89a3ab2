"""The services of ROS 2 whose requests and responses are known here: `rosbags` knows the types of messages alone.

Each is defined as its interface definition (`.srv`) says: the request, a line of dashes, the response. They are those
of `std_srvs`, of the examples, of every node's parameters, of lifecycle nodes, of maps and of cameras, as jazzy, kilted
and lyrical have them. A service is the one that is meant if its hash is (REP 2011), so that a definition which changes
is not taken for another. Those of other services are relayed, but not read.
"""

from __future__ import annotations

SERVICES = {
    "std_srvs/srv/Empty": "---",
    "std_srvs/srv/SetBool": "bool data\n---\nbool success\nstring message",
    "std_srvs/srv/Trigger": "---\nbool success\nstring message",
    "example_interfaces/srv/AddTwoInts": "int64 a\nint64 b\n---\nint64 sum",
    "example_interfaces/srv/SetBool": "bool data\n---\nbool success\nstring message",
    "example_interfaces/srv/Trigger": "---\nbool success\nstring message",
    "rcl_interfaces/srv/DescribeParameters": "string[] names\n---\nrcl_interfaces/ParameterDescriptor[] descriptors",
    "rcl_interfaces/srv/GetParameters": "string[] names\n---\nrcl_interfaces/ParameterValue[] values",
    "rcl_interfaces/srv/GetParameterTypes": "string[] names\n---\nuint8[] types",
    "rcl_interfaces/srv/ListParameters": (
        "string[] prefixes\nuint64 depth\n---\nrcl_interfaces/ListParametersResult result"
    ),
    "rcl_interfaces/srv/SetParameters": (
        "rcl_interfaces/Parameter[] parameters\n---\nrcl_interfaces/SetParametersResult[] results"
    ),
    "rcl_interfaces/srv/SetParametersAtomically": (
        "rcl_interfaces/Parameter[] parameters\n---\nrcl_interfaces/SetParametersResult result"
    ),
    "lifecycle_msgs/srv/ChangeState": "lifecycle_msgs/Transition transition\n---\nbool success",
    "lifecycle_msgs/srv/GetState": "---\nlifecycle_msgs/State current_state",
    "lifecycle_msgs/srv/GetAvailableStates": "---\nlifecycle_msgs/State[] available_states",
    "lifecycle_msgs/srv/GetAvailableTransitions": ("---\nlifecycle_msgs/TransitionDescription[] available_transitions"),
    "nav_msgs/srv/GetMap": "---\nnav_msgs/OccupancyGrid map",
    "nav_msgs/srv/GetPlan": (
        "geometry_msgs/PoseStamped start\ngeometry_msgs/PoseStamped goal\nfloat32 tolerance\n---\nnav_msgs/Path plan"
    ),
    "nav_msgs/srv/SetMap": (
        "nav_msgs/OccupancyGrid map\ngeometry_msgs/PoseWithCovarianceStamped initial_pose\n---\nbool success"
    ),
    "sensor_msgs/srv/SetCameraInfo": "sensor_msgs/CameraInfo camera_info\n---\nbool success\nstring status_message",
}
"""The definitions, by the name of the service."""
REQUEST, RESPONSE, EVENT = "_Request", "_Response", "_Event"
"""What the names of the parts of a service end in."""


def parts(name: str) -> tuple[str, str]:
    """The definitions of the request and of the response of a service that is known."""
    asked, _, answered = SERVICES[name].partition("---")
    return asked, answered

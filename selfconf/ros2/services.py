"""The services and actions of ROS 2 whose fields are known here: `rosbags` knows the types of messages alone.

Each is defined as its interface definition (`.srv`, `.action`) says: the parts, with a line of dashes between. The
services are those of `std_srvs`, of the examples, of every node's parameters, of lifecycle nodes, of maps and of
cameras, and the one by which goals of actions are cancelled, as jazzy, kilted and lyrical have them. A service is the
one that is meant if its hash is (REP 2011), so that a definition which changes is not taken for another. Those of other
services and actions are relayed, but read only where the user gives their definitions (`definitions`).
"""

from __future__ import annotations

CANCEL_GOAL = "action_msgs/srv/CancelGoal"
"""The service by which the goals of every action are cancelled."""

EVENT_INFO = "service_msgs/msg/ServiceEventInfo"
"""What every service has in its hash, besides its parts."""

KNOWN_ACTIONS = {
    "example_interfaces/action/Fibonacci": "int32 order\n---\nint32[] sequence\n---\nint32[] sequence",
    "action_tutorials_interfaces/action/Fibonacci": (
        "int32 order\n---\nint32[] sequence\n---\nint32[] partial_sequence"
    ),
    "turtlesim/action/RotateAbsolute": "float32 theta\n---\nfloat32 delta\n---\nfloat32 remaining",
    "tf2_msgs/action/LookupTransform": (
        "string target_frame\nstring source_frame\nbuiltin_interfaces/Time source_time\n"
        "builtin_interfaces/Duration timeout\nbuiltin_interfaces/Time target_time\nstring fixed_frame\nbool advanced\n"
        "---\ngeometry_msgs/TransformStamped transform\ntf2_msgs/TF2Error error\n---"
    ),
}
"""The definitions of goal, result and feedback, by the name of the action."""

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
    CANCEL_GOAL: "action_msgs/GoalInfo goal_info\n---\nint8 return_code\naction_msgs/GoalInfo[] goals_canceling",
    "nav_msgs/srv/GetMap": "---\nnav_msgs/OccupancyGrid map",
    "nav_msgs/srv/GetPlan": (
        "geometry_msgs/PoseStamped start\ngeometry_msgs/PoseStamped goal\nfloat32 tolerance\n---\nnav_msgs/Path plan"
    ),
    "nav_msgs/srv/SetMap": (
        "nav_msgs/OccupancyGrid map\ngeometry_msgs/PoseWithCovarianceStamped initial_pose\n---\nbool success"
    ),
    "sensor_msgs/srv/SetCameraInfo": "sensor_msgs/CameraInfo camera_info\n---\nbool success\nstring status_message",
}
"""The definitions of request and response, by the name of the service."""

KNOWN_DEFINITIONS = {
    # Those of rosbags have a `char` of IDL in them, which is another one than that of ROS 2.
    "std_msgs/msg/Char": "char data",
    EVENT_INFO: "uint8 event_type\nbuiltin_interfaces/Time stamp\nchar[16] client_gid\nint64 sequence_number",
    **SERVICES,
    **KNOWN_ACTIONS,
}
"""All that is defined here, by its name."""

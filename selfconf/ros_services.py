"""The services and actions of ROS 2 whose fields are known here: `rosbags` knows the types of messages alone.

Each is defined as its interface definition (`.srv`, `.action`) says: the parts, with a line of dashes between. The
services are those of `std_srvs`, of the examples, of every node's parameters, of lifecycle nodes, of maps and of
cameras, and the one by which goals of actions are cancelled, as jazzy, kilted and lyrical have them. A service is the
one that is meant if its hash is (REP 2011), so that a definition which changes is not taken for another. Those of other
services are relayed, but not read.

An action is two services more, which send a goal and ask for its result, and a topic of feedback; all of them name the
goal by a UUID (the design "Actions" of ROS 2).
"""

from __future__ import annotations

from collections.abc import Mapping

REQUEST, RESPONSE, EVENT = "_Request", "_Response", "_Event"
"""What the names of the parts of a service end in."""
GOAL, RESULT, FEEDBACK = "_Goal", "_Result", "_Feedback"
"""What the names of the parts of an action end in."""
SEND_GOAL, GET_RESULT, FEEDBACK_MESSAGE = "_SendGoal", "_GetResult", "_FeedbackMessage"
"""What the names of the services and of the messages end in that an action is made of."""
CANCEL_GOAL = "action_msgs/srv/CancelGoal"
"""The service by which the goals of every action are cancelled."""
_GOAL_ID = "unique_identifier_msgs/UUID goal_id"

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


def action_messages(name: str) -> Mapping[str, str]:
    """The definitions of the messages of an action that is known, by their names."""
    goal, result, feedback = (part.strip() for part in KNOWN_ACTIONS[name].split("---"))
    return {
        name + GOAL: goal,
        name + RESULT: result,
        name + FEEDBACK: feedback,
        name + FEEDBACK_MESSAGE: f"{_GOAL_ID}\n{name}{FEEDBACK} feedback",
    }


def _services_of(name: str) -> dict[str, str]:
    """The definitions of the services of an action, by their names."""
    return {
        name + SEND_GOAL: f"{_GOAL_ID}\n{name}{GOAL} goal\n---\nbool accepted\nbuiltin_interfaces/Time stamp",
        name + GET_RESULT: f"{_GOAL_ID}\n---\nint8 status\n{name}{RESULT} result",
    }


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
    **{service: definition for name in KNOWN_ACTIONS for service, definition in _services_of(name).items()},
}
"""The definitions of services, those of actions included, by their names."""


def parts(name: str) -> tuple[str, str]:
    """The definitions of the request and of the response of a service that is known."""
    asked, _, answered = SERVICES[name].partition("---")
    return asked, answered

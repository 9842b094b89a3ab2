"""Messages of ROS 2 as signals of the robotics ontology, and the other way round, where one says what the other does.

A component that knows nothing of ROS 2 takes and issues kinds of signals such as `rob:PlanarPose2D`. The message types
of this table say the same, or more: a pose in space has the position and the heading of one in the plane, and what is
more in it is left out. In the other direction what a signal does not say is zero. `ontology/ros2.ttl` states the pairs
(`ros2:readAs`, `ros2:writtenFrom`).

Units need no factor: both sides use metres, radians, seconds and degrees Celsius (REP 103, `sensor_msgs`). What ROS 2
measures at no distance (NaN, infinity) is `max_range` in a `rob:RangeScan`, and what is too near to be measured (minus
infinity, REP 117) the least range. A message without a header has no frame: it is said to be empty.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

from selfconf.model.immutable import immutable
from selfconf.model.term import IRI
from selfconf.rdf.vocabulary import ROB

Fields = Mapping[str, Any]


@immutable
class SignalTranslation:
    """What a type of messages is as a kind of signal."""

    message: str
    """The name of the type, such as `geometry_msgs/msg/Twist`."""
    signal: IRI
    fields: tuple[str, ...]
    """The required fields of the signal."""
    read: Callable[[Fields], dict[str, Any]]
    """From the fields of a message to those of a signal."""
    write: Callable[[Fields, float], dict[str, Any]] | None = None
    """From the fields of a signal and its time, in seconds of the Unix epoch, to those of a message."""

    @property
    def name(self) -> str:
        """The local name of the kind of signal."""
        return self.signal.rpartition("#")[2]

    def is_signal(self, value: Any) -> bool:
        """Whether an object is such a signal, and no object with the fields of the message."""
        return isinstance(value, dict) and all(
            name in value and not isinstance(value[name], dict) for name in self.fields
        )


def translation_of(message: str) -> SignalTranslation | None:
    """How a type of messages is translated; None if it is not."""
    return _BY_MESSAGE.get(message)


def _heading(turned: Fields) -> float:
    """The rotation about the vertical axis that is in a quaternion, in radians."""
    x, y, z, w = (turned[name] for name in "xyzw")
    return math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def _turned(heading: float) -> dict[str, float]:
    return {"z": math.sin(heading / 2), "w": math.cos(heading / 2)}


def _header(moment: float, frame: str = "") -> dict[str, Any]:
    seconds = int(moment) if 0.0 <= moment < 2.0**31 else 0
    nanoseconds = int((moment - seconds) * 1e9) if seconds else 0
    return {"stamp": {"sec": seconds, "nanosec": nanoseconds}, "frame_id": frame}


def _planar(pose: Fields) -> dict[str, Any]:
    at = pose["position"]
    return {"x": at["x"], "y": at["y"], "theta": _heading(pose["orientation"])}


def _in_space(signal: Fields) -> dict[str, Any]:
    return {"position": {"x": signal["x"], "y": signal["y"]}, "orientation": _turned(signal["theta"])}


def _velocity(twist: Fields) -> dict[str, Any]:
    return {"linear": twist["linear"]["x"], "angular": twist["angular"]["z"]}


def _twist(signal: Fields) -> dict[str, Any]:
    return {"linear": {"x": signal["linear"]}, "angular": {"z": signal["angular"]}}


def _scan(message: Fields) -> dict[str, Any]:
    nearest, farthest = float(message["range_min"]), float(message["range_max"])
    first, step = float(message["angle_min"]), float(message["angle_increment"])
    ranges = [_measured(each, nearest, farthest) for each in message["ranges"].tolist()]
    return {"angles": [first + step * index for index in range(len(ranges))], "ranges": ranges, "max_range": farthest}


def _distance(message: Fields) -> dict[str, Any]:
    nearest, farthest = float(message["min_range"]), float(message["max_range"])
    return {"angles": [0.0], "ranges": [_measured(message["range"], nearest, farthest)], "max_range": farthest}


def _measured(distance: float, nearest: float, farthest: float) -> float:
    """A distance that ROS 2 has measured, minus infinity for something too near, which is not to look like nothing."""
    return distance if math.isfinite(distance) else nearest if distance == -math.inf else farthest


def _temperature(signal: Fields, moment: float) -> dict[str, Any]:
    """A signal has a field of the message itself, so an object that has the others too is the message."""
    return {"header": _header(moment), **{name: signal[name] for name in _OF_TEMPERATURE if name in signal}}


_OF_TEMPERATURE = ("header", "temperature", "variance")
_POSE, _MOTION, _SCAN = ("x", "y", "theta", "frame"), ("linear", "angular"), ("angles", "ranges", "max_range")
SIGNAL_TRANSLATIONS = (
    SignalTranslation(
        "geometry_msgs/msg/Pose2D",
        ROB.PlanarPose2D,
        _POSE,
        lambda message: {**message, "frame": ""},
        lambda signal, moment: {name: signal[name] for name in ("x", "y", "theta")},
    ),
    SignalTranslation(
        "geometry_msgs/msg/PoseStamped",
        ROB.PlanarPose2D,
        _POSE,
        lambda message: {**_planar(message["pose"]), "frame": message["header"]["frame_id"]},
        lambda signal, moment: {"header": _header(moment, signal["frame"]), "pose": _in_space(signal)},
    ),
    SignalTranslation(
        "geometry_msgs/msg/PoseWithCovarianceStamped",
        ROB.PlanarPose2D,
        _POSE,
        lambda message: {**_planar(message["pose"]["pose"]), "frame": message["header"]["frame_id"]},
    ),
    SignalTranslation(
        "geometry_msgs/msg/Twist", ROB.Velocity2D, _MOTION, _velocity, lambda signal, moment: _twist(signal)
    ),
    SignalTranslation(
        "geometry_msgs/msg/TwistStamped",
        ROB.Velocity2D,
        _MOTION,
        lambda message: _velocity(message["twist"]),
        lambda signal, moment: {"header": _header(moment), "twist": _twist(signal)},
    ),
    SignalTranslation(
        "nav_msgs/msg/Odometry",
        ROB.Odometry2D,
        ("x", "y", "theta", *_MOTION),
        lambda message: {**_planar(message["pose"]["pose"]), **_velocity(message["twist"]["twist"])},
        lambda signal, moment: {
            "header": _header(moment),
            "pose": {"pose": _in_space(signal)},
            "twist": {"twist": _twist(signal)},
        },
    ),
    SignalTranslation("sensor_msgs/msg/LaserScan", ROB.RangeScan, _SCAN, _scan),
    SignalTranslation("sensor_msgs/msg/Range", ROB.RangeScan, _SCAN, _distance),
    SignalTranslation(
        "sensor_msgs/msg/Temperature",
        ROB.Temperature,
        ("temperature",),
        lambda message: {"temperature": message["temperature"]},
        _temperature,
    ),
    SignalTranslation(
        "std_msgs/msg/Bool",
        ROB.Switch,
        ("on",),
        lambda message: {"on": message["data"]},
        lambda signal, moment: {"data": signal["on"]},
    ),
    SignalTranslation(
        "std_msgs/msg/String",
        ROB.Text,
        ("text",),
        lambda message: {"text": message["data"]},
        lambda signal, moment: {"data": signal["text"]},
    ),
)
"""All translations; a type of messages has one at most."""
_BY_MESSAGE = {each.message: each for each in SIGNAL_TRANSLATIONS}

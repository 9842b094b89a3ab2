"""A lifecycle node is configured and activated by its activation, and deactivated after; what goes wrong is FAIL."""

from __future__ import annotations

import struct
import threading
from pathlib import Path

import pytest

from selfconf import ros2
from selfconf.bridging.ros2 import lifecycle
from selfconf.bridging.ros2.lifecycle import LIFECYCLE_TYPES, lifecycle_of
from selfconf.bridging.ros2.tokens import RosEndpoint
from selfconf.bus.port import Urgency
from selfconf.protocol.messages import Apply, Release, Reserve
from tests.bridging.ros2.nodes import DOMAIN, BridgedDomain, StandIn, bridging_domain, node
from tests.sdk.living import LivingStage, until

pytest.importorskip("rosbags", reason="the extra `ros2` is not installed")
LABELS = {1: "unconfigured", 2: "inactive", 3: "active", 4: "finalized", 13: "activating"}
NEXT = {(1, 1): 2, (2, 3): 3, (3, 4): 2}
"""The state that a transition leads to from another one."""


ODD_HASH = "RIHS01_" + "7" * 64
"""The hash of a program that hashes definitions in its own way."""


def key_of(name: str, hashed: str = "") -> str:
    """The end of the keys of a type, by its usual hash or by another one."""
    kind = ros2.usual_type(name)
    assert kind is not None
    package, segment, local = name.split("/")
    return f"{package}::{segment}::dds_::{local}_/{hashed or kind.hash}"


class Managed:
    """A lifecycle node that does what it is told, but for one transition."""

    def __init__(self, stand_in: StandIn, state: int = 1, fails: int = 0, instead: int = 0, hashed: str = "") -> None:
        """`fails` is the transition that it does not make; it says that it did where it is in a state `instead`."""
        self.state, self.made, self._fails, self._instead = state, list[int](), fails, instead
        name = stand_in.name
        event = key_of("lifecycle_msgs/msg/TransitionEvent", hashed)
        stand_in.serves(f"/{name}/change_state", self.change, key_of("lifecycle_msgs/srv/ChangeState", hashed))
        stand_in.serves(f"/{name}/get_state", self.say, key_of("lifecycle_msgs/srv/GetState", hashed))
        stand_in.token("MP", f"/{name}/transition_event", key=event)
        self._events = stand_in.bus.publisher(f"{DOMAIN}/{name}/transition_event/{event}", Urgency.EVENT)

    def change(self, payload: bytes, attachment: bytes) -> tuple[bytes, bytes]:
        """Make the transition of a request."""
        transition = payload[4]
        self.made.append(transition)
        after = NEXT.get((self.state, transition))
        done = after is not None and transition != self._fails
        if after is not None and done:
            self.state = after
        elif self._instead:
            self.state, done = self._instead, True
        return b"\x00\x01\x00\x00" + bytes([done]), attachment

    def say(self, payload: bytes, attachment: bytes) -> tuple[bytes, bytes]:
        """Say the state."""
        label = LABELS[self.state].encode() + b"\0"
        return b"\x00\x01\x00\x00" + struct.pack("<BxxxI", self.state, len(label)) + label, attachment

    def tell_that_it_left(self) -> None:
        """Tell that it has left the active state by itself; whoever asks meanwhile is told what it was told to be."""
        kind = ros2.usual_type("lifecycle_msgs/msg/TransitionEvent")
        assert kind is not None
        told = ros2.message({"goal_state": {"id": 1, "label": LABELS[1]}}, kind)
        self._events.put(told, struct.pack("<qqB16s", 1, 10**9, 16, b"m" * 16))


def complete(found: BridgedDomain, managed: Managed) -> Managed:
    """A lifecycle node that is advertised with all that makes it one."""
    assert until(lambda: found.is_complete("map", "map/change_state", "map/get_state", "map/transition_event"))
    return managed


@pytest.mark.parametrize(("state", "made"), [(1, [1, 3, 4]), (2, [3, 4]), (3, [])])
def test_a_node_is_made_active_and_put_back(living: LivingStage, tmp_path: Path, state: int, made: list[int]) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        managed = complete(found, Managed(found.node("map"), state))
        found.activate("map")
        assert until(lambda: managed.state == 3), found.complaints
        released = found.stage.call(node("map"), "release", Release(2, living.supervisor, "task~1"))
        assert until(lambda: released)
        assert until(lambda: managed.made == made), managed.made
        assert found.causes() == []


class Slow(Managed):
    """A lifecycle node that is active at once, and says so when it is let."""

    let: threading.Event

    def change(self, payload: bytes, attachment: bytes) -> tuple[bytes, bytes]:
        """Make the transition of a request, and answer when that is let."""
        answer = super().change(payload, attachment)
        assert self.let.wait(30)
        return answer


@pytest.mark.parametrize("again", [False, True], ids=["ended", "and begun again"])
def test_a_node_that_is_released_while_it_is_activated_is_put_back(
    living: LivingStage, tmp_path: Path, again: bool
) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        managed = Slow(found.node("map"), 2)
        managed.let = threading.Event()
        complete(found, managed)

        def call(method: str, call: Reserve | Apply | Release) -> None:
            answers = found.stage.call(node("map"), method, call)
            assert until(lambda: answers)

        found.activate("map")
        assert until(lambda: managed.state == 3), found.complaints
        call("release", Release(2, living.supervisor, "task~1"))
        if again:
            call("reserve", Reserve(3, living.supervisor, "task~1"))
            call("apply", Apply(3, living.supervisor, "task~1"))
        managed.let.set()
        if again:
            call("release", Release(4, living.supervisor, "task~1"))
        assert until(lambda: managed.made == [3, 4]), managed.made
        assert until(lambda: managed.state == 2)
        assert found.causes() == []


def test_a_node_whose_activation_takes_too_long_is_put_back_when_its_task_ends(
    living: LivingStage, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(lifecycle, "TRANSITION_SECONDS", 3.0)
    with bridging_domain(living, tmp_path / "ads") as found:
        managed = Slow(found.node("map"), 2)
        managed.let = threading.Event()
        complete(found, managed)
        found.activate("map")
        late = "the service /map/change_state of a lifecycle node does not answer"
        assert until(lambda: found.causes() == [late]), found.complaints
        managed.let.set()
        released = found.stage.call(node("map"), "release", Release(2, living.supervisor, "task~1"))
        assert until(lambda: released)
        assert until(lambda: managed.made == [3, 4]), managed.made


def failed(found: BridgedDomain, managed: Managed) -> str:
    """The reason of the FAIL of a node after its activation."""
    found.called_for("map")
    assert until(found.causes), managed.made
    return found.causes()[0]


def test_a_transition_that_fails_is_a_failure(living: LivingStage, tmp_path: Path) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        managed = complete(found, Managed(found.node("map"), fails=3))
        assert failed(found, managed) == "the transition 'activate' of the lifecycle node /map has failed"


@pytest.mark.parametrize("instead", [2, 1])
def test_a_node_that_is_not_active_and_says_that_it_was_activated_is_a_failure(
    living: LivingStage, tmp_path: Path, instead: int
) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        managed = complete(found, Managed(found.node("map"), fails=3, instead=instead))
        made = "the transition 'activate' of the lifecycle node /map is said to be made"
        assert failed(found, managed) == f"{made}, and it is {LABELS[instead]}"
        assert managed.made[:2] == [1, 3]


def test_a_node_that_is_finalized_cannot_be_activated(living: LivingStage, tmp_path: Path) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        managed = complete(found, Managed(found.node("map"), state=4))
        assert failed(found, managed).startswith("the lifecycle node /map is finalized, from where")


def test_a_node_that_stays_in_a_transition_is_waited_for_no_longer_than_one_may_take(
    living: LivingStage, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(lifecycle, "TRANSITION_SECONDS", 2.0)
    with bridging_domain(living, tmp_path / "ads") as found:
        managed = complete(found, Managed(found.node("map"), 13))
        found.activate("map")
        assert until(lambda: found.causes() == ["the lifecycle node /map is activating, for longer than 2 s"])
        assert managed.made == []


@pytest.mark.parametrize("hashed", ["", ODD_HASH])
def test_a_node_that_leaves_the_active_state_by_itself_has_failed(
    living: LivingStage, tmp_path: Path, hashed: str
) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        managed = complete(found, Managed(found.node("map"), hashed=hashed))
        found.activate("map")
        assert until(lambda: managed.state == 3), found.complaints

        def fails() -> bool:  # what is published before the state is known to be active is nothing new
            managed.tell_that_it_left()
            return bool(found.causes())

        assert until(fails)
        assert found.causes() == ["the lifecycle node /map has become unconfigured"]


@pytest.mark.parametrize("part", LIFECYCLE_TYPES)
def test_what_is_only_called_like_a_part_of_a_lifecycle_node_is_none(part: str) -> None:
    """A text on a topic of that name says nothing of transitions."""

    def parts(types: dict[str, str]) -> dict[str, RosEndpoint]:
        kinds = {name: ros2.usual_type(kind) for name, kind in types.items()}
        return {f"map/{name}": RosEndpoint(1, "", f"/map/{name}", kind) for name, kind in kinds.items() if kind}

    whole, strange = parts(LIFECYCLE_TYPES), parts({**LIFECYCLE_TYPES, part: "std_msgs/msg/String"})
    found = lifecycle_of("/map", whole, whole)
    assert found is not None
    assert found.event is not None
    odd = lifecycle_of("/map", strange, strange)
    assert odd == (found._replace(event=None) if part == "transition_event" else None)

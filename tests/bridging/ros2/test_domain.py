"""What the components of a bridge share: who serves what, and complaints that are told once."""

from __future__ import annotations

from selfconf.bridging.ros2 import domain as shared
from selfconf.bridging.ros2.domain import RosDomain, bridge_token
from selfconf.bridging.ros2.tokens import SERVER, RosEndpoint
from selfconf.bus.memory import Network
from selfconf.ros2 import MessageType
from tests.bridging.ros2.nodes import ADD_HASH


def domain() -> tuple[RosDomain, list[str]]:
    """A domain, and what it has complained of."""
    complaints: list[str] = []
    return RosDomain(Network().node(), 7, complaints.append), complaints


def test_a_service_is_served_until_its_last_server_has_gone() -> None:
    found, _ = domain()
    assert not found.has_server("key")
    for token in ("one", "two"):
        found.server_changed("key", token, True)
    found.server_changed("key", "one", False)
    assert found.has_server("key")
    found.server_changed("key", "two", False)
    assert not found.has_server("key")
    found.server_changed("key", "three", True, of_bridge=True)
    assert found.has_server("key")
    assert not found.has_server("key", of_bridges=False)


def test_a_complaint_is_told_once_and_there_is_an_end_of_complaints() -> None:
    found, complaints = domain()
    for number in range(2 * shared.MOST_SENTENCES):
        found.tell(f"complaint {number}")
        found.tell(f"complaint {number}")
    assert len(complaints) == len(set(complaints)) == shared.MOST_SENTENCES


def test_the_bridge_is_a_node_with_counterparts_of_its_own() -> None:
    found, _ = domain()
    endpoint = RosEndpoint(3, "SC", "/add", MessageType("example_interfaces/srv/AddTwoInts", f"{ADD_HASH}"))
    assert bridge_token(found).key() == f"@ros2_lv/7/{found.session}/0/0/NN/%/%/selfconf_bridge"
    key = bridge_token(found, SERVER, endpoint).key()
    assert key.startswith(f"@ros2_lv/7/{found.session}/0/1/SS/%/%/selfconf_bridge/%add/example_interfaces::srv::dds_::")

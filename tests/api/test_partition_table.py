"""`partition`: who is eligible for each role, in the order of trying, and what keeps the others out."""

from __future__ import annotations

import pytest

from selfconf import partition, read, template
from selfconf.api.partition_table import PartitionTable
from selfconf.errors import BindingError, TemplateError
from selfconf.model.obstacle import PropertyUnmet, WrongType
from tests.lab import ADVERTISEMENTS, NAVIGATE, PREFIXES, iri

EVERYTHING = PREFIXES + "\n".join(ADVERTISEMENTS.values())


def table(ads: str = EVERYTHING) -> PartitionTable:
    """The partition of the paper's task."""
    return partition(template(NAVIGATE).bind(robot=":Astrid", goal="x"), read(ads))


def test_the_roles_are_in_the_order_of_the_template_and_found_by_any_name() -> None:
    found = table()
    assert list(found) == ["sonar", "encoder", "position", "control", "drive"]
    assert len(found) == 5
    for name in ("position", ":position", str(iri("position"))):
        assert found[name].role.iri == iri("position")
    with pytest.raises(KeyError, match="no role 'nobody'; the roles are sonar"):
        found["nobody"]


def test_the_eligible_components_are_in_the_order_of_trying() -> None:
    assert table()["position"].eligible == (iri("person-tracker"), iri("absolute-odometry"))
    assert [candidate.profile.preference for candidate in table()["position"].candidates] == [10, 0]


def test_what_keeps_a_component_out_is_a_value() -> None:
    drive = table()["drive"]
    (obstacle,) = drive.obstacles(iri("pippi-drive"))
    assert isinstance(obstacle, PropertyUnmet)
    assert str(obstacle) == "support is Pippi, not Astrid"
    assert isinstance(drive.obstacles(iri("wheels"))[0], WrongType)
    assert drive.obstacles(iri("astrid-drive")) == ()
    assert drive.excluded[0].component == iri("pippi-drive")
    assert len(drive.excluded) == len(ADVERTISEMENTS) - 1


def test_a_partition_suffices_where_every_role_has_as_many_as_it_asks_for() -> None:
    assert table().sufficient
    poor = table(EVERYTHING.replace("rob:Encoder", "rob:Lamp"))
    assert not poor.sufficient
    assert poor["encoder"].eligible == ()
    assert "no component" in repr(poor["encoder"])


def test_a_partition_prints_as_a_table() -> None:
    text = repr(table())
    head, _, *rows = text.splitlines()
    assert head.startswith("role")
    assert len(rows) == 6
    assert [":position", "1", ":person-tracker"] in [row.split() for row in rows]
    assert ":person-tracker" in table()._repr_html_()


def test_what_cannot_be_partitioned_is_said() -> None:
    with pytest.raises(BindingError, match="needs a value"):
        partition(template(NAVIGATE), read(EVERYTHING))
    bad = PREFIXES + ':t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:pattern "(" .'
    with pytest.raises(TemplateError, match="not well-formed"):
        partition(template(bad), read(EVERYTHING))

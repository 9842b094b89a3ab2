"""What sites are called in lists."""

from __future__ import annotations

from selfconf.site import Shelf, Site
from tests.discovery.field import Field
from tests.lab import write_advertisements


def test_two_sites_of_one_name_are_both_read_and_both_named(field: Field) -> None:
    field.site("home", "tracker")
    (field.folder / "other").mkdir()
    shelf = Shelf([write_advertisements(field.folder / "other", "drive")], print)
    other = Site(field.network.node(), "lab", "home", shelf, life="other")
    discovery = field.discover()
    assert {component.short for component in discovery.found} == {"person-tracker", "astrid-drive"}
    assert len(discovery.sites) == 2
    assert f"home ({other.life})" in discovery.sites
    assert {discovery.name_of_site(found) for found in discovery.found.values()} == set(discovery.sites)
    assert discovery.missing == ()
    assert any("2 sites are called home" in complaint for complaint in discovery.complaints)

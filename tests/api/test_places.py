"""Places are looked up for what a refusal names; the lookup of lines is tried in tests/cli/test_places.py."""

from __future__ import annotations

import selfconf as sc
from selfconf.api.places import Places


def test_roles_and_components_have_file_and_line_and_others_have_no_place(clock: sc.TaskSpecification) -> None:
    places = Places(clock.document.task.template, sc.read("examples/clock").advertisements())
    home = "https://example.org/my-home#"
    assert str(places.of(sc.IRI(f"{home}screen"))) == "examples/clock/tell-the-time.ttl:15"
    assert str(places.of(sc.IRI(f"{home}display"))) == "examples/clock/display.ttl:5"
    assert places.of(sc.IRI(f"{home}kitchen")) is None

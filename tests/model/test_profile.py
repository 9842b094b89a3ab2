"""Profiles of components: ports, properties, places."""

from __future__ import annotations

from selfconf.model.profile import Place


def test_a_place_is_shown_as_editors_know_it() -> None:
    assert str(Place("ads.ttl", 7)) == "ads.ttl:7"
    assert str(Place("ads.ttl")) == "ads.ttl"

"""Components as users name them."""

from __future__ import annotations

import pytest

from selfconf.api.living.component_terms import iri_or_local_name

ROBOT = "https://w3id.org/selfconf/peis-home#astrid-drive"


@pytest.mark.parametrize(
    ("term", "meant"),
    [
        ("astrid-drive", "astrid-drive"),
        (":astrid-drive", "astrid-drive"),
        ("home:astrid-drive", ROBOT),
        (ROBOT, ROBOT),
        (f"<{ROBOT}>", ROBOT),
        ("g:fühler", "fühler"),
        ("urn:dev:mac:0024", "urn:dev:mac:0024"),
        ("<urn:clock>", "urn:clock"),
        ("urn:clock", "urn:clock"),
        ("", ""),
    ],
)
def test_brackets_and_prefixes_are_left_out_and_known_prefixes_replaced(term: str, meant: str) -> None:
    assert iri_or_local_name(term) == meant

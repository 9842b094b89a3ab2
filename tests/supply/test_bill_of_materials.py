"""The bill of materials in the wheel: CycloneDX that its own library reads, the same bytes for the same files."""

from __future__ import annotations

import json
import re

import pytest

pytest.importorskip("cyclonedx", reason="cyclonedx-python-lib, which the package is built with, is not installed")

from cyclonedx.model.bom import Bom
from cyclonedx.model.component import ComponentScope

from supply.bill_of_materials import bill_of_materials
from supply.pins import FILE, requirements

PINNED = list(requirements(FILE.read_text("utf-8")))


def bill() -> str:
    """The document for the pinned versions."""
    return bill_of_materials("selfconf", "1.2.3", PINNED)


def test_the_library_reads_what_was_written() -> None:
    read = Bom.from_json(json.loads(bill()))
    assert read.metadata.component is not None
    assert (read.metadata.component.name, read.metadata.component.version) == ("selfconf", "1.2.3")
    scopes = {part.name: part.scope for part in read.components}
    assert scopes["rdflib"] is ComponentScope.REQUIRED
    assert scopes["cryptography"] is ComponentScope.OPTIONAL
    assert not {"pytest", "ortools", "hatchling"} & scopes.keys()
    assert read.validate()


def test_every_version_that_a_user_installs_is_in_it() -> None:
    written = {(part["name"], part["version"]) for part in json.loads(bill())["components"]}
    for who, requirement in PINNED:
        pin = re.match(r"(\S+)==(\S+)", requirement)
        assert pin is not None
        assert ((pin[1], pin[2]) in written) == bool(
            who & {"-", "sim", "solvers", "serve", "keys", "wot", "ros2", "fast-owl"}
        )


def test_the_same_pins_make_the_same_bytes_and_others_another_serial_number() -> None:
    assert bill() == bill() == bill_of_materials("selfconf", "1.2.3", reversed(PINNED))
    other = bill_of_materials("selfconf", "1.2.3", [one for one in PINNED if "rdflib" not in one[1]])
    assert json.loads(other)["serialNumber"] != json.loads(bill())["serialNumber"]
    assert "timestamp" not in bill()

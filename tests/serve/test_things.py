"""Components are Thing Descriptions that keep to the schema of the W3C."""

from __future__ import annotations

import json
import os
from pathlib import Path

import jsonschema
import pytest

from selfconf.protocol.keys import Keys
from selfconf.serve.things import TD_CONTEXTS, directory_description, thing_description
from tests.lab import ADVERTISEMENTS, iri
from tests.serve.shown import found

BESIDE = Path(__file__).parents[3] / "shared" / "data" / "w3c-wot"
SCHEMA = Path(os.environ.get("SELFCONF_W3C_WOT", BESIDE)) / "td-json-schema-validation.json"


def test_an_output_is_a_property_and_fail_an_event() -> None:
    keys = Keys("lab")
    thing = thing_description(found("tracker").advertisement.profile, keys)
    assert (thing["id"], thing["title"]) == (iri("person-tracker"), "person-tracker")
    pose = thing["properties"]["pose"]
    assert (pose["@type"], pose["readOnly"], pose["observable"]) == (["rob:PlanarPose2D"], True, True)
    assert pose["forms"][0]["href"] == f"zenoh:{keys.output(iri('person-tracker'), 'pose')}"
    assert thing["events"]["fail"]["forms"][0]["href"] == f"zenoh:{keys.fail(iri('person-tracker'))}"


def test_inputs_and_parameters_are_said_in_the_terms_of_selfconf() -> None:
    thing = thing_description(found("control").advertisement.profile, Keys("lab"))
    assert [one["sc:name"] for one in thing["sc:hasInput"]] == ["localize", "position", "sonar"]
    assert thing["sc:hasParameter"][0]["sc:name"] == "goal"


@pytest.mark.w3c
@pytest.mark.skipif(
    not SCHEMA.is_file(), reason="the W3C schema of descriptions is not here; SELFCONF_W3C_WOT names it"
)
def test_every_description_keeps_to_the_schema_of_the_w3c() -> None:
    schema = json.loads(SCHEMA.read_text("utf-8"))
    # The draft after 1.1 asks for a context that is not published yet; what holds is that of 1.0 with that of 1.1.
    schema["definitions"]["thing-context-td-uri-temp"]["const"] = TD_CONTEXTS[0]
    things = [thing_description(found(name).advertisement.profile, Keys("lab")) for name in ADVERTISEMENTS]
    for thing in (*things, directory_description("http://localhost:8000")):
        jsonschema.validate(thing, schema)

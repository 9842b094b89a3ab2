"""Components are Thing Descriptions that keep to the schema of the W3C."""

from __future__ import annotations

import json
import os
from pathlib import Path

import jsonschema
import pytest

from selfconf.model.term import IRI
from selfconf.protocol.keys import Keys
from selfconf.rdf.advertisements import read_advertisements
from selfconf.serve.things import TD_CONTEXTS, directory_description, thing_description
from tests.importing.imports import Workshop, left_out
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


EVERYTHING = """
    rdfs:label "Tracker"@en , "Ortung"@de , "tracker" ; rdfs:comment "On the ceiling." ;
    rob:place :living-room , "kitchen" ; :built "2020-01-01"^^xsd:date ; :weight 2.5 ; :count 3 ; :on true ;
    :nom "suiveur"@fr ; <http://x.example/1> "x" ;
    sc:hasInput [ sc:name "clock" ; sc:signalType rob:Velocity2D ; sc:unit unit:M ; sc:optional true ] ;
    sc:hasOutput [ sc:name "range" ; sc:unit unit:M ; sc:rate [ sc:value 12.5 ; sc:unit unit:HZ ] ] ;
    sc:hasParameter [ sc:name "goal" ; sc:parameterType rob:BehaviouralGoal ] ;
    sc:hasOperation [ sc:name "photo" ; sc:request rob:BehaviouralGoal ; sc:response rob:PlanarPose2D ] ;
    sc:needsOperation [ sc:name "lamp" ; sc:request rob:BehaviouralGoal ; sc:optional true ] .
"""


def test_the_title_is_the_label_in_its_languages() -> None:
    def words(label: str) -> dict[str, object]:
        more = f" :person-tracker rdfs:label {label} ." if label else ""
        thing = thing_description(found("tracker", more).advertisement.profile, Keys("lab"))
        return {member: said for member, said in thing.items() if member.startswith("title") or "label" in member}

    assert words("") == {"title": "person-tracker"}
    assert words('"Tracker"') == {"title": "Tracker"}
    assert words('"Ortung"@de , "Tracker"@en') == {"title": "Ortung", "titles": {"de": "Ortung", "en": "Tracker"}}
    assert words('"Eye" , "Auge"@de') == {"title": "Eye", "titles": {"de": "Auge"}}
    assert words('"a" , "b" , "c"@en') == {"title": "a", "titles": {"en": "c"}, "rdfs:label": "b"}


def test_what_a_component_is_comes_back_from_its_description(tmp_path: Path) -> None:
    """Its rate as a double, as numbers of JSON are read."""
    prefixes = "@prefix unit: <http://qudt.org/vocab/unit/> . @prefix xsd: <http://www.w3.org/2001/XMLSchema#> .\n"
    component = found("tracker", f"\n{prefixes}:person-tracker{EVERYTHING}").advertisement
    thing = thing_description(component.profile, Keys("lab"))
    workshop = Workshop(tmp_path)
    report = workshop.imported("wot", {"tracker.td.json": json.dumps(thing)})
    (text,) = workshop.texts().values()
    assert text.count("sc:Component") == 1
    (again,), problems = read_advertisements(text.encode(), "tracker.ttl")
    assert not problems
    profile = again.profile
    assert profile.types == component.profile.types | {IRI("https://www.w3.org/2019/wot/td#Thing")}
    assert set(profile.properties) == set(component.profile.properties)
    assert (profile.ports, profile.parameters) == (component.profile.ports, component.profile.parameters)
    unneeded = {"titles and descriptions of affordances", "marks of affordances, such as observable"}
    assert set(left_out(report)) == {"forms", "security", *unneeded}

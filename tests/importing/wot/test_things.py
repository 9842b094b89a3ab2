"""Thing Descriptions and Thing Models as components."""

from __future__ import annotations

import json
import random
import time
from typing import Any

import pytest

from selfconf.importing import ImportLedger, ImportReport, document_at
from selfconf.importing.wot import import_things
from selfconf.rdf.turtle import parse
from selfconf.rdf.vocabulary import SC
from tests.importing.imports import Workshop, left_out

CONTEXT = ["https://www.w3.org/2022/wot/td/v1.1", {"saref": "https://w3id.org/saref#"}]


def described(**members: Any) -> str:
    return json.dumps({"@context": CONTEXT, "title": "Lamp", **members})


def only(workshop: Workshop, report: ImportReport) -> str:
    """The text of the only file."""
    (text,) = workshop.texts().values()
    assert len(report.files) == 1
    return text.partition("\n\n")[2].partition("\n\n")[2]


def test_a_thing_description_becomes_an_advertisement(workshop: Workshop) -> None:
    text = described(
        **{"id": "urn:dev:lamp", "@type": "saref:LightSwitch", "description": "On or off.", "saref:hasModel": "X-1"},
        properties={"on": {"@type": "saref:OnOffState"}},
        actions={"toggle": {"@type": "saref:ToggleCommand"}},
    )
    assert (
        only(workshop, workshop.imported("wot", {"lamp.td.json": text}))
        == """\
<urn:dev:lamp> a sc:Component, td:Thing, saref:LightSwitch ;
    rdfs:label "Lamp" ;
    rdfs:comment "On or off." ;
    saref:hasModel "X-1" ;
    sc:hasInput [ sc:name "on" ; sc:signalType saref:OnOffState ; sc:optional true ] ;
    sc:hasOutput [ sc:name "on" ; sc:signalType saref:OnOffState ] ;
    sc:hasOperation [ sc:name "toggle" ; sc:request saref:ToggleCommand ] .
"""
    )


def test_a_thing_model_is_imported_as_what_it_is_a_model_of(workshop: Workshop) -> None:
    text = described(
        **{"@type": "tm:ThingModel", "tm:optional": ["/properties/x"]}, properties={"x": {"readOnly": True}}
    )
    report = workshop.imported("wot", {"lamp.tm.json": text})
    assert "<urn:selfconf:wot:lamp.tm> a sc:Component, td:Thing, tm:ThingModel ;" in only(workshop, report)
    assert left_out(report) == {"marks of affordances that a thing may lack": 1}


def test_a_collection_is_imported_as_its_members(workshop: Workshop) -> None:
    members = [{"@context": CONTEXT, "id": f"urn:dev:{name}", "title": name} for name in ("lamp", "door")]
    text = json.dumps({"@context": CONTEXT, "@type": "ThingCollection", "total": 2, "members": members})
    report = workshop.imported("wot", {"things.json": text, "none.json": json.dumps({"@type": "ThingCollection"})})
    (written,) = workshop.texts().values()
    assert "<urn:dev:lamp> a " in written
    assert "<urn:dev:door> a " in written
    assert left_out(report) == {"empty documents": 1}


def test_the_pages_of_a_directory_are_one_document() -> None:
    """Else a thing that comes to another page would be advertised in two files, of which no import replaces one."""
    pages = [[], ["lamp", "door"], ["bell"]]
    texts = [f"[{', '.join(described(id=f'urn:dev:{name}') for name in page)}]".encode() for page in pages]
    first = document_at("http://192.0.2.7/things", texts[0])
    further = [document_at(f"{first.shown}?page={page}", texts[page - 1], page, first) for page in (2, 3)]
    other = document_at("http://192.0.2.8/things", texts[2])
    found = list(import_things([first, *further, other], ImportLedger("urn:selfconf:wot:", lambda _: None)))
    assert [(document.name, len(document.descriptions)) for document in found] == [("things", 3), ("things", 1)]


def test_titles_are_kept_in_their_languages(workshop: Workshop) -> None:
    text = described(titles={"de": "Lampe", "en": "Lamp", "no tag": "?"})
    assert 'rdfs:label "Lampe"@de, "Lamp"@en, "?" .' in only(workshop, workshop.imported("wot", {"lamp.json": text}))
    text = described(title="Leuchte", titles={"de": "Lampe"})
    assert 'rdfs:label "Leuchte", "Lampe"@de .' in only(workshop, workshop.imported("wot", {"lamp.json": text}))


def test_titles_that_are_no_text_are_named(workshop: Workshop) -> None:
    text = described(title=7, titles={"de": ["Lampe"]}, description=None, descriptions=["shines"])
    report = workshop.imported("wot", {"lamp.json": text})
    assert left_out(report) == {"titles that are no text": 2, "descriptions that are no text": 1}


def test_a_thing_is_no_template_however_it_calls_itself(workshop: Workshop) -> None:
    kinds = [f"https://w3id.org/selfconf#{name}" for name in ("Component", "Template", "Role")]
    report = workshop.imported("wot", {"lamp.json": described(**{"@type": kinds})})
    assert "a sc:Component, td:Thing" in only(workshop, report)
    assert left_out(report) == {"types of selfconf": 2}


def test_an_array_holds_several_things_as_a_directory_answers(workshop: Workshop) -> None:
    report = workshop.imported("wot", {"things.json": f"[{described()}, {described(id='urn:dev:b')}, 5]"})
    text = only(workshop, report)
    assert "<urn:selfconf:wot:things/1> a" in text
    assert "<urn:dev:b> a" in text
    assert left_out(report) == {"documents that describe no thing": 1}


def test_things_of_one_identifier_keep_apart_and_are_named(workshop: Workshop) -> None:
    report = workshop.imported("wot", {name: described(id="urn:dev:lamp") for name in ("a.json", "b.json", "c/b.json")})
    assert [each.component for each in report.renamed] == ["urn:dev:lamp-b", "urn:dev:lamp-c-b"]
    again = workshop.imported("wot", {})
    assert again.renamed == report.renamed


@pytest.mark.parametrize("identifier", ["lamp", "urn:{{ID}}", 5, "urn:a b"])
def test_an_identifier_that_is_none_is_named_and_replaced(workshop: Workshop, identifier: Any) -> None:
    report = workshop.imported("wot", {"lamp.json": described(id=identifier)})
    assert "<urn:selfconf:wot:lamp> a" in only(workshop, report)
    assert left_out(report) == {"identifiers that are no absolute IRIs": 1}


@pytest.mark.parametrize("text", ["[]", "5", '"x"', "null", "{}", '{ "name": "npm package" }'])
def test_what_describes_no_thing_is_named(workshop: Workshop, text: str) -> None:
    report = workshop.imported("wot", {"x.json": text})
    assert report.files == report.unreadable == ()
    assert sum(left_out(report).values()) == 1


def test_values_of_other_vocabularies_are_kept_where_they_are_plain(workshop: Workshop) -> None:
    members = {
        "saref:a": [1, 1.5, True], "saref:b": {"@id": "urn:x"}, "saref:c": {"deep": 1}, "other:d": 1,
        "https://w3id.org/selfconf#preference": 5,
    }  # fmt: skip
    report = workshop.imported("wot", {"lamp.json": described(**members)})
    text = only(workshop, report)
    assert 'saref:a 1, "1.5"^^xsd:double, true ;\n    saref:b <urn:x> .' in text
    assert left_out(report) == {
        "nested values of other vocabularies": 1, "terms with the prefix other:": 1, "terms of selfconf": 1,
    }  # fmt: skip


def test_values_have_the_types_that_the_context_of_the_document_gives_them(workshop: Workshop) -> None:
    context = {
        "ex": "http://ex/", "xsd": "http://www.w3.org/2001/XMLSchema#",
        "rob": "https://w3id.org/selfconf/robotics#", "onRobot": {"@id": "rob:support", "@type": "@id"},
        "built": {"@id": "ex:built", "@type": "xsd:date"}, "nom": {"@id": "ex:nom", "@language": "fr"},
    }  # fmt: skip
    members = {"onRobot": "urn:robots:astrid", "built": "2020-01-01", "nom": "lampe"}
    text = json.dumps({"@context": [CONTEXT[0], context], "id": "urn:c", "title": "C", **members})
    report = workshop.imported("wot", {"lamp.json": text})
    assert left_out(report) == {}
    written = only(workshop, report)
    for stated in ("rob:support <urn:robots:astrid>", 'ex:built "2020-01-01"^^xsd:date', 'ex:nom "lampe"@fr'):
        assert stated in written


def test_a_name_that_occurs_twice_is_named(workshop: Workshop) -> None:
    report = workshop.imported("wot", {"lamp.json": '{ "title": "A", "properties": { "x": {}, "x": {} } }'})
    assert left_out(report) == {"earlier values of 'x'": 1}


def look_alike(random_: random.Random, number: int) -> str:
    """A Thing Description as those in the wild are: most ports without a type, some with a unit."""
    units = ["%", "degree celsius", "lux", "m/s", "furlong"]

    def schema() -> dict[str, Any]:
        found: dict[str, Any] = {"type": "number", "forms": [{"href": "x"}] * random_.randint(1, 8)}
        if random_.random() < 0.15:
            found["@type"] = random_.choice(["saref:Temperature", ["saref:Humidity", "saref:State"], "iot:Unknown"])
        if random_.random() < 0.1:
            found["unit"] = random_.choice(units)
        return found

    return described(
        id=f"urn:dev:{number % 7 * 100 + number // 2}",
        properties={
            f"p{each}": {**schema(), "readOnly": random_.random() < 0.5} for each in range(random_.randint(0, 12))
        },
        actions={f"a{each}": {"input": schema()} for each in range(random_.randint(0, 4))},
        events={f"e{each}": {"data": schema()} for each in range(random_.randint(0, 2))},
    )


def test_hundreds_of_descriptions_are_imported_in_no_time_and_none_is_lost(workshop: Workshop) -> None:
    random_, number = random.Random(1), 300
    texts = {f"{each % 10}/thing{each}.json": look_alike(random_, each) for each in range(number)}
    start = time.process_time()
    report = workshop.imported("wot", texts)
    assert time.process_time() - start < 20 * number / 1241
    assert report.unreadable == ()
    assert len(report.files) == number
    subjects = [each.subject for file in report.files for each in file.document.subjects(SC.Component)]
    assert len(set(subjects)) == number
    for name, text in workshop.texts().items():
        source = json.loads(texts[f"{name.removesuffix('.ttl')}.json"])
        document = parse(text, name)
        (component,) = document.instances(SC.Component)
        assert len(document.values(component, SC.hasOutput)) == len(source["properties"]) + len(source["events"])
        assert len(document.values(component, SC.hasOperation)) == len(source["actions"])

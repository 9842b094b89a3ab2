"""A configuration is judged by what other files of the run say of its template and its components, and by no more."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

import selfconf
from selfconf import library
from selfconf.model.codes import PREAMBLE
from selfconf.rdf.validation.checking import FileChecker, SourceText, UnclearedFile, validate_texts
from selfconf.rdf.validation.term_index import TermIndex
from tests.harness.effort import examples
from tests.search.test_followed_repairs import PREFIXES, components, configured, ecology

TEMPLATE = """\
:radio a sc:Template ; sc:roles ( :source :sink ) .
:source a sc:Role ; sh:class rob:Tuner ; sc:feeds :sink .
:sink a sc:Role ; sh:class rob:Speaker .
"""
TUNER = ':tuner a sc:Component, rob:Tuner ; sc:hasOutput [ sc:name "sound" ; sc:signalType rob:Audio ] .\n'
SPEAKER = ':speaker a sc:Component, rob:Speaker ; sc:hasInput [ sc:name "audio" ; sc:signalType rob:Audio ] .\n'
ANSWER = """\
:now a sc:Configuration ; sc:template :radio ; sc:task [ a sc:Task ; sc:template :radio ] ;
    sc:assignment [ a sc:Assignment ; sc:role :source ; sc:component :tuner ] ,
        [ a sc:Assignment ; sc:role :sink ; sc:component :speaker ] ;
    sc:connection [ a sc:Connection ; sc:from :tuner ; sc:output "sound" ; sc:to :speaker ; sc:input "audio" ] .
"""
ASKING = ':{} a sc:Component, rob:Speaker ; sc:needsOperation [ sc:name "play" ; sc:request rob:Text ] .\n'
OFFERING = ':{} a sc:Component, rob:Tuner ; sc:hasOperation [ sc:name "tune" ; sc:request rob:Text ] .\n'


def found(*texts: str, ontology: str = "") -> list[tuple[str, str]]:
    """File and code of each problem of texts, which get the names 0.ttl, 1.ttl and so on."""
    sources = [SourceText(f"{number}.ttl", (PREAMBLE + text).encode()) for number, text in enumerate(texts)]
    known = [SourceText(str(path), path.read_bytes()) for path in library.ontologies()]
    known.append(SourceText("o.ttl", (PREAMBLE + ontology).encode()))
    shapes = [SourceText(str(path), path.read_bytes()) for path in library.shapes()]
    return [(each.file, each.code) for each in validate_texts(sources, shapes, known).diagnostics]


def test_a_configuration_conforms_beside_its_template_and_its_components() -> None:
    assert found(ANSWER, TEMPLATE, TUNER, SPEAKER) == []


def test_a_wrong_port_is_found_with_the_advertisements_of_other_files() -> None:
    wrong = ANSWER.replace('"audio"', '"radio"')
    # The connection joins no ports; the one that has to be there is missing; the input is unfed.
    assert found(wrong, TEMPLATE, TUNER + SPEAKER) == [("0.ttl", "SC-C10"), ("0.ttl", "SC-C10"), ("0.ttl", "SC-C09")]


def test_a_datatype_that_is_spelt_out_is_the_same_string() -> None:
    assert found(ANSWER.replace('"audio"', '"audio"^^xsd:string'), TEMPLATE, TUNER, SPEAKER) == []


def test_a_template_of_another_file_says_which_roles_there_are() -> None:
    problems = found(ANSWER.replace("sc:role :sink", "sc:role :sinc"), TEMPLATE, TUNER, SPEAKER)
    assert {code for _, code in problems} == {"SC-C07", "SC-C08"}


def test_interactions_belong_to_a_template_though_nothing_in_it_leads_there() -> None:
    long = TEMPLATE.replace(" ; sc:feeds :sink", "") + "[] a sc:Interaction ; sc:from :source ; sc:to :sink .\n"
    assert found(ANSWER, long, TUNER, SPEAKER) == []
    assert found(ANSWER, TEMPLATE.replace(" ; sc:feeds :sink", ""), TUNER, SPEAKER) == [("0.ttl", "SC-C08")]


def test_only_a_configuration_whose_template_is_not_given_is_warned_of() -> None:
    assert found(ANSWER) == [("0.ttl", "SC-K05")]
    assert found(ANSWER, TUNER) == [("0.ttl", "SC-K05")]
    assert found(ANSWER, TEMPLATE) == []


def test_a_task_by_itself_stands_in_the_file_of_its_template() -> None:
    assert found(":music a sc:Task ; sc:template :radio .\n", TEMPLATE) == [("0.ttl", "SC-K05")]


def test_a_binding_of_a_configuration_is_held_against_the_template_of_another_file() -> None:
    bound = ANSWER.replace(
        "; sc:template :radio ]", "; sc:template :radio ; sc:binding [ sc:parameter :x ; sc:value 1 ] ]"
    )
    assert found(bound, TEMPLATE) == [("0.ttl", "SC-K04")]


def test_what_is_wrong_elsewhere_is_told_there_and_once() -> None:
    again = ANSWER.replace(":now", ":then").replace('"audio"', '"radio"')
    assert {file for file, _ in found(ANSWER, TEMPLATE, TUNER + SPEAKER + again)} == {"2.ttl"}


def test_types_match_along_the_hierarchy_and_need_not() -> None:
    below = ":Music a owl:Class ; rdfs:label 'music'@en ; rdfs:subClassOf rob:Audio ."
    music = TUNER.replace("rob:Audio", ":Music")
    assert found(ANSWER, TEMPLATE, music, SPEAKER, ontology=below) == []
    assert found(ANSWER.replace('"audio"', '"other"'), TEMPLATE, music, SPEAKER, ontology=below) == [
        ("0.ttl", "SC-C10"),
        ("0.ttl", "SC-C09"),
    ]
    unlike = TUNER.replace("rob:Audio", "rob:Text")
    assert found(ANSWER, TEMPLATE, unlike, SPEAKER) == [("0.ttl", "SC-C09")]


def test_an_operation_joins_a_need_of_it() -> None:
    ads = OFFERING.format("tuner") + ASKING.format("speaker")
    calling = ANSWER.replace('"sound"', '"tune()"').replace('"audio"', '"play()"')
    assert found(calling, TEMPLATE, ads) == []
    assert found(ANSWER, TEMPLATE, ads) == [("0.ttl", "SC-C10"), ("0.ttl", "SC-C09")]
    assert found(calling, TEMPLATE, ads.replace("rob:Text", "rob:Audio", 1)) == [("0.ttl", "SC-C09")]


def test_an_outcome_is_not_remembered_where_another_file_has_changed() -> None:
    checker = FileChecker((), TermIndex())
    own, one, other = SourceText("a", b"x"), SourceText("b", b"y"), SourceText("b", b"z")
    keys = {checker.key(UnclearedFile(own, {}, beside)) for beside in ((), ((one, ("u",)),), ((other, ("u",)),))}
    assert len(keys) == 3


@pytest.mark.slow
def test_whatever_is_configured_conforms_to_the_files_that_it_is_made_from(tmp_path: Path) -> None:
    rng = random.Random(7)
    judged = tried = 0
    while judged < examples(10):
        tried += 1
        assert tried < 100 * examples(10)
        template, roles = ecology(rng)
        ads = components(rng, list(roles.about))
        answer = configured(tmp_path, template, roles.about, ads, roles.bound)
        if isinstance(answer, selfconf.Configuration):
            text = answer.to_turtle()
            (tmp_path / "answer.ttl").write_text(text)
            files = [tmp_path / name for name in ("answer.ttl", "t.ttl", "ads.ttl")]
            report = selfconf.validate(files)
            assert [one for one in report.diagnostics if one.file == str(files[0])] == [], (PREFIXES, template, ads)
            judged += 1

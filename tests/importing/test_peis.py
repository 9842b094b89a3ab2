"""Component descriptions of the PEIS ecology; the texts are as those of its components are."""

from __future__ import annotations

from pathlib import Path

import pytest

import selfconf
from selfconf.api.answer import Answer
from selfconf.errors import AuthorError
from selfconf.importing.peis import parse_fields, parse_semantics
from selfconf.importing.sources import SourceDocument
from tests.importing.imports import Workshop, left_out

EXAMPLES = Path(__file__).parents[2] / "examples"
DRIVE = r"""# Drive.cmp
Name=drive
Id=+21
Exec='peisplayer $PEISINIT'
ExtraArguments='--player-port 6665'
InitState=off
SpawnDelay=1.0
Semantics=

'(

  \"file:/Components.owl;#wheel_drive\"
  \"wheels and motors\"
  \"Motion drive of a robot.\"
  ( (\"file:/Objects.owl;#Support\" \"ASTRID\") )
  ( )
  ( )
  ( (\"position.0.mi-setvel\" \"file:/Data.owl;#PlanarVel\") )
  ( (\"position.0.pose\" \"file:/Data.owl;#PlanarPose\") (\"status\" \"text\") )

)'
"""


def source(text: str) -> SourceDocument:
    return SourceDocument("x.cmp", "x.cmp", text.encode())


def test_a_description_becomes_an_advertisement(workshop: Workshop) -> None:
    report = workshop.imported("peis", {"Drive.cmp": DRIVE})
    assert (
        workshop.texts()["Drive.ttl"].partition("\n\n")[2].partition("\n\n")[2]
        == """\
<urn:selfconf:peis:drive> a sc:Component, components:wheel_drive ;
    rdfs:label "wheels and motors" ;
    rdfs:comment "Motion drive of a robot." ;
    objects:Support "ASTRID" ;
    sc:hasInput [ sc:name "position.0.mi-setvel" ; sc:signalType data:PlanarVel ] ;
    sc:hasOutput [ sc:name "position.0.pose" ; sc:signalType data:PlanarPose ] , [ sc:name "status" ] .
""".replace("sc:hasOutput [", "sc:hasOutput\n        [").replace("] , [", "] ,\n        [")
    )
    assert left_out(report) == {"settings of peisinit, such as Exec and SpawnDelay": 5, "the type 'text'": 1}


def test_strings_keep_their_double_quotes_and_lose_single_ones_and_a_backslash_takes_the_next_letter() -> None:
    assert parse_fields(source(r"""name = a # comment
        ID=+5 exec='say \'hi\' #1' proxy="x y" """)) == {
        "name": "a", "id": "5", "exec": "say 'hi' #1", "proxy": '"x y"',
    }  # fmt: skip


@pytest.mark.parametrize(
    "semantics", ["'(<none>)'", "'(<semantic description here>)'", "''", r"'(\"NoType\" a b () () () () ())'"]
)
def test_a_placeholder_is_no_semantics_and_is_named(workshop: Workshop, semantics: str) -> None:
    report = workshop.imported("peis", {"x.cmp": f"Name=x\nsemantics= {semantics}\n"})
    assert report.files == report.unreadable == ()
    assert left_out(report) == {"components": 1}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("Name=x\nColour=red\n", "x.cmp:2:7: 'Colour' is no key of a PEIS component"),
        ("Name x\n", "the key Name is followed by '='"),
        ("Name=\n", "the key Name has no value"),
        ("Name=x\nExec='abc\n", "x.cmp:2:7: a string has no end"),
    ],
)
def test_what_is_no_description_is_named_with_its_place(text: str, words: str) -> None:
    with pytest.raises(AuthorError) as error:
        parse_fields(source(text))
    assert words in str(error.value)


@pytest.mark.parametrize(
    ("text", "words"), [("(a b)", "not one list of 8 parts"), ("())", "too many"), ("((", "not one list")]
)
def test_a_semantics_whose_brackets_do_not_fit_is_named(text: str, words: str) -> None:
    with pytest.raises(AuthorError, match=words):
        parse_semantics(source(""), text)


def test_a_semantics_that_is_none_is_named_at_its_key(workshop: Workshop) -> None:
    text = "Name=x\n# semantics= none\nId=+2 Semantics=\n\n'((a)'\n"
    (error,) = workshop.imported("peis", {"x.cmp": text}).unreadable
    assert "x.cmp:3:7: its semantics is not one list of 8 parts" in str(error)


def test_brackets_may_be_nested_as_deep_as_a_stranger_likes() -> None:
    with pytest.raises(AuthorError, match="not one list of 8 parts"):
        parse_semantics(source(""), "(" * 100_000 + ")" * 100_000)


def test_what_has_no_counterpart_is_named(workshop: Workshop) -> None:
    semantics = r"""'(type name \"\" ((a b) (\"urn:p\" \"urn:v\") x) (y) () ((i \"urn:t\") (i \"urn:t\")) ())'"""
    report = workshop.imported("peis", {"x.cmp": f"semantics= {semantics}\n"})
    assert left_out(report) == {
        "types that are no IRIs": 1, "the fifth and sixth part of a semantics": 1, "properties that are no IRIs": 1,
        "parts that are no pairs": 1, "ports": 1,
    }  # fmt: skip
    text = workshop.texts()["x.ttl"]
    assert "<urn:selfconf:peis:name> a sc:Component, <urn:selfconf:peis:Component> ;" in text
    assert "<urn:p> <urn:v>" in text


ASTRID = {
    "drive.cmp": ("wheel_drive", '( (\\"position.0.mi-setvel\\" \\"file:/Data.owl;#PlanarVel\\") ) ( )'),
    "wheels.cmp": ("encoder", '( ) ( (\\"position.0.odopos\\" \\"file:/Data.owl;#EncoderReading\\") )'),
    "ring.cmp": (
        "sonar_array",
        (
            '( ) ( (\\"sonar.pose\\" \\"file:/Data.owl;#PlanarPoseB\\")'
            ' (\\"sonar.range\\" \\"file:/Data.owl;#Distance\\") )'
        ),
    ),
}
"""Astrid's components as she described them in 2008: the same terms, in texts of our own."""
PLAYS = {"sonar": "ring", "encoder": "wheels", "drive": "drive"}


def test_astrid_of_2008_plays_her_roles_of_figure_7(workshop: Workshop) -> None:
    texts = {}
    for name, (kind, ports) in ASTRID.items():
        support = r"( (\"file:/Objects.owl;#Support\" \"ASTRID\") )"
        head = rf"\"file:/PeisComponentsHierarchy.owl;#{kind}\" \"{name[:-4]}\" \"Of Astrid.\""
        said = f"'( {head} {support} ( ) ( ) {ports} )'"
        texts[name] = f"Name={name[:-4]}\nId=+21\nSemantics=\n\n{said}\n"
    report = workshop.imported("peis", texts)
    others = ("thinking-cap.ttl", "person-tracker.ttl")
    home = selfconf.read(*(file.path for file in report.files), *(EXAMPLES / "peis-home" / name for name in others))
    task = selfconf.template(EXAMPLES / "navigate.ttl").bind(robot=":Astrid", goal="(AT BEDROOM)")
    assert not selfconf.partition(task, home)["sonar"].eligible
    partition = selfconf.partition(task, home, reasoning="subclass")
    answer = selfconf.configure(task, home, reasoning="subclass")
    for role, name in PLAYS.items():
        assert [str(each) for each in partition[role].eligible] == [f"urn:selfconf:peis:{name}"]
    assert answer
    assert isinstance(answer, Answer)
    flows = {(str(each.source).rpartition(":")[2], each.output, each.input) for each in answer.connections}
    assert {("ring", "sonar.range", "sonar"), ("wheels", "position.0.odopos", "localize")} < flows


def test_what_is_no_list_of_pairs_and_what_is_said_in_terms_of_selfconf_is_named(workshop: Workshop) -> None:
    sc = "https://w3id.org/selfconf#"
    report = workshop.imported(
        "peis",
        {
            "a.cmp": "Name=a Semantics='(urn:x:T (b c) (d) e () () () f)'",
            "b.cmp": f"Name=b Semantics='({sc}Template b d (({sc}preference high)) () () () ())'",
        },
    )
    assert left_out(report) == {
        "names and descriptions that are lists": 2,
        "parts that are no pairs": 2,
        "terms of selfconf": 1,
        "types of selfconf": 1,
    }
    assert "Template" not in workshop.texts()["b.ttl"]

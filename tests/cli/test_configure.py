"""`configure`: the paper's answer on files, and a sentence for everything that is wrong."""

from __future__ import annotations

import io
import json
import shlex
import subprocess
import sys
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from selfconf.bus.zenoh_bus import client
from selfconf.model.term import IRI
from selfconf.rdf.turtle import document as turtle
from selfconf.rdf.vocabulary import SC
from tests.cli.command import Outcome, each, run
from tests.lab import ADVERTISEMENTS, NAVIGATE, PREFIXES, iri, write_advertisements

BOUND = ("--bind", "robot=:Astrid", "--bind", "goal=(AT BEDROOM)")


class Desk:
    """A template and advertisements on files, and the command over them."""

    def __init__(self, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
        self.folder, self.capsys = folder, capsys
        self.ads = write_advertisements(folder / "ads")
        self.template = folder / "navigate.ttl"
        self.template.write_text(NAVIGATE)

    def configure(self, *arguments: str, ads: bool = True) -> Outcome:
        """Run `configure` with the template and the advertisements."""
        given = ("--ads", str(self.ads)) if ads else ()
        return run(self.capsys, "configure", str(self.template), *given, *arguments)

    def configured(self, *arguments: str) -> dict[str, Any]:
        """The configuration as JSON."""
        outcome = self.configure(*arguments, "--format", "json")
        assert outcome.code == 0, outcome
        body: dict[str, Any] = outcome.body
        assert body["status"] == "configured"
        return body

    def refused(self, *arguments: str) -> dict[str, Any]:
        """The refusal as JSON."""
        outcome = self.configure(*arguments, "--format", "json")
        assert outcome.code == 1, outcome
        body: dict[str, Any] = outcome.body
        assert body["status"] == "refused"
        return body

    def advertise(self, name: str, text: str) -> None:
        """Put one more advertisement there."""
        (self.ads / f"{name}.ttl").write_text(PREFIXES + text)


@pytest.fixture
def desk(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Desk:
    """The paper's files."""
    return Desk(tmp_path, capsys)


def players(body: dict[str, Any]) -> dict[str, list[str]]:
    """Who plays which role, by short names."""
    return {IRI(role["role"]).short: [IRI(c).short for c in role["components"]] for role in body["roles"]}


# The paper's experiment on files.


def test_the_papers_template_and_advertisements_give_exactly_the_papers_configuration(desk: Desk) -> None:
    body = desk.configured(*BOUND)
    seconds = body.pop("seconds")
    assert set(seconds) == {"load", "partition", "search"}
    assert all(value >= 0 for value in seconds.values())

    def wire(source: str, output: str, sink: str, port: str) -> dict[str, dict[str, str]]:
        return {"from": {"component": iri(source), "output": output}, "to": {"component": iri(sink), "input": port}}

    assert body == {
        "status": "configured",
        "template": iri("navigate"),
        "bindings": {"robot": iri("Astrid"), "goal": "(AT BEDROOM)"},
        "roles": [
            {"role": iri("sonar"), "components": [iri("sonar-array")]},
            {"role": iri("encoder"), "components": [iri("wheels")]},
            {"role": iri("position"), "components": [iri("person-tracker")]},
            {"role": iri("control"), "components": [iri("thinking-cap")]},
            {"role": iri("drive"), "components": [iri("astrid-drive")]},
        ],
        "connections": [
            wire("sonar-array", "ranges", "thinking-cap", "sonar"),
            wire("wheels", "odometry", "thinking-cap", "localize"),
            wire("person-tracker", "pose", "thinking-cap", "position"),
            wire("thinking-cap", "set.velocity", "astrid-drive", "velocity"),
        ],
        "parameters": [{"component": iri("thinking-cap"), "name": "goal", "value": "(AT BEDROOM)"}],
        "eligible": {
            iri("sonar"): 1,
            iri("encoder"): 1,
            iri("position"): 2,
            iri("control"): 1,
            iri("drive"): 1,
        },
    }


def test_the_papers_own_algorithm_gives_the_same_configuration(desk: Desk) -> None:
    first, paper = desk.configured(*BOUND), desk.configured(*BOUND, "--strategy", "paper")
    for body in (first, paper):
        body.pop("seconds")
    assert first == paper


def test_without_the_trackers_file_odometry_is_chosen(desk: Desk) -> None:
    (desk.ads / "tracker.ttl").unlink()
    assert players(desk.configured(*BOUND))["position"] == ["absolute-odometry"]


def test_pippis_drive_is_never_taken_and_is_a_near_miss_when_astrids_is_gone(desk: Desk) -> None:
    (desk.ads / "drive.ttl").unlink()
    body = desk.refused(*BOUND)
    assert [(reason["code"], reason["role"]) for reason in body["reasons"]] == [("too-few-eligible", iri("drive"))]
    misses = [(miss["role"], miss["component"], miss["obstacle"]) for miss in body["near_misses"]]
    assert (iri("drive"), iri("pippi-drive"), "support is Pippi, not Astrid") in misses


def test_the_order_of_files_on_the_command_line_changes_nothing(desk: Desk) -> None:
    files = [str(path) for path in sorted(desk.ads.iterdir())]
    bodies = []
    for order in (files, files[::-1]):
        outcome = desk.configure(*BOUND, "--format", "json", *each("--ads", *order), ads=False)
        assert outcome.code == 0
        bodies.append({**outcome.body, "seconds": None})
    assert bodies[0] == bodies[1]


def test_preference_decides_and_then_the_iri(desk: Desk) -> None:
    desk.advertise(
        "ceiling",
        ":a-ceiling-camera a sc:Component, rob:PositionSensor ; sc:preference 10 ;"
        ' sc:hasOutput [ sc:name "pose" ; sc:signalType rob:PlanarPose2D ] .',
    )
    assert players(desk.configured(*BOUND))["position"] == ["a-ceiling-camera"]


# Reasoning.


def subclassed(desk: Desk) -> None:
    """The tracker says only that it is a person tracker, and odometry is gone."""
    (desk.ads / "odometry.ttl").unlink()
    desk.advertise("tracker", ADVERTISEMENTS["tracker"].replace("rob:PositionSensor", "rob:PersonTracker"))


def test_subclass_mode_accepts_a_person_tracker_where_syntactic_mode_refuses_it(desk: Desk) -> None:
    subclassed(desk)
    body = desk.refused(*BOUND)
    assert body["reasons"][0]["role"] == iri("position")
    assert any("--reasoning subclass" in repair["message"] for repair in body["repairs"])
    body = desk.configured(*BOUND, "--reasoning", "subclass")
    assert players(body)["position"] == ["person-tracker"]


def test_owl_rl_mode_accepts_it_too(desk: Desk) -> None:
    subclassed(desk)
    assert players(desk.configured(*BOUND, "--reasoning", "owl-rl"))["position"] == ["person-tracker"]


def test_an_ontology_of_ones_own_counts_in_subclass_mode(desk: Desk) -> None:
    (desk.ads / "odometry.ttl").unlink()
    desk.advertise("tracker", ADVERTISEMENTS["tracker"].replace("rob:PositionSensor", ":CeilingCamera"))
    own = desk.folder / "own.ttl"
    own.write_text(PREFIXES + ":CeilingCamera rdfs:subClassOf rob:PositionSensor .")
    desk.refused(*BOUND, "--reasoning", "subclass")
    body = desk.configured(*BOUND, "--reasoning", "subclass", "--ontology", str(own))
    assert players(body)["position"] == ["person-tracker"]
    desk.refused(*BOUND, "--ontology", str(own))


def test_an_output_of_a_more_special_signal_feeds_an_input_in_subclass_mode_only(desk: Desk) -> None:
    own = desk.folder / "own.ttl"
    own.write_text(PREFIXES + ":GlobalPose rdfs:subClassOf rob:PlanarPose2D .")
    (desk.ads / "odometry.ttl").unlink()
    desk.advertise("tracker", ADVERTISEMENTS["tracker"].replace("rob:PlanarPose2D", ":GlobalPose"))
    desk.refused(*BOUND, "--ontology", str(own))
    desk.configured(*BOUND, "--ontology", str(own), "--reasoning", "subclass")


def test_a_more_general_signal_never_feeds_a_special_input(desk: Desk) -> None:
    own = desk.folder / "own.ttl"
    own.write_text(PREFIXES + "rob:PlanarPose2D rdfs:subClassOf :AnyPose .")
    (desk.ads / "odometry.ttl").unlink()
    desk.advertise("tracker", ADVERTISEMENTS["tracker"].replace("rob:PlanarPose2D", ":AnyPose"))
    desk.refused(*BOUND, "--ontology", str(own), "--reasoning", "subclass")


# Templates.


def with_template(desk: Desk, text: str) -> None:
    """Use another template."""
    desk.template.write_text(PREFIXES + text)


TWO_CAMERAS = """
:watch a sc:Template ; sc:roles ( :left :right :fuse ) .
:left  a sc:Role ; sh:class :Camera .
:right a sc:Role ; sh:class :Camera .
:fuse  a sc:Role ; sh:class :Fusion .
:i1 a sc:Interaction ; sc:from :left ;  sc:to :fuse ; sc:output "image" ; sc:input "left" .
:i2 a sc:Interaction ; sc:from :right ; sc:to :fuse ; sc:output "image" ; sc:input "right" .
"""
CAMERAS = """
:cam1 a sc:Component, :Camera ; sc:hasOutput [ sc:name "image" ; sc:signalType :Image ] ,
    [ sc:name "depth" ; sc:signalType :Image ] .
:cam2 a sc:Component, :Camera ; sc:hasOutput [ sc:name "image" ; sc:signalType :Image ] .
:stereo a sc:Component, :Fusion ; sc:hasInput [ sc:name "left" ; sc:signalType :Image ] ,
    [ sc:name "right" ; sc:signalType :Image ] .
"""


def test_the_long_form_of_interactions_names_the_ports(desk: Desk) -> None:
    with_template(desk, TWO_CAMERAS)
    desk.advertise("cameras", CAMERAS)
    body = desk.configured()
    ends = {(IRI(c["from"]["component"]).short, c["from"]["output"], c["to"]["input"]) for c in body["connections"]}
    assert ends == {("cam1", "image", "left"), ("cam2", "image", "right")}


def test_the_short_form_pairs_all_ports_of_equal_type(desk: Desk) -> None:
    with_template(desk, TWO_CAMERAS[: TWO_CAMERAS.index(":i1")] + ":left sc:feeds :fuse . :right sc:feeds :fuse .")
    desk.advertise("cameras", CAMERAS)
    ends = {
        (IRI(c["from"]["component"]).short, c["from"]["output"], c["to"]["input"])
        for c in desk.configured()["connections"]
    }
    assert ends == {
        (camera, output, port)
        for camera, output in (("cam1", "image"), ("cam1", "depth"), ("cam2", "image"))
        for port in ("left", "right")
    }


def test_a_port_that_nobody_has_is_a_refusal_not_a_crash(desk: Desk) -> None:
    with_template(desk, TWO_CAMERAS.replace('"image"', '"picture"'))
    desk.advertise("cameras", CAMERAS)
    desk.refused()


RADIO = """
:radio a sc:Template ; sc:roles ( :tuner :speaker ) ; sc:parameter :room .
:room a sc:Parameter ; sc:name "room" ; sh:nodeKind sh:IRI .
:tuner   a sc:Role ; sh:class rob:Tuner ; sc:feeds :speaker .
:speaker a sc:Role ; sh:class rob:Speaker ; COUNTS sh:property [ sh:path rob:place ; sh:in ( :room ) ; sh:minCount 1 ] .
"""
SPEAKERS = (
    ':tuner1 a sc:Component, rob:Tuner ; sc:hasOutput [ sc:name "sound" ; sc:signalType :Audio ] .'
    + "".join(
        f":s{n} a sc:Component, rob:Speaker ; rob:place :{room} ;"
        ' sc:hasInput [ sc:name "sound" ; sc:signalType :Audio ] .'
        for n, room in enumerate(("kitchen", "kitchen", "kitchen", "hall"))
    )
    + ':s9 a sc:Component, rob:Speaker ; sc:hasInput [ sc:name "sound" ; sc:signalType :Audio ] .'
)


@pytest.mark.parametrize(
    ("counts", "speakers"),
    [
        ("", ["s0"]),
        ("sc:minCount 1 ;", ["s0", "s1", "s2"]),
        ("sc:minCount 2 ; sc:maxCount 2 ;", ["s0", "s1"]),
        ("sc:minCount 0 ; sc:maxCount 1 ;", ["s0"]),
        ("sc:maxCount 2 ;", ["s0", "s1"]),
    ],
)
def test_a_role_takes_as_many_as_it_asks_for(desk: Desk, counts: str, speakers: list[str]) -> None:
    with_template(desk, RADIO.replace("COUNTS", counts))
    desk.advertise("speakers", SPEAKERS)
    assert players(desk.configured("--bind", "room=:kitchen"))["speaker"] == speakers


def test_a_role_that_asks_for_more_than_there_are_is_refused(desk: Desk) -> None:
    with_template(desk, RADIO.replace("COUNTS", "sc:minCount 4 ;"))
    desk.advertise("speakers", SPEAKERS)
    assert desk.refused("--bind", "room=:kitchen")["reasons"][0]["role"] == iri("speaker")


def test_a_role_that_may_be_played_by_nobody_is_optional(desk: Desk) -> None:
    with_template(desk, RADIO.replace("COUNTS", "sc:minCount 0 ;"))
    desk.advertise("speakers", SPEAKERS)
    assert players(desk.configured("--bind", "room=:attic"))["speaker"] == []


def test_an_unbound_robot_is_the_same_one_for_every_role(desk: Desk) -> None:
    goal = ("--bind", "goal=(AT BEDROOM)")
    body = desk.configured(*goal)
    assert body["bindings"] == {"goal": "(AT BEDROOM)"} or body["bindings"]["robot"] == iri("Astrid")
    assert players(body)["drive"] == ["astrid-drive"]
    desk.advertise("sonar", ADVERTISEMENTS["sonar"].replace(":Astrid", ":Pippi"))
    desk.refused(*goal)
    desk.advertise("encoder", ADVERTISEMENTS["encoder"].replace(":Astrid", ":Pippi"))
    assert players(desk.configured(*goal))["drive"] == ["pippi-drive"]


def test_a_task_brings_its_bindings(desk: Desk) -> None:
    with_template(
        desk,
        NAVIGATE.removeprefix(PREFIXES)
        + ":task a sc:Task ; sc:template :navigate ; sc:binding [ sc:parameter :robot ; sc:value :Astrid ] ,"
        ' [ sc:parameter :goal ; sc:value "(AT KITCHEN)" ] .',
    )
    body = desk.configured()
    assert body["bindings"] == {"robot": iri("Astrid"), "goal": "(AT KITCHEN)"}
    assert body["parameters"][0]["value"] == "(AT KITCHEN)"


def test_one_template_of_several_is_named_by_a_term(desk: Desk) -> None:
    with_template(desk, NAVIGATE.removeprefix(PREFIXES) + RADIO.replace("COUNTS", ""))
    desk.configure(*BOUND).is_one_sentence("--template")
    assert desk.configured(*BOUND, "--template", ":navigate")["template"] == iri("navigate")


# Formats.


def test_the_text_is_for_people(desk: Desk) -> None:
    outcome = desk.configure(*BOUND)
    assert outcome.code == 0
    assert ":position  :person-tracker" in outcome.out
    assert ':thinking-cap goal = "(AT BEDROOM)"' in outcome.out


def test_the_turtle_is_a_configuration(desk: Desk) -> None:
    document = turtle.parse(desk.configure(*BOUND, "--format", "turtle").out, "answer")
    (name,) = document.instances(SC.Configuration)
    assert len(document.values(name, SC.connection)) == 4
    assert len(document.values(name, SC.assignment)) == 5


def test_the_mermaid_is_a_flow_chart(desk: Desk) -> None:
    out = desk.configure(*BOUND, "--format", "mermaid").out
    assert out.startswith("flowchart LR\n")
    assert out.count("-->") == 4


@pytest.mark.parametrize("form", ["text", "turtle", "mermaid"])
def test_a_refusal_is_readable_in_every_format(desk: Desk, form: str) -> None:
    (desk.ads / "drive.ttl").unlink()
    outcome = desk.configure(*BOUND, "--format", form)
    assert outcome.code == 1
    assert "no component is eligible for the role drive" in outcome.out


# What is wrong with the input.


def test_an_advertisement_that_does_not_conform_is_named_and_left_out(desk: Desk) -> None:
    desk.advertise("bad", ':lamp a sc:Component, rob:PositionSensor ; sc:preference "high" .')
    outcome = desk.configure(*BOUND, "--format", "json")
    assert outcome.code == 0
    assert "bad.ttl" in outcome.err
    assert "sc:preference" in outcome.err
    assert outcome.body["eligible"][iri("position")] == 2


def test_a_component_whose_input_accepts_what_cannot_be_judged_is_named_once(desk: Desk) -> None:
    shape = '[ sh:property [ sh:path sc:name ; sh:pattern "(" ] ]'
    port = f'[ sc:name "i" ; sc:signalType rob:Text ; sc:accepts {shape} ]'
    desk.advertise("odd", f":odd a sc:Component, rob:PositionSensor ; sc:hasInput {port} .")
    outcome = desk.configure(*BOUND)
    assert outcome.code == 0
    assert outcome.err.count("what its input accepts cannot be judged") == 1


def test_a_component_that_is_advertised_twice_is_named(desk: Desk) -> None:
    desk.advertise("z", ADVERTISEMENTS["tracker"])
    outcome = desk.configure(*BOUND)
    assert outcome.code == 0
    assert "z.ttl" in outcome.err
    assert "tracker.ttl already" in outcome.err


def test_a_shape_in_one_advertisement_does_not_speak_about_another_component(desk: Desk) -> None:
    """Not even where pySHACL judges, over the advertisements of everybody."""
    (desk.ads / "drive.ttl").unlink()
    desk.advertise(
        "liar",
        ":liar a sc:Component, rob:Encoder ; :knows :pippi-drive . :pippi-drive rob:support :Astrid ; a :Approved .",
    )
    with_template(
        desk,
        ":t a sc:Template ; sc:roles ( :r ) ."
        " :r a sc:Role ; sh:class rob:MotorDrive ; sh:or ( [ sh:class :Approved ] ) .",
    )
    desk.refused()


def bad_templates() -> list[tuple[str, str]]:
    """Templates that cannot be read, each with words that the sentence must hold."""
    role = ":r a sc:Role ; sh:class rob:Encoder ."
    return [
        ("this is no turtle", "navigate.ttl:8"),
        ("", "no sc:Template"),
        (":t a sc:Template .", "sc:roles"),
        (":t a sc:Template ; sc:roles ( ) .", "empty"),
        (":t a sc:Template ; sc:roles ( :r ) .", "not described as a sc:Role"),
        (f":t a sc:Template ; sc:roles ( :r :r ) . {role}", "2 times"),
        (f":t a sc:Template ; sc:roles ( :r ) . {role} :r sc:feeds :nobody .", "which is no role"),
        (f":t a sc:Template ; sc:roles ( [ a sc:Role ] ) . {role}", "IRI"),
        (f"[] a sc:Template ; sc:roles ( :r ) . {role}", "IRI"),
        (f":t a sc:Template ; sc:roles ( :r ) . {role} :r sc:minCount 3 ; sc:maxCount 1 .", "at least 3 and at most 1"),
        (f':t a sc:Template ; sc:roles ( :r ) . {role} :r sc:minCount "two" .', "whole number"),
        (f":t a sc:Template ; sc:roles ( :r ) . {role} :r sc:minCount {'9' * 5000} .", "whole number"),
        (f":t a sc:Template ; sc:roles ( :r ) . {role} :i a sc:Interaction ; sc:from :r .", "sc:to"),
        (f":t a sc:Template ; sc:roles ( :r ) . {role} :i a sc:Interaction ; sc:from :r ; sc:to :x .", "no role"),
        (f":t a sc:Template ; sc:roles ( :r ) ; sc:parameter :p . {role} :p a sc:Parameter .", "sc:name"),
        (f":t a sc:Template ; sc:roles ( :r ) . {role} :r sc:sets [ sc:value 1 ] .", "sc:parameterType"),
        (f':t a sc:Template ; sc:roles ( :r ) . {role} :r sh:pattern "(" .', "not well-formed"),
        (
            f':t a sc:Template ; sc:roles ( :r ) . {role} :r sh:property [ sh:minCount "x" ; sh:path 3 ] .',
            "well-formed",
        ),
        (f":t a sc:Template ; sc:roles ( :r ) . {role} :r sh:property [ sh:minCount 1 ] .", "well-formed"),
        (":k a sc:Task ; sc:template :elsewhere .", "not in this file"),
    ]


@pytest.mark.parametrize(("text", "words"), bad_templates())
def test_a_template_that_cannot_be_read_is_one_sentence(desk: Desk, text: str, words: str) -> None:
    with_template(desk, text)
    assert desk.configure().is_one_sentence(words, "navigate.ttl")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--bind", "robot=:Astrid"), "the parameter 'goal' needs a value"),
        ((*BOUND, "--bind", "colour=red"), "no parameter 'colour'"),
        ((*BOUND, "--bind", "robot=:Pippi"), "bound twice"),
        (("--bind", "robot"), "NAME=TERM"),
        (("--bind", "=x"), "NAME=TERM"),
        (("--bind", "robot=x:Astrid", "--bind", "goal=x"), "prefix x:"),
        (("--bind", "robot=<Astrid", "--bind", "goal=x"), "no Turtle term"),
        (("--bind", "robot=http://example.org/a", "--bind", "goal=x"), "angle brackets"),
        (("--bind", "robot=Astrid", "--bind", "goal=x"), "cannot stand for the parameter 'robot'"),
        (("--bind", "robot=:Astrid", "--bind", "goal=3"), "cannot stand for the parameter 'goal'"),
        ((*BOUND, "--ontology", "/no/such/file.ttl"), "no file or folder /no/such/file.ttl"),
        ((*BOUND, "--template", "navigate"), "CURIE"),
        ((*BOUND, "--template", ":radio"), "radio"),
    ],
)
def test_an_argument_that_does_not_fit_is_one_sentence(desk: Desk, arguments: tuple[str, ...], words: str) -> None:
    assert desk.configure(*arguments).is_one_sentence(words)


def test_files_that_are_not_there_or_are_not_turtle_are_one_sentence(desk: Desk) -> None:
    missing = desk.folder / "nowhere"
    assert desk.configure(*BOUND, "--ads", str(missing), ads=False).is_one_sentence(f"no file or folder {missing}")
    assert run(desk.capsys, "configure", str(missing), "--ads", str(desk.ads)).is_one_sentence(str(missing))
    assert run(desk.capsys, "configure", str(desk.ads), "--ads", str(desk.ads)).is_one_sentence("is a folder")
    (desk.ads / "broken.ttl").write_bytes(b"@prefix : <x> .\n:a :b \xff .")
    assert desk.configure(*BOUND).is_one_sentence("broken.ttl:2", "not Turtle")


def test_without_a_peer_there_is_a_sentence_that_says_what_to_start(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    for module in ("selfconf.api.membership", "selfconf.rendezvous"):
        monkeypatch.setattr(f"{module}.client", partial(client, seconds=0.1))
    assert desk.configure(*BOUND, ads=False).is_one_sentence("selfconf site")
    assert desk.configure(*BOUND, "--connect", "tcp/127.0.0.1:1", ads=False).is_one_sentence("no site answers")
    assert desk.configure(*BOUND, "--connect", "here", ads=False).is_one_sentence("no endpoint")


def test_an_empty_folder_is_an_honest_no(desk: Desk) -> None:
    empty = desk.folder / "empty"
    empty.mkdir()
    outcome = desk.configure(*BOUND, "--ads", str(empty), "--format", "json", ads=False)
    assert outcome.code == 1
    assert len(outcome.body["reasons"]) >= 1


# What the shell does with the streams.


@pytest.mark.parametrize(
    ("task", "redirected", "code"),
    [
        ("robot=:Pippi", "| true", 1),
        ("robot=:Pippi", "2>&1 | true", 1),
        ("nobody=:Pippi", "2>&1 | true", 2),
        ("robot=:Astrid", ">&-", 0),
        ("robot=:Pippi", ">&- 2>&-", 1),
    ],
)
def test_the_exit_code_does_not_depend_on_who_reads(desk: Desk, task: str, redirected: str, code: int) -> None:
    words = ("-m", "selfconf", "configure", desk.template, "--ads", desk.ads, "--bind", "goal=x", "--bind", task)
    command = shlex.join(map(str, (sys.executable, *words)))
    script = f"({command}; echo $? >code) {redirected}"
    done = subprocess.run(["bash", "-c", script], cwd=desk.folder, capture_output=True, text=True, check=False)
    assert "Traceback" not in done.stderr
    assert (desk.folder / "code").read_text() == f"{code}\n"


def test_template_or_advertisements_come_in_on_stdin_but_not_both(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    answer = desk.configured(*BOUND)["roles"]

    def piped(text: str, *arguments: str) -> Outcome:
        monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(text.encode())))
        return run(desk.capsys, "configure", *arguments, *BOUND, "--format", "json")

    assert piped(NAVIGATE, "-", "--ads", str(desk.ads)).body["roles"] == answer
    everything = "".join(path.read_text() for path in sorted(desk.ads.glob("*.ttl")))
    assert piped(everything, str(desk.template), "--ads", "-").body["roles"] == answer
    assert piped(NAVIGATE, "-", "--ads", "-").is_one_sentence("- is standard input")
    assert piped("garbage", "-", "--ads", str(desk.ads)).is_one_sentence("<stdin>:1:")


def test_standard_input_that_is_closed_is_one_sentence(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", None)
    for given in (("-", "--ads", str(desk.ads)), (str(desk.template), "--ads", "-")):
        assert run(desk.capsys, "configure", *given, *BOUND).is_one_sentence("standard input is closed")


def test_of_two_descriptions_the_first_by_path_counts_in_whatever_order_they_are_given(desk: Desk) -> None:
    for name, text in (("a", ":lamp a sc:Component, :A ."), ("b", ":lamp a sc:Component, :B .")):
        (desk.folder / f"{name}.ttl").write_text(PREFIXES + text)
    desk.template.write_text(PREFIXES + ":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class :A .")
    files = [str(desk.folder / f"{name}.ttl") for name in "ab"]
    for order in (files, files[::-1]):
        outcome = desk.configure(*each("--ads", *order), ads=False)
        assert outcome.code == 0
        line = (PREFIXES + "x").count("\n") + 1
        assert outcome.err == f"{files[1]}:{line}: left out {iri('lamp')}: it is advertised in {files[0]} already\n"


# Terms in words.


@pytest.mark.parametrize(
    ("literal", "text", "value"),
    [
        ("5", "5", 5),
        ('"5"', '"5"', "5"),
        ("1.50", "1.50", 1.5),
        ("true", "true", True),
        ('"hello"@en', '"hello"@en', "hello"),
        ('"say \\"x\\"\\n"', '"say \\"x\\"\\n"', 'say "x"\n'),
        ('"INF"^^xsd:double', '"INF"^^xsd:double', "INF"),
        ('"NaN"^^xsd:double', '"NaN"^^xsd:double', "NaN"),
        ('"2026-01-01"^^xsd:date', '"2026-01-01"^^xsd:date', "2026-01-01"),
    ],
)
def test_a_value_is_shown_as_turtle_and_written_as_json(desk: Desk, literal: str, text: str, value: Any) -> None:
    desk.template.write_text(NAVIGATE.replace(" ; sh:datatype xsd:string", ""))
    bound = ("--bind", "robot=:Astrid", "--bind", f"goal={literal}")
    assert f"\n  goal = {text}\n" in desk.configure(*bound).out
    body = json.loads(desk.configure(*bound, "--format", "json").out, parse_constant=pytest.fail)
    assert [body["bindings"]["goal"], body["parameters"][0]["value"]] == [value, value]


def test_a_blank_node_is_no_value_from_outside(desk: Desk) -> None:
    outcome = desk.configure("--bind", "robot=_:b", "--bind", "goal=x")
    assert outcome.is_one_sentence("_:b is a blank node", "bind robot to an IRI")


def test_an_answer_that_is_not_certified_is_never_printed(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    assert desk.configure(*BOUND).code == 0
    monkeypatch.setattr("selfconf.search.problem.Problem.feeders", lambda *_: iter(()))
    monkeypatch.setattr("selfconf.search.problem.Problem.compatible", lambda *_: True)
    for form in ("text", "json", "turtle"):
        assert desk.configure(*BOUND, "--format", form).is_one_sentence("the search has made a mistake", "missing")


SUPPLIED = ":t a sc:Template ; sc:roles ( :source :user ) . :source a sc:Role ; sh:class :Source ; sc:feeds :user ."
USER = ":user a sc:Role ; sh:class :User ."
RECRUITING = ":t a sc:Template ; sc:roles ( :user ) . :user a sc:Role ; sh:class :User ; sc:recruits true ."
COMPOSITE = """:NAME a sc:Component, :User, :NAME-type ; sc:hasOutput [ sc:name "o" ; sc:signalType :S ] ;
    sc:grounding [ sc:template :NAME-inside ] .
:NAME-inside a sc:Template ; sc:roles ( :NAME-role ) ;
    sc:hasOutput [ sc:name "o" ; sc:signalType :S ; sc:of :NAME-role ] .
:NAME-role a sc:Role ; sh:class :WANTED ."""


def source(name: str, wanted: str, issued: str) -> str:
    """A component that makes one signal of another."""
    issues = f'sc:hasOutput [ sc:name "o" ; sc:signalType :{issued} ]'
    return f':{name} a sc:Component, :Source ; sc:hasInput [ sc:name "i" ; sc:signalType :{wanted} ] ; {issues} .'


@pytest.mark.parametrize(
    ("task", "ads", "code", "sentence"),
    [
        (
            RECRUITING,
            {
                "user": ':u a sc:Component, :User ; sc:hasInput [ sc:name "i" ; sc:signalType :S ] .',
                "both": source("a", "T", "S") + source("b", "S", "T"),
            },
            1,
            "the nearest is a, which is fed only in a circle: its input 'i' by b by a",
        ),
        (
            SUPPLIED + USER,
            {
                "u": ':u a sc:Component, :User ; sc:hasInput [ sc:name "i" ; sc:accepts _:s ] . _:s sh:node _:s .',
                "s": ':s a sc:Component, :Source ; sc:hasOutput [ sc:name "o" ; sc:signalType :S ] .',
            },
            1,
            "left out https://example.org/peis-home#u: the sc:accepts of input 'i' is no shape",
        ),
        (
            SUPPLIED.replace("sc:feeds :user", "") .replace(":source :user", ":user") + USER,
            {
                "one": COMPOSITE.replace("NAME", "one").replace("WANTED", "two-type"),
                "two": COMPOSITE.replace("NAME", "two").replace("WANTED", "one-type"),
            },
            0,
            ":one: it could be inside of itself (one of two of one); a composite of itself has no end",
        ),
        (
            SUPPLIED + USER,
            {
                "u": ':u a sc:Component, :User ; sc:needsOperation [ sc:name "look" ; sc:response :S ] .',
                "s": ':s a sc:Component, :Source ; sc:hasOperation [ sc:name "see" ; sc:response :T ] .',
            },
            1,
            "the operation 'look' (-> S) that u needs cannot be called: no candidate of source offers an operation",
        ),
        (
            SUPPLIED + USER,
            {
                "u": ':u a sc:Component, :User ; sc:hasInput [ sc:name "i" ; sc:signalType :S ; sc:unit "metre" ] .',
                "s": ':s a sc:Component, :Source ; sc:hasOutput [ sc:name "o" ; sc:signalType :S ] .',
            },
            1,
            "left out https://example.org/peis-home#u: the sc:unit of 'i' is an IRI, if it is there at all",
        ),
        (
            SUPPLIED.replace("sc:feeds :user", "").replace(":source :user", ":user") + USER,
            {
                "one": COMPOSITE.replace("NAME", "one").replace("WANTED", "Part"),
                "part": ':part a sc:Component, :Part ; sc:hasOutput [ sc:name "o" ; sc:signalType :T ] .',
            },
            0,
            "its inside cannot be configured now: the input 'o' (S) of one cannot be fed: no candidate of one-role",
        ),
        (
            SUPPLIED.replace("sc:feeds :user", "").replace(":source :user", ":user") + USER,
            {"one": COMPOSITE.replace("NAME", "one").replace("sc:of :one-role", "sc:of :nobody")},
            0,
            "peis-home#nobody>, which is no role of the template",
        ),
    ],
    ids=["cycle", "endless", "itself", "unanswered", "unit", "unserved", "roleless"],
)  # fmt: skip
def test_what_cannot_be_composed_is_one_sentence(
    task: str, ads: dict[str, str], code: int, sentence: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "task.ttl").write_text(PREFIXES + task)
    write_advertisements(tmp_path / "ads", advertisements=ads)
    outcome = run(capsys, "configure", str(tmp_path / "task.ttl"), "--ads", str(tmp_path / "ads"))
    assert outcome.code == code
    assert sentence in outcome.out + outcome.err
    assert "Traceback" not in outcome.err

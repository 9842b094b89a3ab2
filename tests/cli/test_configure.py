"""`configure`: the paper's answer on files, under each reasoning, and in each format."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from selfconf.rdf.turtle import document as turtle
from selfconf.rdf.vocabulary import SC
from tests.cli.command import each, run
from tests.cli.desk import BOUND, Desk, players
from tests.cli.processes import Home
from tests.lab import ADVERTISEMENTS, NAVIGATE, PREFIXES, iri

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


@pytest.mark.parametrize("form", ["turtle", "mermaid"])
def test_a_format_that_does_not_tell_what_would_replace_what_says_so(form: str, desk: Desk) -> None:
    assert desk.configure(*BOUND, "--format", form).err == ""
    asked = desk.configure(*BOUND, "--format", form, "--what-if")
    assert asked.code == 0
    assert asked.err == f"--what-if is shown as text and as JSON, not by --format {form}\n"


def test_an_interaction_that_connects_nothing_as_the_input_is_optional_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for name, port in (
        ("talker", 'sc:hasOutput [ sc:name "words" ; sc:signalType :Words ]'),
        ("listener", 'sc:hasInput [ sc:name "text" ; sc:signalType :Text ; sc:optional true ]'),
    ):
        (tmp_path / "ads").mkdir(exist_ok=True)
        (tmp_path / "ads" / f"{name}.ttl").write_text(f"{PREFIXES}:{name} a sc:Component, :{name.title()} ; {port} .")
    roles = ":source a sc:Role ; sh:class :Talker ; sc:feeds :sink . :sink a sc:Role ; sh:class :Listener ."
    (tmp_path / "chat.ttl").write_text(f"{PREFIXES}:chat a sc:Template ; sc:roles ( :source :sink ) . {roles}")
    found = run(capsys, "configure", str(tmp_path / "chat.ttl"), "--ads", str(tmp_path / "ads"))
    assert found.code == 0
    assert ":source feeds :sink, which connects nothing: no output of the one matches an input of" in found.err


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


# The living ecology.


@pytest.mark.process
def test_what_is_chosen_and_absent_is_named_as_a_run_would_do_without_it(
    home: Home, capsys: pytest.CaptureFixture[str]
) -> None:
    home.site("peis-home", "ads")
    home.components("sonar", "encoder", "odometry", "control", "drive")
    template, where = str(home.folder / "navigate.ttl"), home.arguments()
    said = run(capsys, "configure", template, *BOUND, *where)
    assert said.code == 0
    assert [line for line in said.err.splitlines() if "is absent" in line] == [
        ":person-tracker is absent: `run` does without it, unless it is started before that"
    ]
    home.components("tracker")
    assert run(capsys, "configure", template, *BOUND, *where).err == ""

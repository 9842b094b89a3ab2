"""`configure` with templates of other kinds than the paper's: ports by name, counts, free parameters, tasks."""

from __future__ import annotations

import pytest

from selfconf.model.term import IRI
from tests.cli.desk import BOUND, Desk, players, with_template
from tests.lab import ADVERTISEMENTS, NAVIGATE, PREFIXES, iri

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

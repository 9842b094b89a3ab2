"""What composites are inside, from the advertisements of a site: configured, or refused with a sentence."""

from __future__ import annotations

from dataclasses import replace

import pytest

from selfconf.composition import Inside, configurable, insides, why_none
from selfconf.model.configuration import Assignment, Configuration, Connection, ParameterSetting
from selfconf.model.holder import Holder
from selfconf.model.refusal import Refusal, TooFewEligible, Undecided
from selfconf.model.term import IRI, Literal, Term
from selfconf.model.wording import MANY
from selfconf.rdf.advertisements import Advertisement, read_advertisements
from selfconf.rdf.turtle import Document, parse
from selfconf.render import holder_text
from tests.lab import PREFIXES, iri

COMPOSITE = """
:whole a sc:Component, :Whole ; sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ] ;
    sc:hasParameter [ sc:name "robot" ; sc:parameterType :Robot ] , [ sc:name "speed" ; sc:parameterType :Speed ] ;
    sc:grounding [ sc:template :localise ] .
"""
TEMPLATE = """
:localise a sc:Template ; sc:parameter :robot , :speed ; sc:roles ( :tracker ) ;
    sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ; sc:of :tracker ] .
:robot a sc:Parameter ; sc:name "robot" ; sh:nodeKind sh:IRI .
:speed a sc:Parameter ; sc:name "speed" ; sh:datatype xsd:integer .
:tracker a sc:Role ; sh:class :Tracker ; sh:property [ sh:path :of ; sh:in ( :robot ) ; sh:minCount 1 ] ;
    sc:sets [ sc:parameterType :Rate ; sc:value :speed ] .
"""
TRACKERS = """
:a a sc:Component, :Tracker ; :of :Astrid ; sc:hasOutput [ sc:name "where" ; sc:signalType :Pose ] ;
    sc:hasParameter [ sc:name "rate" ; sc:parameterType :Rate ] .
:p a sc:Component, :Tracker ; :of :Pippi ; sc:hasOutput [ sc:name "where" ; sc:signalType :Pose ] ;
    sc:hasParameter [ sc:name "rate" ; sc:parameterType :Rate ] .
"""
WHOLE = iri("whole")


def known(text: str) -> dict[IRI, Advertisement]:
    """The advertisements of a document."""
    found, wrong = read_advertisements((PREFIXES + text).encode(), "site.ttl")
    assert wrong == []
    return {one.component: one for one in found}


def judged(text: str) -> tuple[dict[IRI, Inside], dict[IRI, str]]:
    """The composites of a document that can be configured, and why the others cannot."""
    return configurable(known(text), lambda one: document(text))


def document(text: str) -> Document:
    """A document of Turtle."""
    return parse(PREFIXES + text, "site.ttl")


def holding(**values: Term) -> Configuration:
    """A configuration that holds the composite, with values for its parameters."""
    settings = tuple(ParameterSetting(WHOLE, name, value) for name, value in values.items())
    return Configuration(iri("task"), (Assignment(iri("role"), (WHOLE,)),), (), settings)


def test_the_inside_is_configured_with_the_values_that_the_composite_is_set_to() -> None:
    text = COMPOSITE + TEMPLATE + TRACKERS
    assert [*judged(text)[0]] == [WHOLE]
    for robot, player in (("Astrid", "a"), ("Pippi", "p")):
        holder = holding(robot=iri(robot), speed=Literal("3", IRI("http://www.w3.org/2001/XMLSchema#integer")))
        ((component, inside),) = insides(known(text), lambda one: document(text), holder)
        assert component == WHOLE
        assert isinstance(inside, Configuration)
        assert inside.components == (iri(player),)
        assert [one.value.lexical for one in inside.settings if isinstance(one.value, Literal)] == ["3"]


def test_a_parameter_that_is_set_and_that_no_component_inside_states_gets_its_value_with_the_composite() -> None:
    """A tracker of any robot: if it is of one, it is the one that it is set to."""
    template = TEMPLATE.replace(" ; sh:minCount 1", "").replace("sc:value :speed", "sc:value :robot")
    text = COMPOSITE + template + TRACKERS.replace(":of :Astrid ; ", "").split(":p a")[0]
    found, why = judged(text)
    assert ([*found], why) == ([WHOLE], {})
    ((_, inside),) = insides(known(text), lambda one: document(text), holding(robot=iri("Emil")))
    assert isinstance(inside, Configuration)
    assert [(one.component, one.value) for one in inside.settings] == [(iri("a"), iri("Emil"))]


SCALED = """
:whole a sc:Component, :Whole ; sc:grounding [ sc:template :scaled ] ;
    sc:hasInput [ sc:name "hint" ; sc:signalType :Length{hint} ] ;
    sc:hasOutput [ sc:name "size" ; sc:signalType :Length{size} ] .
:scaled a sc:Template ; sc:roles ( :scale ) ;
    sc:hasInput [ sc:name "hint" ; sc:signalType :Length ; sc:of :scale ] ;
    sc:hasOutput [ sc:name "size" ; sc:signalType :Length ; sc:of :scale ] .
:scale a sc:Role ; sh:class :Scale .
:s a sc:Component, :Scale ; sc:hasInput [ sc:name "near" ; sc:signalType :Length ; sc:unit unit:M ; sc:frame :map ] ;
    sc:hasOutput [ sc:name "far" ; sc:signalType :Length ; sc:unit unit:CentiM ; sc:frame "base" ] .
"""


@pytest.mark.parametrize(
    ("hint", "size", "refused"),
    [
        ("", "", ""),
        (" ; sc:unit unit:M ; sc:frame :map", ' ; sc:unit unit:CentiM ; sc:frame "base"', ""),
        (" ; sc:unit unit:CentiM", "", "near"),
        (" ; sc:frame :odom", "", "near"),
        ("", " ; sc:unit unit:M", "size"),
        ("", ' ; sc:frame "map"', "size"),
    ],
)
def test_what_is_inside_has_the_unit_and_frame_that_the_composite_states(hint: str, size: str, refused: str) -> None:
    """Also where its template states none: what stands behind an output is what those outside follow."""
    found, why = judged(SCALED.format(hint=hint, size=size))
    assert [*found] == ([] if refused else [WHOLE])
    assert refused in why.get(WHOLE, "")


@pytest.mark.parametrize(
    ("composite", "template", "refused"),
    [
        ("sc:unit unit:M", "sc:unit unit:M", ""),
        ("sc:unit unit:CentiM", "sc:unit unit:M", "its input 'hint' is"),
        ("sc:unit unit:M", "sc:frame :odom", "near"),
        ("sc:frame :map", "sc:unit unit:CentiM", "near"),
    ],
)
def test_a_port_of_a_composite_has_what_its_template_states_as_well(
    composite: str, template: str, refused: str
) -> None:
    of_template = ':Length ; sc:of :scale ] ;\n    sc:hasOutput [ sc:name "size"'
    text = SCALED.format(hint=f" ; {composite}", size="")
    assert of_template in text
    found, why = judged(text.replace(of_template, of_template.replace(":Length", f":Length ; {template}")))
    assert [*found] == ([] if refused else [WHOLE])
    assert refused in why.get(WHOLE, "")


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"robot": iri("Astrid")}, "the parameter 'speed' of its template localise needs a value"),
        ({"robot": Literal("Astrid"), "speed": Literal("3")}, "cannot stand for the parameter 'robot'"),
    ],
)
def test_values_with_which_there_is_no_inside_are_one_sentence(values: dict[str, Term], sentence: str) -> None:
    text = COMPOSITE + TEMPLATE + TRACKERS
    ((_, why),) = insides(known(text), lambda one: document(text), holding(**values))
    assert isinstance(why, str)
    assert sentence in why


def test_of_a_composite_without_an_inside_it_is_said_why() -> None:
    text = COMPOSITE + TEMPLATE
    ((component, why),) = insides(known(text), lambda one: document(text), holding(robot=iri("Astrid")))
    assert component == WHOLE
    assert isinstance(why, str)
    assert why.startswith("its inside cannot be configured now: no component is eligible for the role tracker")
    assert "inside of itself" not in why


@pytest.mark.parametrize(
    ("before", "after", "sentence"),
    [
        (
            'sc:name "robot" ; sc:parameterType',
            'sc:name "robots" ; sc:parameterType',
            "its parameter 'robots' is none of",
        ),
        (
            "sc:template :localise ]",
            "sc:template :localise ; sc:binding [ sc:parameter :robot ; sc:value :Astrid ] ]",
            "its grounding binds 'robot', and it has it as an operational parameter as well",
        ),
        (
            ', [ sc:name "speed" ; sc:parameterType :Speed ]',
            "",
            "the parameter 'speed' of the template localise has no value; bind it in the grounding",
        ),
        (
            'sc:name "pose" ; sc:signalType :Pose ] ;\n    sc:hasParameter',
            'sc:name "pose" ; sc:signalType :Place ] ;\n    sc:hasParameter',
            "its output 'pose' is Place, and that of the template localise is Pose",
        ),
        ("sh:minCount 1 ]", "sh:minInclusive :robot ]", "the parameter 'robot' cannot be left free"),
    ],
)
def test_what_a_composite_and_its_template_say_of_each_other_differs(before: str, after: str, sentence: str) -> None:
    text = COMPOSITE + TEMPLATE + TRACKERS
    assert before in text
    found, why = judged(text.replace(before, after, 1))
    assert found == {}
    assert sentence in why[WHOLE]


HINTED = """
:whole a sc:Component, :Whole ; sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ] ;
    sc:hasInput [ sc:name "hint" ; sc:signalType :Hint ; sc:optional true ] ; sc:grounding [ sc:template :localise ] .
:localise a sc:Template ; sc:roles ( :tracker ) ;
    sc:hasInput [ sc:name "hint" ; sc:signalType :Hint ; sc:of :tracker ] ;
    sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ; sc:of :tracker ] .
:tracker a sc:Role ; sh:class :Tracker .
:a a sc:Component, :Tracker ; sc:hasInput [ sc:name "h" ; sc:signalType :Hint ] ;
    sc:hasOutput [ sc:name "where" ; sc:signalType :Pose ] .
"""
WITHOUT = ':b a sc:Component, :Tracker ; sc:hasOutput [ sc:name "where" ; sc:signalType :Pose ] .'


@pytest.mark.parametrize(("fed", "others", "player"), [(True, WITHOUT, "a"), (False, WITHOUT, "b"), (False, "", None)])
def test_an_optional_input_that_nobody_feeds_is_fed_to_nobody_inside(
    fed: bool, others: str, player: str | None
) -> None:
    text = HINTED + others
    hint = Connection(iri("hinter"), "hint", WHOLE, "hint")
    holder = replace(holding(), connections=(hint,) if fed else ())
    ((_, inside),) = insides(known(text), lambda one: document(text), holder)
    if player is None:
        assert isinstance(inside, str)
        assert inside.startswith("its inside cannot be configured now: the input 'h' (Hint) of a cannot be fed")
        assert inside.endswith("; no component feeds its optional input 'hint'")
    else:
        assert isinstance(inside, Configuration)
        assert inside.components == (iri(player),)


TWO_WHOLES = """
:whole a sc:Component, :Whole ; sc:grounding [ sc:template :localise ] ;
    sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ] .
:wholly a sc:Component, :Whole ; sc:grounding [ sc:template :localise ] ;
    sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ] .
:localise a sc:Template ; sc:roles ( :tracker ) ;
    sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ; sc:of :tracker ] .
:tracker a sc:Role ; sh:class :Tracker .
"""
ALONE = ':{} a sc:Component, :Tracker ; sc:shareable false ; sc:hasOutput [ sc:name "where" ; sc:signalType :Pose ] .'


def insides_beside(players: list[str], others: str) -> dict[str, str]:
    """The component inside of each composite, or why there is none, where others play a role with the composites."""
    text = TWO_WHOLES + others
    holder = Configuration(iri("task"), (Assignment(iri("role"), tuple(map(iri, players))),), ())
    found = insides(known(text), lambda one: document(text), holder)
    return {one.short: it if isinstance(it, str) else it.components[0].short for one, it in found}


def test_what_a_configuration_holds_is_inside_of_none_of_its_composites() -> None:
    assert insides_beside(["whole", "a"], ALONE.format("a") + ALONE.format("b")) == {"whole": "b"}
    assert insides_beside(["whole", "a"], ALONE.format("a").replace("false", "true")) == {"whole": "a"}
    ((_, why),) = insides_beside(["whole", "a"], ALONE.format("a")).items()
    assert why.endswith("no component that is free is eligible for the role tracker; a acts for task")


def test_what_is_inside_of_one_composite_is_inside_of_no_other_beside_it() -> None:
    assert insides_beside(["whole", "wholly"], ALONE.format("a") + ALONE.format("b")) == {"whole": "a", "wholly": "b"}
    one = insides_beside(["whole", "wholly"], ALONE.format("a"))
    assert one["whole"] == "a"
    assert one["wholly"].endswith("; a acts for whole")


LACKING = Refusal(iri("localise"), (TooFewEligible(iri("tracker"), 1, 0),))


def test_why_there_is_no_configuration_is_said_in_words() -> None:
    assert why_none(None) == "it was taken down"
    assert why_none(Undecided(steps=7)) == str(Undecided(steps=7))
    assert why_none(LACKING) == "no component is eligible for the role tracker"


def test_of_what_is_lacking_it_is_said_which_task_holds_it_and_since_when() -> None:
    holder = Holder("patrol~1", 2, 0.0, "c1")
    said = why_none(replace(LACKING, held=((iri("camera"), holder), (iri("t1"), holder))))
    assert said == (
        f"no component is eligible for the role tracker; camera: {holder_text(holder)}; t1: {holder_text(holder)}"
    )
    assert "the task patrol (priority 2, configurator c1) holds it since " in said
    many = why_none(replace(LACKING, held=((iri("camera"), holder),) * (MANY + 2)))
    assert many.endswith("; and 2 more are held")
    assert many.count("camera") == MANY


NESTED = """
:outer a sc:Component, :Outer ; sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ] ;
    sc:grounding [ sc:template :o ] .
:o a sc:Template ; sc:roles ( :inmost ) ; sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ; sc:of :inmost ] .
:inmost a sc:Role ; sh:class :Inner .
:inner a sc:Component, :Inner ; sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ] ;
    sc:grounding [ sc:template :i ] .
:i a sc:Template ; sc:roles ( :tracker ) ; sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ; sc:of :tracker ] .
:tracker a sc:Role ; sh:class :Tracker ; sc:recruits true .
:a a sc:Component, :Tracker ; sc:hasInput [ sc:name "i" ; sc:signalType :Image ] ;
    sc:hasOutput [ sc:name "where" ; sc:signalType :Pose ] .
:eye a sc:Component, :Camera ; sc:hasOutput [ sc:name "image" ; sc:signalType :Image ] .
"""


def test_what_no_recruit_is_wanted_for_is_in_no_circle() -> None:
    found, why = judged(NESTED)
    assert (sorted(found), why) == ([iri("inner"), iri("outer")], {})
    # Where the inner one could recruit the outer one, it is a circle.
    found, why = judged(NESTED.replace('"i" ; sc:signalType :Image', '"i" ; sc:signalType :Pose'))
    assert found == {}
    assert "it could be inside of itself (inner of outer of inner)" in why[iri("inner")]

"""Templates and tasks: roles, interactions, parameters, costs, and a sentence for what is none."""

from __future__ import annotations

import re
from fractions import Fraction
from pathlib import Path

import pytest

from selfconf.errors import TemplateError
from selfconf.model.cost import CostLevel, CostTerm
from selfconf.model.profile import Condition, Input, Output, needed_operation, offered_operation
from selfconf.model.template import Interaction, Setting, Task, TemplatePort
from selfconf.model.term import IRI, Literal
from selfconf.rdf.tasks import templates
from selfconf.rdf.tasks.templates import cost_of
from selfconf.rdf.turtle import document as turtle
from selfconf.rdf.vocabulary import ROB, SC, XSD
from tests.lab import NAVIGATE, PREFIXES, iri

FIRST, REST = (f"<http://www.w3.org/1999/02/22-rdf-syntax-ns#{name}>" for name in ("first", "rest"))
ROLE = ":r a sc:Role ; sh:class :L ."
BINDING = "sc:binding [ sc:parameter :p ; sc:value 1 ]"
INTERACTION = "[] a sc:Interaction ; sc:from :r ; sc:to :s"
EYE_AND_MIND = frozenset((iri("eye"), iri("mind")))


def read(text: str, wanted: IRI | None = None) -> Task:
    """The task of a text."""
    return templates.read_task(turtle.parse(PREFIXES + text, "t.ttl"), wanted).task


def test_figure_7_of_the_paper_is_read_as_five_roles_and_four_interactions() -> None:
    template = read(NAVIGATE.removeprefix(PREFIXES)).template
    assert [role.iri.short for role in template.roles] == ["sonar", "encoder", "position", "control", "drive"]
    assert {(i.source.short, i.sink.short) for i in template.interactions} == {
        ("sonar", "control"),
        ("encoder", "control"),
        ("position", "control"),
        ("control", "drive"),
    }
    assert template.role(iri("control")).settings == (Setting(ROB.BehaviouralGoal, iri("goal")),)
    assert {(p.name, p.in_shape, p.is_set) for p in template.parameters} == {
        ("robot", True, False),
        ("goal", False, True),
    }


def test_the_long_form_of_an_interaction_names_ports() -> None:
    template = read(
        f":t a sc:Template ; sc:roles ( :r :s ) . {ROLE} :s a sc:Role . :r sc:feeds :s ."
        ' [] a sc:Interaction ; sc:from :r ; sc:to :s ; sc:output "image" ; sc:input "left" .'
    ).template
    assert set(template.interactions) == {
        Interaction(iri("r"), iri("s")),
        Interaction(iri("r"), iri("s"), "image", "left"),
    }


def test_interactions_of_another_template_in_the_same_file_are_not_ours() -> None:
    text = (
        f":t a sc:Template ; sc:roles ( :r ) . {ROLE}"
        " :u a sc:Template ; sc:roles ( :x :y ) . :x a sc:Role . :y a sc:Role ."
        " [] a sc:Interaction ; sc:from :x ; sc:to :y ."
    )
    assert read(text, iri("t")).template.interactions == ()
    assert len(read(text, iri("u")).template.interactions) == 1


def test_a_task_is_a_template_with_values() -> None:
    task = read(
        f':t a sc:Template ; sc:roles ( :r ) ; sc:parameter :p . {ROLE} :p a sc:Parameter ; sc:name "p" .'
        ' :k a sc:Task ; sc:template :t ; sc:binding [ sc:parameter :p ; sc:value "x" ] .'
    )
    assert (task.iri, task.bindings, task.by_name()) == (iri("k"), {iri("p"): Literal("x")}, {"p": Literal("x")})


@pytest.mark.parametrize(
    ("template", "task", "priority"),
    [("", "", 0), ("3", "", 3), ("", "-2", -2), ("3", "+5", 5), ("3", "0", 0)],
)
def test_a_task_has_its_own_priority_or_that_of_its_template(template: str, task: str, priority: int) -> None:
    given, own = (f" ; sc:priority {value}" if value else "" for value in (template, task))
    text = f":t a sc:Template ; sc:roles ( :r ){given} . {ROLE} :k a sc:Task ; sc:template :t{own} ."
    assert read(text).priority == priority


def test_of_several_templates_one_must_be_named() -> None:
    text = f":t a sc:Template ; sc:roles ( :r ) . :u a sc:Template ; sc:roles ( :r ) . {ROLE}"
    with pytest.raises(TemplateError, match="several"):
        read(text)
    assert read(text, iri("u")).template.iri == iri("u")
    with pytest.raises(TemplateError, match="there is no template"):
        read(text, iri("v"))


def test_for_a_template_that_is_not_there_those_that_are_there_are_named() -> None:
    text = f":t a sc:Template ; sc:roles ( :r ) . :u a sc:Template ; sc:roles ( :r ) . {ROLE}"
    with pytest.raises(TemplateError, match=r"it has <[^>]*t>, <[^>]*u>$"):
        read(text, iri("v"))


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (":k a sc:Task .", "exactly one template"),
        (f":t a sc:Template ; sc:roles ( :r ) . {ROLE} :k a sc:Task ; sc:template :u .", "not in this file"),
        (
            f":t a sc:Template ; sc:roles ( :r ) . {ROLE} :k a sc:Task ; sc:template :t ; {BINDING} .",
            "no parameter of its template",
        ),
        (":t a sc:Template ; sc:roles ( :r ) , ( :s ) .", "exactly one list"),
        (':t a sc:Template ; sc:roles ( "r" ) .', "needs an IRI"),
        (':t a sc:Template ; sc:roles "r" .', '"r" is no list of roles; write it in parentheses'),
        (f":t a sc:Template ; sc:roles :r . {ROLE}", "is no list of roles"),
        (f":t a sc:Template ; sc:roles () . {ROLE}", "at least one role"),
        (f":t a sc:Template ; sc:roles [ {FIRST} :r ] . {ROLE}", "exactly one rdf:first and one rdf:rest"),
        (f":t a sc:Template ; sc:roles [ {FIRST} :r, :s ; {REST} () ] . {ROLE}", "exactly one rdf:first"),
        (f":t a sc:Template ; sc:roles _:l . _:l {FIRST} :r ; {REST} _:l . {ROLE}", "has no end"),
        (f':t a sc:Template ; sc:roles ( :r ) . {ROLE} :r sc:feeds "x" .', "no role"),
        (f":t a sc:Template ; sc:roles ( :r ) . {ROLE} :r sc:minCount -1 .", "whole number"),
        (f":t a sc:Template ; sc:roles ( :r ) . {ROLE} :r sc:minCount 1, 2 .", "whole number"),
        (f":t a sc:Template ; sc:roles ( :r ) ; sc:priority 0.5 . {ROLE}", "one whole number from -1000000"),
        (f":t a sc:Template ; sc:roles ( :r ) ; sc:priority 1, 2 . {ROLE}", "one whole number from -1000000"),
        (f":t a sc:Template ; sc:roles ( :r ) . {ROLE} :r sc:priority 1 .", "as a sc:Template or a sc:Task"),
        (f':t a sc:Template ; sc:roles ( :r ) ; sc:parameter :p, :q . {ROLE} :p sc:name "x" . :q sc:name "x" .', "two"),
        (f':t a sc:Template ; sc:roles ( :r ) ; sc:parameter :p . {ROLE} :p sc:name "" .', "sc:name of the parameter"),
        (
            f":t a sc:Template ; sc:roles ( :r :s ) . {ROLE} :s a sc:Role . {INTERACTION} ; sc:output :port .",
            "name of one port",
        ),
    ],
)
def test_what_cannot_be_read_is_one_sentence_that_names_the_file(text: str, sentence: str) -> None:
    with pytest.raises(TemplateError, match=sentence) as caught:
        read(text)
    assert str(caught.value).startswith("t.ttl: ")
    assert "\n" not in str(caught.value)


def wrong_about_templates() -> list[Path]:
    """The bad files whose first line promises an error about a template or a task, or a list without an end.

    Not those about what a composite binds, which stands in its advertisement, nor those about values that a parameter
    does not allow by more than its datatype and kind: `complete` judges these.
    """
    files = sorted((Path(__file__).parents[2] / "bad").glob("*.ttl"))
    wrong = [file for file in files if re.search(r"error\[SC-([TK]|S06)", file.read_text("utf-8").partition("\n")[0])]
    return [file for file in wrong if not file.stem.startswith(("composite-", "unfit-"))]


@pytest.mark.parametrize("path", wrong_about_templates(), ids=lambda path: path.stem)
def test_whatever_validation_refuses_in_a_template_or_task_its_reader_refuses(path: Path) -> None:
    document = turtle.parse(path.read_bytes(), path.name)
    with pytest.raises(TemplateError):
        templates.read_task(document)


def test_a_parameter_may_stand_wherever_its_value_will_stand() -> None:
    task = read(
        f":t a sc:Template ; sc:roles ( :r ) ; sc:parameter :n . {ROLE} :n a sc:Parameter ; sc:name 'n' ."
        " :r sh:property [ sh:path rob:place ; sh:minCount :n ; sh:in ( :n ) ; sh:pattern :n ; sh:minInclusive :n ] ."
    )
    assert [parameter.in_shape for parameter in task.template.parameters] == [True]


@pytest.mark.parametrize("path", sorted((Path(__file__).parents[3] / "examples").rglob("*.ttl")), ids=str)
def test_every_example_that_holds_a_template_is_read(path: Path) -> None:
    document = turtle.parse(path.read_bytes(), path.name)
    if document.instances(SC.Template):
        assert templates.read_task(document).template.roles


# Costs.


def cost(text: str) -> tuple[CostLevel, ...]:
    """The levels of the cost of the template `:t` in a text."""
    return cost_of(turtle.parse(PREFIXES + text, "t.ttl"), iri("t"), EYE_AND_MIND)


def test_a_template_that_states_no_cost_has_no_levels() -> None:
    assert cost(":t a sc:Template .") == ()


def test_a_term_counts_once_and_for_all_roles_unless_it_says_otherwise() -> None:
    assert cost(":t sc:cost ( [ sc:term [ sc:property :delay ] ] ) .") == ((CostTerm(iri("delay")),),)


def test_a_term_may_state_a_weight_what_counts_otherwise_and_a_role() -> None:
    term = "[ sc:property :delay ; sc:weight -0.5 ; sc:otherwise 10 ; sc:ofRole :eye ]"
    expected = CostTerm(iri("delay"), Fraction(-1, 2), Fraction(10), iri("eye"))
    assert cost(f":t sc:cost ( [ sc:term {term} ] ) .") == ((expected,),)


def test_levels_keep_the_order_of_the_list() -> None:
    levels = cost(":t sc:cost ( [ sc:term [ sc:property :z ] ] [ sc:term [ sc:property :a ] , [ sc:property :b ] ] ) .")
    assert [{term.property.short for term in level} for level in levels] == [{"z"}, {"a", "b"}]


def test_a_weight_is_exact() -> None:
    ((term,),) = cost(":t sc:cost ( [ sc:term [ sc:property :delay ; sc:weight 0.1 ] ] ) .")
    assert term.weight == Fraction(1, 10)


@pytest.mark.parametrize(
    ("stated", "sentence"),
    [
        ("()", "the cost of a template is one list of levels"),
        ("[ sc:term [ sc:property :a ] ]", "the cost of a template is one list of levels"),
        ("( [ sc:term [ sc:property :a ] ] ) , ( [ sc:term [ sc:property :b ] ] )", "is one list of levels"),
        ("( [ ] )", "each level of sc:cost has at least one sc:term"),
        ("( [ sc:term [ ] ] )", "needs exactly one sc:property, an IRI"),
        ('( [ sc:term [ sc:property "delay" ] ] )', "needs exactly one sc:property, an IRI"),
        ("( [ sc:term [ sc:property :a ; sc:weight 1 , 2 ] ] )", "sc:weight of a term of sc:cost is one finite number"),
        ('( [ sc:term [ sc:property :a ; sc:otherwise "INF"^^xsd:double ] ] )', "sc:otherwise .* one finite number"),
        ("( [ sc:term [ sc:property :a ; sc:ofRole :eye , :mind ] ] )", "write a term for each role"),
        ("( [ sc:term [ sc:property :a ; sc:ofRole :ear ] ] )", "which is no role of the template"),
    ],
)
def test_what_is_no_cost_is_one_sentence(stated: str, sentence: str) -> None:
    with pytest.raises(TemplateError, match=sentence):
        cost(f":t sc:cost {stated} .")


@pytest.mark.parametrize("default", ["", "; sh:defaultValue 1"])
@pytest.mark.parametrize(
    ("stated", "place"),
    [
        (":r sc:minCount :p", "minCount"),
        (":r sc:maxCount :p", "maxCount"),
        (":r sc:recruits :p", "recruits"),
        (":t sc:priority :p", "priority"),
        (":t sc:cost ( [ sc:term [ sc:property :v ; sc:weight :p ] ] )", "weight"),
        (":t sc:cost ( [ sc:term [ sc:property :v ; sc:otherwise :p ] ] )", "otherwise"),
        ("[] a sc:Interaction ; sc:from :r ; sc:to :r ; sc:output :p", "output"),
        ("[] a sc:Interaction ; sc:from :r ; sc:to :r ; sc:input :p", "input"),
        (':t sc:hasOutput [ sc:name "o" ; sc:of :r ; sc:signalType :p ]', "signalType"),
        (':t sc:hasOperation [ sc:name "o" ; sc:of :r ; sc:request :p ]', "request"),
    ],
)
def test_a_parameter_that_stands_for_what_is_the_same_for_all_tasks_is_named(
    stated: str, place: str, default: str
) -> None:
    text = f":t a sc:Template ; sc:parameter :p ; sc:roles ( :r ) . :p a sc:Parameter ; sc:name 'p' {default} ."
    with pytest.raises(TemplateError, match=rf"the parameter <.*#p> cannot stand for sc:{place}, which is the same "):
        read(f"{text} {ROLE} {stated} .")


def test_a_value_of_a_task_that_cannot_stand_for_its_parameter_is_told_where_it_stands() -> None:
    text = (
        f":t a sc:Template ; sc:roles ( :r ) ; sc:parameter :p . {ROLE} "
        ":p a sc:Parameter ; sc:name 'p' ; sh:datatype xsd:decimal . "
        ":k a sc:Task ; sc:template :t ; sc:binding [ sc:parameter :p ; sc:value {} ] ."
    )
    with pytest.raises(
        TemplateError, match=r": 5 cannot stand for the parameter 'p': it is 5, an integer, not a decimal"
    ) as raised:
        read(text.replace("{}", "5"))
    assert raised.value.subject == iri("k")
    assert read(text.replace("{}", "5.0")).bindings == {iri("p"): Literal("5.0", XSD.decimal)}


EYE_ROLE = ":eye a sc:Role ; sh:class :Camera ."
OF_EYE = ":look a sc:Template ; sc:roles ( :eye )"


def ports(said: str) -> tuple[TemplatePort, ...]:
    """The ports of a template that says something."""
    return read(f"{OF_EYE} ; {said} . {EYE_ROLE}").template.ports


def test_ports_are_read_inputs_first() -> None:
    found = ports(
        'sc:hasOutput [ sc:name "image" ; sc:signalType :Image , :Detail ; sc:of :eye ] ;'
        'sc:hasInput [ sc:name "zoom" ; sc:signalType :Zoom ; sc:of :eye ]'
    )
    assert found == (
        TemplatePort(iri("eye"), Input("zoom", (iri("Zoom"),))),
        TemplatePort(iri("eye"), Output("image", (iri("Detail"), iri("Image")))),
    )


def test_operations_and_what_is_said_of_units_are_read_as_a_component_has_them() -> None:
    found = ports(
        'sc:hasOperation [ sc:name "look" ; sc:request :Where ; sc:response :Text ; sc:of :eye ] ;'
        'sc:needsOperation [ sc:name "light" ; sc:of :eye ] ;'
        'sc:hasInput [ sc:name "zoom" ; sc:signalType :Zoom ; sc:unit :Dioptre ; sc:of :eye ]'
    )
    assert [one.port for one in found] == [
        needed_operation("light", None, None),
        Input("zoom", (iri("Zoom"),), condition=Condition(iri("Dioptre"))),
        offered_operation("look", iri("Where"), iri("Text")),
    ]


@pytest.mark.parametrize(
    ("said", "sentence"),
    [
        ("sc:hasOutput [ sc:signalType :Image ; sc:of :eye ]", "has exactly one sc:name"),
        ('sc:hasOutput [ sc:name "" ; sc:signalType :Image ; sc:of :eye ]', "has exactly one sc:name"),
        ('sc:hasOutput [ sc:name "a()" ; sc:signalType :Image ; sc:of :eye ]', "has exactly one sc:name"),
        ('sc:hasOutput [ sc:name "a\\tb" ; sc:signalType :Image ; sc:of :eye ]', "has exactly one sc:name"),
        ('sc:hasOutput [ sc:name "bild"@de ; sc:signalType :Image ; sc:of :eye ]', "has exactly one sc:name, a string"),
        ('sc:hasOutput [ sc:name "a" ; sc:signalType :Image ]', "is that of exactly one role, sc:of"),
        ('sc:hasOutput [ sc:name "a" ; sc:signalType :Image ; sc:of :ear ]', "which is no role of the template"),
        ('sc:hasOutput [ sc:name "a" ; sc:of :eye ]', "has signal types, which are IRIs"),
        ('sc:hasOperation [ sc:name "a" ; sc:request "a" ; sc:of :eye ]', "at most one sc:request, an IRI"),
        ('sc:needsOperation [ sc:name "a" ; sc:response :A , :B ; sc:of :eye ]', "at most one sc:response, an IRI"),
        ('sc:hasInput [ sc:name "a" ; sc:signalType :A ; sc:unit "m" ; sc:of :eye ]', "at most one sc:unit, an IRI"),
        ('sc:hasOutput [ sc:name "a" ; sc:signalType "a" ; sc:of :eye ]', "has signal types, which are IRIs"),
        ('sc:hasInput [ sc:name "a" ; sc:signalType :A ; sc:frame "" ; sc:of :eye ]', "at most one sc:frame, an IRI"),
        (
            'sc:hasOutput [ sc:name "a" ; sc:signalType :A ; sc:frame :map , :odom ; sc:of :eye ]',
            "at most one sc:frame, an IRI or a string",
        ),
        (
            'sc:hasInput [ sc:name "a" ; sc:signalType :A ; sc:of :eye ] , [ sc:name "a" ; sc:of :eye ]',
            "is called 'a', and another one as well",
        ),
    ],
)  # fmt: skip
def test_what_is_no_port_of_the_template_is_one_sentence(said: str, sentence: str) -> None:
    with pytest.raises(TemplateError, match=sentence):
        ports(said)

"""Templates and tasks: roles, interactions, parameters, and a sentence for what is none."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from selfconf.errors import TemplateError
from selfconf.model.template import Interaction, Setting, Task
from selfconf.model.term import IRI, Literal
from selfconf.rdf.tasks import templates
from selfconf.rdf.turtle import document as turtle
from selfconf.rdf.vocabulary import ROB, SC
from tests.lab import NAVIGATE, PREFIXES, iri

ROLE = ":r a sc:Role ; sh:class :L ."
BINDING = "sc:binding [ sc:parameter :p ; sc:value 1 ]"
INTERACTION = "[] a sc:Interaction ; sc:from :r ; sc:to :s"


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


@pytest.mark.parametrize(
    ("counts", "minimum", "maximum"),
    [
        ("", 1, 1),
        ("sc:minCount 2 ;", 2, None),
        ("sc:maxCount 3 ;", 1, 3),
        ("sc:minCount 0 ; sc:maxCount 1 ;", 0, 1),
        ("sc:minCount 2 ; sc:maxCount 2 ;", 2, 2),
    ],
)
def test_a_role_asks_for_exactly_one_unless_it_says_otherwise(counts: str, minimum: int, maximum: int | None) -> None:
    (role,) = read(f":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; {counts} sh:class :L .").template.roles
    assert (role.minimum, role.maximum) == (minimum, maximum)


@pytest.mark.parametrize(("text", "value"), [("true", True), ("1", True), ("false", False), ("0", False)])
def test_a_role_says_that_it_recruits_by_a_truth_value_however_it_is_written(text: str, value: bool) -> None:
    said = f'sc:recruits "{text}"^^xsd:boolean'
    (role,) = read(f":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; {said} ; sh:class :L .").template.roles
    assert role.recruits is value


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


def test_the_same_setting_twice_is_one() -> None:
    settings = ":r sc:sets [ sc:parameterType :P ; sc:value 1 ] , [ sc:parameterType :P ; sc:value 1 ] ."
    (role,) = read(f":t a sc:Template ; sc:roles ( :r ) . {ROLE} {settings}").template.roles
    assert [setting.type for setting in role.settings] == [iri("P")]
    with pytest.raises(TemplateError, match="2 different values"):
        read(f":t a sc:Template ; sc:roles ( :r ) . {ROLE} {settings.replace('1', '1.0', 1)}")


def test_of_several_templates_one_must_be_named() -> None:
    text = f":t a sc:Template ; sc:roles ( :r ) . :u a sc:Template ; sc:roles ( :r ) . {ROLE}"
    with pytest.raises(TemplateError, match="several"):
        read(text)
    assert read(text, iri("u")).template.iri == iri("u")
    with pytest.raises(TemplateError, match="there is no template"):
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


@pytest.mark.parametrize(
    "shape",
    [
        "sh:class 5",
        "sh:minCount 1",
        "sh:property 5",
        "sh:property [ sh:minCount 1 ]",
        "sh:or :x",
        "sh:node 5",
        "sh:property [ sh:path rob:place ; sh:minInclusive :x ]",
        "sh:closed 'yes'",
        "sh:sparql [ sh:select 'SELECT' ]",
    ],
)
def test_a_role_that_is_no_shape_is_not_read(shape: str) -> None:
    with pytest.raises(TemplateError, match="role"):
        read(f":t a sc:Template ; sc:roles ( :r ) . {ROLE} :r {shape} .")


def test_a_parameter_may_stand_wherever_its_value_will_stand() -> None:
    task = read(
        f":t a sc:Template ; sc:roles ( :r ) ; sc:parameter :n . {ROLE} :n a sc:Parameter ; sc:name 'n' ."
        " :r sh:property [ sh:path rob:place ; sh:minCount :n ; sh:in :n ; sh:pattern :n ; sh:minInclusive :n ] ."
    )
    assert [parameter.in_shape for parameter in task.template.parameters] == [True]


@pytest.mark.parametrize("path", sorted((Path(__file__).parents[3] / "examples").rglob("*.ttl")), ids=str)
def test_every_example_that_holds_a_template_is_read(path: Path) -> None:
    document = turtle.parse(path.read_bytes(), path.name)
    if document.instances(SC.Template):
        assert templates.read_task(document).task.template.roles

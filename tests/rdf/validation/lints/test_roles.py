"""Lints about roles, and what their shapes ask for."""

from __future__ import annotations

import pytest

from tests.rdf.validation.lints.linted_text import TEMPLATE, lints, only

VALIDATOR = "sh:nodeValidator [ sh:select 'SELECT $this WHERE { $this ?p $least }' ]"


def test_a_role_that_has_the_type_of_its_component_is_told_what_to_write() -> None:
    assert only(TEMPLATE.replace("sc:Role ; sh:class rob:Lamp", "sc:Role, rob:Lamp")).hint == "Write sh:class rob:Lamp."


def test_a_role_that_has_a_class_of_the_authors_own_ontology_as_its_type_is_told_what_to_write() -> None:
    own = ":Lift a owl:Class ; rdfs:label 'lift' .\n"
    some = TEMPLATE.replace(
        "sc:Role ; sh:class rob:Lamp", "sc:Role, :Lift ; sh:property [ sh:path rob:place ; sh:minCount 1 ]"
    )
    assert only(own + some).hint == "Write sh:class :Lift."
    assert not lints(own + TEMPLATE.replace("sc:Role ;", "sc:Role, :Lift ;"))
    assert not lints(own.replace(" ;", " ; rdfs:subClassOf sc:Role ;", 1) + some)


def test_a_component_of_the_name_of_a_role_is_told_to_have_another_and_not_what_a_role_writes() -> None:
    lamp = ':r a sc:Component, rob:Lamp ; rob:place :hall ; sc:hasInput [ sc:name "on" ; sc:signalType rob:Switch ] .'
    found = only(TEMPLATE + lamp)
    assert (found.code, found.message) == ("SC-L14", ":r is a component and a role as well.")
    assert found.hint == "Give one of the two another IRI."


def test_a_role_may_say_that_it_is_a_shape() -> None:
    assert not lints(TEMPLATE + ":r a sh:NodeShape, :Pivotal .")


@pytest.mark.parametrize(
    ("shape", "hint"),
    [
        ("sh:property [ sh:path rob:place ; sh:value :hall ]", "Did you mean sh:hasValue?"),
        ("sh:property [ sh:path rob:place ; sc:value :hall ]", "Did you mean sh:hasValue?"),
        (
            "sh:property [ sh:path sc:hasOutput ; sc:name 'image' ]",
            "Write [ sh:path ( sc:hasOutput sc:name ) ; sh:hasValue ... ].",
        ),
        ("sh:node [ sh:property [ sh:path :p ; sh:minCount 1 ; sh:resultMessage 'so' ] ]", "Did you mean sh:message?"),
        ("sh:or ( [ sh:class :A ] [ sh:value :a ] )", "Did you mean sh:hasValue?"),
        ("sh:select 'SELECT $this WHERE { $this ?p 1 }'", "Write sh:sparql [ sh:select ... ]."),
        ("sc:recruits [ sh:class :A ; sh:focusNode :a ]", None),
    ],
)
def test_a_word_of_shacl_that_says_nothing_in_a_shape_is_noticed(shape: str, hint: str | None) -> None:
    found = only(TEMPLATE + f":r {shape} .")
    assert (found.code, found.hint) == ("SC-L25", hint)


@pytest.mark.parametrize(
    ("said", "property_"),
    [
        (":r rob:place :hall .", "rob:place"),
        (":r :floor 2 ; sh:property [ sh:path :floor ; sh:minCount 1 ] .", ":floor"),
    ],
)
def test_a_property_of_components_that_is_said_of_a_role_is_noticed(said: str, property_: str) -> None:
    found = only(TEMPLATE + said)
    assert (found.code, found.hint) == ("SC-L25", f"Write sh:property [ sh:path {property_} ; sh:hasValue ... ].")


def test_what_else_is_said_of_a_role_is_left_alone() -> None:
    assert not lints(TEMPLATE + ":r rdfs:label 'lamp' ; :drawnAs :Bulb ; rdfs:seeAlso :r2 .")


def test_words_of_shacl_outside_of_the_shapes_of_roles_are_left_alone() -> None:
    assert not lints(TEMPLATE + "[] a sh:ValidationResult ; sh:focusNode :a ; sh:value 5 ; sh:resultPath rob:place .")


@pytest.mark.parametrize(
    "role",
    [
        "",
        " ; sh:class sc:Component",
        " ; sh:nodeKind sh:IRI",
        " ; sh:property [ sh:path rob:place ]",
        " ; sh:property [ sh:path rob:place ; sh:minCount 0 ]",
        " ; sh:property [ sh:path ( rob:place :part ) ; sh:minCount 0 ]",
    ],
)
def test_a_role_that_every_component_meets_is_noticed(role: str) -> None:
    assert only(f":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role{role} .").code == "SC-L27"


@pytest.mark.parametrize(
    "more",
    [
        ":r sh:property [ sh:path rob:place ; sh:minCount 1 ] .",
        ":r sh:property [ sh:path rob:place ; sh:in ( :kitchen ) ] .",
        ":r sh:or ( [ sh:class rob:Tuner ] [ sh:class rob:Display ] ) .",
        ":r sh:property [ sh:path rob:place ; sh:or ( [ sh:in ( :kitchen ) ] [ sh:in ( :hall ) ] ) ] .",
        ":r sh:property [ sh:path rob:place ; sh:not [ sh:in ( :kitchen ) ] ] .",
        ":r sh:property [ sh:path rob:place ; sh:closed true ] .",
        ":r sc:sets [ sc:parameterType rob:Station ; sc:value 3 ] .",
        ':t sc:hasOutput [ sc:name "sound" ; sc:signalType rob:Audio ; sc:of :r ] .',
        f":r :least 3 . :Least a sh:ConstraintComponent ; sh:parameter [ sh:path :least ] ; {VALIDATOR} .",
    ],
)
def test_a_role_of_which_anything_is_asked_is_left_alone(more: str) -> None:
    assert not lints(f":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role . {more}")


def test_an_optional_role_that_issues_for_the_template_is_joined() -> None:
    text = TEMPLATE + ":r sc:minCount 0 . "
    assert only(text).code == "SC-L20"
    assert not lints(text + ':t sc:hasOutput [ sc:name "o" ; sc:signalType rob:Text ; sc:of :r ] .')


def test_a_role_whose_port_an_interaction_names_is_left_alone() -> None:
    roles = ":t a sc:Template ; sc:roles ( :r :s ) . :r a sc:Role . :s a sc:Role ; sh:class rob:Display ."
    assert not lints(f'{roles} [] a sc:Interaction ; sc:from :r ; sc:to :s ; sc:output "text" .')


def test_a_role_for_a_kind_of_signals_is_noticed() -> None:
    found = only(":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class rob:Audio .")
    assert found.code == "SC-L28"
    assert "sc:signalType" in (found.hint or "")


@pytest.mark.parametrize(
    ("wrong", "right", "code"),
    [
        ("sh:node rob:Tuner", "sh:node [ sh:class rob:Tuner ]", "SC-L14"),
        ("sh:not rob:Tuner", "sh:not [ sh:class rob:Tuner ]", "SC-L14"),
        ("sh:or ( [ a rob:Tuner ] [ sh:class :A ] )", "sh:or ( [ sh:class rob:Tuner ] [ sh:class :A ] )", "SC-L14"),
        ("sc:recruits [ a rob:Tuner ]", "sc:recruits [ sh:class rob:Tuner ]", "SC-L14"),
        ("sc:recruits [ sh:class rob:Audio ]", "sc:recruits [ sh:class rob:Tuner ]", "SC-L28"),
        (
            "sh:property [ sh:path sc:signalType ; sh:hasValue rob:Audio ]",
            "sh:property [ sh:path ( sc:hasOutput sc:signalType ) ; sh:hasValue rob:Audio ]",
            "SC-L25",
        ),
        (
            "sh:property [ sh:path ( sc:rate sc:value ) ; sh:minInclusive 5 ]",
            "sh:property [ sh:path ( sc:hasOutput sc:rate sc:value ) ; sh:minInclusive 5 ]",
            "SC-L25",
        ),
    ],
)
def test_what_a_role_asks_for_in_vain_is_noticed_with_what_to_write(wrong: str, right: str, code: str) -> None:
    found = only(f"{TEMPLATE}:r {wrong} .")
    assert (found.code, found.hint is not None) == (code, True)
    assert not lints(f"{TEMPLATE}:r {right} .")


def test_a_shape_with_a_name_that_says_what_it_asks_for_is_left_alone() -> None:
    assert not lints(TEMPLATE + ":r sh:node :There . :There sh:property [ sh:path rob:place ; sh:minCount 1 ] .")
    assert not lints(TEMPLATE + ":r sh:node :Any . :Any a sh:NodeShape .")
    parameter = ":t sc:parameter :p . :p a sc:Parameter ; sc:name 'p' ."
    assert not lints(f"{TEMPLATE}{parameter} :r sh:node :p .")


@pytest.mark.parametrize("word", ["sh:minCnt", "sc:vlue"])
def test_a_misspelt_word_in_a_shape_is_one_problem(word: str) -> None:
    assert only(f"{TEMPLATE}:r sh:property [ sh:path rob:place ; {word} 1 ] .").code == "SC-L01"

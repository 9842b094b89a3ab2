"""Lints about templates: roles that are not listed or cannot be played, parameters that are not used."""

from __future__ import annotations

import pytest

from tests.rdf.validation.lints.linted_text import HEAD, TEMPLATE, lints, only

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


def test_a_query_may_name_things_that_no_ontology_declares() -> None:
    prefix = "PREFIX rob: <https://w3id.org/selfconf/robotics#>"
    query = f"{prefix} SELECT $this {{ $this rob:place rob:SomewhereElse }}"
    assert not lints(TEMPLATE + f":r sh:sparql [ sh:select '{query}' ] .")


def test_a_component_of_the_name_of_a_role_is_told_to_have_another_and_not_what_a_role_writes() -> None:
    lamp = ':r a sc:Component, rob:Lamp ; rob:place :hall ; sc:hasInput [ sc:name "on" ; sc:signalType rob:Switch ] .'
    found = only(TEMPLATE + lamp)
    assert (found.code, found.message) == ("SC-L14", ":r is a component and a role as well.")
    assert found.hint == "Give one of the two another IRI."


def test_a_role_may_say_that_it_is_a_shape() -> None:
    assert not lints(TEMPLATE + ":r a sh:NodeShape, :Pivotal .")


def test_a_parameter_that_no_template_lists_is_noticed() -> None:
    text = TEMPLATE + ":r sh:property [ sh:path rob:place ; sh:in ( :p ) ] . :p a sc:Parameter ; sc:name 'p' ."
    assert only(text).code == "SC-L15"
    assert not lints(text + ":t sc:parameter :p .")


BORROWED = (
    TEMPLATE
    + ":t sc:parameter :p . :r sh:property [ sh:path rob:place ; sh:in ( :p ) ] . :p a sc:Parameter ; sc:name 'p' .\n"
    + ":u a sc:Template ; sc:roles ( :s ) . :s a sc:Role ; sh:class rob:Lamp ; "
)


@pytest.mark.parametrize(
    "said",
    [
        "sh:property [ sh:path rob:place ; sh:in ( :hall :p ) ] .",
        "sh:node :There . :There sh:property [ sh:path rob:place ; sh:hasValue :p ] .",
        "sc:sets [ sc:parameterType :Place ; sc:value :p ] .",
    ],
)
def test_a_parameter_of_another_template_is_noticed_where_a_role_mentions_it(said: str) -> None:
    found = only(BORROWED + said)
    assert (found.code, found.hint) == ("SC-L15", "Say sc:parameter :p of :u as well.")
    assert found.source[found.column - found.source_column :].startswith(":p")
    assert not lints(BORROWED + said + " :u sc:parameter :p .")


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
    ("condition", "noticed"),
    [
        ("$this rob:place home:p", True),
        ("$this rob:place <https://example.org/home#p>", True),
        ("$this rob:place home:place, ?p, 'home:p' # home:p", False),
    ],
)
def test_a_parameter_in_the_text_of_a_query_is_noticed(condition: str, noticed: bool) -> None:
    prefixes = " ".join(
        f"[ sh:prefix '{name}' ; sh:namespace '{iri}'^^<http://www.w3.org/2001/XMLSchema#anyURI> ]"
        for name, iri in (("home", "https://example.org/home#"), ("rob", "https://w3id.org/selfconf/robotics#"))
    ).replace("] [", "] , [")
    text = (
        f"{TEMPLATE} :t sc:parameter :p . :p a sc:Parameter ; sc:name 'p' . :prefixes sh:declare {prefixes} .\n"
        ":r sh:property [ sh:path rob:place ; sh:in ( :p ) ] ; sh:sparql [ sh:prefixes :prefixes ;\n"
        f'sh:select """SELECT $this WHERE {{ FILTER NOT EXISTS {{ {condition}\n}} }}""" ] .'
    )
    assert [found.code for found in lints(text)] == ["SC-L16"] * noticed


@pytest.mark.parametrize(
    "shape",
    [
        "sh:minCount 2 ; sh:maxCount 1",
        "sh:minCount 1 ; sh:in ()",
        "sh:minCount 3 ; sh:in ( :x :y )",
        "sh:hasValue :z ; sh:in ( :x :y )",
    ],
)
def test_a_property_shape_that_contradicts_itself_is_noticed(shape: str) -> None:
    assert only(TEMPLATE + f":r sh:property [ sh:path rob:place ; {shape} ] .").code == "SC-L11"


@pytest.mark.parametrize(
    "other",
    [
        ":q a sc:Role ; sh:class rob:Lamp ; sh:targetClass sc:Component ; sh:property [ sh:path rob:place ; %s ] .",
        ":q a sh:NodeShape ; sh:targetClass sc:Component ; sh:property [ sh:path rob:place ; %s ] .",
        ":q a sh:NodeShape ; sh:targetObjectsOf rob:place ; sh:nodeKind sh:Literal .",
    ],
)
def test_the_targets_of_other_shapes_of_the_file_say_nothing_of_a_role(other: str) -> None:
    asked = "sh:property [ sh:path rob:place ; sh:minCount 1 ; sh:nodeKind sh:IRI ]"
    text = TEMPLATE.replace("( :r )", "( :r :q )" if "Role" in other else "( :r )")
    assert not lints(f"{text} :r {asked} . {other.replace('%s', 'sh:maxCount 0')}")


def test_a_target_of_a_role_does_not_make_every_component_meet_its_shape() -> None:
    assert not lints(TEMPLATE + ":r sh:targetClass sc:Component .")


@pytest.mark.parametrize(
    "shape", ["sh:minCount 1 ; sh:maxCount 1", "sh:minCount 2 ; sh:in ( :x :y )", "sh:hasValue :x ; sh:in ( :x )"]
)
def test_a_property_shape_that_can_be_kept_is_left_alone(shape: str) -> None:
    assert not lints(TEMPLATE + f":r sh:property [ sh:path rob:place ; {shape} ] .")


def test_a_contradiction_is_shown_at_its_second_side_and_names_the_place_of_the_first() -> None:
    first = ":r sh:property [ sh:path rob:place ; sh:maxCount 1 ] .\n"
    found = only(TEMPLATE + first + ":r sh:node [ sh:property [ sh:path rob:place ; sh:minCount 2 ] ] .")
    assert (found.line - HEAD, found.column) == (3, 48)
    assert found.message == (
        f"sh:minCount 2 and sh:maxCount 1 (line {HEAD + 2}) exclude each other, so no component can play the role :r."
    )


def test_a_closed_role_that_does_not_let_a_component_have_a_type_is_told_how_to() -> None:
    found = only(TEMPLATE + ":r sh:closed true .")
    assert found.hint is not None
    assert "sh:ignoredProperties" in found.hint


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


def test_a_contradiction_in_a_shape_that_is_no_role_is_not_reported() -> None:
    shape = ":s a sh:NodeShape ; sh:property [ sh:path rob:place ; sh:minCount 2 ; sh:maxCount 1 ] ."
    assert not lints(TEMPLATE + shape)


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


ASKED, LATENCY = TEMPLATE + ":r {} .", "rob:latency ;"
RATED = ":a a sc:Component, rob:Tuner ; sc:hasInput [ sc:name 'i' ; sc:signalType rob:Audio ; sc:accepts [ {} ] ] ."


@pytest.mark.parametrize(
    ("text", "wrong", "right", "code"),
    [
        (ASKED, f"{LATENCY} sh:minInclusive 12 ;", f"{LATENCY} sh:minInclusive 5 ;", "SC-L11"),
        (ASKED, f"{LATENCY} sh:minInclusive 12 ;", f"{LATENCY} sh:maxCount 0 ;", "SC-L11"),
        (ASKED, "( sc:hasOutput sc:rate ) ;", "( sc:hasOutput sc:rate sc:value ) ;", "SC-L11"),
        (RATED, "sc:rate ;", "( sc:rate sc:value ) ;", "SC-L22"),
        (RATED, "sc:rate ; sh:minCount 1 ;", "( sc:rate sc:value ) ; sh:minCount 1 ;", "SC-L22"),
    ],
)
def test_what_no_value_can_meet_is_noticed_where_there_may_be_none(
    text: str, wrong: str, right: str, code: str
) -> None:
    assert only(text.format(f"sh:property [ sh:path {wrong} sh:maxInclusive 9 ]")).code == code
    assert not lints(text.format(f"sh:property [ sh:path {right} sh:maxInclusive 9 ]"))

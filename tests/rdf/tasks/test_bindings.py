"""Values for the parameters of a template: as text, as defaults, and as the parameter's own shape allows."""

from __future__ import annotations

import pytest

from selfconf.errors import BindingError
from selfconf.model.cost import CostTerm
from selfconf.model.term import IRI, Literal, Term
from selfconf.rdf.tasks import bindings, templates
from selfconf.rdf.tasks.templates import TaskDocument
from selfconf.rdf.turtle import document as turtle
from selfconf.rdf.vocabulary import RDF, XSD
from tests.lab import PREFIXES, iri

KNOWN = {"": "https://example.org/peis-home#", "rob": "https://w3id.org/selfconf/robotics#"}


@pytest.mark.parametrize(
    ("text", "term"),
    [
        (":Astrid", iri("Astrid")),
        ("rob:Encoder", IRI("https://w3id.org/selfconf/robotics#Encoder")),
        ("<urn:x>", IRI("urn:x")),
        ("(AT BEDROOM)", Literal("(AT BEDROOM)")),
        ("two words", Literal("two words")),
        ("at 10:30", Literal("at 10:30")),
        ('"a:b"', Literal("a:b")),
        ("'x'@en", Literal("x", IRI("http://www.w3.org/1999/02/22-rdf-syntax-ns#langString"), "en")),
        ("5", Literal("5", XSD.integer)),
        ("-2.5", Literal("-2.5", XSD.decimal)),
        ("1e3", Literal("1e3", XSD.double)),
        ("true", Literal("true", XSD.boolean)),
        ('"5"^^<urn:t>', Literal("5", IRI("urn:t"))),
        ("", Literal("")),
    ],
)
def test_a_term_on_the_command_line_is_read_as_an_author_means_it(text: str, term: Term) -> None:
    assert bindings.read_term(text, KNOWN) == term


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("nobody:x", "no prefix nobody:"),
        ("дом:x", "no prefix дом:"),
        ("http://example.org/x", "angle brackets"),
        ("<no iri>", "no Turtle term"),
        ('"unfinished', "no Turtle term"),
        ("<urn:a> . <urn:b> <urn:c> <urn:d>", "no Turtle term"),
        ('"a", "b"', "no Turtle term"),
    ],
)
def test_a_term_that_is_none_is_refused_with_what_to_write(text: str, words: str) -> None:
    with pytest.raises(BindingError, match=words):
        bindings.read_term(text, KNOWN)


def test_the_string_that_is_proposed_for_what_looks_like_a_curie_is_read_as_it_was_meant() -> None:
    meant = r"C:\maps"
    with pytest.raises(BindingError) as caught:
        bindings.read_term(meant, KNOWN)
    proposed = str(caught.value).partition("for a string write '")[2].removesuffix("'")
    assert bindings.read_term(proposed, KNOWN) == Literal(meant)


def test_a_prefix_and_its_names_may_be_of_any_script() -> None:
    assert bindings.read_term("дом:кухня", {"дом": "urn:d:"}) == IRI("urn:d:кухня")


def test_digits_of_other_scripts_are_words() -> None:
    assert bindings.read_term("٣", KNOWN) == Literal("٣")


TEMPLATE = """
:t a sc:Template ; sc:roles ( :r ) ; sc:parameter :robot, :goal, :speed .
:robot a sc:Parameter ; sc:name "robot" ; sh:nodeKind sh:IRI .
:goal  a sc:Parameter ; sc:name "goal" ; sh:datatype xsd:string .
:speed a sc:Parameter ; sc:name "speed" ; sh:defaultValue 0.5 ; sh:datatype xsd:decimal ; sh:minExclusive 0 .
:r a sc:Role ; sh:property [ sh:path rob:support ; sh:in ( :robot ) ] ;
    sc:sets [ sc:parameterType :G ; sc:value :goal ] , [ sc:parameterType :S ; sc:value :speed ] .
"""


def completed(*bound: tuple[str, str]) -> dict[str, Term]:
    """The values by name, after binding."""
    task = templates.read_task(turtle.parse(PREFIXES + TEMPLATE, "t.ttl"))
    return bindings.complete(bindings.bind(task, bound)).task.by_name()


def test_what_is_bound_and_what_has_a_default_has_a_value_and_the_rest_stays_free() -> None:
    assert completed(("goal", "x")) == {"goal": Literal("x"), "speed": Literal("0.5", XSD.decimal)}
    assert completed(("goal", "x"), ("robot", ":Astrid"), ("speed", "1.5")) == {
        "robot": iri("Astrid"),
        "goal": Literal("x"),
        "speed": Literal("1.5", XSD.decimal),
    }


@pytest.mark.parametrize(
    ("bound", "words"),
    [
        ((), "'goal' needs a value"),
        ((("goal", "x"), ("colour", "red")), "no parameter 'colour'; it has: goal, robot, speed"),
        ((("goal", "x"), ("goal", "y")), "bound twice"),
        ((("goal", "5"),), "cannot stand for the parameter 'goal'"),
        ((("goal", "x"), ("robot", "Astrid")), "cannot stand for the parameter 'robot'"),
        ((("goal", "x"), ("speed", "-1.0")), "cannot stand for the parameter 'speed'"),
    ],
)
def test_a_value_that_does_not_fit_is_refused(bound: tuple[tuple[str, str], ...], words: str) -> None:
    with pytest.raises(BindingError, match=words):
        completed(*bound)


@pytest.mark.parametrize(
    ("asked", "value", "taken"),
    [
        ("decimal", "2", Literal("2.0", XSD.decimal)),
        ("double", "2", Literal("2", XSD.double)),
        ("double", "0.5", Literal("0.5", XSD.double)),
        ("float", "0.5", Literal("0.5", XSD.float)),
        ("decimal", Literal("0.5", XSD.double), Literal("0.5", XSD.decimal)),
        ("nonNegativeInteger", "2", Literal("2", XSD.nonNegativeInteger)),
        ("byte", "127", Literal("127", XSD.byte)),
        ("long", "9223372036854775807", Literal("9223372036854775807", XSD.long)),
        ("int", Literal("7", XSD.integer), Literal("7", XSD.int)),
    ],
)
def test_a_number_takes_the_datatype_that_its_parameter_asks_for(asked: str, value: str | Term, taken: Term) -> None:
    text = TEMPLATE.replace("sh:defaultValue 0.5 ; ", "").replace("decimal", asked)
    task = templates.read_task(turtle.parse(PREFIXES + text, "t.ttl"))
    assert bindings.complete(bindings.bind(task, [("goal", "x"), ("speed", value)])).task.by_name()["speed"] == taken


@pytest.mark.parametrize(
    ("asked", "value"),
    [
        ("integer", "0.5"),
        ("integer", "1e3"),
        ("integer", "7.0"),
        ("byte", "128"),
        ("unsignedInt", "-1"),
        ("long", "9223372036854775808"),
        ("unsignedLong", "18446744073709551616"),
        ("int", "7.0"),
    ],
)
def test_a_number_that_its_parameter_has_no_place_for_is_refused(asked: str, value: str) -> None:
    text = TEMPLATE.replace("sh:defaultValue 0.5 ; ", "").replace("decimal", asked)
    task = templates.read_task(turtle.parse(PREFIXES + text, "t.ttl"))
    with pytest.raises(BindingError, match=f"not an? {asked}"):
        bindings.complete(bindings.bind(task, [("goal", "x"), ("speed", value)]))


def anything() -> TaskDocument:
    """A task whose parameter may be anything."""
    text = ':t a sc:Template ; sc:parameter :p ; sc:roles ( :r ) . :p a sc:Parameter ; sc:name "p" .'
    role = ":r a sc:Role ; sc:sets [ sc:parameterType :G ; sc:value :p ] ."
    return templates.read_task(turtle.parse(PREFIXES + text + role, "t.ttl"))


@pytest.mark.parametrize(
    ("value", "words"),
    [
        ('"abc"^^xsd:integer', "cannot stand for the parameter 'p': it is no integer"),
        ('"5"^^xsd:date', "it is no date"),
        (Literal("true", XSD.integer), "it is no integer"),
    ],
)
def test_a_literal_that_is_none_of_its_datatype_is_refused(value: str | Term, words: str) -> None:
    with pytest.raises(BindingError, match=words):
        bindings.bind(anything(), [("p", value)])


@pytest.mark.parametrize("value", ['"7"^^xsd:integer', '"07"^^xsd:decimal', '"2026-11-26"^^xsd:date', '"x"^^:own'])
def test_a_literal_that_is_one_of_its_datatype_is_taken(value: str) -> None:
    assert bindings.bind(anything(), [("p", value)]).task.bindings


@pytest.mark.parametrize("value", ["\udcff", '"\ud800"', Literal("a\udcff")])
def test_half_a_character_is_refused_in_a_sentence(value: str | Term) -> None:
    task = templates.read_task(turtle.parse(PREFIXES + TEMPLATE, "t.ttl"))
    with pytest.raises(BindingError, match=r"^the value of 'goal' is no text in UTF-8: '.*\\ud[8c]"):
        bindings.bind(task, [("goal", value)])


@pytest.mark.parametrize(
    ("bound", "shown", "hint"),
    [
        (("speed", "2e0"), "2e0 cannot stand", None),
        (("speed", '"2"'), '"2" cannot stand', """; write bind(speed='"2"^^xsd:decimal')"""),
        (("speed", "fast"), '"fast" cannot stand', None),
        (("goal", "5"), "5 cannot stand", """; write bind(goal='"5"')"""),
        (("robot", "Astrid"), '"Astrid" cannot stand', "; write a CURIE such as :Astrid, or an <IRI>"),
        (("robot", "my Astrid"), '"my Astrid" cannot stand', "; write a CURIE such as :my-Astrid, or an <IRI>"),
        (("robot", "!"), '"!" cannot stand', "; write a CURIE such as :kitchen, or an <IRI>"),
    ],
)
def test_a_value_of_another_datatype_is_shown_as_it_is_with_what_would_do(
    bound: tuple[str, str], shown: str, hint: str | None
) -> None:
    with pytest.raises(BindingError) as told:
        completed(*dict([("goal", "x"), bound]).items())
    assert str(told.value).startswith(shown)
    assert str(told.value).endswith(hint) if hint else "; write" not in str(told.value)


def test_a_text_that_needs_a_language_is_shown_with_one() -> None:
    task = templates.read_task(turtle.parse(PREFIXES + TEMPLATE.replace("xsd:string", f"<{RDF.langString}>"), "t.ttl"))
    with pytest.raises(BindingError) as told:
        bindings.complete(bindings.bind(task, [("goal", "north hall")]))
    advice = str(told.value).partition("; write ")[2]
    assert advice == "bind(goal='\"north hall\"@en')"
    bindings.complete(bindings.bind(task, [("goal", '"north hall"@en')]))


@pytest.mark.parametrize(
    ("prefix", "advice"), [("home:", "; write a CURIE such as home:3, or an <IRI>"), (None, "; write an <IRI>")]
)
def test_a_curie_that_is_proposed_has_a_prefix_of_the_template(prefix: str | None, advice: str) -> None:
    home = "https://example.org/home#"
    declared = (
        f"@prefix sc: <https://w3id.org/selfconf#> . @prefix sh: <http://www.w3.org/ns/shacl#> . @base <{home}> ."
    )
    text = f"""{declared} {f"@prefix {prefix} <{home}> ." if prefix else ""}
        <#t> a sc:Template ; sc:parameter <#place> ; sc:roles ( <#r> ) .
        <#place> a sc:Parameter ; sc:name "place" ; sh:nodeKind sh:IRI .
        <#r> a sc:Role ; sh:property [ sh:path <#at> ; sh:in ( <#place> ) ] ."""
    task = templates.read_task(turtle.parse(text, "t.ttl"))
    with pytest.raises(BindingError) as told:
        bindings.complete(bindings.bind(task, [("place", "3")]))
    assert str(told.value).endswith(advice)


def test_a_task_binds_for_itself_and_may_not_be_contradicted() -> None:
    text = TEMPLATE + ':k a sc:Task ; sc:template :t ; sc:binding [ sc:parameter :goal ; sc:value "y" ] .'
    task = templates.read_task(turtle.parse(PREFIXES + text, "t.ttl"))
    assert bindings.complete(task).task.by_name()["goal"] == Literal("y")
    with pytest.raises(BindingError, match="bound twice"):
        bindings.bind(task, [("goal", "z")])


@pytest.mark.parametrize(
    "path",
    [
        ":x",
        "( :y :x )",
        "[ sh:inversePath :x ]",
        "[ sh:alternativePath ( :y :x ) ]",
        "[ sh:alternativePath ( ( :y :x ) :y ) ]",
        "( :y [ sh:zeroOrMorePath ( :y :x ) ] )",
    ],
)
def test_a_path_cannot_be_left_free(path: str) -> None:
    text = (
        "@prefix sc: <https://w3id.org/selfconf#> . @prefix sh: <http://www.w3.org/ns/shacl#> . @prefix : <urn:x:> ."
        " :t a sc:Template ; sc:parameter :x ; sc:roles ( :r ) . :x a sc:Parameter ; sc:name 'x' ."
        f" :r a sc:Role ; sh:property [ sh:path {path} ; sh:hasValue 3 ] ."
    )
    with pytest.raises(
        BindingError,
        match=r"'x' cannot be left free, for it stands in sh:(p|inverseP|alternativeP|zeroOrMoreP)ath; .*bind\(x=",
    ):
        bindings.complete(templates.read_task(turtle.parse(text, "t.ttl")))


@pytest.mark.parametrize(
    ("place", "good", "bad"), [("languageIn", "en", ":y"), ("closed true ; sh:ignoredProperties", ":y", "3")]
)
def test_a_member_of_a_list_of_names_is_bound_and_cannot_be_left_free(place: str, good: str, bad: str) -> None:
    text = (
        "@prefix sc: <https://w3id.org/selfconf#> . @prefix sh: <http://www.w3.org/ns/shacl#> . @prefix : <urn:x:> ."
        " :t a sc:Template ; sc:parameter :x ; sc:roles ( :r ) . :x a sc:Parameter ; sc:name 'x' ."
        f" :r a sc:Role ; sh:property [ sh:path :n ; sh:{place} ( :x ) ] ."
    )
    task = templates.read_task(turtle.parse(text, "t.ttl"))
    assert bindings.complete(bindings.bind(task, [("x", good)])).task.bindings
    with pytest.raises(BindingError, match="has to be a list in parentheses, of"):
        bindings.complete(bindings.bind(task, [("x", bad)]))
    with pytest.raises(BindingError, match=r"'x' cannot be left free, for it stands in sh:(languageIn|ignoredProp)"):
        bindings.complete(task)


@pytest.mark.parametrize("place", ["minInclusive", "maxExclusive", "minCount", "pattern"])
def test_a_limit_cannot_be_left_free(place: str) -> None:
    text = (
        "@prefix sc: <https://w3id.org/selfconf#> . @prefix sh: <http://www.w3.org/ns/shacl#> . @prefix : <urn:x:> ."
        " :t a sc:Template ; sc:parameter :x ; sc:roles ( :r ) . :x a sc:Parameter ; sc:name 'x' ."
        f" :r a sc:Role ; sh:property [ sh:path :n ; sh:{place} :x ] ."
    )
    task = templates.read_task(turtle.parse(text, "t.ttl"))
    with pytest.raises(BindingError, match=rf"'x' cannot be left free, for it stands in sh:{place}; .*bind\(x="):
        bindings.complete(task)
    value = '"3"' if place == "pattern" else "3"
    assert bindings.complete(bindings.bind(task, [("x", value)])).task.bindings


@pytest.mark.parametrize(
    ("said", "value", "sentence"),
    [
        (
            "sh:class :x",
            "3",
            r"3 cannot stand for the parameter 'x' in the shape of .*: the value of sh:class has to be",
        ),
        ("sh:pattern :x", "3", "the value of sh:pattern has to be a regular expression"),
        ("sh:property [ sh:path :n ; sh:minInclusive :x ]", ":y", "<urn:x:y> cannot stand for the parameter 'x'"),
        ("sh:or ( [ sh:property [ sh:path :n ; sh:minLength :x ] ] )", "long", '"long" cannot stand for the parameter'),
        ("sh:property [ sh:path ( :n :x ) ; sh:minCount 1 ]", "3", "with these values the shape of the role"),
        (
            "sc:recruits [ sh:class :x ]",
            "3",
            "^3 cannot stand .* 'x' in the shape of what the role .* recruits: the value",
        ),
        ("sc:recruits [ sh:pattern :x ]", '"(("', "this is no regular expression: missing"),
    ],
)
def test_a_value_with_which_the_shape_of_a_role_would_be_none_cannot_be_bound(
    said: str, value: str, sentence: str
) -> None:
    text = (
        "@prefix sc: <https://w3id.org/selfconf#> . @prefix sh: <http://www.w3.org/ns/shacl#> . @prefix : <urn:x:> ."
        " :t a sc:Template ; sc:parameter :x ; sc:roles ( :r ) . :x a sc:Parameter ; sc:name 'x' ."
        f" :r a sc:Role ; {said} ."
    )
    task = bindings.bind(templates.read_task(turtle.parse(text, "t.ttl")), [("x", value)])
    with pytest.raises(BindingError, match=sentence):
        bindings.complete(task)


@pytest.mark.parametrize("place", ["equals", "disjoint", "lessThan", "lessThanOrEquals", "datatype"])
def test_what_is_no_value_of_a_component_cannot_be_left_free_unless_it_is_listed(place: str) -> None:
    text = (
        "@prefix sc: <https://w3id.org/selfconf#> . @prefix sh: <http://www.w3.org/ns/shacl#> . @prefix : <urn:x:> ."
        " :t a sc:Template ; sc:parameter :x ; sc:roles ( :r ) . :x a sc:Parameter ; sc:name 'x' ."
        f" :r a sc:Role ; sh:property [ sh:path :n ; sh:{place} :x ] ."
    )
    with pytest.raises(BindingError, match=rf"'x' cannot be left free, for it stands in sh:{place}; .*bind\(x="):
        bindings.complete(templates.read_task(turtle.parse(text, "t.ttl")))
    listed = templates.read_task(turtle.parse(f"{text} :x sh:in ( :p :q ) .", "t.ttl"))
    assert not bindings.complete(listed).task.bindings


@pytest.mark.parametrize("recruits", ["[ sh:property [ sh:path :n ; sh:in ( :x ) ] ]", ":shape . :shape sh:class :x"])
def test_a_shape_of_recruits_cannot_be_left_free(recruits: str) -> None:
    text = (
        "@prefix sc: <https://w3id.org/selfconf#> . @prefix sh: <http://www.w3.org/ns/shacl#> . @prefix : <urn:x:> ."
        " :t a sc:Template ; sc:parameter :x ; sc:roles ( :r ) . :x a sc:Parameter ; sc:name 'x' ."
        f" :shape a sh:NodeShape . :r a sc:Role ; sh:class :A ; sc:recruits {recruits} ."
    )
    task = templates.read_task(turtle.parse(text, "t.ttl"))
    for later in ((), ("x",)):
        with pytest.raises(BindingError, match=r"'x' cannot be left free, for it stands in sc:recruits; .*bind\(x="):
            bindings.complete(task, later)
    assert bindings.complete(bindings.bind(task, [("x", ":c")])).task.bindings


def test_a_shape_of_recruits_has_the_default_of_its_parameter_until_that_has_another_value() -> None:
    text = (
        "@prefix sc: <https://w3id.org/selfconf#> . @prefix sh: <http://www.w3.org/ns/shacl#> . @prefix : <urn:x:> ."
        " :t a sc:Template ; sc:parameter :x ; sc:roles ( :r ) . :x a sc:Parameter ; sc:name 'x' ; sh:defaultValue 3 ."
        " :r a sc:Role ; sh:class :A ; sc:recruits [ sh:property [ sh:path :n ; sh:in ( :x ) ] ] ."
    )
    task = templates.read_task(turtle.parse(text, "t.ttl"))
    assert list(bindings.complete(task, ("x",)).task.bindings) == ["urn:x:x"]


PREFERRED = """
:t a sc:Template ; sc:roles ( :r ) ; sc:parameter :k ; sc:cost ( [ sc:term [ sc:property :k ] ] ) .
:k a sc:Parameter ; sc:name "k" . :r a sc:Role ; sh:class :X .
"""
SETTING = """
:t a sc:Template ; sc:roles ( :r ) ; sc:parameter :k . :k a sc:Parameter ; sc:name "k" .
:r a sc:Role ; sh:class :X ; sc:sets [ sc:parameterType :k ; sc:value 1 ] , [ sc:parameterType :G ; sc:value 2 ] .
"""


def test_the_property_that_a_cost_counts_and_the_type_that_a_role_sets_are_replaced_by_their_values() -> None:
    counted = templates.read_task(turtle.parse(PREFIXES + PREFERRED, "t.ttl"))
    template = bindings.complete(bindings.bind(counted, [("k", ":price")])).template
    assert template.cost == ((CostTerm(iri("price")),),)
    sets = templates.read_task(turtle.parse(PREFIXES + SETTING, "t.ttl"))
    (role,) = bindings.complete(bindings.bind(sets, [("k", ":H")])).template.roles
    assert [setting.type for setting in role.settings] == [iri("H"), iri("G")]


@pytest.mark.parametrize(("text", "place"), [(PREFERRED, "sc:property"), (SETTING, "sc:parameterType")])
def test_what_a_cost_counts_or_a_role_sets_is_an_iri_and_cannot_be_left_free(text: str, place: str) -> None:
    task = templates.read_task(turtle.parse(PREFIXES + text, "t.ttl"))
    with pytest.raises(BindingError, match=rf"'k' cannot be left free, for it stands in {place};"):
        bindings.complete(task)
    with pytest.raises(BindingError, match=f"^3 cannot stand for the parameter 'k': it stands for a {place}, which"):
        bindings.complete(bindings.bind(task, [("k", "3")]))


def test_values_that_make_a_role_set_one_type_twice_are_refused() -> None:
    task = templates.read_task(turtle.parse(PREFIXES + SETTING, "t.ttl"))
    with pytest.raises(BindingError, match=r"the role <.*#r> sets <.*#G> to 2 different values"):
        bindings.complete(bindings.bind(task, [("k", ":G")]))


def test_the_shape_of_each_role_is_read_once_to_see_which_of_many_parameters_may_stay_free(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    numbers = range(20)
    listed = " ".join(f":r{k}" for k in numbers)
    lines = [f":t a sc:Template ; sc:roles ( {listed} ) ; sc:parameter {', '.join(f':p{k}' for k in numbers)} ."]
    for k in numbers:
        lines.append(f':p{k} a sc:Parameter ; sc:name "p{k}" .')
        lines.append(f":r{k} a sc:Role ; sh:class :C ; sh:property [ sh:path :on ; sh:hasValue :p{k} ] .")
    given = templates.read_task(turtle.parse(PREFIXES + "\n".join(lines), "t.ttl"))
    read: list[object] = []
    statements = bindings.shape_statements

    def counted(document: turtle.Document, role: turtle.Node) -> object:
        read.append(role)
        return statements(document, role)

    monkeypatch.setattr(bindings, "shape_statements", counted)
    assert not bindings.complete(given).task.bindings
    assert len(read) == len(numbers)

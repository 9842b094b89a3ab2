"""Lints about words: what reads well and is probably not what was meant."""

from __future__ import annotations

import pytest

from selfconf import library
from selfconf.model.codes import PREAMBLE
from selfconf.model.diagnostic import Diagnostic, Severity
from selfconf.rdf.validation.checking import SourceText, validate_texts
from tests.harness.effort import thorough

HEAD = PREAMBLE.count("\n")
SHAPES = [SourceText(path.name, path.read_bytes()) for path in library.shapes()]
ONTOLOGIES = [SourceText(path.name, path.read_bytes()) for path in library.ontologies()]
TEMPLATE = ":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class rob:Lamp .\n"


def lints(text: str, head: str = PREAMBLE) -> list[Diagnostic]:
    return list(validate_texts([SourceText("a.ttl", (head + text).encode())], SHAPES, ONTOLOGIES).diagnostics)


def only(text: str, head: str = PREAMBLE) -> Diagnostic:
    (found,) = lints(text, head)
    return found


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        (":a a sc:Compnent, sc:Component, rob:Tuner .", "sc:Component"),
        (":a a sc:Component, rob:Tuner ; sc:preferance 1 .", "sc:preference"),
        (":a a sc:Component, rob:Tuner ; sc:Preference 1 .", "sc:preference"),
        (TEMPLATE + ":r sh:property [ sh:path rob:place ; sh:minCnt 1 ] .", "sh:minCount"),
        (TEMPLATE + ":r sh:targetClas rob:Lamp .", "sh:targetClass"),
        (TEMPLATE + ":r sh:nodeKind sh:IR .", "sh:IRI"),
        (TEMPLATE + ":r sc:feedss :r .", "sc:feeds"),
        (TEMPLATE + ":r sh:clas rob:Lamp .", "sh:class"),
        (TEMPLATE + ":r sh:Class rob:Lamp .", "sh:class"),
        (TEMPLATE + ":r sh:orr ( [] ) .", "sh:or"),
    ],
)
def test_a_misspelt_term_of_selfconf_or_shacl_is_an_error(text: str, meant: str) -> None:
    found = [each for each in lints(text) if each.code == "SC-L01"]
    assert [each.hint for each in found] == [f"Did you mean {meant}?"]
    assert found[0].severity is Severity.ERROR


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        (":a a sc:Component, rob:Tunr .", "rob:Tuner"),
        (":a a sc:Component, rob:Tuner ; rob:plcae :x .", "rob:place"),
        (":a a sc:Component, rob:Tuner ; rdfs:lable 'x' .", "rdfs:label"),
        (":a a sc:Component, rob:Tuner ; :weight '5'^^xsd:integr .", "xsd:integer"),
        (TEMPLATE.replace("rob:Lamp", "rob:Lmap"), "rob:Lamp"),
        (TEMPLATE + ":r sh:property [ sh:path rob:palce ; sh:minCount 1 ] .", "rob:place"),
        (TEMPLATE + ":r sh:property [ sh:path rob:place ; sh:disjoint rob:palce ] .", "rob:place"),
        (":a a sc:Component, :A ; sc:hasOperation [ sc:name 'x' ; sc:request rob:Imge ] .", "rob:Image"),
        (":a a sc:Component, :A ; sc:hasOperation [ sc:name 'x' ; sc:response rob:Imge ] .", "rob:Image"),
        (":A a owl:Class ; rdfs:label 'a' ; owl:equivalentClass rob:Lmap .", "rob:Lamp"),
        (
            TEMPLATE + ":r sh:sparql [ sh:select 'PREFIX r: <https://w3id.org/selfconf/robotics#> "
            "SELECT $this { $this r:palce ?v }' ] .",
            "rob:place",
        ),
        (":A a owl:Class ; rdfs:label 'a' ; owl:equivalentClass [ owl:unionOf ( rob:Lmap ) ] .", "rob:Lamp"),
        (":A a owl:Class ; rdfs:label 'a' ; rdfs:subClassOf [ owl:onProperty rob:palce ] .", "rob:place"),
        (TEMPLATE + ":t sc:cost ( [ sc:term [ sc:property rob:palce ] ] ) .", "rob:place"),
        (TEMPLATE + ":r sh:property [ sh:path ( rob:suport rob:place ) ; sh:minCount 1 ] .", "rob:support"),
        (
            TEMPLATE + ":r sh:property [ sh:path [ sh:alternativePath ( rob:place rob:suport ) ] ; sh:minCount 1 ] .",
            "rob:support",
        ),
        (
            TEMPLATE + ":r sh:property [ sh:path [ sh:alternativePath ( rob:place ( rob:suport :in ) ) ] ] .",
            "rob:support",
        ),
        (TEMPLATE + ":r sh:closed true ; sh:ignoredProperties ( rdf:type rob:palce ) .", "rob:place"),
        (TEMPLATE + ":r sh:property [ sh:path rdf:type ; sh:hasValue rob:Lmap ] .", "rob:Lamp"),
        (TEMPLATE + ":r sh:property [ sh:path ( sc:hasOutput sc:signalType ) ; sh:in ( rob:Imge ) ] .", "rob:Image"),
    ],
)
def test_a_misspelt_term_of_a_loaded_ontology_is_a_warning(text: str, meant: str) -> None:
    found = only(text)
    assert (found.code, found.severity, found.hint) == ("SC-L02", Severity.WARNING, f"Did you mean {meant}?")


@pytest.mark.parametrize(
    ("text", "code", "hint"),
    [
        (":a a sc:component, rob:Tuner .", "SC-L01", "Did you mean sc:Component?"),
        (TEMPLATE + ":r sh:class rob:place .", "SC-L02", "Did you mean rob:Place?"),
        (TEMPLATE + ":r sh:class rob:support .", "SC-L02", None),
    ],
)
def test_a_property_in_the_place_of_a_class_is_noticed(text: str, code: str, hint: str | None) -> None:
    found = only(text)
    assert (found.code, found.hint) == (code, hint)
    assert "is a property, where a class has to stand" in found.message


def test_a_value_that_a_role_asks_for_is_no_term_of_a_vocabulary() -> None:
    assert not lints(
        TEMPLATE + ":r sh:property [ sh:path rob:place ; sh:in ( rob:kitchen rob:hall ) ; sh:hasValue rob:hall ] ."
    )


def test_a_parameter_that_stands_for_a_class_is_no_misspelt_class() -> None:
    ontology = SourceText("home.ttl", (PREAMBLE + ":Home a owl:Class ; rdfs:label 'home' .").encode())
    text = TEMPLATE + ":t sc:parameter :kind . :kind a sc:Parameter ; sc:name 'kind' . :r sh:class :kind ."
    files = [SourceText("a.ttl", (PREAMBLE + text).encode())]
    assert not validate_texts(files, SHAPES, [*ONTOLOGIES, ontology]).diagnostics


def test_the_namespace_of_a_datatype_without_a_prefix_may_be_nearly_right() -> None:
    found = only(":a a sc:Component, rob:Tuner ; :bands '5'^^<https://www.w3.org/2001/XMLSchema#integer> .")
    assert (found.code, found.hint) == ("SC-L06", "Did you mean <http://www.w3.org/2001/XMLSchema#>?")


@pytest.mark.parametrize("prefix", ["rdf", "rdfs", "owl", "xsd", "rob"])
def test_a_prefix_with_no_name_behind_it_is_no_term(prefix: str) -> None:
    found = only(f":a a sc:Component, :A ; {prefix}: 1 .")
    assert (found.code, found.hint) == ("SC-L02", None)
    assert found.message.endswith(f" {prefix}:.")


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        (":a a sc:Component, sc:Tuner .", "rob:Tuner"),
        (":a a sc:Component, rob:Tuner ; sc:label 'a' .", "rdfs:label"),
        (TEMPLATE + ":r sc:class rob:Lamp .", "sh:class"),
        (TEMPLATE + ":r rob:feeds :r .", "sc:feeds"),
    ],
)
def test_a_term_with_the_prefix_of_another_vocabulary_is_found_there(text: str, meant: str) -> None:
    assert only(text).hint == f"Did you mean {meant}?"


def test_nothing_is_suggested_where_nothing_is_alike() -> None:
    assert only(":a a sc:Component, rob:Tuner ; rob:location :x .").hint is None


def test_a_literal_comes_with_an_iri_to_write_instead() -> None:
    assert only(":a a sc:Component, rob:Tuner ; rob:place 'living room' .").hint == (
        "Write an IRI, such as :living-room."
    )


def test_a_prefix_that_is_nearly_right_is_told_once_and_not_for_each_signal() -> None:
    head = PREAMBLE.replace("selfconf/robotics#", "selfconf/robotics/")
    text = ":a a sc:Component, rob:Tuner ; sc:hasOutput [ sc:name 'x' ; sc:signalType rob:Audio ] ."
    assert [each.code for each in lints(text, head)] == ["SC-L06"]


def test_every_occurrence_of_a_misspelt_term_is_reported() -> None:
    assert [each.column for each in lints(":a a sc:Component, rob:Tuner ; sc:nme 1 ; sc:nme 2 .")] == [32, 43]


def test_terms_of_an_ontology_that_is_not_loaded_are_left_alone() -> None:
    assert not lints(":a a sc:Component, <https://example.org/x#Tunr> ; <https://example.org/x#y> 1 .")


def test_membership_properties_of_rdf_are_no_misspelling() -> None:
    rdf = "http://www.w3.org/1999/02/22-rdf-syntax-ns#"
    assert not lints(f":a a sc:Component, rob:Tuner ; :uses [ <{rdf}_1> 5 ] .")


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        ("http://w3id.org/selfconf#", "https://w3id.org/selfconf#"),
        ("https://w3id.org/selfconf/", "https://w3id.org/selfconf#"),
        ("https://www.w3.org/ns/shacl#", "http://www.w3.org/ns/shacl#"),
        ("https://www.w3.org/ns/shacl/", "http://www.w3.org/ns/shacl#"),
    ],
)
def test_nearly_the_namespace_of_selfconf_or_shacl_is_an_error(wrong: str, right: str) -> None:
    found = only(":a a sc:Component, rob:Tuner .", PREAMBLE + f"@prefix x: <{wrong}> .\n")
    assert (found.code, found.severity, found.hint) == ("SC-L06", Severity.ERROR, f"Did you mean <{right}>?")


def test_nearly_the_namespace_of_another_vocabulary_is_a_warning() -> None:
    head = PREAMBLE + "@prefix x: <https://www.w3.org/2000/01/rdf-schema#> .\n"
    assert only(":a a sc:Component, rob:Tuner .", head).severity is Severity.WARNING


def test_a_prefix_may_be_declared_twice_alike() -> None:
    assert not lints("@prefix rob: <https://w3id.org/selfconf/robotics#> .\n:a a sc:Component, rob:Tuner .")


def test_a_literal_where_a_thing_is_wanted_is_noticed_in_every_known_ontology() -> None:
    assert only(':a a sc:Component, rob:Tuner ; rob:support "Astrid" .').code == "SC-L07"


@pytest.mark.parametrize("asked", ["sh:hasValue :p", "sh:in ( :hall :p )"])
def test_a_parameter_that_stands_for_a_literal_where_a_thing_is_wanted_is_noticed(asked: str) -> None:
    text = TEMPLATE + f":t sc:parameter :p . :r sh:property [ sh:path rob:place ; {asked} ] . :p a sc:Parameter ; "
    found = only(text + "sc:name 'p' ; sh:datatype xsd:string .")
    assert (found.code, found.hint) == ("SC-L07", "Say sh:nodeKind sh:IRI of :p in place of its sh:datatype.")
    assert not lints(text + "sc:name 'p' .")
    assert not lints(text.replace("rob:place", ":floor") + "sc:name 'p' ; sh:datatype xsd:integer .")


def test_a_label_is_a_literal_and_stays_one() -> None:
    assert not lints(':a a sc:Component, rob:Tuner ; rdfs:label "tuner" ; :note "x" .')


def test_what_is_wrong_with_a_template_hides_what_is_merely_strange_about_it() -> None:
    text = ":t a sc:Template ; sc:roles :r . :r a sc:Role ; sh:class rob:Lamp ."
    assert {each.code for each in lints(text)} == {"SC-T02"}


def test_a_signal_type_of_an_operation_is_passed_over_and_that_of_a_port_is_not() -> None:
    port = ':x a sc:Component, rob:Tuner ; sc:hasOutput [ sc:name "a" ; sc:signalType rob:Audio ] ;'
    for link in ("sc:hasOperation", "sc:needsOperation"):
        assert lints(f'{port} {link} [ sc:name "b" ; sc:request rob:Audio ] .') == []
        assert only(f'{port} {link} [ sc:name "b" ; sc:signalType rob:Audio ] .').code == "SC-L24"


def test_ports_in_parentheses_are_one_problem() -> None:
    ports = "[ sc:name 'a' ; sc:signalType rob:Audio ] [ sc:name 'b' ; sc:signalType rob:Audio ]"
    assert only(f":x a sc:Component, rob:Tuner ; sc:hasOutput ( {ports} ) .").code == "SC-A07"


@pytest.mark.parametrize(
    ("text", "owners"),
    [
        (":a a sc:Component, rob:Tuner ; sc:unit unit:M .", "a sc:Input or a sc:Output"),
        (":a a sc:Component, rob:Tuner ; sc:command 'python a.py' .", "a sc:Grounding"),
        (
            ":a a sc:Component, rob:Tuner ; sc:hasParameter [ sc:name 'p' ; sc:parameterType :P ; sc:depth 3 ] .",
            "a sc:Input",
        ),
        (
            ":a a sc:Component, rob:Tuner ; sc:hasOutput [ sc:name 'o' ; sc:signalType rob:Text ; sc:request :R ] .",
            "a sc:Operation",
        ),
        (
            ":a a sc:Component, rob:Tuner ; sc:grounding [ sc:command 'python a.py' ; sc:frame 'map' ] .",
            "a sc:Input or a sc:Output",
        ),
        (
            ":a a sc:Component, rob:Tuner ; sc:hasOutput [ sc:name 'o' ; sc:signalType rob:Text ; sc:value 30 ] .",
            "a rate or a duration, of what a role sets, and of a binding",
        ),
    ],
)
def test_what_is_said_of_another_part_of_an_advertisement_is_passed_over_and_told(text: str, owners: str) -> None:
    found = only(text)
    assert (found.code, found.severity, found.hint) == ("SC-L25", Severity.WARNING, f"It is said of {owners}.")


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        (":r sc:optional true .", "A role that may stay unplayed has sc:minCount 0."),
        (":r sc:output 'light' .", "It is said of a sc:Interaction."),
        (":r sc:rate [ sc:value 5 ; sc:unit <http://qudt.org/vocab/unit/HZ> ] .", "It is said of a sc:Output."),
        (":t sc:command 'python t.py' .", "It is said of a sc:Grounding."),
        (":t sc:template :t .", "It is said of a sc:Grounding or a sc:Task."),
        (
            ":t sc:parameter :p . :p a sc:Parameter ; sc:name 'p' ; sc:value 3 . :r sh:node [ sh:in ( :p ) ] .",
            "The default of a parameter is sh:defaultValue.",
        ),
        (
            ":k a sc:Task ; sc:template :t ; sc:parameter :p .",
            "A task has sc:binding [ sc:parameter ... ; sc:value ... ].",
        ),
        (
            ":a a sc:Component, rob:Lamp ; sc:parameter [ sc:name 'p' ; sc:parameterType :P ] .",
            "What is set of a component is its sc:hasParameter.",
        ),
    ],
)
def test_what_is_said_of_another_part_of_a_template_is_passed_over_and_told(text: str, hint: str) -> None:
    found = only(TEMPLATE + text)
    assert (found.code, found.hint) == ("SC-L25", hint)


@pytest.mark.parametrize(
    ("datatype", "value", "hint"),
    [
        ("integer", '"2"', "2"),
        ("integer", '"two"', "a number, such as 10"),
        ("boolean", '"true"', "true"),
        ("boolean", "1", "true"),
        ("boolean", '"0"', "false"),
        ("negativeInteger", "5", "a number, such as -10"),
        ("double", '"INF"', '"INF"^^xsd:double'),
        ("duration", '"P1D"', '"P1D"^^xsd:duration'),
        ("boolean", '"yes"', "true or false"),
        ("date", '"2026-01-31"', '"2026-01-31"^^xsd:date'),
        ("date", '"31.1.2026"^^xsd:date', 'it as in "2026-01-31"^^xsd:date'),
    ],
)
def test_a_literal_of_another_datatype_than_its_property_has_is_told(datatype: str, value: str, hint: str) -> None:
    declared = f":p a owl:DatatypeProperty ; rdfs:label 'p' ; rdfs:range xsd:{datatype} .\n"
    found = only(f"{declared}:a a sc:Component, rob:Tuner ; :p {value} .")
    assert (found.code, found.severity, found.hint) == ("SC-L26", Severity.WARNING, f"Write {hint}.")


def test_a_literal_of_one_of_the_datatypes_of_its_property_is_not_told() -> None:
    declared = ":p a owl:DatatypeProperty ; rdfs:label 'p' ; rdfs:range xsd:integer, xsd:date .\n"
    assert lints(f"{declared}:a a sc:Component, rob:Tuner ; :p 2, '2026-01-31'^^xsd:date .") == []


def test_the_literal_of_a_file_is_told_whose_property_another_file_declares() -> None:
    vocabulary = PREAMBLE + ":p a owl:DatatypeProperty ; rdfs:label 'p' ; rdfs:range xsd:integer ."
    texts = [SourceText("a.ttl", (PREAMBLE + ":a a sc:Component, rob:Tuner ; :p '2' .").encode())]
    ontologies = [*ONTOLOGIES, SourceText("v.ttl", vocabulary.encode())]
    assert [one.code for one in validate_texts(texts, SHAPES, ontologies).diagnostics] == ["SC-L26"]


@pytest.mark.parametrize(
    ("asked", "code", "at"),
    [
        ("sh:path rob:place ; sh:hasValue 'kitchen'", "SC-L07", "'kitchen'"),
        ("sh:path rob:place ; sh:in ( :hall 'kitchen' )", "SC-L07", "'kitchen'"),
        ("sh:path :p ; sh:maxInclusive '2'", "SC-L26", "'2'"),
        ("sh:path :p ; sh:in ( 1 '2' 3 )", "SC-L26", "'2'"),
    ],
)
def test_what_a_shape_asks_of_a_property_is_as_the_property_wants_it(asked: str, code: str, at: str) -> None:
    declared = ":p a owl:DatatypeProperty ; rdfs:label 'p' ; rdfs:range xsd:integer .\n"
    role = f":r sh:property [ {asked} ] ."
    found = only(declared + TEMPLATE + role)
    assert (found.code, found.line, found.column) == (code, HEAD + 3, role.index(at) + 1)


def test_what_a_shape_asks_of_a_longer_path_is_left_alone() -> None:
    asked = "sh:path ( rob:support rob:place ) ; sh:hasValue 'kitchen'"
    assert lints(f"{TEMPLATE}:r sh:property [ {asked} ] .") == []


@thorough
def test_a_list_of_thousands_may_be_asked_for() -> None:
    many = " ".join(f":p{number}" for number in range(3000))
    assert only(f"{TEMPLATE}:r sh:property [ sh:path rob:place ; sh:in ( {many} 'kitchen' ) ] .").code == "SC-L07"


COSTED = TEMPLATE + ":t sc:cost ( [ sc:term [ sc:property rob:latency ; {} ] ] ) ."
INSIDE = TEMPLATE + ":a a sc:Component, rob:Lamp ; sc:grounding {} ."


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        (COSTED.format("sc:role :r"), COSTED.format("sc:ofRole :r")),
        (COSTED.format("sc:of :r"), COSTED.format("sc:ofRole :r")),
        (INSIDE.format(":t"), INSIDE.format("[ sc:template :t ]")),
        (INSIDE.format("[ sc:task :t ]"), INSIDE.format("[ sc:template :t ]")),
        (
            TEMPLATE + ":r sc:signalType rob:Image .",
            TEMPLATE + ":r sh:property [ sh:path ( sc:hasOutput sc:signalType ) ; sh:hasValue rob:Image ] .",
        ),
        (
            TEMPLATE + ":r sc:parameterType :Goal .",
            TEMPLATE + ":r sh:property [ sh:path ( sc:hasParameter sc:parameterType ) ; sh:hasValue :Goal ] .",
        ),
        (
            TEMPLATE + ":r sc:feeds :r . [] a sc:Interaction ; sc:from :r ; sc:to :r ; sc:signalType rob:Image .",
            TEMPLATE + ":r sc:feeds :r . [] a sc:Interaction ; sc:from :r ; sc:to :r ; sc:output 'image' .",
        ),
    ],
)
def test_a_term_at_the_wrong_part_of_a_template_is_noticed_with_what_to_write(wrong: str, right: str) -> None:
    found = only(wrong)
    assert (found.code, found.hint is not None) == ("SC-L25", True)
    assert not lints(right)


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        (COSTED.replace("rob:latency ; {}", "rob:Camera"), COSTED.replace("rob:latency ; {}", "rob:power")),
        (COSTED.replace("rob:latency ; {}", "rob:place"), COSTED.replace("rob:latency ; {}", ":price")),
        (
            TEMPLATE + ":r sh:property [ sh:path rob:Place ; sh:minCount 1 ] .",
            TEMPLATE + ":r sh:property [ sh:path rob:place ; sh:minCount 1 ] .",
        ),
    ],
)
def test_what_is_no_property_or_counts_nothing_is_noticed_in_a_path_and_a_cost(wrong: str, right: str) -> None:
    assert only(wrong).code == "SC-L02"
    assert not lints(right)

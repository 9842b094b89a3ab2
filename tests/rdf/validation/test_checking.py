"""Validation: what it finds, where it finds it, and that files leave each other alone."""

from __future__ import annotations

import inspect
import sys
import time
from collections.abc import Iterable
from itertools import pairwise
from pathlib import Path

import pytest

from selfconf import library
from selfconf.errors import TurtleError
from selfconf.model.codes import CODES, PREAMBLE, Code
from selfconf.model.diagnostic import Diagnostic, Report, Severity
from selfconf.rdf.turtle import USUAL
from selfconf.rdf.validation import checking
from selfconf.rdf.validation.checking import SourceText, validate_texts
from tests.bad_files import BAD, checked, promised

ADVERTISEMENT = ":tuner a sc:Component, rob:Tuner .\n"


def load(path: Path) -> SourceText:
    return SourceText(str(path), path.read_bytes(), path.resolve().as_uri())


SHAPES = [load(path) for path in library.shapes()]
ONTOLOGIES = [load(path) for path in library.ontologies()]


def check(*texts: str, ontologies: Iterable[SourceText] = ()) -> Report:
    """Validate texts, which get the names 0.ttl, 1.ttl and so on and the usual prefixes."""
    sources = [SourceText(f"{number}.ttl", (PREAMBLE + text).encode()) for number, text in enumerate(texts)]
    return validate_texts(sources, SHAPES, [*ONTOLOGIES, *ontologies])


def found(report: Report) -> list[str]:
    """Line (counted from below the prefixes), column and code of each problem."""
    head = PREAMBLE.count("\n")
    return [f"{each.line - head}:{each.column} {each.code}" for each in report.diagnostics]


INSIDE = """
:radio-set a sc:Component, :Radio ; sc:grounding [ sc:template :play ] ;
    sc:hasInput [ sc:name "choice" ; sc:signalType rob:Text ] ;
    sc:hasOutput [ sc:name "sound" ; sc:signalType rob:Audio ] ;
    sc:hasOperation [ sc:name "mute" ; sc:response rob:Text ] .
:play a sc:Template ; sc:roles ( :source ) ;
    sc:hasInput [ sc:name "choice" ; sc:signalType rob:Text ; sc:of :source ] ;
    sc:hasOutput [ sc:name "sound" ; sc:signalType rob:Audio ; sc:of :source ] ;
    sc:hasOperation [ sc:name "mute" ; sc:response rob:Text ; sc:of :source ] .
:source a sc:Role ; sh:class rob:Tuner .
:tuner a sc:Component, rob:Tuner ; sc:hasInput [ sc:name "station" ; sc:signalType rob:Text ] ;
    sc:hasOutput [ sc:name "audio" ; sc:signalType rob:Audio ] ;
    sc:hasOperation [ sc:name "hush" ; sc:response rob:Text ] .
:now a sc:Configuration ; sc:template :play ; sc:insideOf :radio-set ;
    sc:assignment [ a sc:Assignment ; sc:role :source ; sc:component :tuner ] ;
    sc:connection [ a sc:Connection ; sc:from :tuner ; sc:output "audio" ; sc:to :radio-set ; sc:input "sound" ] ,
        [ a sc:Connection ; sc:from :tuner ; sc:output "hush()" ; sc:to :radio-set ; sc:input "mute()" ] ,
        [ a sc:Connection ; sc:from :radio-set ; sc:output "choice" ; sc:to :tuner ; sc:input "station" ] .
"""
"""What a composite is inside: its outputs hear what issues them, and its inputs feed what follows them."""


def test_a_configuration_inside_of_a_composite_is_connected_with_its_ports() -> None:
    assert {each.severity for each in check(INSIDE).diagnostics} <= {Severity.WARNING}


@pytest.mark.parametrize("port", ['sc:input "sound"', 'sc:input "mute()"', 'sc:output "choice"'])
def test_a_configuration_inside_of_a_composite_is_connected_with_no_port_that_it_does_not_have(port: str) -> None:
    report = check(INSIDE.replace(port, f'{port.partition(" ")[0]} "other"'))
    assert [each.code for each in report.diagnostics if each.severity is Severity.ERROR] == ["SC-C09"]


def test_a_configuration_that_is_inside_of_nothing_is_connected_with_nothing_outside() -> None:
    report = check(INSIDE.replace(" ; sc:insideOf :radio-set", ""))
    assert "SC-C06" in {each.code for each in report.diagnostics}


@pytest.mark.slow
@pytest.mark.parametrize("path", BAD, ids=lambda path: path.stem)
def test_a_bad_file_earns_what_its_first_line_says(path: Path) -> None:
    found = [f"{each.line}:{each.column} {each.severity.value}[{each.code}]" for each in checked(path).diagnostics]
    assert sorted(found) == sorted(promised(path))


@pytest.mark.parametrize(
    "code", [code for code in CODES if code.bad and code.language == "turtle"], ids=lambda code: code.code
)
def test_the_bad_example_of_a_code_earns_it_and_the_good_one_nothing(code: Code) -> None:
    bad, good = check(code.bad), check(code.good)
    assert {each.code for each in bad.diagnostics} == {code.code}
    assert not good.diagnostics


@pytest.mark.parametrize("path", [*library.ontologies(), *library.shapes()], ids=lambda path: path.stem)
def test_what_selfconf_brings_along_conforms(path: Path) -> None:
    assert not validate_texts([load(path)], SHAPES, ONTOLOGIES).diagnostics


def test_all_problems_are_reported_in_the_order_of_the_text() -> None:
    text = ':a a sc:Component ;\n sc:preference "x" .\n:b a rob:Tuner ; sc:hasInput 1 .\n[] a sc:Task .'
    assert found(check(text)) == ["1:1 SC-A03", "2:16 SC-A04", "3:1 SC-A02", "3:30 SC-A06", "4:1 SC-K01"]


def test_a_file_that_is_not_turtle_does_not_keep_others_from_being_checked() -> None:
    report = check(":a a sc:Component ;", ":b a sc:Component .", ADVERTISEMENT)
    assert [(each.file, each.code) for each in report.diagnostics] == [("0.ttl", "SC-S01"), ("1.ttl", "SC-A03")]
    assert report.unreadable == {"0.ttl"}
    assert not report.conforms


def test_every_syntax_error_of_a_file_is_reported() -> None:
    assert found(check(":a a , .\n:b :c :d .\n:e x:f :g .\n:h x:i :j .")) == ["1:6 SC-S01", "3:4 SC-S01"]


def test_bytes_that_are_not_utf_8_are_placed() -> None:
    (problem,) = validate_texts(
        [SourceText("a.ttl", "# ä\n:a :b ".encode() + b"\xe4 .")], SHAPES, ONTOLOGIES
    ).diagnostics
    assert (problem.line, problem.column, problem.code) == (2, 7, "SC-S02")


def test_a_byte_order_mark_is_allowed() -> None:
    source = SourceText("a.ttl", b"\xef\xbb\xbf" + (PREAMBLE + ADVERTISEMENT).encode())
    assert not validate_texts([source], SHAPES, ONTOLOGIES).diagnostics


def test_a_file_cannot_bring_shapes_that_judge_another() -> None:
    shape = ":mine a sh:NodeShape ; sh:targetClass rob:Tuner ; sh:property [ sh:path rob:place ; sh:minCount 1 ] ."
    assert not check(shape, ADVERTISEMENT).errors


def test_a_file_cannot_bring_axioms_that_judge_another() -> None:
    axiom = "rob:Tuner rdfs:subClassOf sc:Template . sc:Component rdfs:subClassOf sc:Template ."
    assert not [each for each in check(axiom, ADVERTISEMENT).diagnostics if each.file == "1.ttl"]


def test_two_files_that_speak_of_one_port_do_not_add_up() -> None:
    first = ':tuner a sc:Component, rob:Tuner ; sc:hasOutput :out . :out sc:name "a" ; sc:signalType rob:Audio .'
    second = ':radio a sc:Component, rob:Tuner ; sc:hasOutput :out . :out sc:name "b" ; sc:signalType rob:Audio .'
    assert not check(first, second).diagnostics


def test_a_component_that_two_files_describe_is_an_error_in_the_second() -> None:
    (problem,) = check(ADVERTISEMENT, "\n" + ADVERTISEMENT).diagnostics
    assert (problem.file, problem.code) == ("1.ttl", "SC-L04")
    assert "0.ttl" in problem.message


LAMPS = ":lamps a sc:Template ; sc:roles ( :lamp ) . :lamp a sc:Role ; sh:class rob:Lamp ; {} ."
ROOM = "sh:property [ sh:path rob:place ; sh:in ( {} ) ]"


def test_a_template_that_two_files_describe_differently_has_a_warning_in_the_second() -> None:
    one, two = LAMPS.format(ROOM.format(":hall")), LAMPS.format(ROOM.format(":kitchen"))
    assert [(found.file, found.code) for found in check(one, two).diagnostics] == [("1.ttl", "SC-L31")]
    (found,) = check(two, "\n" + one, two).diagnostics
    assert (found.file, found.line) == ("1.ttl", PREAMBLE.count("\n") + 2)
    assert "0.ttl" in found.message


def test_copies_of_a_template_in_files_of_tasks_and_of_advertisements_are_no_mistake() -> None:
    template = LAMPS.format(ROOM.format(":hall"))
    task = ":evening a sc:Task ; sc:template :lamps ."
    inside = ":lights a sc:Component, :Lights ; sc:grounding [ sc:template :lamps ] ."
    labelled = template + ' :lamps rdfs:label "lamps"@en . :hall a :Room .'
    assert not check(template, template + task, template + inside, labelled).diagnostics


def test_an_advertisement_needs_no_port_no_label_and_no_known_type() -> None:
    assert check(":a a sc:Component, <https://example.org/else#Thing> .").conforms


def test_a_signal_type_is_known_if_a_given_ontology_declares_it() -> None:
    text = ':a a sc:Component, rob:Tuner ; sc:hasOutput [ sc:name "x" ; sc:signalType <urn:my:Noise> ] .'
    ontology = SourceText("my.ttl", b"<urn:my:Noise> a <http://www.w3.org/2002/07/owl#Class> .")
    assert [each.code for each in check(text).diagnostics] == ["SC-L03"]
    assert not check(text, ontologies=[ontology]).diagnostics


def test_a_signal_type_is_known_if_another_file_of_the_run_declares_it() -> None:
    text = ':a a sc:Component, rob:Tuner ; sc:hasOutput [ sc:name "x" ; sc:signalType :Noise ] .'
    assert not check(text, ':Noise a owl:Class ; rdfs:label "noise" .').diagnostics


@pytest.mark.parametrize(
    "ontology",
    [
        ":Noise a owl:Class ; rdfs:label 'noise' .",
        ":Noise rdfs:subClassOf rob:Audio ; rdfs:label 'noise' .",
        ":Sound a owl:Class ; rdfs:label 'sound' . :Noise rdfs:comment 'a sound that is not liked' .",
        ":Sound a owl:Class ; rdfs:label 'sound' .",
        ":hears rdfs:subPropertyOf rob:support .",
        "rdfs:comment rdfs:comment 'says nothing of noise' .",
    ],
)
@pytest.mark.parametrize("signal", [":Noise", ":Noize"])
def test_an_ontology_is_known_alike_given_as_such_or_validated_beside(ontology: str, signal: str) -> None:
    text = f':a a sc:Component, rob:Tuner ; :volume 3 ; sc:hasOutput [ sc:name "x" ; sc:signalType {signal} ] .'
    given = check(text, ontologies=[SourceText("my.ttl", (PREAMBLE + ontology).encode())])
    beside = check(text, ontology)
    assert [each for each in beside.diagnostics if each.file == "0.ttl"] == list(given.diagnostics)


def test_a_class_without_a_namespace_covers_none() -> None:
    ontology = SourceText("my.ttl", b"<urn:Noise> a <http://www.w3.org/2002/07/owl#Class> .")
    assert not check(":a a sc:Component, <urn:Kind> .", ontologies=[ontology]).diagnostics


def test_an_ontology_that_is_not_turtle_is_refused_by_name() -> None:
    with pytest.raises(TurtleError, match=r"my\.ttl:1:1: "):
        check(ADVERTISEMENT, ontologies=[SourceText("my.ttl", b"a .")])


def test_an_ontology_that_is_not_utf_8_is_refused_by_name() -> None:
    with pytest.raises(TurtleError, match=r"my\.ttl:1:5: .*UTF-8"):
        check(ADVERTISEMENT, ontologies=[SourceText("my.ttl", b"<urn\xff> .")])


def test_a_parameter_may_stand_wherever_its_value_will_stand() -> None:
    text = """
:t a sc:Template ; sc:roles ( :r ) ; sc:parameter :n, :least, :room, :words, :any .
:n a sc:Parameter ; sc:name "n" ; sh:datatype xsd:integer .
:least a sc:Parameter ; sc:name "least" ; sh:datatype xsd:double ; sh:defaultValue 0.5e0 .
:room a sc:Parameter ; sc:name "room" ; sh:nodeKind sh:IRI .
:words a sc:Parameter ; sc:name "words" ; sh:datatype xsd:string .
:any a sc:Parameter ; sc:name "any" .
:r a sc:Role ; sh:class rob:Lamp ;
    sh:property [ sh:path rob:place ; sh:hasValue :room ; sh:minCount :n ] ,
        [ sh:path rdfs:label ; sh:pattern :words ; sh:maxCount :any ] ,
        [ sh:path :brightness ; sh:minInclusive :least ] .
"""
    assert not check(text).diagnostics


@pytest.mark.parametrize(
    ("shape", "column"),
    [
        ("sh:class 5", 10),
        ("sh:minCount 1", 1),
        ("sh:property 5", 13),
        ("sh:property [ sh:minCount 1 ]", 13),
        ("sh:property [ sh:path ( rob:place ) ]", 23),
        ("sh:or :x", 7),
        ("sh:node 5", 9),
        ("sh:property [ sh:path rob:place ; sh:minInclusive :x ]", 51),
    ],
)
def test_a_role_that_is_no_shape_is_reported(shape: str, column: int) -> None:
    text = f":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class rob:Lamp .\n:r\n{shape} ."
    problems = check(text).diagnostics
    assert problems
    assert {problem.code for problem in problems} == {"SC-T13"}
    head = PREAMBLE.count("\n")
    places = [(problem.line - head, problem.column) for problem in problems]
    assert (3, column) in places or (column == 1 and places == [(1, 38)])


def test_a_misspelt_term_comes_with_what_was_probably_meant() -> None:
    (problem,) = check(":t a sc:Component, rob:Tuner ; sc:prefernce 5 .").diagnostics
    assert problem.hint == "Did you mean sc:preference?"
    assert problem.severity is Severity.ERROR
    assert problem.width == len("sc:prefernce")


def test_two_diagnostics_are_equal_whatever_line_they_show() -> None:
    assert Diagnostic("a", 1, 1, "SC-S01", "x", source="y") == Diagnostic("a", 1, 1, "SC-S01", "x")


def test_a_file_with_a_nul_is_no_turtle_at_the_place_of_the_nul() -> None:
    text = b'# a note\n<urn:x:a> <urn:x:p> "a\x00b" .\n'
    report = validate_texts([SourceText("nul.ttl", text)], SHAPES, ONTOLOGIES)
    assert [(found.line, found.column, found.code) for found in report.diagnostics] == [(2, 23, "SC-S01")]
    assert report.unreadable == {"nul.ttl"}


@pytest.mark.slow
def test_a_chain_of_roles_conforms_however_long_it_is() -> None:
    check(":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class rob:Tuner .")  # loads what is loaded once
    names = [f":r{number}" for number in range(150)]
    chain = "".join(f"{one} sc:feeds {after} .\n" for one, after in pairwise(names))
    roles = "".join(f"{one} a sc:Role ; sh:class rob:Tuner .\n" for one in names)
    text = f"{PREAMBLE}:t a sc:Template ; sc:roles ( {' '.join(names)} ) .\n{chain}{roles}"
    limit = sys.getrecursionlimit()
    sys.setrecursionlimit(len(inspect.stack(0)) + 100)  # a call within a call for each role would need more
    try:
        assert not validate_texts([SourceText("t.ttl", text.encode())], SHAPES, ONTOLOGIES).diagnostics
    finally:
        sys.setrecursionlimit(limit)


def test_a_foreign_vocabulary_is_told_once_in_a_run_and_costs_no_check(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(checking, "MOST_STATEMENTS", 1)  # no file is checked in full
    ports = " , ".join(f'[ sc:name "{n}" ; sc:signalType <urn:my#T{n % 3}> ]' for n in range(30))
    files = [f":a{n} a sc:Component, rob:Tuner ; sc:hasOutput {ports} ." for n in range(3)]
    (problem,) = check(*files).diagnostics
    assert (problem.file, problem.code, problem.column) == ("0.ttl", "SC-L03", files[0].index("<urn:my#T0>") + 1)
    assert "<urn:my#>" in problem.message


def test_a_literal_that_cannot_be_read_is_told_at_its_place_and_loses_no_other_file() -> None:
    large = f':a a sc:Component, rob:Tuner ;\n rdfs:label "{"x" * (17 << 20)}" .'
    problems = check(large, ":a a sc:Component .").diagnostics
    assert [(found.file, found.code) for found in problems] == [("0.ttl", "SC-S05"), ("1.ttl", "SC-A03")]
    assert problems[0].column == 13
    assert len(problems[0].source) < 1_000


def test_many_problems_on_one_long_line_take_little_memory() -> None:
    text = " ".join(f":a{n} a sc:Component, rob:Tuneer ." for n in range(400))
    problems = check(text).diagnostics
    assert len(problems) == 400
    kept = {id(each): sys.getsizeof(each) for one in problems for each in (one.source, one.message, one.hint)}
    assert sum(kept.values()) < 400 << 10  # the line with each of them would take 6 MiB


def test_problems_on_one_long_line_take_as_long_each_however_many_there_are() -> None:
    def seconds(size: int) -> float:
        began = time.process_time()
        assert len(check(" ".join(f":a{n} a sc:Component, rob:Tuneer ." for n in range(size))).diagnostics) == size
        return time.process_time() - began

    # 8 times, or 64 if it were quadratic; on a machine that others use too, one in five runs at least is not held up
    few = min(seconds(60), seconds(60))
    assert any(seconds(480) < 20 * few + 0.1 for _ in range(5))


@pytest.mark.parametrize("link", ["rdfs:subPropertyOf", "owl:equivalentProperty"])
def test_a_property_may_lie_below_the_inverse_of_another(link: str) -> None:
    assert not check(f':in a owl:ObjectProperty ; rdfs:label "in" ; {link} [ owl:inverseOf rob:place ] .').diagnostics


def test_a_word_of_a_vocabulary_of_others_is_not_taken_for_a_standard_one() -> None:
    words = SourceText("spec.ttl", b"<urn:spec#kind> a <http://www.w3.org/2002/07/owl#DatatypeProperty> .")
    (problem,) = check(":a a sc:Component, rob:Tuner ; <urn:spec#class> 1 .", ontologies=[words]).diagnostics
    assert (problem.code, problem.hint) == ("SC-L02", None)


USUAL_PREFIXES = "".join(
    f"@prefix {prefix}: <{namespace.base}> .\n" for prefix, namespace in USUAL.items() if prefix != "unit"
)
FRIDGE = """@prefix : <https://example.org/home#> .
:fridge a sc:Component, rob:Thermometer ;
    rdfs:label "Fridge" ;
    rob:place :kitchen ;
    sc:hasOutput [ sc:name "t" ; sc:signalType rob:Temperature ] .
"""


def slips(text: str) -> list[tuple[int, str, str | None]]:
    """Line below the prefixes, message and hint of each problem."""
    head = USUAL_PREFIXES.count("\n")
    report = validate_texts([SourceText("a.ttl", (USUAL_PREFIXES + text).encode())], [], [])
    return [(each.line - head, each.message, each.hint) for each in report.diagnostics if each.code == "SC-S01"]


@pytest.mark.parametrize(
    ("right", "wrong", "line", "advice"),
    [
        ("] .\n", "]\n", 6, "the dot after the last statement is missing"),
        ('"Fridge" ;', '"Fridge"', 4, "a semicolon is missing"),
        (":kitchen ;", ":kitchen .", 5, "should be a semicolon"),
        ('"t" ; sc', '"t" , sc', 5, "the closing ] is missing"),
        ("rob:Temperature ]", "rob:Temperature", 5, "the closing ] is missing"),
        ('"Fridge"', '"Fridge', 3, "the closing quotation mark is missing"),
        ('"Fridge"', "“Fridge”", 3, "straight"),
        ("rob:place", "unit:place", 4, "Write @prefix unit: <http://qudt.org/vocab/unit/> ."),
        ("rob:place", "my:place", 4, "Write @prefix my: <...> ."),
        (":kitchen", "( :kitchen , :hall )", 4, "without commas"),
        (":kitchen", "<https://example.org/living room>", 4, "a blank is written %20"),
        ("a sc:Component", "is sc:Component", 2, "A predicate is an IRI or a"),
    ],
)
def test_a_slip_is_told_once_with_what_to_try(right: str, wrong: str, line: int, advice: str) -> None:
    assert right in FRIDGE
    ((found, _, hint),) = slips(FRIDGE.replace(right, wrong))
    assert found == line
    assert hint is not None
    assert advice in hint


def test_a_prefix_that_is_used_twice_is_missed_once_and_two_are_missed_both() -> None:
    text = "<urn:a> x:b x:c . <urn:a> y:b x:c ."
    assert [message.split()[6] for _, message, _ in slips(text)] == ["x:", "y:"]


def test_mistakes_on_different_lines_are_all_told() -> None:
    assert [line for line, _, _ in slips("rdf:a rdf:b , .\nrdf:a rdf:b rdf:c .\nrdf:a rdf:b , .\n")] == [1, 3]

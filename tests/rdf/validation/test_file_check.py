"""The check of one file: every problem with its place, also of what cannot be read or takes too long."""

from __future__ import annotations

import pytest

from selfconf import library
from selfconf.composition import Inside
from selfconf.errors import AuthorError
from selfconf.model.diagnostic import Diagnostic
from selfconf.model.hierarchy import NOTHING_ABOVE
from selfconf.rdf.advertisements import read_advertisements
from selfconf.rdf.tasks import InsideReader
from selfconf.rdf.turtle import parse
from selfconf.rdf.validation import file_check
from selfconf.rdf.validation.checking import SourceText, UnclearedFile
from selfconf.rdf.validation.file_check import problems_of, shapes_of
from selfconf.rdf.validation.prefilter import prefilter
from selfconf.rdf.validation.term_index import index_of
from tests.lab import PREFIXES
from tests.shipped import shipped_shapes

HEAD = PREFIXES.count("\n")
INDEX = index_of([prefilter(path.read_bytes()) for path in library.ontologies()])
LAMP = ":lamp a sc:Component, :Lamp .\n"
TASK = (
    ":t a sc:Template ; sc:roles ( :r ) ; sc:parameter :p .\n"
    ':p a sc:Parameter ; sc:name "p" ; sh:nodeKind sh:IRI .\n'
    ":r a sc:Role ; sh:class :Lamp ; sh:property [ sh:path :in ; sh:in ( :p ) ] {} .\n"
    ":k a sc:Task ; sc:template :t ; sc:binding [ sc:parameter :p ; sc:value {} ] ."
)


def found(text: str, prefixes: str = PREFIXES, elsewhere: dict[str, str] | None = None) -> list[Diagnostic]:
    """The problems of a file, which stands alone but for what is described elsewhere as well."""
    source = SourceText("a.ttl", (prefixes + text).encode(), "file:///a.ttl")
    return problems_of(UnclearedFile(source, elsewhere or {}), shipped_shapes(), INDEX)


def told(text: str) -> list[tuple[str, int, int]]:
    """Code, line below the prefixes and column of each problem of a file."""
    return sorted((each.code, each.line - HEAD, each.column) for each in found(text))


def test_a_file_that_is_right_has_no_problems() -> None:
    assert found(LAMP) == []


def test_an_empty_file_has_no_problems() -> None:
    assert found("", prefixes="") == []


def test_a_violation_of_a_shape_is_at_the_value_that_breaks_it() -> None:
    assert told(f'{LAMP}:lamp sc:preference "high" .') == [("SC-A04", 2, 21)]


def test_violations_of_shapes_and_of_words_are_both_told() -> None:
    assert [code for code, _, _ in told(f'{LAMP}:lamp sc:preference "high" ; sc:preferense 1 .')] == [
        "SC-A04",
        "SC-L01",
    ]


def test_an_unfit_value_of_a_task_is_told_beside_other_mistakes() -> None:
    text = TASK.format("; sc:minCount 2 ; sc:maxCount 1", '"kitchen"')
    assert [code for code, _, _ in told(text)] == ["SC-K02", "SC-T12"]


def test_of_a_binding_of_several_values_none_is_told_to_be_unfit() -> None:
    assert [each.message for each in found(TASK.format("", '"kitchen" , :hall'))] == [
        "A binding has exactly one sc:value."
    ]


def test_what_is_not_turtle_is_one_problem_where_reading_ends() -> None:
    (only,) = found(f"{LAMP}:lamp :p ;; . :bell\n")
    assert (only.code, only.file) == ("SC-S01", "a.ttl")
    assert only.message.startswith("This is not Turtle 1.1: ")


def test_a_list_without_an_end_is_not_given_to_the_shapes() -> None:
    text = ":t a sc:Template ; sc:roles _:a . _:a rdf:first :r ; rdf:rest _:a ."
    prefixes = PREFIXES + "@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> .\n"
    assert [each.code for each in found(text, prefixes) if each.code.startswith("SC-S")] == ["SC-S06"]


def test_what_nests_too_deeply_is_told_instead_of_checked() -> None:
    depth = 2_000
    (only,) = found(":a :p " + "[ :p " * depth + "1" + " ]" * depth + " .")
    assert only.code == "SC-S05"


def test_a_check_that_takes_too_long_ends_and_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(file_check, "FILE_SECONDS", 0.01)
    (only,) = found("\n".join(f":lamp{number} a sc:Component, :Lamp ." for number in range(500)))
    assert only.code == "SC-S05"
    assert only.message.startswith("This file takes more than 0.01 seconds of processor time")


def test_a_component_that_another_file_describes_as_well_is_told_with_that_file() -> None:
    elsewhere = {"https://example.org/peis-home#lamp": "b.ttl"}
    (only,) = found(LAMP, elsewhere=elsewhere)
    assert "b.ttl" in only.message


def test_shapes_are_read_once_for_the_same_texts() -> None:
    texts = [path.read_text("utf-8") for path in library.shapes()]
    assert shapes_of(*texts) is shapes_of(*texts)


@pytest.mark.parametrize(
    ("inside", "outside", "same"),
    [
        ("sc:hasOutput [ {} sc:signalType :A , :B ]", "sc:hasOutput [ {} sc:signalType :B , :A ]", True),
        ("sc:hasOutput [ {} sc:signalType :A , :B ]", "sc:hasOutput [ {} sc:signalType :A ]", False),
        ("sc:hasInput [ {} sc:signalType :A ]", "sc:hasInput [ {} sc:signalType :A , :B ]", False),
        ("sc:hasInput [ {} sc:signalType :A ]", "sc:hasInput [ {} ]", False),
        ("sc:hasInput [ {} sc:signalType :A ]", "sc:hasInput [ {} sc:signalType :A ; sc:optional true ]", True),
        (
            "sc:hasOutput [ {} sc:signalType :A ; sc:unit :C ]",
            "sc:hasOutput [ {} sc:signalType :A ; sc:unit :F ]",
            False,
        ),
        ("sc:hasInput [ {} sc:signalType :A ; sc:unit :C ]", "sc:hasInput [ {} sc:signalType :A ; sc:unit :F ]", False),
        (
            "sc:hasInput [ {} sc:signalType :A ; sc:frame :h ]",
            "sc:hasInput [ {} sc:signalType :A ; sc:frame :i ]",
            False,
        ),
        ("sc:hasInput [ {} sc:signalType :A ; sc:unit :C ]", "sc:hasInput [ {} sc:signalType :A ; sc:frame :h ]", True),
        (
            "sc:hasOutput [ {} sc:signalType :A ; sc:unit :C ]",
            "sc:hasOutput [ {} sc:signalType :A ; sc:unit :C ]",
            True,
        ),
        ("sc:hasOutput [ {} sc:signalType :A ]", "sc:hasOutput [ {} sc:signalType :A ; sc:unit :F ]", True),
        ("sc:hasOperation [ {} sc:request :A ]", "sc:hasOperation [ {} sc:request :A ]", True),
        ("sc:needsOperation [ {} sc:request :A ]", "sc:needsOperation [ {} sc:response :A ]", False),
        ("sc:hasOperation [ {} ]", "sc:hasOperation [ {} sc:response :A ]", False),
    ],
)
def test_a_composite_has_the_types_and_units_of_its_template_as_whoever_configures_it_asks(
    inside: str, outside: str, same: bool
) -> None:
    name = 'sc:name "p" ;'
    text = (
        f":t a sc:Template ; sc:roles ( :r ) ; {inside.format(f'{name} sc:of :r ;')} .\n:r a sc:Role ; sh:class :R .\n"
        f":c a sc:Component, :C ; sc:grounding [ sc:template :t ] ; {outside.format(name)} .\n"
    )
    assert ("SC-A22" not in [code for code, _, _ in told(text)]) is same
    assert has_an_inside(text) is same


BOUND = "sc:grounding [ sc:template :t ; sc:binding [ sc:parameter :p ; sc:value 5 ] ]"
UNBOUND = "sc:grounding [ sc:template :t ]"
SETTABLE = 'sc:hasParameter [ sc:name "p" ; sc:parameterType :P ]'


@pytest.mark.parametrize(
    ("role", "parameter", "composite", "good"),
    [
        ("", "", BOUND, True),
        ("", "", UNBOUND, False),
        ("", "; sh:defaultValue 5", UNBOUND, True),
        ("", "", f"{UNBOUND} ; {SETTABLE}", True),
        ("", "", f"{BOUND} ; {SETTABLE}", False),
        ("; sh:property [ sh:path :q ; sh:in ( :p ) ]", "", UNBOUND, True),
        ("; sh:or ( [ sh:property [ sh:path :q ; sh:hasValue :p ] ] [ sh:class :S ] )", "", UNBOUND, True),
        ("; sc:recruits [ sh:property [ sh:path :q ; sh:hasValue :p ] ]", "", UNBOUND, False),
        ("; sc:feeds :r", "", UNBOUND, False),
    ],
)
def test_a_composite_gives_the_parameters_of_its_template_one_value_as_its_site_asks(
    role: str, parameter: str, composite: str, good: bool
) -> None:
    text = (
        f':t a sc:Template ; sc:roles ( :r ) ; sc:parameter :p .\n:p a sc:Parameter ; sc:name "p" {parameter} .\n'
        f":r a sc:Role ; sh:class :R ; sc:sets [ sc:parameterType :P ; sc:value :p ] {role} .\n"
        f":c a sc:Component, :C ; {composite} .\n"
    )
    assert ("SC-A22" not in [code for code, _, _ in told(text)]) is good
    assert has_an_inside(text) is good


def has_an_inside(text: str) -> bool:
    """Whether the composite of a document is taken by what configures its inside."""
    ((composite,), _) = read_advertisements((PREFIXES + text).encode(), "a.ttl")
    try:
        Inside.of(composite.profile, InsideReader(parse(PREFIXES + text, "a.ttl")), NOTHING_ABOVE)
    except AuthorError:
        return False
    return True

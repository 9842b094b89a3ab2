"""Violations of the shapes: as few shapes as may find something, and each violation where its author looks for it."""

from __future__ import annotations

import pytest
from rdflib import SH, Graph, URIRef

from selfconf.model.diagnostic import Severity
from selfconf.rdf.positions import parse_with_positions
from selfconf.rdf.validation.shape_violations import reported_violations, shape_violations
from selfconf.rdf.vocabulary import SHAPES as NAMES
from tests.lab import PREFIXES
from tests.shipped import shipped_shapes

SHAPES = shipped_shapes()
HEAD = PREFIXES.count("\n")
LAMP = ":lamp a sc:Component, :Lamp .\n"
PORT = '[ sc:name "{}" ; sc:signalType :S ]'


def told(text: str) -> list[tuple[int, int, str]]:
    """Line below the prefixes, column and shape of each violation of a text, in the order of the text."""
    graph, positions = parse_with_positions(PREFIXES + text, "a.ttl")
    found = shape_violations(graph, positions, SHAPES)
    return sorted((each.line - HEAD, each.column, (each.shape or "").removeprefix(NAMES.base)) for each in found)


def needed(text: str) -> set[str]:
    """The shapes with targets that a text may violate."""
    shapes = SHAPES.needed(Graph().parse(data=PREFIXES + text, format="turtle"))
    return {str(shape).removeprefix(NAMES.base) for shape in shapes}


def test_what_conforms_has_no_violations() -> None:
    assert told(LAMP) == []


@pytest.mark.parametrize(
    ("text", "at"),
    [
        (':lamp sc:preference "high" .', (2, 21)),
        (":lamp sc:preference 1 , 2 .", (2, 25)),
        (":lamp sc:hasInput [ sc:signalType :S ] .", (2, 19)),
        (f":lamp sc:hasInput {PORT.format('a')} , {PORT.format('a')} .", (2, 66)),
        (":bell sc:hasInput 5 .", (2, 19)),
    ],
    ids=["the wrong value", "the second of two", "the node that lacks", "the second name", "the literal"],
)
def test_a_violation_is_where_its_author_would_look_for_it(text: str, at: tuple[int, int]) -> None:
    assert at in [(line, column) for line, column, _ in told(LAMP + text)]


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        (f":bell a sc:Component, :B ; sc:hasInput ( {PORT.format('a')} {PORT.format('b')} ) .", "These are no list"),
        (f":bell a sc:Component, :B ; sc:hasInput {PORT.format('a')[:-1]} ; sc:shareable true ] .", "of the component"),
        (":bell a sc:Component, :B ; sc:feeds :lamp .", "say it of a role, in a template"),
    ],
)
def test_a_violation_tells_what_to_do_where_its_shape_alone_would_mislead(text: str, hint: str) -> None:
    graph, positions = parse_with_positions(PREFIXES + LAMP + text, "a.ttl")
    (found,) = shape_violations(graph, positions, SHAPES)
    assert hint in (found.hint or "")


@pytest.mark.parametrize("counts", ["sc:minCount [ ]", "sc:minCount 1 ; sc:maxCount [ ]", "sc:maxCount ( 1 )"])
def test_brackets_that_stand_for_a_number_are_a_violation(counts: str) -> None:
    """pySHACL cannot compare a blank node."""
    assert {"MinCount", "MaxCount"} & {shape for _, _, shape in told(f":r a sc:Role ; {counts} .")}


@pytest.mark.parametrize(
    ("counts", "shapes"),
    [
        ('sc:minCount "1" ; sc:maxCount 2', ["MinCount"]),
        ("sc:minCount 1 ; sc:maxCount :few", ["MaxCount"]),
        ("sc:minCount 2, 3 ; sc:maxCount 1", ["MinCount"]),
        ("sc:minCount 2 ; sc:maxCount 1", ["CountOrder"]),
    ],
)
def test_counts_that_are_none_are_not_compared(counts: str, shapes: list[str]) -> None:
    assert [shape for _, _, shape in told(f":r a sc:Role ; {counts} .")] == shapes


PLAY = ':t a sc:Template ; sc:roles ( :r ) ; sc:parameter :p . :p a sc:Parameter ; sc:name "p" . :r a sc:Role {} .\n'
TASK = PLAY.format("") + ":k a sc:Task ; sc:template :t ; sc:binding {} ."


@pytest.mark.parametrize(
    ("text", "only"),
    [
        (':t a sc:Template ; sc:roles ( "r" ) .', (1, 31, "RoleIri")),
        (':t a sc:Template ; sc:roles ( :r ) ; sc:parameter "p" . :r a sc:Role .', (1, 51, "ParameterIri")),
        (PLAY.format("; sc:minCount :p"), (1, 117, "FixedValue")),
        (PLAY.format("") + ":t sc:priority :p .", (2, 16, "FixedValue")),
        (PLAY.format("; sc:sets :p"), (1, 113, "SettingNode")),
        (TASK.format(":p"), (2, 44, "BindingNode")),
        (TASK.format('[ sc:parameter "p" ; sc:value 1 ]'), (2, 59, "BindingParameterIri")),
        (
            PLAY.format("") + ':t sc:hasInput [ sc:name "i" ; sc:signalType :S ; sc:of :x ] .',
            (2, 57, "TemplatePortRole"),
        ),
    ],
)
def test_one_mistake_is_one_violation(text: str, only: tuple[int, int, str]) -> None:
    assert told(text) == [only]


@pytest.mark.parametrize("roles", [":r , :q", "( )", ":r"])
@pytest.mark.parametrize(
    "said",
    [
        "[] a sc:Interaction ; sc:from :r ; sc:to :q",
        ":t sc:cost ( [ sc:term [ sc:property :p ; sc:ofRole :q ] ] )",
        ':t sc:hasInput [ sc:name "i" ; sc:signalType :S ; sc:of :q ]',
    ],
)
def test_where_the_roles_are_no_list_only_that_is_told(roles: str, said: str) -> None:
    found = told(f":t a sc:Template ; sc:roles {roles} . :r a sc:Role . :q a sc:Role .\n{said} .")
    assert [line for line, _, _ in found] == [1]


@pytest.mark.parametrize(
    "said", [":lamp sc:tolerates ( 5 )", ":r a sc:Role ; sc:sets ( [ ] )", ":lamp sc:hasParameter ( [ ] )"]
)
def test_a_list_for_a_node_in_brackets_is_one_violation(said: str) -> None:
    assert len(told(f"{LAMP}{said} .")) == 1


def test_two_lists_for_nodes_are_two_violations() -> None:
    assert len(told(f"{LAMP}:lamp sc:hasParameter ( [ ] ) , ( [ ] ) .")) == 2


@pytest.mark.parametrize("link", ["sc:hasOperation", "sc:needsOperation"])
def test_of_two_operations_of_one_name_the_second_is_to_blame(link: str) -> None:
    text = f'{LAMP}:lamp {link} [ sc:name "on" ] ,\n[ sc:name "on" ] .'
    assert told(text) == [(3, 11, "OperationNamesDistinct")]


def test_of_two_outputs_of_a_template_of_one_name_the_second_is_to_blame() -> None:
    port = '[ sc:name "o" ; sc:signalType :S ; sc:of :r ]'
    assert told(f"{PLAY.format('')}:t sc:hasOutput {port} ,\n{port} .") == [(3, 11, "TemplatePortNamesDistinct")]


def test_of_three_equal_names_the_first_is_not_to_blame() -> None:
    ports = " , ".join(PORT.format("a") for _ in range(3))
    assert [shape for _, _, shape in told(f"{LAMP}:lamp sc:hasInput {ports} .")] == ["PortNamesDistinct"] * 2


def test_a_diagnostic_names_its_code_its_shape_and_how_bad_it_is() -> None:
    graph, positions = parse_with_positions(f'{PREFIXES}{LAMP}:lamp sc:preference "high" .', "a.ttl")
    (only,) = shape_violations(graph, positions, SHAPES)
    assert (only.code, only.severity, only.file) == ("SC-A04", Severity.ERROR, "a.ttl")
    assert (only.shape or "").startswith(NAMES.base)


def test_only_shapes_with_a_target_in_the_file_are_needed() -> None:
    assert needed(":a :p :b .") == set()
    lamp, role = needed(LAMP), needed(":r a sc:Role .")
    assert lamp
    assert role
    assert not lamp & role
    assert needed(LAMP + ":r a sc:Role .") == lamp | role


def test_where_classes_have_classes_above_all_shapes_of_classes_are_needed() -> None:
    classes = {shape for shape, kind, _ in SHAPES.targets if kind == SH.targetClass}
    assert len(needed(":Lamp rdfs:subClassOf :Light .")) >= len(classes) - 4


def test_queries_about_names_are_asked_only_where_a_name_is_there_twice() -> None:
    two = f"{LAMP}:lamp sc:hasInput {PORT.format('a')} , " + PORT
    assert "PortNamesDistinct" not in needed(two.replace("{}", "b") + " .")
    assert "PortNamesDistinct" in needed(two.replace("{}", "a") + " .")


def test_the_needed_shapes_of_two_files_alike_are_the_same() -> None:
    graphs = [Graph().parse(data=PREFIXES + LAMP.replace("lamp", name), format="turtle") for name in ("a", "b")]
    assert SHAPES.needed(graphs[0]) == SHAPES.needed(graphs[1])


def test_the_needed_shapes_find_what_all_shapes_find() -> None:
    text = (
        f'{PREFIXES}{LAMP}:lamp sc:preference "high" ; sc:hasInput 5 . :t a sc:Template . :r a sc:Role ; sc:feeds 1 .'
    )
    graph = Graph().parse(data=text, format="turtle")
    few, every = (
        {(found.shape, found.focus, found.value) for found in reported_violations(graph, SHAPES.read, only)}
        for only in (SHAPES.needed(graph), None)
    )
    assert few == every
    assert URIRef(NAMES.Component) not in {shape for shape, _, _ in few}

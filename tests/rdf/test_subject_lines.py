"""The lines of subjects, found without a parser, are those that the parser with positions finds."""

from __future__ import annotations

from pathlib import Path

import pytest
from rdflib import URIRef

from selfconf.rdf.positions import NotTurtleError, parse_with_positions
from selfconf.rdf.subject_lines import subject_lines

ROOT = Path(__file__).parents[2]
FOLDERS = ("examples", "ontology", "shapes", "benchmarks", "tests")


def parsed(text: str) -> dict[str, int | None]:
    """The lines of the named subjects by the parser with positions; none of a text that is no Turtle."""
    try:
        graph, positions = parse_with_positions(text, "some.ttl")
    except (NotTurtleError, RecursionError):
        return {}
    return {
        str(subject): positions.line_of(subject) for subject in set(graph.subjects()) if isinstance(subject, URIRef)
    }


@pytest.mark.parametrize("folder", FOLDERS)
@pytest.mark.filterwarnings("ignore")
def test_of_real_files_every_line_is_that_of_the_parser(folder: str) -> None:
    found = 0
    for path in sorted((ROOT / folder).rglob("*.ttl")):
        try:
            text = path.read_text("utf-8")
        except UnicodeDecodeError:
            continue
        lines, expected = subject_lines(text), parsed(text)
        if lines and expected:
            found += len(lines)
            assert (path, lines) == (path, expected)
    assert found > 10


HEAD = "@prefix : <urn:x:> .\n"


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        pytest.param(':a :p "x. :b :p 1 ." .\n:c :p 1 .', {"urn:x:a": 2, "urn:x:c": 3}, id="a full stop in a string"),
        pytest.param(
            ':a :p """one\n"two" \\"""\n:b :p 1 .\n""" .\n:c :p 1 .',
            {"urn:x:a": 2, "urn:x:c": 6},
            id="a string of several lines",
        ),
        pytest.param(":a :p 1 . # .\n# :b :p 1 .\n:c :p 1 .", {"urn:x:a": 2, "urn:x:c": 4}, id="comments"),
        pytest.param(
            ":a :p 1.5, .5, :b.c.\n:d :p 1.\n:e :p :f .", {"urn:x:a": 2, "urn:x:d": 3, "urn:x:e": 4}, id="dots"
        ),
        pytest.param(":a :p 1 .:b :p 2 .", {"urn:x:a": 2, "urn:x:b": 2}, id="no blank between statements"),
        pytest.param(
            ":a :p [ :q ( :b [ :r :c ] ) ] ;\n :p :d .\n[ :p :e ] .\n_:b :p 1 .\n( 1 ) :p :f .\n:f :p 1 .",
            {"urn:x:a": 2, "urn:x:f": 7},
            id="brackets, and subjects without a name",
        ),
        pytest.param(":a :p 1 .\n:b :p 1 .\n:a :q 1 .", {"urn:x:a": 2, "urn:x:b": 3}, id="a subject that comes twice"),
        pytest.param(
            "PREFIX p: <urn:y:>\np:a :p 1 .\nprefix p: <urn:z:> <urn:w> a p:a .\nBASE <urn:q>\n:b a :c .",
            {"urn:y:a": 3, "urn:w": 4, "urn:x:b": 6},
            id="directives of SPARQL",
        ),
        pytest.param(
            ':a :p "x"@en.\r\n:b :p "1"^^:t.\r:c a :d .', {"urn:x:a": 2, "urn:x:b": 3, "urn:x:c": 4}, id="ends"
        ),
    ],
)
def test_a_statement_begins_where_the_one_before_has_ended(text: str, lines: dict[str, int]) -> None:
    assert subject_lines(HEAD + text) == lines
    assert parsed(HEAD + text) == lines


@pytest.mark.parametrize(
    "text",
    [
        "<a> a :B .",
        "@base <urn:y:> . <#a> a :B .",
        "@prefix p: <#> . p:a a :B .",
        ":a\\.b a :B .",
        "p:a a :B .",
        ":a a :B . } :c a :B .",
        '"a" a :B .',
        "a a :B .",
        ':a :p "b .\n',
    ],
)
def test_nothing_is_said_of_what_is_not_followed(text: str) -> None:
    assert subject_lines(f"{HEAD}:x a :B .\n{text}") == {}

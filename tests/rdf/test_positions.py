"""Positions, against a Turtle reader that shares nothing with rdflib's but the recommendation."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass, field
from pathlib import Path

import pyshacl
import pytest
from rdflib import Graph, Literal, URIRef
from rdflib.collection import Collection
from rdflib.compare import isomorphic
from rdflib.plugins.parsers.notation3 import RDFSink, SinkParser

from selfconf.rdf.positions import NotTurtleError, Offsets, Positions, TextPosition, parse_with_positions
from selfconf.rdf.rdflib_terms import to_rdflib
from selfconf.rdf.turtle import parse

ROOT = Path(__file__).resolve().parents[2]
OURS = sorted((*ROOT.glob("ontology/*.ttl"), *ROOT.glob("shapes/*.ttl")))
PACKAGED = sorted((Path(pyshacl.__file__).parent / "assets").glob("*.ttl"))
MORE = sorted(Path(os.environ["SELFCONF_TURTLE"]).rglob("*.ttl")) if "SELFCONF_TURTLE" in os.environ else []
"""A folder of Turtle files from elsewhere, if there is one at hand."""
EX = "https://example.org/"
HEAD = f"@prefix : <{EX}> .\n"

TOKEN = re.compile(
    r"""(?P<blank>[ \t\r\n]+|\#[^\n]*)
      |(?P<iri><[^<>\s]*>)
      |(?P<text>\"\"\"(?:[^"\\]|\\.|"(?!\"\"))*\"\"\"|'''(?:[^'\\]|\\.|'(?!''))*'''|"(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)*')
      |(?P<tag>@[A-Za-z]+(?:-[A-Za-z0-9]+)*)
      |(?P<type>\^\^)
      |(?P<mark>[\[\](),;])
      |(?P<word>(?:[^\s<>"'\[\](),;.\\\#^@]|\\.|\.(?![\s\#]|$))+)
      |(?P<stop>\.)""",
    re.VERBOSE | re.DOTALL,
)


@dataclass
class Reader:
    """A Turtle reader that knows nothing but where tokens begin."""

    text: str
    found: list[Offsets] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.tokens: list[tuple[str, int, str]] = []
        position = 0
        while position < len(self.text):
            match = TOKEN.match(self.text, position)
            assert match, self.text[position : position + 40]
            if match.lastgroup != "blank":
                self.tokens.append((str(match.lastgroup), position, match[0]))
            position = match.end()
        self.next = 0

    def peek(self) -> str:
        return self.tokens[self.next][2] if self.next < len(self.tokens) else ""

    def take(self) -> tuple[str, int, str]:
        self.next += 1
        return self.tokens[self.next - 1]

    def read(self) -> list[Offsets]:
        while self.next < len(self.tokens):
            if self.peek().lower() in ("@prefix", "@base", "prefix", "base"):
                at = self.peek().startswith("@")
                while self.take()[0] != "iri":
                    pass
                assert not at or self.take()[2] == "."
                continue
            bracket = self.peek() == "["
            subject = self.term()
            if not (bracket and self.peek() == "."):
                self.properties(subject)
            assert self.take()[2] == "."
        return self.found

    def properties(self, subject: int) -> None:
        while self.peek() not in (".", "]"):
            if self.peek() == ";":
                self.take()
                continue
            predicate = self.take()[1]
            while True:
                self.found.append(Offsets(subject, predicate, self.term()))
                if self.peek() != ",":
                    break
                self.take()

    def term(self) -> int:
        kind, start, token = self.take()
        if token == "[":
            self.properties(start)
            assert self.take()[2] == "]"
        elif token == "(":
            members = []
            while self.peek() != ")":
                members.append(self.term())
            self.take()
            for index, member in enumerate(members):
                cell = member if index else start
                self.found.append(Offsets(cell, member, member))
                following = members[index + 1] if index + 1 < len(members) else member
                self.found.append(Offsets(cell, following, following))
        elif kind == "text" and self.tokens[self.next][0] in ("tag", "type") and self.take()[0] == "type":
            self.take()
        return start


@pytest.mark.slow
@pytest.mark.parametrize("path", [*OURS, *PACKAGED, *MORE], ids=lambda path: path.name)
def test_every_term_of_real_files_stands_where_an_independent_reader_finds_it(path: Path) -> None:
    text = path.read_text("utf-8")
    try:
        graph, positions = parse_with_positions(text, path.name, "https://example.org/base")
    except NotTurtleError:
        with pytest.raises(SyntaxError):
            Graph().parse(data=text, format="turtle", publicID="https://example.org/base")
        return
    expected = Reader(text).read()
    assert set(positions.triples) == set(graph)
    assert set(positions.triples.values()) <= set(expected)
    if len(positions.triples) == len(expected):
        assert sorted(positions.triples.values()) == sorted(expected)
    else:  # the file states something twice, and the first place counts
        repeated = set(expected) - set(positions.triples.values())
        words = {tuple(token(text, offset) for offset in offsets) for offsets in positions.triples.values()}
        assert all(tuple(token(text, offset) for offset in offsets) in words for offsets in repeated)


def token(text: str, offset: int) -> str:
    match = TOKEN.match(text, offset)
    assert match
    return match[0]


@pytest.mark.parametrize("path", OURS, ids=lambda path: path.name)
def test_the_graph_is_the_one_that_rdflib_reads(path: Path) -> None:
    text = path.read_text("utf-8")
    assert isomorphic(parse_with_positions(text, path.name)[0], Graph().parse(data=text, format="turtle"))


def where(text: str, value: URIRef | Literal) -> tuple[TextPosition, ...]:
    """The places of the subject, the predicate and the object of the one triple with a value."""
    graph, positions = parse_with_positions(HEAD + text, "a.ttl")
    (triple,) = graph.triples((None, None, value))
    return tuple(map(positions.place, positions.triples[triple]))


def test_columns_count_characters_and_not_bytes() -> None:
    assert where(':é :ß "😀", :x .', URIRef(EX + "x")) == (TextPosition(2, 1), TextPosition(2, 4), TextPosition(2, 12))


def test_a_node_in_brackets_stands_at_its_bracket() -> None:
    assert where(":a :b [\n  :c 5 ] .", Literal(5)) == (TextPosition(2, 7), TextPosition(3, 3), TextPosition(3, 6))


def test_a_node_in_brackets_that_is_a_subject_keeps_its_place_after_it_is_closed() -> None:
    assert where("[ :a :b ] :c :d .", URIRef(EX + "d")) == (
        TextPosition(2, 1),
        TextPosition(2, 11),
        TextPosition(2, 14),
    )


def test_the_cells_of_a_list_stand_at_their_members() -> None:
    graph, positions = parse_with_positions(HEAD + ":a :b ( :c\n  [ :d 1 ]\n  ( 2 ) ) .", "a.ttl")
    head = graph.value(URIRef(EX + "a"), URIRef(EX + "b"))
    assert head is not None
    members = Collection(graph, head)
    assert [positions.of_node(member) for member in members] == [
        TextPosition(2, 9),
        TextPosition(3, 3),
        TextPosition(4, 3),
    ]
    assert positions.of_node(head) == TextPosition(2, 7)


def test_a_triple_that_is_stated_twice_stands_where_it_is_stated_first() -> None:
    assert where(":a :b :c .\n:a :b :c .", URIRef(EX + "c"))[2] == TextPosition(2, 7)


def test_comments_and_strings_that_look_like_turtle_move_nothing() -> None:
    text = '# :a :b :c .\n:a :b """ # :x :y :z .\n""" , :c . # the end'
    assert where(text, URIRef(EX + "c")) == (TextPosition(3, 1), TextPosition(3, 4), TextPosition(4, 7))


def test_windows_line_ends_count_once() -> None:
    assert where(":a\r\n  :b\r\n  :c .\r\n", URIRef(EX + "c")) == (
        TextPosition(2, 1),
        TextPosition(3, 3),
        TextPosition(4, 3),
    )


def test_a_byte_order_mark_takes_no_column() -> None:
    _, positions = parse_with_positions("\ufeff<urn:a> <urn:b> <urn:c> .", "a.ttl")
    assert positions.of_node(URIRef("urn:a")) == TextPosition(1, 1)


def test_every_declaration_of_a_prefix_is_noted() -> None:
    _, positions = parse_with_positions("@prefix : <urn:a#> .\nPREFIX b: <urn:b#>\n  @prefix : <urn:c#> .", "a.ttl")
    assert [(prefix, iri, positions.place(offset)) for prefix, iri, offset in positions.prefixes] == [
        ("", "urn:a#", TextPosition(1, 1)),
        ("b", "urn:b#", TextPosition(2, 1)),
        ("", "urn:c#", TextPosition(3, 3)),
    ]


PREFIXES = "".join(
    f"@prefix {name}: <urn:x:{name}#> .\n" for name in ("a", "a.b", "is.x", "has.x", "true.x", "false.y")
)


@pytest.mark.parametrize(
    "text",
    [
        ":t a a.b:T .",
        ":t a.b:p 1 ; has.x:p true.x:q , true ; is.x:p false.y:z , false .",
        ":t :p true, false.",
        ':t :p "y" ^^ <urn:t> .',
        ":t :p (\"y\"\n^^ # so it is\n<urn:t> \"z\" @en '''x'''\t@en-gb).",
        ":t :p 007 , +1 , -.5 , 1.50 , 1.e5 , .1E+2 , 1e0 .",
        f":t :p {'9' * 5_000} .",
    ],
    ids=range(7),
)
def test_all_turtle_is_turtle(text: str) -> None:
    text = HEAD + PREFIXES + text
    graph, _ = parse_with_positions(text, "a.ttl")
    assert isomorphic(graph, to_rdflib(parse(text, "a.ttl").triples()))


@pytest.mark.parametrize(
    ("text", "place"),
    [
        (":a :b :c\n:d :e :f .", TextPosition(3, 1)),
        (":a :b , .", TextPosition(2, 6)),
        (":a x:b :c .", TextPosition(2, 4)),
        (":a :b ( :c", TextPosition(2, 11)),
        (":a :b [ :c :d .", TextPosition(2, 15)),
        (":a :b", TextPosition(2, 6)),
        (":a :b :c", TextPosition(2, 9)),
        ("<a b", TextPosition(2, 1)),
    ],
)
def test_what_is_not_turtle_is_placed(text: str, place: TextPosition) -> None:
    with pytest.raises(NotTurtleError) as caught:
        parse_with_positions(HEAD + text, "a.ttl")
    line = Positions("a.ttl", HEAD + text).place(caught.value.offset)
    assert abs(line.column - place.column) <= 1, (line, caught.value.message)
    assert line.line == place.line


def test_a_token_is_as_wide_as_it_looks() -> None:
    positions = Positions("a.ttl", ':a sc:name "pose"@en, <urn:x y>; [ 5.0 ] .')
    widths = {match.start() + 1: match.end() - match.start() for match in re.finditer(r"\S+", positions.text)}
    assert positions.width(TextPosition(1, 1)) == widths[1]
    assert positions.width(TextPosition(1, 4)) == len("sc:name")
    assert positions.width(TextPosition(1, 12)) == len('"pose"@en')
    assert positions.width(TextPosition(1, 34)) == 1
    assert positions.width(TextPosition(1, 36)) == len("5.0")


PRIVATE = ("directiveOrStatement", "bind", "node", "item", "subject", "prop", "object", "verb", "property_list",
           "objectList", "makeStatement", "path", "nodeOrLiteral", "strconst", "tok")  # fmt: skip


@pytest.mark.parametrize("method", PRIVATE)
def test_rdflib_still_has_the_private_methods_that_are_overridden(method: str) -> None:
    assert callable(getattr(SinkParser, method))


def test_rdflib_still_makes_lists_and_statements_in_its_sink() -> None:
    assert RDFSink.newList.__code__.co_varnames[:3] == ("self", "n", "f")
    assert RDFSink.makeStatement.__code__.co_varnames[:3] == ("self", "quadruple", "why")
    assert RDFSink.normalise.__code__.co_varnames[:3] == ("self", "f", "n")

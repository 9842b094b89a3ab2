"""The notation of RosTooling models."""

from __future__ import annotations

import pytest

from selfconf.errors import AuthorError
from selfconf.importing.ros2.model_text import ModelEntry, parse_model, unquoted
from selfconf.importing.sources import SourceDocument


def parsed(text: str) -> list[ModelEntry]:
    return parse_model(SourceDocument("x.ros2", "x.ros2", text.encode()))


def outline(entries: list[ModelEntry]) -> list[object]:
    return [[each.key, each.text, outline(each.below)] for each in entries]


def test_names_items_and_words_are_nested_by_indentation() -> None:
    text = """
# a system
robot:
  subSystems:
    base
    - arm   # a comment
  nodes:
    node1:
      from: "pkg.node"
      type:'a/b'
      interfaces:
        - out: pub-> "x::y"
  connections:
    -[ a , b]
    - ["c/d", e]
"""
    assert outline(parsed(text)) == [
        ["robot", "", [
            ["subSystems", "", [["", "base", []], ["", "arm", []]]],
            ["nodes", "", [["node1", "", [
                ["from", '"pkg.node"', []],
                ["type", "'a/b'", []],
                ["interfaces", "", [["out", 'pub-> "x::y"', []]]],
            ]]]],
            ["connections", "", [["", "[ a , b]", []], ["", '["c/d", e]', []]]],
        ]],
    ]  # fmt: skip


def test_a_list_may_take_several_lines() -> None:
    (entry,) = parsed("nodes: [ a,\n  'b c',\n d ]\n")
    assert entry.words() == ["a", "b c", "d"]


def test_a_flow_mapping_is_what_could_stand_below_its_name() -> None:
    text = """
pubs:
  scan: { type: "a/b" , "qos": {depth: 5, list: [1, 2], x: 'a, b'},
          empty: {}, url: http://x }
  none: {}
  - odd: {a, b}
  broken: {a: {b: c} d: e}
"""
    assert outline(parsed(text)) == [
        ["pubs", "", [
            ["scan", "", [
                ["type", '"a/b"', []],
                ["qos", "", [["depth", "5", []], ["list", "[1, 2]", []], ["x", "'a, b'", []]]],
                ["empty", "", []],
                ["url", "http://x", []],
            ]],
            ["none", "", []],
            ["odd", "{a, b}", []],
            ["broken", "{a: {b: c} d: e}", []],
        ]],
    ]  # fmt: skip
    deep = parsed(f"x: {'{a: ' * 200}1{'}' * 200}")
    assert (deep[0].text[:4], deep[0].below) == ("{a: ", [])


def test_a_hash_in_quotes_is_no_comment_and_quotes_are_no_part_of_a_value() -> None:
    (entry,) = parsed('a:\n  b: "x # y"\n')
    assert entry.value("b") == "x # y"
    assert entry.value("c") == ""
    assert unquoted("'") == "'"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("a:\n  b: [1,\n", "x.ros2:2:3: a list in brackets has no end"),
        ("a:\n  b: {c: 1,\n", "x.ros2:2:3: a mapping in braces has no end"),
        ('a:\n  b: "x\n', "x.ros2:2:6: a quotation has no end"),
        ("a:\n  b c d\n", "x.ros2:2:3: a line is `name:`"),
        ("# a launch file\nfrom launch import x\n", "not 'from launch import x'; is this a .ros2 or .rossystem model"),
        ("\n".join(f"{' ' * each}a:" for each in range(100)), "nested more than 50 levels deep"),
        ("{}", "x.ros2:1:1: a line is"),
    ],
)
def test_what_is_none_of_the_notation_is_named_with_its_place(text: str, words: str) -> None:
    with pytest.raises(AuthorError) as error:
        parsed(text)
    assert words in str(error.value)

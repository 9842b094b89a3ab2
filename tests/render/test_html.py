"""HTML for notebooks: nothing that others wrote gets out of its place."""

from __future__ import annotations

from xml.etree import ElementTree

from selfconf.model.configuration import Assignment, Configuration, Connection
from selfconf.model.term import IRI
from selfconf.render import diagram, html_sections, html_table, html_text, short
from selfconf.render.html import CHARACTERS
from tests.render.answers import CONFIGURATION, NAMES, SINK, SOURCE, TEMPLATE, term

EVIL = "<script>alert('x')</script> & \"more\""
SVG = "{http://www.w3.org/2000/svg}"


def drawn(configuration: Configuration) -> ElementTree.Element:
    """The diagram of a configuration, which is well-formed XML."""
    return ElementTree.fromstring(diagram(configuration, NAMES))


def columns(configuration: Configuration) -> dict[str, int]:
    """The horizontal place of each component, by the title of its node."""
    return {
        group.findtext(f"{SVG}title", "").rpartition("#")[2]: int(rect.get("x", ""))
        for group in drawn(configuration).iter(f"{SVG}g")
        for rect in group.iter(f"{SVG}rect")
    }


def test_a_table_has_its_cells_escaped() -> None:
    tree = ElementTree.fromstring(html_table(["name", EVIL], [["a", EVIL], ["b", ""]]))
    assert [cell.text for cell in tree.iter("th")] == ["name", EVIL]
    assert [cell.text for cell in tree.iter("td")] == ["a", EVIL, "b", None]
    assert tree.find(".//script") is None


def test_text_stays_as_it_is() -> None:
    assert ElementTree.fromstring(html_text(f"  two\n{EVIL}")).text == f"  two\n{EVIL}"


def test_sections_have_their_headings_escaped_and_their_parts_as_they_are() -> None:
    page = ElementTree.fromstring(f"<div>{html_sections({EVIL: '<b>bold</b>', 'second': ''})}</div>")
    assert [heading.text for heading in page.iter("h4")] == [EVIL, "second"]
    assert page.findtext("b") == "bold"


def test_a_diagram_has_a_node_for_each_component_and_an_arrow_for_each_pair() -> None:
    tree = drawn(CONFIGURATION)
    assert sorted(columns(CONFIGURATION)) == ["clock", "screen"]
    arrows = [path.findtext(f"{SVG}title") for path in tree.iter(f"{SVG}path") if path.find(f"{SVG}title") is not None]
    assert arrows == ["time → text"]


def chain(*pairs: tuple[str, str]) -> Configuration:
    """Components that feed each other."""
    names = list(dict.fromkeys(name for pair in pairs for name in pair))
    connections = tuple(Connection(term(a), "out", term(b), "in") for a, b in pairs)
    return Configuration(TEMPLATE, (Assignment(SOURCE, tuple(map(term, names))),), connections)


def test_what_is_fed_stands_to_the_right_of_what_feeds_it() -> None:
    places = columns(chain(("a", "b"), ("b", "c"), ("a", "c")))
    assert places["a"] < places["b"] < places["c"]


def test_a_loop_is_drawn_too() -> None:
    assert len(columns(chain(("a", "b"), ("b", "a"), ("a", "a")))) == 2


def test_an_empty_configuration_is_an_empty_diagram() -> None:
    assert columns(Configuration(TEMPLATE, ())) == {}


def test_a_long_name_is_cut_and_a_strange_one_escaped() -> None:
    long, strange = IRI("urn:" + "x" * 200), IRI.unchecked(f"urn:{EVIL}")
    text = diagram(Configuration(TEMPLATE, (Assignment(SINK, (long, strange)),)), short)
    nodes = [node.text or "" for node in ElementTree.fromstring(text).iter(f"{SVG}text")]
    assert nodes[0] == "x" * (CHARACTERS - 1) + "…"
    assert max(map(len, nodes)) <= CHARACTERS
    assert "<script" not in text

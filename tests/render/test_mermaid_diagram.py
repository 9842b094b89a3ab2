"""Configurations as flow charts of Mermaid."""

from __future__ import annotations

from dataclasses import replace

from selfconf.model.configuration import Assignment, Configuration, Connection
from selfconf.model.term import IRI
from selfconf.render import mermaid, short
from tests.render.answers import CLOCK, CONFIGURATION, NAMES, SCREEN, SINK, SOURCE, TEMPLATE


def test_a_configuration_is_a_chart_of_nodes_with_their_roles_and_named_arrows() -> None:
    assert mermaid(CONFIGURATION, NAMES).splitlines() == [
        "flowchart LR",
        '    c0[":clock<br/><i>source</i>"]',
        '    c1[":screen<br/><i>sink</i>"]',
        '    c0 -->|"time → text"| c1',
    ]


def test_a_configuration_of_nothing_is_an_empty_chart() -> None:
    assert mermaid(Configuration(TEMPLATE, ()), NAMES) == "flowchart LR"


def test_words_that_would_end_a_label_or_begin_a_tag_are_escaped() -> None:
    evil = IRI.unchecked('urn:x"]<b>&amp;')
    chart = mermaid(
        Configuration(
            TEMPLATE, (Assignment(SOURCE, (evil,)), Assignment(SINK, ())), (Connection(evil, 'o"', evil, "i|<br>"),)
        ),
        short,
    )
    _, node, arrow = chart.splitlines()
    assert node == '    c0["x#quot;]&lt;b&gt;&amp;amp;<br/><i>source</i>"]'
    assert arrow == '    c0 -->|"o#quot; → i|&lt;br&gt;"| c0'
    assert node.count('"') == arrow.count('"') == 2


def test_the_name_of_a_port_forges_no_line_of_a_chart() -> None:
    wire = Connection(CLOCK, "time\n    c9 --> c8", SCREEN, "text\x1b[2J")
    *_, arrow = mermaid(replace(CONFIGURATION, connections=(wire,)), NAMES).splitlines()
    assert arrow == r'    c0 -->|"time\n    c9 --&gt; c8 → text\x1b[2J"| c1'

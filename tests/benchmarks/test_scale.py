"""The benchmark of large ecologies: its short run works, rdflib reads the same, and what is missed is said."""

from __future__ import annotations

from dataclasses import replace

import pytest
import rdflib

from benchmarks.scale import engines, report, styles, worlds
from selfconf.rdf.advertisements import read_advertisements
from tests.benchmarks.short_run import short_run
from tests.harness.effort import thorough


@thorough
@pytest.mark.process
def test_the_short_run_runs() -> None:
    printed = short_run("benchmarks.scale")
    assert "| 200 |" in printed
    assert "each with a label" in printed
    assert "N-Triples, shuffled" in printed


def test_rdflib_reads_the_same_profiles() -> None:
    text = "".join(worlds.ecology(50))
    good, bad = read_advertisements(text.encode(), "a.ttl")
    found = engines.profiles(rdflib.Graph().parse(data=text, format="turtle"))
    assert not bad
    assert {replace(profile, properties=()) for profile in found} == {
        replace(advertisement.profile, properties=()) for advertisement in good
    }


def test_other_forms_of_an_advertisement_are_advertisements() -> None:
    head, *advertisements = worlds.ecology(20)
    for form in (worlds.labelled, worlds.linked, worlds.topical, worlds.unlike):
        text = head + "".join(form(text, number) for number, text in enumerate(advertisements))
        good, bad = read_advertisements(text.encode(), "a.ttl")
        assert (len(good), bad) == (20, [])


@pytest.mark.parametrize("style", styles.STYLES)
def test_the_ecology_is_the_same_as_whatever_program_writes_it(style: str) -> None:
    text = "".join(worlds.ecology(20))
    plain, _ = read_advertisements(text.encode(), "a.ttl")
    good, bad = read_advertisements(styles.STYLES[style](text).encode(), "a.ttl")
    assert not bad
    found, expected = ({one.component: one.profile for one in ads} for ads in (good, plain))
    if "store" in style:  # which writes 0.040 as 0.04
        found, expected = ({c: replace(p, properties=()) for c, p in some.items()} for some in (found, expected))
    assert found == expected


def measured(load: float, refusal: float) -> engines.Found:
    """What `configure` might have measured."""
    parts = {"partition": 0.001, "search": 0.001, "refusal": refusal}
    return {"parse": 1.0, "load": load, "bytes": 500, "candidates": 100, **parts}


def test_a_goal_that_is_missed_is_said_to_be_missed() -> None:
    graph, crowded = {"load": 60.0, "read": 9.0, "bytes": 9000.0}, {"alone": 1.0, "in the crowd": 1.0, "unwanted": 9}
    text = "\n".join(report.judged({1000: (measured(0.7, 0.001), None, graph)}, crowded))
    assert text.count(", met") == 4
    assert "86 times as quick as its parsing alone, 99 with reading" in text
    text = "\n".join(report.judged({1000: (measured(2.5, 1.0), None, graph)}, {**crowded, "in the crowd": 2.0}))
    assert text.count("**missed**") == 4

"""`configure --strategy best`: the cheapest configuration by the template's cost, and what is not known of it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from selfconf.search.strategies import best
from selfconf.search.strategies import first as solve
from tests.cli.command import Outcome, run

ROOT = Path(__file__).resolve().parents[2]
WATCH = (ROOT / "examples" / "watch.ttl").read_text("utf-8")
ADS = ROOT / "examples" / "watch"
LATENCY = "[ sc:term [ sc:property rob:latency ] ]"
POWER = "[ sc:term [ sc:property rob:power ; sc:otherwise 20 ] ]"


class Watch:
    """The template of the manual, perhaps with another cost, over its advertisements."""

    def __init__(self, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
        self.template, self.capsys = folder / "watch.ttl", capsys
        self.template.write_text(WATCH)

    def costs(self, *levels: str) -> None:
        """State another cost."""
        head, _, tail = WATCH.partition("    sc:cost (")
        cost = f"    sc:cost ( {' '.join(levels)} ) .\n" if levels else "    .\n"
        self.template.write_text(head + cost + tail.partition(") .\n")[2])

    def run(self, *arguments: str) -> Outcome:
        """Run `configure` with it."""
        return run(self.capsys, "configure", str(self.template), "--ads", str(ADS), *arguments)

    def best(self, *arguments: str) -> dict[str, Any]:
        """The best configuration as JSON."""
        outcome = self.run("--strategy", "best", "--format", "json", *arguments)
        assert outcome.code == 0, outcome
        body: dict[str, Any] = outcome.body
        return body


@pytest.fixture
def watch(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Watch:
    """The example."""
    return Watch(tmp_path, capsys)


def players(body: dict[str, Any]) -> list[str]:
    """Who plays, by short names."""
    return [component.rpartition("#")[2] for role in body["roles"] for component in role["components"]]


def test_best_takes_the_cheapest_and_first_the_preferred(watch: Watch) -> None:
    body = watch.best()
    assert players(body) == ["shelf-camera", "light-tracker"]
    assert body["cost"] == {
        "levels": [0.11, 24.0], "bound": [0.11, 24.0], "proved": True, "unknown": 0, "missing": [], "nobody_has": [],
    }  # fmt: skip
    first = watch.run("--format", "json").body
    assert players(first) == ["corner-camera", "deep-tracker"]
    assert "cost" not in first


def test_levels_are_compared_in_their_order(watch: Watch) -> None:
    watch.costs("[ sc:term [ sc:property rob:latency ; sc:weight -1 ] ]", POWER)
    assert players(watch.best()) == ["corner-camera", "deep-tracker"]
    watch.costs("[ sc:term [ sc:property rob:power ; sc:weight -1 ; sc:ofRole :camera ] ]")
    body = watch.best()
    assert players(body) == ["stereo-camera", "light-tracker"]
    assert body["cost"]["levels"] == [-9.0]


def test_what_comes_after_a_failure_is_the_cheapest_of_what_keeps_the_most(watch: Watch) -> None:
    watch.costs("[ sc:term [ sc:property rob:latency ; sc:weight -1 ] ]", POWER)
    lines = [" ".join(line.split()) for line in watch.run("--strategy", "best", "--what-if").out.splitlines()]
    assert ":corner-camera -> :shelf-camera, :light-tracker, and :deep-tracker would stop" in lines


def test_a_cost_over_a_property_that_nobody_has_is_told(watch: Watch) -> None:
    watch.costs("[ sc:term [ sc:property rob:error ] ]")
    body = watch.best()
    assert players(body) == ["corner-camera", "deep-tracker"]
    assert body["cost"]["unknown"] == 2
    assert [one.rpartition("#")[2] for one in body["cost"]["nobody_has"]] == ["error"]
    text = watch.run("--strategy", "best")
    assert text.code == 0
    assert "2 terms are unknown" in text.out
    assert "no component of the ecology has a number for rob:error" in text.out


def test_a_component_without_the_property_is_named(watch: Watch) -> None:
    watch.costs("[ sc:term [ sc:property rob:power ; sc:ofRole :tracker ] ]", LATENCY)
    watch.template.write_text(watch.template.read_text() + "\n:tracker sh:hasValue :light-tracker .")
    text = watch.run("--strategy", "best").out
    assert "1 term is unknown" in text
    assert ":light-tracker has no number for rob:power" in text


def test_without_a_cost_the_first_is_as_good_as_any(watch: Watch) -> None:
    watch.costs()
    best, first = watch.run("--strategy", "best"), watch.run()
    assert (best.code, best.out) == (0, first.out)
    assert "states no sc:cost" in best.err
    assert first.err == ""


def test_an_impossible_template_is_refused_by_best_as_by_first(watch: Watch) -> None:
    watch.template.write_text(watch.template.read_text() + "\n:tracker sh:class rob:Speaker .")
    bodies = [watch.run("--strategy", name, "--format", "json").body for name in ("first", "best")]
    assert bodies[0]["status"] == "refused"
    assert bodies[0]["reasons"] == bodies[1]["reasons"]


@pytest.mark.parametrize(
    ("cost", "words"),
    [
        ("sc:cost ()", "one list of levels"),
        (f"sc:cost ( {LATENCY} ) , ( {POWER} )", "one list of levels"),
        ("sc:cost ( [ sc:property rob:latency ] )", "at least one sc:term"),
        ("sc:cost ( [ sc:term [ sc:weight 1 ] ] )", "exactly one sc:property"),
        ('sc:cost ( [ sc:term [ sc:property "latency" ] ] )', "an IRI"),
        ('sc:cost ( [ sc:term [ sc:property rob:latency ; sc:weight "much" ] ] )', "sc:weight"),
        ("sc:cost ( [ sc:term [ sc:property rob:latency ; sc:weight 1e999 ] ] )", "finite number"),
        ("sc:cost ( [ sc:term [ sc:property rob:latency ; sc:otherwise 1 , 2 ] ] )", "sc:otherwise"),
        ("sc:cost ( [ sc:term [ sc:property rob:latency ; sc:ofRole :snik ] ] )", "no role of the template"),
        ("sc:cost ( [ sc:term [ sc:property rob:latency ; sc:ofRole :camera , :tracker ] ] )", "at most one sc:ofRole"),
    ],
)
def test_a_cost_that_cannot_be_read_is_one_sentence(watch: Watch, cost: str, words: str) -> None:
    watch.costs()
    watch.template.write_text(watch.template.read_text() + f"\n:watch {cost} .")
    assert watch.run("--strategy", "best").is_one_sentence(words, "watch.ttl")


def test_an_answer_that_is_not_proved_says_so(watch: Watch, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = best.best_configuration

    def hasty(problem: best.Problem, steps: int, running: best.Configuration | None) -> best.Optimum:
        assert running is None
        found, first = whole(problem), solve.search(problem)
        assert isinstance(found, best.Optimum)
        assert isinstance(first, best.Configuration)
        return best.Optimum(first, tuple(2 * level for level in found.cost), found.bound, (), proved=False)

    monkeypatch.setattr("selfconf.composition.searches.best_configuration", hasty)
    text = watch.run("--strategy", "best").out
    assert "level 1  0.22  (bound 0.11)" in text
    assert "not proved" in text
    assert not watch.best()["cost"]["proved"]

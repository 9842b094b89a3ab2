"""`configure`: a configuration that is true and can be looked into, or a refusal that is false and explained."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import pytest

from selfconf import configure, read, template
from selfconf.api.answer import Answer, Inquiry, Method
from selfconf.composition import Strategy
from selfconf.errors import BindingError, SelfconfError, TemplateError
from selfconf.model.configuration import Configuration
from selfconf.model.hierarchy import Reasoning
from selfconf.model.refusal import Refusal, Undecided
from selfconf.model.term import IRI
from selfconf.rdf.turtle import parse
from selfconf.rdf.vocabulary import SC
from tests.lab import ADVERTISEMENTS, NAVIGATE, PREFIXES, iri, write_advertisements

EVERYTHING = PREFIXES + "\n".join(ADVERTISEMENTS.values())
COST = "sc:cost ( [ sc:term [ sc:property :price ] , [ sc:property :weight ] ] )"
PRICED = PREFIXES + f":t a sc:Template ; {COST} ; sc:roles ( :r ) .\n:r a sc:Role ; sh:class :Lamp ."
LAMPS = (
    PREFIXES + ":dear a sc:Component, :Lamp ; :price 9 ; sc:preference 5 . :cheap a sc:Component, :Lamp ; :price 2 ."
)


def navigation(ads: str = EVERYTHING, **more: object) -> Answer | Refusal | Undecided:
    """The answer to the paper's task."""
    task = template(NAVIGATE).bind(robot=":Astrid", goal="(AT BEDROOM)")
    return configure(task, read(ads), **more)  # type: ignore[arg-type]  # options by name


def answered(**more: object) -> Answer:
    """The paper's configuration."""
    found = navigation(**more)  # type: ignore[arg-type]  # options by name
    assert isinstance(found, Answer)
    return found


def test_an_answer_is_a_configuration_and_true() -> None:
    answer = answered()
    assert answer
    assert isinstance(answer, Configuration)
    assert type(answer.plain) is Configuration
    assert answer.plain.components == answer.components
    assert len(answer.connections) == 4
    assert answer.settings[0].component == iri("thinking-cap")


@pytest.mark.parametrize("role", ["position", ":position", str(iri("position"))])
def test_the_components_of_a_role_are_found_by_any_of_its_names(role: str) -> None:
    assert answered()[role] == (iri("person-tracker"),)


def test_a_role_that_there_is_not_is_answered_with_those_that_there_are() -> None:
    with pytest.raises(KeyError, match="no role 'nobody'; the roles are sonar, encoder, position, control, drive"):
        answered()["nobody"]


def test_an_answer_is_turtle_that_says_what_it_is_a_configuration_of() -> None:
    document = parse(answered().to_turtle(), "answer.ttl")
    (name,) = document.instances(SC.Configuration)
    assert len(document.values(name, SC.assignment)) == 5
    assert len(document.values(name, SC.connection)) == 4
    assert document.values(name, SC.template) == [iri("navigate")]


def test_an_answer_is_text_a_chart_and_a_page() -> None:
    answer = answered(what_if=True)
    assert "configured :navigate" in str(answer)
    assert ":person-tracker -> :absolute-odometry" in [" ".join(line.split()) for line in str(answer).splitlines()]
    assert repr(answer).startswith("<configured :navigate")
    assert answer.to_mermaid().count("-->") == 4
    page = ElementTree.fromstring(f"<div>{answer._repr_html_()}</div>")
    assert page.findtext("h4") == "configured :navigate"


def test_what_would_replace_what_is_told_when_asked_for() -> None:
    assert answered().what_if is None
    told = {one.component.short: one for one in answered(what_if=True).what_if or ()}
    assert told["person-tracker"].started == (iri("absolute-odometry"),)
    assert told["astrid-drive"].fatal


def test_the_best_answer_has_its_cost_and_what_is_not_known_of_it() -> None:
    task, home = template(PRICED), read(LAMPS)
    first, best = configure(task, home), configure(task, home, strategy="best")
    assert isinstance(first, Answer)
    assert isinstance(best, Answer)
    assert (first["r"], first.optimum) == ((iri("dear"),), None)
    assert best["r"] == (iri("cheap"),)
    assert best.optimum is not None
    assert [float(level) for level in best.optimum.cost] == [2.0]
    assert best.unknown == (iri("weight"),)
    assert "nobody in the ecology has a number for :weight" in str(best)


def test_a_property_that_another_component_has_is_not_unknown_to_the_ecology() -> None:
    best = configure(template(PRICED), read(LAMPS + ":oven a sc:Component, :Oven ; :weight 3 ."), strategy="best")
    assert isinstance(best, Answer)
    assert best.unknown == ()
    assert best.optimum is not None
    assert best.optimum.missing == ((iri("cheap"), iri("weight")),)


# Refusals.


def test_a_refusal_is_false_and_has_reasons_near_misses_and_places(tmp_path: Path) -> None:
    ads = write_advertisements(tmp_path / "ads")
    (ads / "drive.ttl").unlink()
    refusal = navigation(str(ads))
    assert isinstance(refusal, Refusal)
    assert not refusal
    assert [reason.role for reason in refusal.reasons] == [iri("drive")]
    (miss,) = [miss for miss in refusal.near_misses if miss.component == iri("pippi-drive")]
    assert miss.place is not None
    assert (miss.place.source, miss.place.line) == (str(ads / "pippi.ttl"), PREFIXES.count("\n") + 1)
    assert refusal.repairs


def test_a_refusal_that_subclasses_would_mend_says_so_unless_they_are_seen_already() -> None:
    special = EVERYTHING.replace("rob:PositionSensor", "rob:PersonTracker")
    refusal = navigation(special)
    assert isinstance(refusal, Refusal)
    assert refusal.hint == "with --reasoning subclass there is a configuration"
    assert navigation(special, reasoning="subclass")


def test_what_is_not_decided_is_false_too() -> None:
    found = navigation(steps=1)
    assert isinstance(found, Undecided)
    assert not found


# Methods.


def test_a_method_is_named_by_the_words_of_the_command_line() -> None:
    method = Method.of("best", "owl-rl", ["a.ttl"], 7, 0.5)
    assert method == Method(Strategy.BEST, Reasoning.OWL_RL, (Path("a.ttl"),), 7, 0.5)
    for words in (("worst",), ("first", "magic")):
        with pytest.raises((ValueError, SelfconfError), match=words[-1]):
            Method.of(*words)


def test_a_wider_hierarchy_is_tried_where_the_roles_saw_none() -> None:
    robotics = "https://w3id.org/selfconf/robotics#"
    wider = Method.of().wider()
    assert wider is not None
    assert wider.matches(IRI(robotics + "PersonTracker"), IRI(robotics + "PositionSensor"))
    assert Method.of(reasoning="subclass").wider() is None


@pytest.mark.parametrize("strategy", [strategy.value for strategy in Strategy])
def test_every_strategy_answers(strategy: str) -> None:
    assert answered(strategy=strategy)["position"] == (iri("person-tracker"),)


def test_an_inquiry_has_the_figures_of_its_answer() -> None:
    inquiry = Inquiry(template(NAVIGATE).bind(robot=":Astrid", goal="x"), read(EVERYTHING), Method())
    assert inquiry.eligible == {
        iri(role): number
        for role, number in (("sonar", 1), ("encoder", 1), ("position", 2), ("control", 1), ("drive", 1))
    }
    assert inquiry.seconds.keys() == {"load", "partition"}
    assert inquiry.answer()
    assert inquiry.seconds.keys() == {"load", "partition", "search"}


# What is wrong with the task.


def test_a_task_without_a_value_or_with_a_shape_that_is_none_is_said() -> None:
    with pytest.raises(BindingError, match="needs a value"):
        configure(template(NAVIGATE), read(EVERYTHING))
    bad = PREFIXES + ':t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:pattern "(" .'
    with pytest.raises(TemplateError, match="not well-formed"):
        configure(template(bad), read(EVERYTHING))

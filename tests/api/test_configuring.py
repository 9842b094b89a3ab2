"""`configure`, from an ecology and a task to an answer: what is held or shared, costs, and refusals."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

import pytest

import selfconf as sc
from selfconf import configure, read, template
from selfconf.api.answer import Answer
from selfconf.api.configuring import Inquiry
from selfconf.api.method import Method
from selfconf.api.reading import described_in
from selfconf.composition import Strategy, TimeLimit
from selfconf.errors import AuthorError, BindingError, ProgrammerError, TemplateError
from selfconf.model.configuration import Configuration, Wants
from selfconf.model.holder import Holder
from selfconf.model.refusal import Refusal, Undecided
from selfconf.model.term import IRI
from selfconf.project import STRATEGIES
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.turtle import Document
from tests.api.navigation import EVERYTHING, answered, navigation
from tests.lab import NAVIGATE, PREFIXES, iri, write_advertisements

Result = TypeVar("Result")


def test_a_component_that_another_task_holds_is_told_apart_from_one_that_is_not_eligible(
    clock: sc.TaskSpecification, monkeypatch: pytest.MonkeyPatch
) -> None:
    screen = sc.IRI("https://example.org/my-home#display")
    monkeypatch.setattr(sc.Ecology, "holders", lambda _: {screen: Holder("watch~1")})
    inquiry = Inquiry(clock, sc.read("examples/clock"), Method())
    refusal = inquiry.answer()
    assert isinstance(refusal, Refusal)
    assert [str(reason) for reason in refusal.reasons] == ["no component that is free is eligible for the role screen"]
    assert refusal.held == ((screen, Holder("watch~1")),)
    assert inquiry.eligible["https://example.org/my-home#screen"] == 1


def test_a_refusal_names_each_component_that_is_eligible_and_held(
    clock: sc.TaskSpecification, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = Path("examples/clock/display.ttl").read_text()
    ecology = sc.read("examples/clock", text.replace(":display ", ":spare "))
    holders = {sc.IRI(f"https://example.org/my-home#{one}"): Holder(f"{one}~1") for one in ("display", "spare", "lamp")}
    monkeypatch.setattr(sc.Ecology, "holders", lambda _: holders)
    refusal = sc.configure(clock, ecology)
    assert isinstance(refusal, Refusal)
    assert [(component.short, holder.name) for component, holder in refusal.held] == [
        ("display", "display"),
        ("spare", "spare"),
    ]


def test_what_another_task_holds_would_replace_nothing(
    clock: sc.TaskSpecification, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = Path("examples/clock/display.ttl").read_text()
    ecology = sc.read("examples/clock", text.replace(":display ", ":spare "))
    for holders, fatal in (({}, False), ({sc.IRI("https://example.org/my-home#spare"): Holder("watch~1")}, True)):
        monkeypatch.setattr(sc.Ecology, "holders", lambda _, holders=holders: holders)
        answer = sc.configure(clock, ecology, what_if=True)
        assert isinstance(answer, Answer)
        told = {one.component.short: one for one in answer.what_if or ()}
        assert told["display"].fatal is fatal


@pytest.mark.parametrize("agrees", [True, False])
def test_what_can_be_shared_is_free_for_those_that_want_the_same_of_it(
    clock: sc.TaskSpecification, monkeypatch: pytest.MonkeyPatch, agrees: bool
) -> None:
    text = Path("examples/clock/display.ttl").read_text()
    ecology = sc.read("examples/clock/clock.ttl", text.replace("rob:Display ;", "rob:Display ; sc:shareable true ;"))
    alone = sc.configure(clock, ecology)
    assert isinstance(alone, Answer)
    (screen,) = alone["screen"]
    holder = Holder("watch~1", wants=alone.wants(screen) if agrees else Wants())
    monkeypatch.setattr(sc.Ecology, "holders", lambda _: {screen: holder})
    answer = sc.configure(clock, ecology)
    if agrees:
        assert answer == alone
    else:
        assert isinstance(answer, Refusal)
        assert answer.held == ((screen, holder),)
        assert str(answer.reasons[0]) == "no component that is free is eligible for the role screen"


def test_what_can_be_shared_is_shared_as_its_holder_wants(
    clock: sc.TaskSpecification, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = Path("examples/clock/display.ttl").read_text()
    shared = text.replace("rob:Display ;", "rob:Display ; sc:shareable true ;")
    clocks = Path("examples/clock/clock.ttl").read_text()
    ecology = sc.read(clocks, clocks.replace(":clock ", ":second-clock "), shared)
    first = sc.configure(clock, ecology)
    assert isinstance(first, Answer)
    (screen,) = first["screen"]
    second = first.wants(screen).inputs
    other = frozenset(
        (port, sc.IRI(source.replace("#clock", "#second-clock")), output) for port, source, output in second
    )
    monkeypatch.setattr(sc.Ecology, "holders", lambda _: {screen: Holder("watch~1", wants=Wants(other))})
    answer = sc.configure(clock, ecology)
    assert isinstance(answer, Answer)
    assert answer.wants(screen).inputs == other != second


RADIO = f"""{PREFIXES}
:play a sc:Template ; sc:roles ( :tuner ) ; sc:hasOutput [ sc:name "sound" ; sc:signalType rob:Audio ; sc:of :tuner ] .
:tuner a sc:Role ; sh:class rob:Tuner .
:radio-set a sc:Component, :Radio ; sc:preference 5 ; sc:grounding [ sc:template :play ] ;
    sc:hasOutput [ sc:name "sound" ; sc:signalType TYPE ] .
:old-radio a sc:Component, :Radio ; sc:hasOutput [ sc:name "sound" ; sc:signalType rob:Audio ] .
"""


@pytest.mark.parametrize(("signal", "player"), [("rob:Text", "old-radio"), ("rob:Audio", "radio-set")])
def test_a_composite_that_can_be_nothing_inside_plays_no_role_and_is_named(
    signal: str, player: str, tmp_path: Path
) -> None:
    """One whose inside cannot be configured from these advertisements plays, as others may be at its site."""
    (tmp_path / "radio.ttl").write_text(RADIO.replace("TYPE", signal))
    task = template(f"{PREFIXES}:listen a sc:Template ; sc:roles ( :set ) . :set a sc:Role ; sh:class :Radio .")
    inquiry = Inquiry(task, read(tmp_path), Method())
    assert inquiry.eligible == {str(iri("set")): 1 if player == "old-radio" else 2}
    answer = inquiry.answer()
    assert isinstance(answer, Answer)
    assert answer.components == (iri(player),)
    assert [(one.component, one.reason) for one in answer.left_out] == (
        [(iri("radio-set"), "its output 'sound' is Text, and that of the template play is Audio")]
        if player == "old-radio"
        else []
    )


def test_a_file_that_advertises_many_composites_is_read_once_for_what_they_are_inside(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    read_again: list[IRI] = []

    def described(advertisement: Advertisement) -> Document:
        read_again.append(advertisement.component)
        return described_in(advertisement)

    (tmp_path / "radio.ttl").write_text(RADIO.replace("TYPE", "rob:Text"))
    sets = [f":set{number} a sc:Component, :Radio ; sc:grounding [ sc:template :play ] ." for number in range(9)]
    (tmp_path / "sets.ttl").write_text("\n".join([RADIO.partition(":radio-set")[0], *sets]))
    task = template(f"{PREFIXES}:listen a sc:Template ; sc:roles ( :set ) . :set a sc:Role ; sh:class :Radio .")
    monkeypatch.setattr("selfconf.api.configuring.described_in", described)
    inquiry = Inquiry(task, read(tmp_path), Method())
    assert read_again == [iri("radio-set"), iri("set0")]
    assert inquiry.eligible == {str(iri("set")): 1}


def test_what_composites_of_one_file_are_inside_is_read_from_it_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    sets = [f":set{n} a sc:Component, :Radio ; SAID" for n in range(9)]
    head, _, said = RADIO.replace("TYPE", "rob:Audio").partition(":radio-set a sc:Component, :Radio ; ")
    said = said.partition(":old-radio")[0]
    text = head + "\n".join(one.replace("SAID", said) for one in sets) + ":tuner1 a sc:Component, rob:Tuner ; "
    (tmp_path / "sets.ttl").write_text(f'{text} sc:hasOutput [ sc:name "sound" ; sc:signalType rob:Audio ] .')
    task = template(f"{PREFIXES}:listen a sc:Template ; sc:roles ( :set ) . :set a sc:Role ; sh:class :Radio .")
    inquiry = Inquiry(task, read(tmp_path), Method())
    answer = inquiry.answer()
    assert isinstance(answer, Answer)
    read_again: list[IRI] = []

    def described(advertisement: Advertisement) -> Document:
        read_again.append(advertisement.component)
        return described_in(advertisement)

    monkeypatch.setattr("selfconf.api.configuring.described_in", described)
    ((component, inside),) = inquiry.insides(answer)
    assert component == iri("set0")
    assert isinstance(inside, Configuration)
    assert inside.components == (iri("tuner1"),)
    assert read_again == [iri("set0")]


def test_what_a_composite_is_inside_is_not_told_where_no_file_says_it() -> None:
    """It is not refused: an ecology that lives, or an endpoint, does not hand on the document of the composite."""
    text = RADIO.replace("TYPE", "rob:Audio")
    task = template(f"{PREFIXES}:listen a sc:Template ; sc:roles ( :set ) . :set a sc:Role ; sh:class :Radio .")
    inquiry = Inquiry(task, read(text), Method())
    answer = inquiry.answer()
    assert isinstance(answer, Answer)
    assert inquiry.insides(answer) == []


class OneQuestion(TimeLimit):
    """The time is up after one question."""

    asked = 0

    def within(self, ask: Callable[[], Result], otherwise: Result) -> Result:
        self.asked += 1
        return otherwise if self.asked > 1 else ask()


def test_what_composites_are_inside_takes_no_longer_than_the_time_that_is_allowed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("selfconf.api.configuring.TimeLimit", OneQuestion)
    (tmp_path / "radio.ttl").write_text(RADIO.replace("TYPE", "rob:Audio"))
    task = template(f"{PREFIXES}:listen a sc:Template ; sc:roles ( :set ) . :set a sc:Role ; sh:class :Radio .")
    inquiry = Inquiry(task, read(tmp_path), Method(seconds=2))
    answer = inquiry.answer()
    assert isinstance(answer, Answer)
    assert inquiry.insides(answer) == [(iri("radio-set"), Undecided(seconds=2))]


def test_a_refusal_of_text_that_is_in_no_file_has_its_lines(clock: sc.TaskSpecification) -> None:
    ecology = sc.read(*(Path(f"examples/clock/{name}.ttl").read_text() for name in ("clock", "display")))
    refusal = sc.configure(clock.bind(room=":cellar"), ecology)
    assert isinstance(refusal, sc.Refusal)
    assert [str(miss.place) for miss in refusal.near_misses] == ["<text>:5"]


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (
            {"strategy": "worst"},
            f"there is no strategy 'worst'; choose one of {', '.join(map(repr, STRATEGIES))}",
        ),
        ({"reasoning": "owl"}, "there is no reasoning 'owl'; choose one of 'syntactic', 'subclass', 'owl-rl'"),
    ],
)
def test_a_word_that_is_no_option_is_answered_with_those_that_are(
    options: dict[str, str], said: str, task: sc.TaskSpecification, home: sc.Ecology
) -> None:
    with pytest.raises(ProgrammerError) as error:
        sc.configure(task, home, **options)  # type: ignore[arg-type]  # words are all that is given
    assert str(error.value) == said


def test_arguments_of_another_kind_are_refused_in_a_sentence(task: sc.TaskSpecification, home: sc.Ecology) -> None:
    with pytest.raises(ProgrammerError, match=r"selfconf.template\(\) gives, not str"):
        sc.configure("examples/navigate.ttl", home)  # type: ignore[arg-type]  # refused when it runs, too
    with pytest.raises(ProgrammerError, match=r"selfconf.read\(\) or selfconf.join\(\) gives, not str"):
        sc.configure(task, "examples/peis-home")  # type: ignore[arg-type]  # refused when it runs, too
    with pytest.raises(ProgrammerError, match="steps are a whole number"):
        sc.configure(task, home, steps=0)
    with pytest.raises(ProgrammerError, match="seconds are a number"):
        sc.configure(task, home, seconds=-1)
    with pytest.raises(ProgrammerError, match="what_if is True or False, not 'no'"):
        sc.configure(task, home, what_if="no")  # type: ignore[arg-type]  # refused when it runs, too
    with pytest.raises(AuthorError, match="an empty text is no path"):
        sc.configure(task, home, ontologies="")
    with pytest.raises(ProgrammerError, match="paths are one path or several"):
        sc.configure(task, home, ontologies=None)  # type: ignore[arg-type]  # refused when it runs, too


def test_ontologies_are_a_path_or_several(task: sc.TaskSpecification, home: sc.Ecology) -> None:
    peis = Path("ontology/peis-home.ttl")
    for ontologies in (peis, str(peis), [peis], (str(peis),), "ontology"):
        assert sc.configure(task, home, reasoning="subclass", ontologies=ontologies)
    with pytest.raises(AuthorError, match="no file or folder nowhere"):
        sc.configure(task, home, ontologies="nowhere.ttl")


COST = "sc:cost ( [ sc:term [ sc:property :price ] , [ sc:property :weight ] ] )"
PRICED = PREFIXES + f":t a sc:Template ; {COST} ; sc:roles ( :r ) .\n:r a sc:Role ; sh:class :Lamp ."
LAMPS = (
    PREFIXES + ":dear a sc:Component, :Lamp ; :price 9 ; sc:preference 5 . :cheap a sc:Component, :Lamp ; :price 2 ."
)


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
    assert best.unknown_properties == (iri("weight"),)
    assert "no component of the ecology has a number for :weight" in str(best)


def test_a_property_that_another_component_has_is_not_unknown_to_the_ecology() -> None:
    best = configure(template(PRICED), read(LAMPS + ":oven a sc:Component, :Oven ; :weight 3 ."), strategy="best")
    assert isinstance(best, Answer)
    assert best.unknown_properties == ()
    assert best.optimum is not None
    assert best.optimum.missing == ((iri("cheap"), iri("weight")),)


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
    assert refusal.hint == "with reasoning='subclass' there is a configuration"
    assert navigation(special, reasoning="subclass")


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


def test_a_task_without_a_value_or_with_a_shape_that_is_none_is_said() -> None:
    with pytest.raises(BindingError, match="needs a value"):
        configure(template(NAVIGATE), read(EVERYTHING))
    bad = PREFIXES + ':t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:pattern "(" .'
    with pytest.raises(TemplateError, match="not well-formed"):
        configure(template(bad), read(EVERYTHING))


def test_the_time_to_load_counts_the_reading_of_files(clock: sc.TaskSpecification) -> None:
    ecology = sc.read("examples/clock")
    inquiry = Inquiry(clock, ecology, Method())
    assert inquiry.seconds["load"] > ecology.read_seconds > 0

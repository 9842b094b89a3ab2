"""Composition of a task from advertisements: hints, fallbacks and what stands by."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

from selfconf.composition import searches
from selfconf.composition.composer import STANDBY, Composer
from selfconf.composition.searches import Strategy
from selfconf.configurator.state import Phase
from selfconf.deployment.notices import AT_LEISURE
from selfconf.model.configuration import Configuration
from selfconf.model.hierarchy import Hierarchy
from selfconf.model.optimum import Optimum
from selfconf.model.refusal import Refusal, Undecided
from selfconf.model.term import IRI
from selfconf.protocol.messages import Wire
from selfconf.rdf.advertisements import reader as advertisements
from selfconf.rdf.advertisements.advertisement import Advertisement
from selfconf.rdf.deadline import Abandoned
from selfconf.rdf.tasks import templates
from selfconf.rdf.tasks.templates import TaskDocument
from selfconf.rdf.turtle import document as turtle
from tests import hostile_words
from tests.lab import PREFIXES, Lab, iri

NOBODY: frozenset[IRI] = frozenset()
CONTROL = """
:control a sc:Role ; sh:class :Controller .
:position a sc:Role ; sh:class :Locator ; sc:feeds :control .
"""
PLAIN = f":navigate a sc:Template ; sc:roles ( :position :control ) . {CONTROL}"
PRICED = (
    ":navigate a sc:Template ; sc:roles ( :position :control ) ;"
    f" sc:cost ( [ sc:term [ sc:property :price ] ] ) . {CONTROL}"
)


def task(text: str) -> TaskDocument:
    """A template as a task."""
    return templates.read_task(turtle.parse(PREFIXES + text, "template.ttl"))


def ecology(*described: str) -> Mapping[IRI, Advertisement]:
    """Components by what they say of themselves."""
    found, malformed = advertisements.read_document(turtle.parse(PREFIXES + "\n".join(described), "ads.ttl"))
    assert not malformed
    return {one.component: one for one in found}


def locator(name: str, signal: str = "Pose", price: int = 1) -> str:
    """A component that tells where something is."""
    output = f'[ sc:name "pose" ; sc:signalType :{signal} ]'
    return f":{name} a sc:Component, :Locator ; :price {price} ; sc:hasOutput {output} ."


def controller(name: str, **inputs: str) -> str:
    """A component with those inputs; by default it wants to know where something is."""
    wanted = inputs or {"where": "Pose"}
    ports = " , ".join(f'[ sc:name "{port}" ; sc:signalType :{signal} ]' for port, signal in wanted.items())
    return f":{name} a sc:Component, :Controller ; :price 1 ; sc:hasInput {ports} ."


def configured(composer: Composer, given: Mapping[IRI, Advertisement]) -> Configuration:
    """The configuration of an ecology that has one."""
    answer = composer.compose(given, NOBODY, None)
    assert isinstance(answer, Configuration), answer
    return answer


# The hint that subclasses would do.


def test_a_signal_that_is_of_a_subclass_of_what_is_wanted_is_a_hint() -> None:
    composer, given = Composer(task(PLAIN)), ecology(locator("gps", "PlanarPose"), controller("cap"))
    above = Hierarchy([(iri("PlanarPose"), iri("Pose"))])
    assert isinstance(composer.compose(given, NOBODY, None), Refusal)
    assert composer.possible_under(given, above)
    assert configured(Composer(task(PLAIN), above), given).connections


def test_a_hierarchy_in_which_no_more_matches_is_no_hint() -> None:
    composer, given = Composer(task(PLAIN)), ecology(locator("gps", "PlanarPose"), controller("cap"))
    for lower, upper in (("PlanarPose", "Thing"), ("Pose", "PlanarPose"), ("Locator", "Pose")):
        assert not composer.possible_under(given, Hierarchy([(iri(lower), iri(upper))]))


def test_subclasses_that_match_but_do_not_suffice_are_no_hint() -> None:
    composer = Composer(task(PLAIN))
    given = ecology(locator("gps", "PlanarPose"), controller("cap", where="Pose", when="Time"))
    assert not composer.possible_under(given, Hierarchy([(iri("PlanarPose"), iri("Pose"))]))


@pytest.mark.parametrize(("steps", "found"), [(1_000, True), (1, False)])
def test_that_subclasses_would_do_is_found_within_steps(
    monkeypatch: pytest.MonkeyPatch, steps: int, found: bool
) -> None:
    monkeypatch.setattr("selfconf.composition.composer.HINT_STEPS", steps)
    above = Hierarchy([(iri("PlanarPose"), iri("Pose"))])
    composer, given = Composer(task(PLAIN)), ecology(locator("gps", "PlanarPose"), controller("cap"))
    assert composer.possible_under(given, above) == found


def test_subclasses_that_need_an_optional_role_are_a_hint() -> None:
    document = task(
        ":navigate a sc:Template ; sc:roles ( :position :control ) . :control a sc:Role ; sh:class :Steering ."
        ":position a sc:Role ; sh:class :Locator ; sc:minCount 0 ; sc:feeds :control ."
    )
    above = Hierarchy([(iri("Controller"), iri("Steering"))])
    composer, given = Composer(document), ecology(locator("gps"), controller("cap"))
    assert isinstance(composer.compose(given, NOBODY, None), Refusal)
    assert composer.possible_under(given, above)
    assert not composer.possible_under(ecology(controller("cap")), above)


def test_subclasses_of_players_without_recruits_are_no_hint() -> None:
    document = task(
        ":navigate a sc:Template ; sc:roles ( :control ) . :control a sc:Role ; sh:class :Steering ; sc:recruits true ."
    )
    above = Hierarchy([(iri("Controller"), iri("Steering"))])
    pose = '[ sc:name "pose" ; sc:signalType :Pose ]'
    only = f":cap a sc:Component, :Controller ; sc:hasInput {pose} ; sc:hasOutput {pose} ."
    composer = Composer(document)
    assert not composer.possible_under(ecology(only), above)  # which would have to feed itself
    assert composer.possible_under(ecology(only, locator("gps")), above)


def test_a_recruit_whose_signal_is_of_a_subclass_of_what_is_wanted_is_a_hint() -> None:
    recruiting = ":navigate a sc:Template ; sc:roles ( :control ) . :control a sc:Role ; sh:class :Controller"
    composer = Composer(task(f"{recruiting} ; sc:recruits true ."))
    given = ecology(locator("gps", "PlanarPose"), controller("cap"))
    assert isinstance(composer.compose(given, NOBODY, None), Refusal)
    assert composer.possible_under(given, Hierarchy([(iri("PlanarPose"), iri("Pose"))]))


# The strategy `best`.


def test_where_the_best_is_not_decided_the_first_is_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(searches, "SLICES", (1,))
    given = ecology(locator("gps", price=9), locator("odometry", price=2), controller("cap"))
    answers = list(Composer(task(PRICED), strategy=Strategy.BEST).answers(given, NOBODY, None))
    assert isinstance(answers[0], Undecided)
    assert answers[-1] == configured(Composer(task(PRICED)), given)


def test_where_it_is_decided_the_best_is_the_last_answer() -> None:
    given = ecology(locator("gps", price=9), locator("odometry", price=2), controller("cap"))
    *_, answer = Composer(task(PRICED), strategy=Strategy.BEST).answers(given, NOBODY, None)
    assert isinstance(answer, Optimum)
    assert answer.proved
    assert answer.configuration.assignments[0].components == (iri("odometry"),)


def test_with_steps_given_no_more_than_these_are_taken_for_the_best() -> None:
    given = ecology(locator("gps", price=9), locator("odometry", price=2), controller("cap"))
    composer = Composer(task(PRICED), strategy=Strategy.BEST, steps=1)
    assert all(isinstance(answer, Undecided) for answer in composer.answers(given, NOBODY, None))


# Who stands by.


def test_components_that_could_feed_an_input_next_stand_by_and_chosen_ones_do_not() -> None:
    names = [f"locator{number}" for number in range(STANDBY + 3)]
    given = ecology(*map(locator, names), controller("cap", start="Pose", end="Pose"))
    composer = Composer(task(PLAIN))
    configuration = configured(composer, given)
    playing, *others = [iri(name) for name in names]
    assert configuration.assignments[0].components == (playing,)
    spare = tuple(Wire(one, "pose") for one in others[:STANDBY])
    assert composer.standby(configuration, NOBODY) == {iri("cap"): {"start": spare, "end": spare}}


def test_a_lost_component_does_not_stand_by() -> None:
    names = [f"locator{number}" for number in range(STANDBY + 3)]
    given = ecology(*map(locator, names), controller("cap"))
    composer = Composer(task(PLAIN))
    found = composer.standby(configured(composer, given), frozenset({iri(names[1])}))
    assert found == {iri("cap"): {"where": tuple(Wire(iri(one), "pose") for one in names[2 : 2 + STANDBY])}}


def test_a_component_in_another_role_does_not_stand_by() -> None:
    text = PLAIN.replace(":position :control", ":position :spare :control") + ":spare a sc:Role ; sh:class :Locator ."
    given = ecology(locator("a"), locator("b"), locator("c"), controller("cap"))
    composer = Composer(task(text))
    found = composer.standby(configured(composer, given), NOBODY)
    assert found == {iri("cap"): {"where": (Wire(iri("c"), "pose"),)}}


def test_where_no_candidate_is_left_none_stands_by() -> None:
    composer, given = Composer(task(PLAIN)), ecology(locator("gps"), controller("cap"))
    assert composer.standby(configured(composer, given), NOBODY) == {}


def test_with_a_budget_a_running_configuration_is_still_repaired() -> None:
    given = ecology(*(f":c{number} a sc:Component, :Worker ." for number in range(6)))
    pair = task(":duo a sc:Template ; sc:roles ( :a :b ) . :a a sc:Role . :b a sc:Role .")
    composer = Composer(pair, steps=10_000)
    running = configured(composer, given)
    after = composer.compose(given, frozenset(running.components[:1]), running)
    assert isinstance(after, Configuration)
    assert running.components[1] in after.components
    hurried = Composer(pair, steps=1).compose(given, frozenset(running.components[:1]), running)
    assert isinstance(hurried, Undecided)


# The strategy `paper`.

SET = """
:go a sc:Template ; sc:parameter :goal ; sc:roles ( :mind ) .
:goal a sc:Parameter ; sc:name "goal" .
:mind a sc:Role ; sh:class :Mind ; sc:sets [ sc:parameterType :Goal ; sc:value :goal ] .
"""
MIND = ':cap a sc:Component, :Mind ; sc:hasParameter [ sc:name "goal" ; sc:parameterType :Goal ] .'


@pytest.mark.parametrize("strategy", Strategy)
def test_a_parameter_that_is_set_and_has_no_value_is_a_reason_for_every_strategy(strategy: Strategy) -> None:
    answer = Composer(task(SET), strategy=strategy).compose(ecology(MIND), NOBODY, None)
    assert isinstance(answer, Refusal)
    assert [reason.code for reason in answer.reasons] == ["value-unknown"]


@pytest.mark.parametrize("strategy", Strategy)
def test_a_role_that_takes_no_component_sets_nothing_by_any_strategy(strategy: Strategy) -> None:
    optional = SET.replace("sh:class", "sc:minCount 0 ; sc:maxCount 1 ; sh:class")
    answer = Composer(task(optional), strategy=strategy).compose(ecology(MIND), NOBODY, None)
    assert isinstance(answer, Configuration)
    assert (answer.components, answer.settings) == ((), ())


def test_the_papers_algorithm_gives_the_first_configuration_and_needs_more_steps() -> None:
    given = ecology(*(locator(f"locator{number}") for number in range(3)), controller("cap"))
    paper = Composer(task(PLAIN), strategy=Strategy.PAPER)
    assert configured(paper, given) == configured(Composer(task(PLAIN)), given)
    hurried = Composer(task(PLAIN), strategy=Strategy.PAPER, steps=1).compose(given, NOBODY, None)
    assert hurried == Undecided(1)


def test_the_partition_is_made_again_only_when_the_ecology_has_changed() -> None:
    composer, given = Composer(task(PLAIN)), ecology(locator("gps"), controller("cap"))
    first = composer.partition(given)
    assert composer.partition(dict(given)) is first
    assert [
        len(candidates) for candidates in composer.partition({**given, **ecology(locator("odometry"))}).candidates
    ] == [2, 1]
    grown = {**given}
    composer.partition(grown)
    grown |= ecology(locator("odometry"))
    assert [len(candidates) for candidates in composer.partition(grown).candidates] == [2, 1]


def test_a_partition_that_was_ended_in_the_middle_is_made_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    composer, before = Composer(task(PLAIN)), ecology(locator("gps"), controller("cap"))
    after = {**before, **ecology(locator("odometry"))}
    composer.partition(before)

    def ended(_: object) -> None:
        raise Abandoned

    with monkeypatch.context() as patch:
        patch.setattr(composer.partitioner, "partition", ended)
        with pytest.raises(Abandoned):
            composer.partition(after)
    assert composer.partition(after) == Composer(task(PLAIN)).partition(after)


def test_components_that_were_passed_over_are_those_before_the_last_choice() -> None:
    given = ecology(locator("gps", "Time"), locator("odometry"), locator("wheels"), controller("cap"))
    composer = Composer(task(PLAIN))
    assert composer.passed_over(configured(composer, given)) == {iri("position"): [iri("gps")], iri("control"): []}


def helping(composer: Composer, given: Mapping[IRI, Advertisement], *held: str) -> dict[IRI, tuple[IRI, ...]]:
    """The held components that could help where the ecology is refused without them."""
    components = frozenset(map(iri, held))
    refusal = composer.compose(given, components, None)
    assert isinstance(refusal, Refusal)
    return composer.usable(components, refusal)


def test_what_could_help_is_told_with_the_roles_that_it_may_play() -> None:
    given = ecology(locator("gps"), locator("beacon"), controller("cap"), ":lamp a sc:Component, :Lamp .")
    held = "gps", "beacon", "lamp", "unheard-of"
    assert helping(Composer(task(PLAIN)), given, *held) == {iri(one): (iri("position"),) for one in ("gps", "beacon")}


def test_a_component_of_a_role_that_has_candidates_does_not_help() -> None:
    given = ecology(locator("gps"), locator("beacon"), controller("cap"))
    assert helping(Composer(task(PLAIN)), given, "beacon", "cap") == {iri("cap"): (iri("control"),)}


def test_where_no_reason_is_known_a_component_of_any_role_may_help() -> None:
    composer, given = Composer(task(PLAIN)), ecology(locator("gps"), controller("cap"))
    composer.partition(given)
    unexplained = Refusal(composer.task.template.iri, ())
    assert composer.usable({*given}, unexplained) == {iri("gps"): (iri("position"),), iri("cap"): (iri("control"),)}


def test_a_component_that_feeds_what_is_not_fed_helps() -> None:
    given = ecology(locator("ear", "Echo"), locator("gps"), controller("cap"), controller("hat"))
    helped = helping(Composer(task(PLAIN)), given, "gps", "hat")
    assert helped == {iri("gps"): (iri("position"),), iri("hat"): (iri("control"),)}


def test_a_component_of_a_role_that_shares_too_few_with_others_helps() -> None:
    both = ":navigate a sc:Template ; sc:roles ( :r :s ) . :r a sc:Role ; sh:class :Locator ."
    composer = Composer(task(f"{both} :s a sc:Role ; sh:class :Locator ."))
    assert helping(composer, ecology(locator("gps"), locator("beacon")), "beacon") == {
        iri("beacon"): (iri("r"), iri("s"))
    }


def test_what_could_help_as_a_recruit_is_told_without_a_role() -> None:
    recruiting = ":navigate a sc:Template ; sc:roles ( :control ) . :control a sc:Role ; sh:class :Controller"
    composer = Composer(task(f"{recruiting} ; sc:recruits true ."))
    given = ecology(locator("gps"), locator("ear", "Echo"), controller("cap"))
    assert helping(composer, given, "gps", "ear") == {iri("gps"): ()}


def test_what_strangers_say_keeps_them_out_and_no_one_else() -> None:
    given = templates.read_task(turtle.parse(hostile_words.TEMPLATE, "template.ttl"))
    strangers = [hostile_words.stranger(kind, 1) for kind in hostile_words.KINDS]
    found = {
        one.component: one
        for text in (hostile_words.HONEST, *strangers)
        for one in advertisements.read_document(turtle.parse(text, "ads.ttl"))[0]
    }
    composer = Composer(given)
    first = composer.compose(found, NOBODY, None)
    assert isinstance(first, Configuration)
    assert first.components == tuple(map(iri, ("cam-1", "ear-1", "arm-1", "screen")))
    assert sorted(composer.not_judged()) == [iri("stranger-beyond-1"), iri("stranger-crowd-1")]
    second = composer.compose(found, frozenset({iri("cam-1"), iri("ear-1")}), first)
    assert isinstance(second, Configuration)
    assert second.components == tuple(map(iri, ("cam-2", "ear-2", "arm-1", "screen")))


def test_a_running_task_survives_what_strangers_advertise_and_the_failure_of_a_component(tmp_path: Path) -> None:
    honest = {line.split()[0][1:]: line for line in hostile_words.HONEST.splitlines() if line.startswith(":")}
    (tmp_path / "home").mkdir()
    for number, kind in enumerate(kind for kind in hostile_words.KINDS for _ in range(4)):
        (tmp_path / "home" / f"stranger{number}.ttl").write_text(hostile_words.stranger(kind, number))
    lab = Lab(tmp_path, advertised=honest)
    lab.site("home")
    for name in honest:
        lab.component(name)
    agent = lab.agent(hostile_words.TEMPLATE, bound=())
    assert lab.running(agent)
    assert agent.configuration is not None
    assert agent.configuration.components == tuple(map(iri, ("cam-1", "ear-1", "arm-1", "screen")))
    lab.crash("cam-1")
    assert lab.until(lambda: "cam-2" in lab.active() and agent.state.phase is Phase.RUNNING)
    lab.let_pass(2 * AT_LEISURE)
    assert lab.ended == []
    named = [event.component.short.rpartition("-")[0] for event in lab.acts("left out")]
    assert sorted(named) == ["stranger-beyond"] * 4 + ["stranger-crowd"] * 4  # each once, though composed twice
    assert agent.configuration.components == tuple(map(iri, ("cam-2", "ear-1", "arm-1", "screen")))

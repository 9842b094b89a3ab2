"""What a refusal tells beyond its reasons: near misses by type, what would mend it, the reasoning that would."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TypeVar

import pytest

from selfconf.composition import Composer, TimeLimit, explained
from selfconf.model.hierarchy import Hierarchy
from selfconf.model.refusal import Refusal
from selfconf.model.relaxation import AcceptNearMiss
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement, read_advertisements
from selfconf.rdf.tasks import read_task
from selfconf.rdf.turtle import parse
from tests.lab import PREFIXES, iri

UNLIMITED = TimeLimit(None)
Result = TypeVar("Result")
EYE = ":watch a sc:Template ; sc:roles ( :eye ) .\n:eye a sc:Role ; sh:class :Camera ."
TEAM = f":team a sc:Template ; sc:roles ( {' '.join(f':r{k}' for k in range(7))} ) .\n" + "\n".join(
    f":r{k} a sc:Role ; sh:class :Worker ." for k in range(7)
)
CROWD = "\n".join(f":c{k} a sc:Component, :Worker ." for k in range(6))
"""One worker too few."""
BELOW = Hierarchy([(iri("CeilingCamera"), iri("Camera"))])
NOTHING = Hierarchy()


def refused(
    task: str, ads: str, steps: int | None = None, hierarchy: Hierarchy = NOTHING
) -> tuple[Composer, Mapping[IRI, Advertisement], Refusal]:
    """A task that has no configuration, with the refusal as the search gives it."""
    composer = Composer(read_task(parse(PREFIXES + task, "t.ttl")), hierarchy, steps=steps)
    good, bad = read_advertisements((PREFIXES + ads).encode(), "a.ttl")
    assert not bad
    ecology = {one.component: one for one in good}
    refusal = composer.compose(ecology, frozenset(), None)
    assert isinstance(refusal, Refusal)
    return composer, ecology, refusal


def test_a_misspelt_type_is_a_near_miss_and_to_accept_it_would_do() -> None:
    composer, ecology, refusal = refused(EYE, ":cam a sc:Component, :Camra .")
    assert refusal.near_misses == ()
    told = explained(composer, ecology, refusal, NOTHING, UNLIMITED)
    assert [(miss.component, str(miss.obstacle)) for miss in told.near_misses] == [
        (iri("cam"), "is no Camera but a Camra (is one of them misspelt?)")
    ]
    assert isinstance(told.repairs[0], AcceptNearMiss)
    assert told.reasons == refusal.reasons


def accepted_near_misses(task: str, ads: str, hierarchy: Hierarchy = NOTHING) -> list[IRI]:
    """The components that a refusal proposes to take all the same."""
    composer, ecology, refusal = refused(task, ads, hierarchy=hierarchy)
    repairs = explained(composer, ecology, refusal, None, UNLIMITED).repairs
    return [one.candidate.profile.component for one in repairs if isinstance(one, AcceptNearMiss)]


SHOWN = """:show a sc:Template ; sc:roles ( :eye :screen ) .
:eye a sc:Role ; sh:class :Camera ; sc:feeds :screen%s .
:screen a sc:Role ; sh:class :Screen%s ."""
OLD = " ; sh:property [ sh:path :age ; sh:maxInclusive 2 ]"
FAST = "sc:accepts [ sh:property [ sh:path ( sc:rate sc:value ) ; sh:minCount 1 ; sh:minInclusive 2 ] ]"
SCREEN = f":s a sc:Component, :Screen ; :age 3 ; sc:hasInput [ sc:name 'in' ; sc:signalType :Image ; {FAST} ] ."


def seeing(name: str, rate: int) -> str:
    """A camera of some rate."""
    output = f"sc:name 'out' ; sc:signalType :Image ; sc:rate [ sc:value {rate} ; sc:unit unit:HZ ]"
    return f":{name} a sc:Component, :Camera ; :age 3 ; sc:hasOutput [ {output} ] .\n"


def test_to_take_a_near_miss_would_do_if_it_conforms_to_what_an_input_accepts() -> None:
    ads = seeing("fast", 5) + seeing("slow", 1) + SCREEN
    assert accepted_near_misses(SHOWN % (OLD, ""), ads) == [iri("fast")]


def test_to_take_a_near_miss_would_do_if_what_feeds_it_conforms_to_what_it_accepts() -> None:
    assert accepted_near_misses(SHOWN % ("", OLD), seeing("fast", 5) + SCREEN) == [iri("s")]
    assert accepted_near_misses(SHOWN % ("", OLD), seeing("slow", 1) + SCREEN) == []


def test_to_take_a_near_miss_would_do_if_what_it_sends_along_lies_below_what_is_taken() -> None:
    ads = """:cam a sc:Component, :Camera ; sc:hasOperation [ sc:name 'look' ; sc:request :CeilingCamera ] .
    :s a sc:Component, :Screen ; :age 3 ; sc:needsOperation [ sc:name 'ask' ; sc:request :%s ] ."""
    above = Hierarchy([(iri("Special"), iri("CeilingCamera"))])
    assert accepted_near_misses(SHOWN % ("", OLD), ads % "Special", above) == [iri("s")]
    assert accepted_near_misses(SHOWN % ("", OLD), ads % "Camera", above) == []


@pytest.mark.parametrize("others", ["", ":f a sc:Component, :Camera ; :age 1 ; :at :hall ."], ids=["alone", "one more"])
def test_to_take_a_near_miss_would_do_if_it_states_what_a_role_is_set_to(others: str) -> None:
    """Beside a camera without an output the near miss states a further value, alone it states the only one."""
    where = " ; sh:property [ sh:path :at ; sh:in ( :room ) ]"
    set_ = " ; sc:sets [ sc:parameterType :Place ; sc:value :room ]"
    room = SHOWN.replace("sc:roles", "sc:parameter :room ; sc:roles") + '\n:room a sc:Parameter ; sc:name "room" .'
    ads = (
        seeing("fast", 5).replace(":age 3", ":age 3 ; :at :kitchen")
        + others
        + SCREEN.replace(":age 3", ":age 3 ; sc:hasParameter [ sc:name 'place' ; sc:parameterType :Place ]")
    )
    assert accepted_near_misses(room % (OLD + where, set_), ads) == [iri("fast")]


@pytest.mark.parametrize(("place", "accepted"), [("hall", True), ("kitchen", True), ("garage", False)])
def test_to_take_a_near_miss_would_do_if_it_is_where_another_component_is(place: str, accepted: bool) -> None:
    where = " ; sh:property [ sh:path :at ; sh:in ( :room ) ]"
    room = SHOWN.replace("sc:roles", "sc:parameter :room ; sc:roles") + '\n:room a sc:Parameter ; sc:name "room" .'
    screens = [SCREEN.replace(":s a", f":{one} a").replace(":age 3", f":at :{one}") for one in ("hall", "kitchen")]
    ads = seeing("fast", 5).replace(":age 3", f":age 3 ; :at :{place}") + "\n".join(screens)
    assert accepted_near_misses(room % (OLD + where, where), ads) == [iri("fast")] * accepted


def test_that_a_hierarchy_would_do_is_a_hint_where_none_was_seen() -> None:
    composer, ecology, refusal = refused(EYE, ":cam a sc:Component, :CeilingCamera .")
    told = explained(composer, ecology, refusal, BELOW, UNLIMITED)
    assert told.hint == "with reasoning='subclass' there is a configuration"
    (miss,) = told.near_misses
    assert "which lies below it" in str(miss.obstacle)
    assert explained(composer, ecology, refusal, NOTHING, UNLIMITED).hint is None


def test_where_a_hierarchy_is_seen_already_there_is_no_hint() -> None:
    composer, ecology, refusal = refused(EYE, ":cam a sc:Component, :Oven .", hierarchy=BELOW)
    told = explained(composer, ecology, refusal, None, UNLIMITED)
    assert (told.hint, told.near_misses) == (None, ())


def test_a_role_that_has_its_candidates_has_no_near_miss_by_type() -> None:
    composer, ecology, refusal = refused(TEAM, CROWD + " :odd a sc:Component, :Workr .")
    assert explained(composer, ecology, refusal, NOTHING, UNLIMITED).near_misses == refusal.near_misses


def test_steps_limit_the_relaxations_that_are_tried() -> None:
    composer, ecology, refusal = refused(TEAM, CROWD)
    assert explained(composer, ecology, refusal, NOTHING, UNLIMITED).repairs
    composer, ecology, refusal = refused(TEAM, CROWD, steps=40)
    assert not explained(composer, ecology, refusal, NOTHING, UNLIMITED).repairs


def test_without_time_a_refusal_stays_as_it_is() -> None:
    composer, ecology, refusal = refused(EYE, ":cam a sc:Component, :CeilingCamera .")
    told = explained(composer, ecology, refusal, BELOW, TimeLimit(1e-9))
    assert (told.reasons, told.repairs, told.hint) == (refusal.reasons, (), None)


class Ending(TimeLimit):
    """The time is up after a number of questions."""

    def __init__(self, questions: int) -> None:
        super().__init__(None)
        self.left = questions

    def within(self, ask: Callable[[], Result], otherwise: Result) -> Result:
        self.left -= 1
        return otherwise if self.left < 0 else ask()


def test_that_the_time_ended_before_all_relaxations_were_tried_is_told() -> None:
    seeing = ':eye a sc:Component, :Camera ; sc:hasInput [ sc:name "light" ; sc:signalType :Light ] .'
    lamp = ':lamp a sc:Component, :Lamp ; sc:hasOutput [ sc:name "light" ; sc:signalType :Light ] .'
    composer, ecology, refusal = refused(EYE, f"{seeing}\n{lamp}")
    whole = explained(composer, ecology, refusal, None, UNLIMITED)
    assert {one.code for one in whole.repairs} > {"let-recruit"}
    told = [explained(composer, ecology, refusal, None, Ending(questions)) for questions in range(5)]
    assert [one.repairs == whole.repairs for one in told] == [False] * 4 + [True]
    assert [one.repairs_stopped for one in told] == [True] * 4 + [False]

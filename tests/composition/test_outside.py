"""What is outside of a composite plays in its inside: it issues what the template receives, and needs what it gives."""

from __future__ import annotations

from selfconf.composition import Composer
from selfconf.composition.outside import inside_alone, with_outside, with_outside_candidate, with_outside_player
from selfconf.model.configuration import Configuration, Connection, Wants
from selfconf.model.holder import Holder
from selfconf.model.partition import Barred, Partition
from selfconf.model.refusal import InputUnfed, Outcome, Refusal
from selfconf.model.sharing import agreed
from selfconf.model.template import Interaction, Role
from selfconf.rdf import tasks
from selfconf.rdf.advertisements import read_advertisements
from selfconf.rdf.turtle import parse
from tests.lab import PREFIXES, iri

TEXT = f"""{PREFIXES}
:whole a sc:Component, :Whole ; sc:grounding [ sc:template :localise ] ;
    sc:hasInput [ sc:name "hint" ; sc:signalType :Hint ] ; sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ] .
:localise a sc:Template ; sc:roles ( :tracker ) ;
    sc:hasInput [ sc:name "hint" ; sc:signalType :Hint ; sc:of :tracker ] ;
    sc:hasOutput [ sc:name "pose" ; sc:signalType :Pose ; sc:of :tracker ] .
:tracker a sc:Role ; sh:class :Tracker .
"""
TRACKER = """:t a sc:Component, :Tracker ; sc:hasInput [ sc:name "help" ; sc:signalType :Hint ] ;
    sc:hasOutput [ sc:name "where" ; sc:signalType :Pose ] ."""
WHOLE, TRACKER_ROLE = iri("whole"), iri("tracker")


def answered(tracker: str) -> object:
    """The inside of the composite with one tracker."""
    composer = Composer(tasks.InsideReader(parse(TEXT, "t.ttl")).read(WHOLE), outside=WHOLE)
    found, _ = read_advertisements((PREFIXES + tracker).encode(), "ads.ttl")
    return composer.compose({one.component: one for one in found}, frozenset((WHOLE,)), None)


def test_ports_are_joined_by_type_to_those_of_the_players_of_their_roles() -> None:
    found = answered(TRACKER)
    assert isinstance(found, Configuration)
    assert found.components == (iri("t"),)
    assert set(found.connections) == {
        Connection(WHOLE, "hint", iri("t"), "help"),
        Connection(iri("t"), "where", WHOLE, "pose"),
    }


def test_an_inside_that_does_not_give_what_the_template_promises_is_refused() -> None:
    found = answered(TRACKER.replace(":Pose", ":Guess"))
    assert isinstance(found, Refusal)
    (reason,) = found.reasons
    assert isinstance(reason, InputUnfed)
    assert (reason.role, reason.input, reason.sources) == (WHOLE, "pose", (TRACKER_ROLE,))


def test_what_is_outside_feeds_no_input_that_accepts_a_shape() -> None:
    """Whether it conforms is not known: another component may feed the composite each time."""
    accepting = "sc:signalType :Hint ; sc:accepts [ sh:property [ sh:path sc:rate ; sh:maxCount 1 ] ]"
    found = answered(TRACKER.replace("sc:signalType :Hint", accepting))
    assert isinstance(found, Refusal)
    (reason,) = found.reasons
    assert isinstance(reason, InputUnfed)
    assert (reason.component, reason.input, reason.sources) == (iri("t"), "help", (WHOLE,))
    optional = answered(TRACKER.replace("sc:signalType :Hint", f"{accepting} ; sc:optional true"))
    assert isinstance(optional, Configuration)
    assert set(optional.connections) == {Connection(iri("t"), "where", WHOLE, "pose")}


def test_what_is_outside_is_a_role_of_its_own_that_is_left_out_in_the_end() -> None:
    task = tasks.InsideReader(parse(TEXT, "t.ttl")).read(WHOLE).task
    whole = with_outside(task, WHOLE)
    assert whole.template.roles == (*task.template.roles, Role(WHOLE))
    assert whole.template.interactions == (
        Interaction(WHOLE, TRACKER_ROLE, "hint"),
        Interaction(TRACKER_ROLE, WHOLE, None, "pose"),
    )
    ((outside,),) = with_outside_candidate(Partition(()), whole, WHOLE).candidates
    assert [port.name for port in outside.profile.inputs] == ["pose"]
    assert [port.name for port in outside.profile.outputs] == ["hint"]
    inside = Configuration(task.template.iri, ())
    assert inside_alone(with_outside_player(inside, WHOLE), WHOLE) == inside


def test_what_is_outside_is_not_avoided_without_end_where_another_task_wants_another_source() -> None:
    composer = Composer(tasks.InsideReader(parse(TEXT, "t.ttl")).read(WHOLE), outside=WHOLE)
    shared = TRACKER.replace("sc:hasInput", "sc:shareable true ; sc:hasInput")
    (tracker,), _ = read_advertisements((PREFIXES + shared).encode(), "ads.ttl")
    searches = 0

    def search(left_out: frozenset[Barred]) -> Outcome:
        nonlocal searches
        searches += 1
        assert searches < 10
        return composer.compose({tracker.component: tracker}, left_out, None)

    holder = Holder("other~1", wants=Wants(frozenset({("help", iri("helper"), "hint")})))
    found, taken = agreed(search, {tracker.component: holder})
    assert isinstance(found, Refusal)
    assert taken == {tracker.component: holder}


def test_a_composite_that_a_task_holds_is_not_what_its_own_inside_lacks() -> None:
    composer = Composer(tasks.InsideReader(parse(TEXT, "t.ttl")).read(WHOLE), outside=WHOLE)
    found, _ = read_advertisements((PREFIXES + TRACKER.replace("Pose", "Hint")).encode(), "ads.ttl")
    refusal = composer.compose({one.component: one for one in found}, frozenset((WHOLE,)), None)
    assert isinstance(refusal, Refusal)
    assert composer.usable({WHOLE, iri("t")}, refusal) == {iri("t"): (TRACKER_ROLE,)}

"""What inputs accept: which outputs feed them, and what becomes of a shape that cannot be judged."""

from __future__ import annotations

from random import Random

import pytest

from selfconf import configure, read, template
from selfconf.model.configuration import Configuration
from selfconf.model.hierarchy import NOTHING_ABOVE
from selfconf.model.refusal import Refusal, Undecided
from selfconf.rdf.advertisements import read_advertisements
from selfconf.rdf.eligibility import acceptance
from selfconf.rdf.eligibility.advertisement_index import AdvertisementIndex
from selfconf.rdf.eligibility.partitioner import Partitioner
from tests.lab import PREFIXES
from tests.rdf.eligibility.test_output_shapes import OUTPUTS, home

RDF = "@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> ."
TASK = f"""{PREFIXES}:t a sc:Template ; sc:roles ( :sensor :display ) .
:sensor a sc:Role ; sh:class :Sensor ; sc:feeds :display . :display a sc:Role ; sh:class :Display ."""


def answered(accepts: str, others: str = "") -> Configuration | Refusal | Undecided:
    """The answer to who feeds a display that accepts some outputs."""
    port = f'[ sc:name "i" ; sc:signalType :Pose ; sc:accepts [ {accepts} ] ]'
    display = f":show a sc:Component, :Display ; sc:hasInput {port} ."
    return configure(template(TASK), read(PREFIXES + OUTPUTS + display + others))


def test_one_shape_takes_no_longer_than_all_may(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(acceptance, "SECONDS", 0.2)
    letters = Random(1)
    labels = ("".join(letters.choice("ab") for _ in range(2000)) for _ in range(300))
    many = "".join(
        f' , [ sc:name "{n}" ; sc:signalType :Pose ; rdfs:label "{label}" ]' for n, label in enumerate(labels)
    )
    hostile = f':hostile a sc:Component, :Sensor ; sc:hasOutput [ sc:name "o" ; sc:signalType :Pose ]{many} .'
    answer = answered('sh:path rdfs:label ; sh:pattern "a[ab]{900}c"', hostile)
    assert isinstance(answer, Refusal)  # the display is left out, as its shape takes too long


@pytest.mark.parametrize(
    ("accepts", "source"),
    [
        ("sh:property [ sh:path ( sc:rate sc:value ) ; sh:minInclusive 5 ]", "high"),
        ("sh:property [ sh:path sc:unit ; sh:hasValue unit:M ]", "low"),
        ("sh:path sc:unit ; sh:hasValue unit:M ; sh:disjoint :age", "low"),
        ("sh:property [ sh:path ( [ sh:inversePath sc:hasOutput ] :on ) ; sh:in ( :Astrid ) ]", "high"),
        ("sh:property [ sh:path ( sc:rate sc:value ) ; sh:lessThanOrEquals :age ]", "high"),
        ("sh:property [ sh:path [ sh:inversePath sc:hasOutput ] ; sh:node [ sh:class :Good ] ]", "high"),
    ],
)
def test_the_first_output_that_conforms_feeds_the_input(accepts: str, source: str) -> None:
    answer = answered(accepts)
    assert isinstance(answer, Configuration)
    assert [connection.source.short for connection in answer.connections] == [source]


def test_where_none_conforms_the_refusal_says_that_it_is_the_shape() -> None:
    answer = answered("sh:property [ sh:path sc:unit ; sh:hasValue unit:KiloM ]")
    assert isinstance(answer, Refusal)
    assert "conforms to its sc:accepts" in str(answer.reasons[0])


def test_a_shape_that_nests_too_deeply_keeps_out_the_component_that_states_it() -> None:
    deep = "sh:node [ " * 20 + "sh:nodeKind sh:Literal" + " ]" * 20
    answer = answered(f"sh:property [ sh:path sc:name ; {deep} ]")
    assert isinstance(answer, Refusal)
    assert "display" in str(answer.reasons[0])


def test_what_another_component_says_disqualifies_no_output() -> None:
    path = "( [ sh:inversePath sc:hasOutput ] :on [ sh:inversePath :on ] )"
    alone = f"sh:property [ sh:path {path} ; sh:maxCount 1 ]"
    judged_by_pyshacl = (
        f"{alone} , [ sh:path sc:name ; sh:qualifiedValueShape [ sh:nodeKind sh:Literal ] ; sh:qualifiedMinCount 1 ]"
    )
    for accepts in (alone, judged_by_pyshacl):
        answer = answered(accepts)
        assert isinstance(answer, Configuration)
        assert [connection.source.short for connection in answer.connections] == ["high"]


def test_what_an_advertisement_says_of_another_component_makes_no_output_conform() -> None:
    camera = ':cam a sc:Component, :Sensor ; :on :base ; sc:hasOutput [ sc:name "o" ; sc:signalType :Pose ] .'
    place = "sh:property [ sh:path ( [ sh:inversePath sc:hasOutput ] :on :place ) ; sh:hasValue :kitchen ]"
    port = f'[ sc:name "i" ; sc:signalType :Pose ; sc:accepts [ {place} ] ]'
    display = f":show a sc:Component, :Display ; sc:hasInput {port} ."
    alone = read(f"{PREFIXES}{camera} :base :place :kitchen .", PREFIXES + display)
    assert isinstance(configure(template(TASK), alone), Configuration)
    beside = read(f"{PREFIXES}{camera} :base :place :kitchen .", f"{PREFIXES}{display} :base a sc:Component, :Base .")
    assert isinstance(configure(template(TASK), beside), Refusal)


def test_stars_within_stars_are_walked_once() -> None:
    star = "[ sh:alternativePath ( sc:hasOutput [ sh:inversePath sc:hasOutput ] ) ]"
    for _ in range(5):
        star = f"[ sh:zeroOrMorePath {star} ]"
    assert isinstance(answered(f"sh:property [ sh:path {star} ; sh:minCount 1 ]"), Configuration)


def test_many_strangers_with_shapes_of_their_own_change_no_answer() -> None:
    strangers = "".join(
        f':s{k} a sc:Component, :Display ; sc:hasInput [ sc:name "i" ; sc:signalType :Pose ;'
        f" sc:accepts [ sh:property [ sh:path ( sc:rate sc:value ) ; sh:minInclusive {k} ] ] ] ;"
        f' sc:hasOutput [ sc:name "o" ; sc:signalType :Pose ] ; sc:preference -1 .\n'
        for k in range(100, 400)
    )
    display = ':show a sc:Component, :Display ; sc:hasInput [ sc:name "i" ; sc:signalType :Pose ] .\n'
    task = TASK.replace(":display a sc:Role ;", ":display a sc:Role ; sc:recruits true ;")
    alone, among = (
        configure(template(task), read(PREFIXES + OUTPUTS + display + others)) for others in ("", strangers)
    )
    assert isinstance(alone, Configuration)
    assert isinstance(among, Configuration)
    assert (alone.assignments, alone.recruits, alone.connections) == (
        among.assignments,
        among.recruits,
        among.connections,
    )


def test_an_output_that_takes_too_long_to_judge_feeds_nothing_and_is_named() -> None:
    port = 'sc:hasOutput [ sc:name "o" ; sc:signalType :Pose ]'
    accepts = 'sh:property [ sh:path ( [ sh:inversePath sc:hasOutput ] :model ) ; sh:pattern "^(?:(a|b|ab)+)\\\\1?$" ]'
    wants = f'sc:hasInput [ sc:name "i" ; sc:signalType :Pose ; sc:accepts [ {accepts} ] ]'
    ads = f""":slow a sc:Component, :Sensor ; :model "{"ab" * 40}!" ; {port} .
        :quick a sc:Component, :Sensor ; :model "aa" ; {port} . :show a sc:Component, :Display ; {wants} ."""
    ecology = AdvertisementIndex.of(read_advertisements((PREFIXES + ads).encode(), "ads")[0])
    partitioner = Partitioner(template(TASK).document, NOTHING_ABOVE)
    sensors, _ = partitioner.partition(ecology).candidates
    assert [bool(one.profile.outputs[0].conforms) for one in sensors] == [True, False]
    ((component, why),) = partitioner.not_judged.items()
    assert component == home("slow")
    assert why.reason.startswith(
        "its output 'o' feeds no input whose sc:accepts cannot be judged of it: matching the pattern"
    )


def test_a_pattern_that_takes_too_long_for_every_output_keeps_its_own_component_out() -> None:
    port = 'sc:hasOutput [ sc:name "o" ; sc:signalType :Pose ]'
    model = "sh:property [ sh:path ( [ sh:inversePath sc:hasOutput ] :model ) ; sh:pattern"
    slow, quick = (
        f'sc:hasInput [ sc:name "i" ; sc:signalType :Pose ; sc:accepts [ {model} "{like}" ] ] ]'
        for like in ("^(?:(a|b|ab)+)\\\\1?$", "^a")
    )
    ads = f""":one a sc:Component, :Sensor ; :model "{"ab" * 40}!" ; {port} .
        :a a sc:Component, :Display ; {slow} . :b a sc:Component, :Display ; {quick} ."""
    ecology = AdvertisementIndex.of(read_advertisements((PREFIXES + ads).encode(), "ads")[0])
    partitioner = Partitioner(template(TASK).document, NOTHING_ABOVE)
    sensors, displays = partitioner.partition(ecology).candidates
    assert [one.profile.component for one in displays] == [home("b")]
    assert [bool(one.profile.outputs[0].conforms) for one in sensors] == [True]
    ((component, why),) = partitioner.not_judged.items()
    assert component == home("a")
    assert why.reason.startswith("what its input accepts cannot be judged: matching the pattern")


ON = "sh:property [ sh:path ( [ sh:inversePath sc:hasOutput ] :on ) ; sh:in ( :Astrid ) ]"
GOOD = "sh:property [ sh:path [ sh:inversePath sc:hasOutput ] ; sh:class :Good ]"


@pytest.mark.parametrize(
    ("role", "accepts", "proposed"),
    [
        ("", "sh:property [ sh:path sc:unit ; sh:hasValue unit:M ]", True),
        ("", "sh:property [ sh:path sc:signalType ; sh:hasValue :Other ; sh:maxCount 1 ]", False),
        ("", ON, True),
        ("; sh:property [ sh:path :in ; sh:minCount 1 ]", ON, True),
        ("; sh:property [ sh:path :on ; sh:in ( :Berta ) ]", ON, False),
        ("; sh:not [ sh:class :Good ]", GOOD, False),
        ("; sh:not [ sh:class :Good ]", ON, True),
        ("", ON.replace(":on", "rdf:type"), True),
        ("; sh:not [ sh:class :Astrid ]", ON.replace(":on", "rdf:type"), False),
    ],
)
def test_no_component_is_asked_for_that_could_not_be_as_its_role_and_the_input_ask(
    role: str, accepts: str, proposed: bool
) -> None:
    port = f'[ sc:name "i" ; sc:signalType :Pose ; sc:accepts [ {accepts} ] ]'
    show = f"{PREFIXES} {RDF} :show a sc:Component, :Display ; sc:hasInput {port} ."
    task = TASK.replace("sh:class :Sensor", f"sh:class :Sensor {role}")
    answer = configure(template(task), read(show))
    assert isinstance(answer, Refusal)
    sensor = "add one more component for the role sensor"
    fitting = f"{sensor} that issues Pose as the sc:accepts of its input asks"
    both = f"{sensor} and one more component for the role display"
    assert str(answer.repairs[0]) == (fitting if proposed else both)


def test_no_component_is_asked_for_to_recruit_that_contradicts_itself() -> None:
    only = (
        PREFIXES
        + ":t a sc:Template ; sc:roles ( :display ) . :display a sc:Role ; sh:class :Display ; sc:recruits true ."
    )
    for most, proposed in (("", True), ("; sh:maxCount 1", False)):
        accepts = f"sc:accepts [ sh:property [ sh:path sc:signalType ; sh:hasValue :Other {most} ] ]"
        port = f'[ sc:name "i" ; sc:signalType :Pose ; {accepts} ]'
        answer = configure(template(only), read(f"{PREFIXES} :show a sc:Component, :Display ; sc:hasInput {port} ."))
        assert isinstance(answer, Refusal)
        assert any("to recruit" in str(one) for one in answer.repairs) is proposed

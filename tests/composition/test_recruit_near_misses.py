"""What a refusal says of recruits: the nearest, what keeps it from being recruited, and when it helps to recruit."""

from __future__ import annotations

import pytest

from selfconf.composition import recruit_near_misses
from selfconf.composition.composer import Composer
from selfconf.composition.explanation import explained
from selfconf.composition.recruit_near_misses import RECRUITING_ROLES
from selfconf.composition.time_limit import TimeLimit
from selfconf.model.configuration import Configuration
from selfconf.model.hierarchy import Hierarchy
from selfconf.model.refusal import InputUnfed, Refusal
from selfconf.model.relaxation import LetRecruit
from selfconf.model.term import IRI
from selfconf.rdf.tasks import bindings, templates
from selfconf.rdf.turtle import document as turtle
from tests.lab import PREFIXES
from tests.rdf.eligibility.test_partitioner import read

NEEDY = ':needy a sc:Component , :Localiser ; sc:hasInput [ sc:name "scan" ; sc:signalType :Scan{} ] .'
ABOVE = Hierarchy([(IRI(f"https://example.org/peis-home#{one}"), IRI("urn:Ranges")) for one in ("Scan", "Echo")])


def composer(recruits: str) -> Composer:
    text = f"{PREFIXES} :t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class :Localiser{recruits} ."
    return Composer(bindings.complete(templates.read_task(turtle.parse(text, "t.ttl"))))


def refused(recruits: str, *ads: str) -> Refusal:
    asked, ecology = composer(recruits), {one.component: one for one in read(ads)}
    answer = asked.compose(ecology, frozenset(), None)
    assert isinstance(answer, Refusal)
    return explained(asked, ecology, answer, ABOVE, TimeLimit(None))


def source(name: str, signal: str, more: str = "") -> str:
    return f':{name} a sc:Component , :Source ; sc:hasOutput [ sc:name "o" ; sc:signalType :{signal}{more} ] .'


def nearest(*ads: str, wanting: str = "") -> tuple[str, list[str]]:
    """What the reason says of the nearest recruit, and the names of all who are near."""
    refusal = refused(" ; sc:recruits true", NEEDY.format(wanting), *ads)
    (reason,) = refusal.reasons
    assert isinstance(reason, InputUnfed)
    names = [miss.component.short for miss in refusal.near_misses if miss.recruit]
    return str(reason).partition("; the nearest is ")[2], names


def test_the_nearest_recruit_is_named_with_what_it_issues() -> None:
    said, names = nearest(source("camera", "Image"), source("sonar", "Echo"))
    assert said == "sonar, which issues Echo, which is akin to Scan"
    assert names == ["sonar"]


def test_a_recruit_that_is_not_fed_itself_is_named_with_what_it_lacks() -> None:
    converter = (
        ':converter a sc:Component , :Source ; sc:hasInput [ sc:name "raw" ; sc:signalType :Raw ] ;'
        ' sc:hasOutput [ sc:name "o" ; sc:signalType :Scan ] .'
    )
    said, names = nearest(converter, source("sonar", "Echo"))
    assert said.startswith("converter, which is not fed itself: no component that can be recruited issues a Raw for")
    assert names == ["converter", "sonar"]


def converter(name: str, wanted: str, issued: str) -> str:
    """A component that makes one signal of another."""
    made = f'sc:hasOutput [ sc:name "o" ; sc:signalType :{issued} ]'
    return f':{name} a sc:Component , :Source ; sc:hasInput [ sc:name "i" ; sc:signalType :{wanted} ] ; {made} .'


@pytest.mark.parametrize(
    ("shape", "obstacle"),
    [
        ("sh:class :Certified", "is no Certified"),
        ("sh:not [ sh:property [ sh:path :old ; sh:minCount 1 ] ]", "is what it must not be"),
        (
            'sh:sparql [ sh:message "too old" ; sh:select "SELECT $this WHERE { $this a ?type }" ]',
            "violates: too old",
        ),
    ],
)
def test_who_issues_the_signal_and_is_kept_out_by_the_shape_of_suppliers_is_near(shape: str, obstacle: str) -> None:
    aged = source("lidar", "Scan") + " :lidar :old true ."
    refusal = refused(f" ; sc:recruits [ {shape} ]", NEEDY.format(""), aged, source("sonar", "Echo"))
    (reason,) = refusal.reasons
    assert "; the nearest is lidar, which " in str(reason)
    (miss,) = [miss for miss in refusal.near_misses if miss.recruit and miss.component.short == "lidar"]
    assert obstacle in str(miss.obstacle)


def test_recruits_that_only_feed_each_other_are_named_as_a_circle() -> None:
    said, names = nearest(converter("a", "Raw", "Scan"), converter("b", "Scan", "Raw"))
    assert said == "a, which is fed only in a circle: its input 'i' by b by a"
    assert names == ["a"]


def test_a_recruit_whose_own_supplier_is_not_fed_is_named_with_that() -> None:
    said, _ = nearest(converter("a", "Raw", "Scan"), converter("b", "Ore", "Raw"))
    assert said == "a, which is not fed itself: b, which issues a Raw for its input 'i', is not fed either"


def test_a_recruit_does_not_lack_what_players_issue() -> None:
    needy = NEEDY.format("").replace(" .", ' ; sc:hasOutput [ sc:name "raw" ; sc:signalType :Raw ] .')
    more = 'sc:hasInput [ sc:name "j" ; sc:signalType :Dust ] ; sc:hasOutput'
    unfed = converter("a", "Raw", "Scan").replace("sc:hasOutput", more)
    (reason,) = refused(" ; sc:recruits true", needy, unfed).reasons
    assert "no component that can be recruited issues a Dust for its input 'j'" in str(reason)


def test_of_what_issues_something_akin_and_is_not_fed_itself_it_is_told_what_it_issues() -> None:
    assert nearest(converter("sonar", "Raw", "Echo"))[0] == "sonar, which issues Echo, which is akin to Scan"


def test_a_recruit_in_another_unit_or_that_is_not_accepted_is_named_with_that() -> None:
    said, _ = nearest(source("lidar", "Scan", " ; sc:unit unit:MilliM"), wanting=" ; sc:unit unit:M")
    assert said == "lidar, which issues what is in MilliM, not in M, a unit of the same dimension (output 'o')"
    shape = " ; sc:accepts [ sh:property [ sh:path sc:frame ; sh:minCount 1 ] ]"
    said, _ = nearest(source("lidar", "Scan"), wanting=shape)
    assert said == "lidar, which issues what is not accepted: it has no frame (output 'o')"


def test_a_recruit_that_issues_the_signal_as_asked_is_told_of_no_other_output() -> None:
    other = ' ; sc:unit unit:MilliM ] , [ sc:name "p" ; sc:signalType :Scan ; sc:unit unit:M'
    unfed = source("a", "Scan", other).replace(" .", ' ; sc:hasInput [ sc:name "i" ; sc:signalType :Raw ] .')
    said, _ = nearest(unfed, wanting=" ; sc:unit unit:M")
    assert said == "a, which is not fed itself: no component that can be recruited issues a Raw for its input 'i'"


def test_where_nobody_is_near_nobody_is_named() -> None:
    assert nearest(source("camera", "Image")) == ("", [])


def test_a_component_that_issues_what_it_needs_itself_is_not_near_to_being_recruited_for_that() -> None:
    mapper = converter("mapper", "Scan", "Scan").replace(":Source", ":Source , :Localiser")
    refusal = refused(" ; sc:recruits [ sh:class :Camera ]", mapper)
    assert str(refusal.reasons[0]).endswith("no recruit that can be fed itself issues a Scan")
    assert not refusal.near_misses


def test_who_could_be_recruited_is_not_advised_as_a_player() -> None:
    refusal = refused(" ; sc:recruits true", NEEDY.format(""), source("sonar", "Echo"))
    assert not [one for one in refusal.repairs if one.code in ("accept-near-miss", "let-recruit")]


def test_that_a_role_recruits_is_advised_where_it_helps() -> None:
    ads = NEEDY.format(""), source("lidar", "Scan")
    (advice,) = [one for one in refused("", *ads).repairs if isinstance(one, LetRecruit)]
    assert str(advice) == "let the role r recruit (sc:recruits true): it would bring lidar"
    followed = composer(" ; sc:recruits true").compose({one.component: one for one in read(ads)}, frozenset(), None)
    assert isinstance(followed, Configuration)
    assert followed.recruits == advice.recruits


@pytest.mark.parametrize("signal", ["Echo", "Image"])
def test_that_a_role_recruits_is_not_advised_where_it_does_not_help(signal: str) -> None:
    refusal = refused("", NEEDY.format(""), source("other", signal))
    assert not [one for one in refusal.repairs if isinstance(one, LetRecruit)]


@pytest.mark.parametrize(
    ("compiled", "tried"), [(recruit_near_misses.COMPILED_ROLES, RECRUITING_ROLES), (13, 2), (1, 1)]
)
def test_roles_of_which_it_is_not_tried_whether_they_would_better_recruit_are_told_of(
    compiled: int, tried: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(recruit_near_misses, "COMPILED_ROLES", compiled)
    numbers = range(RECRUITING_ROLES + 1)
    roles = "".join(f":r{k} a sc:Role ; sh:class :K{k} . :s sc:feeds :r{k} .\n" for k in numbers)
    listed = " ".join(f":r{k}" for k in numbers)
    text = f"{PREFIXES} :t a sc:Template ; sc:roles ( :s {listed} ) . :s a sc:Role ; sh:class :Source .\n{roles}"
    issued = [[f'[ sc:name "o{k}" ; sc:signalType :S{k} ]' for k in numbers if k != lacking] for lacking in numbers]
    ads = [f":a{k} a sc:Component , :Source ; sc:hasOutput {' , '.join(some)} ." for k, some in enumerate(issued)]
    ads += [f':c{k} a sc:Component , :K{k} ; sc:hasInput [ sc:name "i" ; sc:signalType :S{k} ] .' for k in numbers]
    asked = Composer(bindings.complete(templates.read_task(turtle.parse(text, "t.ttl"))))
    ecology = {one.component: one for one in read(ads)}
    answer = asked.compose(ecology, frozenset(), None)
    assert isinstance(answer, Refusal)
    told = explained(asked, ecology, answer, None, TimeLimit(None))
    assert len([one for one in told.repairs if isinstance(one, LetRecruit)]) == tried
    assert told.repairs_stopped

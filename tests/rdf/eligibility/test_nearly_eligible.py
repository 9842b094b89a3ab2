"""Near misses: exactly one thing keeps them out, whoever finds out what, and letting them in leaves no surprise."""

from __future__ import annotations

from hypothesis import assume, given
from hypothesis import strategies as st

from selfconf.composition.composer import Composer
from selfconf.model.hierarchy import Hierarchy
from selfconf.model.refusal import Refusal
from selfconf.rdf.advertisements.advertisement import Advertisement
from selfconf.rdf.eligibility.nearly_eligible import exclusions, near_misses
from selfconf.rdf.eligibility.partitioner import Partitioner
from selfconf.rdf.eligibility.role_tests import ClassTest, Count
from selfconf.rdf.tasks import bindings, templates
from selfconf.rdf.turtle import document as turtle
from tests.lab import ADVERTISEMENTS, PREFIXES, iri
from tests.rdf.eligibility.test_partitioner import partitioner, read
from tests.rdf.eligibility.test_shape_compiler import COMPONENTS, HIERARCHIES, SHAPES, by_pyshacl, ecology

ROLE = ":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; "
ROBOT = ':t a sc:Template ; sc:parameter :robot . :robot a sc:Parameter ; sc:name "robot" ; '


def near(text: str, *ads: str) -> list[tuple[str, str]]:
    """The near misses of a template among some advertisements, each with what it is told by."""
    return [(miss.component.short, str(miss)) for miss in near_misses(partitioner(text), read(ads))]


def repairs(text: str, *ads: str) -> list[str]:
    """What would mend the refusal of a template by some advertisements, by letting somebody in."""
    task = bindings.complete(templates.read_task(turtle.parse(PREFIXES + text, "t.ttl")))
    composer, found = Composer(task), {one.component: one for one in read(ads)}
    refused = composer.compose(found, frozenset(), None)
    assert isinstance(refused, Refusal)
    relaxed = composer.with_relaxations(found, refused)
    return [str(repair) for repair in relaxed.repairs if repair.code == "accept-near-miss"]


def test_near_misses_are_those_of_the_class_whom_one_thing_keeps_out() -> None:
    text = f"{ROLE} sh:class rob:MotorDrive ; sh:property [ sh:path rob:support ; sh:in ( :Astrid ) ] ."
    found = near(text, ADVERTISEMENTS["pippi"], ADVERTISEMENTS["encoder"])
    assert found == [("pippi-drive", "its support is Pippi, not Astrid")]


def test_a_near_miss_for_any_value_of_a_parameter_is_told_by_the_name_of_the_parameter() -> None:
    text = f"{ROLE} sh:class rob:MotorDrive ; sh:property [ sh:path ( :near :beside ) ; sh:hasValue :where ] ."
    text = text.replace(":t a sc:Template", ":where a sc:Parameter ; sc:name 'where' . :t a sc:Template")
    found = near(text.replace("sc:roles", "sc:parameter :where ; sc:roles"), ADVERTISEMENTS["pippi"])
    assert found == [("pippi-drive", "it violates: no near/beside is where")]


def test_a_near_miss_is_told_in_the_words_of_the_author_too() -> None:
    message = 'sh:message "nur Astrid"@de , "only Astrid drives"@en'
    text = f"{ROLE} sh:class rob:MotorDrive ; sh:property [ sh:path rob:support ; sh:in ( :Astrid ) ; {message} ] ."
    found = near(text, ADVERTISEMENTS["pippi"])
    assert found == [("pippi-drive", "its support is Pippi, not Astrid (only Astrid drives)")]


def test_a_component_of_no_alternative_class_is_no_near_miss() -> None:
    assert near(f"{ROLE} sh:or ( [ sh:class :Lift ] [ sh:class :Crane ] ) .", *ADVERTISEMENTS.values()) == []


def test_a_component_of_one_alternative_class_may_be_a_near_miss() -> None:
    one_of = "sh:or ( [ sh:class :Lift ] [ sh:class rob:MotorDrive ] )"
    text = f"{ROLE} {one_of} ; sh:property [ sh:path rob:support ; sh:in ( :Astrid ) ] ."
    found = near(text, ADVERTISEMENTS["pippi"], ADVERTISEMENTS["encoder"])
    assert found == [("pippi-drive", "its support is Pippi, not Astrid")]


def test_a_class_that_is_ruled_out_is_none_of_the_role() -> None:
    text = f"{ROLE} sh:not [ sh:class :Lift ] ; sh:property [ sh:path rob:support ; sh:in ( :Astrid ) ] ."
    assert near(text, ADVERTISEMENTS["pippi"]) == [("pippi-drive", "its support is Pippi, not Astrid")]


@given(SHAPES, COMPONENTS, st.sampled_from(HIERARCHIES))
def test_tests_and_pyshacl_agree_on_the_near_misses(
    shape: str, components: list[tuple[str, list[tuple[str, str]], bool]], hierarchy: Hierarchy
) -> None:
    assume("lessThan" not in shape and "NaN" not in str(components))  # of what has no order pySHACL says no more
    text = f"{PREFIXES} :t a sc:Template ; sc:roles ( :role ) . :role a sc:Role ; {shape} ."
    task = bindings.complete(templates.read_task(turtle.parse(text, "t.ttl")))
    ads = ecology(components)

    def of_its_class(one: Advertisement) -> bool:
        tests = Partitioner(task, hierarchy).roles[0].tests
        choices = [test.groups for test in tests if isinstance(test, Count) and test.minimum]
        classes = [[[test for test in way if isinstance(test, ClassTest)] for way in some] for some in choices]
        own = [test for test in tests if isinstance(test, ClassTest)]
        return all(
            any(all(test.admits(one.types, hierarchy) for test in way) for way in some) for some in ([own], *classes)
        )

    akin = {one.component for one in ads if of_its_class(one)}
    alone = {miss.component for miss in near_misses(by_pyshacl(Partitioner(task, hierarchy)), ads)}
    assert {miss.component for miss in near_misses(Partitioner(task, hierarchy), ads)} == alone & akin


def test_who_is_let_in_still_gives_the_free_parameters_their_values() -> None:
    text = """
        :t a sc:Template ; sc:roles ( :r ) ; sc:parameter :on , :at . :on a sc:Parameter ; sc:name "on" .
        :at a sc:Parameter ; sc:name "at" ; sh:in ( :kitchen :cellar ) .
        :r a sc:Role ; sh:class :A ; sh:property [ sh:path rob:support ; sh:in ( :on ) ] ,
            [ sh:path rob:place ; sh:hasValue :at ] , [ sh:path ( :battery :charge ) ; sh:minInclusive 5 ] .
    """
    ads = read(
        [
            ":weak a sc:Component, :A ; rob:support :Astrid ; rob:place :kitchen ; :battery [ :charge 3 ] .",
            ":away a sc:Component, :A ; rob:support :Pippi ; rob:place :attic ; :battery [ :charge 5 ] .",
            ":both a sc:Component, :A ; rob:support :Pippi ; rob:place :attic ; :battery [ :charge 3 ] .",
        ]
    )
    away, weak = near_misses(partitioner(text), ads)
    assert (away.component, away.allows) == (iri("away"), {iri("on"): {iri("Pippi")}})
    assert str(away) == "it wants at to be attic, which it may not be"
    assert (weak.component, weak.allows) == (iri("weak"), {iri("on"): {iri("Astrid")}, iri("at"): {iri("kitchen")}})


def test_what_only_pyshacl_can_judge_is_an_obstacle_like_any_other() -> None:
    text = (
        f"{ROLE} sh:class :A ; sh:property [ sh:path :power ; sh:minInclusive 5 ] ;"
        " sh:property [ sh:path [ sh:alternativePath ( :room :place ) ] ; sh:hasValue :kitchen ] ."
    )
    found = near(
        text,
        ":both a sc:Component, :A ; :power 3 ; :room :cellar .",
        ":weak a sc:Component, :A ; :power 3 ; :room :kitchen .",
        ":away a sc:Component, :A ; :power 5 ; :room :cellar .",
        ":good a sc:Component, :A ; :power 5 ; :place :kitchen .",
    )
    assert [component for component, _ in found] == ["away", "weak"]
    assert "violates: " in found[0][1]
    assert found[1][1] == "its power is 3, not at least 5"


def test_one_property_is_one_obstacle_with_all_that_is_wrong_with_it() -> None:
    text = f"{ROLE} sh:property [ sh:path :room ; sh:minCount 2 ; sh:in ( :kitchen :hall ) ] ."
    found = near(text, ":a a sc:Component, :A ; :room :cellar .")
    assert found == [("a", "it has 1 of room, too few; its room is cellar, not hall or kitchen")]


def test_what_looks_alike_is_told_apart() -> None:
    text = f'{ROLE} sh:property [ sh:path :n ; sh:in ( 1 "ab"@en "2020-01-01"^^xsd:date ) ] .'
    wrong = {"a": '"1"', "b": '"ab"@en-GB', "c": '"2020-01-01"^^xsd:dateTime'}
    found = near(text, *(f":{name} a sc:Component, :A ; :n {value} ." for name, value in wrong.items()))
    wanted = '"2020-01-01"^^date or "ab"@en or 1'
    assert [told for _, told in found] == [
        f'its n is "1", not {wanted}',
        f'its n is "ab"@en-gb, not {wanted}',
        f'its n is "2020-01-01"^^dateTime, not {wanted}',
    ]


def test_a_role_may_take_what_no_change_of_its_statement_would_make_eligible() -> None:
    on = "sh:property [ sh:path :place ; sh:in ( {} ) ]"
    one, robot = on.format(":P1"), on.format(":robot")
    text = f"{ROBOT} sh:nodeKind sh:IRI . :t sc:roles ( :a :b ) . :a a sc:Role ; sh:class :A ; {one} ; {robot} . "
    text += f":b a sc:Role ; sh:class :B ; {robot} ."
    ecology = ":a1 a sc:Component, :A ; :place :P0 .", ":b1 a sc:Component, :B ; :place :P0 ."
    # In P1 it would be on another robot than b1.
    assert repairs(text, *ecology) == ["let the role a take a1, although its place is P0, not P1"]


def test_a_near_miss_brings_along_the_values_that_it_allows() -> None:
    power = "sh:property [ sh:path :power ; sh:minInclusive 5 ] ;"
    on = "sh:property [ sh:path :support ; sh:in ( :robot ) ]"
    text = f"{ROBOT} sh:nodeKind sh:IRI . :t sc:roles ( :a :b ) . :a a sc:Role ; sh:class :A ; {power} {on} . "
    text += f":b a sc:Role ; sh:class :B ; {on} ."
    weak, other = ":a1 a sc:Component, :A ; :power 3 ; :support :X .", ":b1 a sc:Component, :B ; :support "
    assert near(text, weak) == [("a1", "its power is 3, not at least 5")]
    assert repairs(text, weak, f"{other} :Y .") == []
    assert repairs(text, weak, f"{other} :X .") == ["let the role a take a1, although its power is 3, not at least 5"]
    assert repairs(text, weak, ":b1 a sc:Component, :B .") == [
        "let the role a take a1, although its power is 3, not at least 5"
    ]
    judged = text.replace(power, "sh:property [ sh:path [ sh:inversePath [ sh:inversePath :power ] ] ; sh:in ( 5 ) ] ;")
    assert repairs(judged, weak, f"{other} :Y .") == []
    assert len(repairs(judged, weak, f"{other} :X .")) == 1


def test_a_component_that_leaves_no_value_for_a_parameter_is_kept_out_by_that_too() -> None:
    text = f"{ROBOT} sh:in ( :Astrid ) . :t sc:roles ( :r ) . :r a sc:Role ; sh:class :A ;"
    text += " sh:property [ sh:path :power ; sh:in ( 5 ) ] ; sh:property [ sh:path :support ; sh:in ( :robot ) ] ."
    assert near(text, ":a a sc:Component, :A ; :power 3 ; :support :Pippi .") == []
    assert near(text, ":a a sc:Component, :A ; :power 3 ; :support :Astrid .") == [("a", "its power is 3, not 5")]


def test_what_free_parameters_could_not_be_is_told_beside_what_else_keeps_out() -> None:
    """A component that is told to have one obstacle is a near miss: without it, it could play."""
    text = f"{ROBOT} sh:in ( :Astrid ) . :t sc:roles ( :r ) . :r a sc:Role ; sh:class :A ;"
    text += " sh:property [ sh:path :power ; sh:in ( 5 ) ] , [ sh:path :support ; sh:in ( :robot ) ] ,"
    asked = partitioner(f"{text} [ sh:path :of ; sh:in ( :robot ) ] .")
    ads = (
        ":barred a sc:Component, :A ; :power 3 ; :support :Pippi .",
        ":split a sc:Component, :A ; :power 3 ; :support :Astrid ; :of :Pippi .",
        ":near a sc:Component, :A ; :power 3 ; :support :Astrid .",
    )
    found = {one.component.short: one.obstacles for one in exclusions(asked, asked.roles[0], (), read(ads))}
    assert {name: [str(one) for one in some] for name, some in found.items()} == {
        "barred": ["power is 3, not 5", "wants robot to be Pippi, which it may not be"],
        "split": ["power is 3, not 5", "leaves no value for a free parameter that its statements agree on"],
        "near": ["power is 3, not 5"],
    }
    assert [miss.component.short for miss in near_misses(asked, read(ads))] == ["near"]


def test_a_value_that_a_free_parameter_may_not_have_is_one_thing_that_keeps_out() -> None:
    room = ':t a sc:Template ; sc:parameter :room . :room a sc:Parameter ; sc:name "room" ; sh:in ( :kitchen ) .'
    text = f"{room} {ROLE} sh:class :A ; sh:property [ sh:path :place ; sh:in ( :room ) ] ."
    ads = (":far a sc:Component, :A ; :place :hall .", ":other a sc:Component, :B ; :place :hall .")
    assert near(text, *ads) == [("far", "it wants room to be hall, which it may not be")]
    (first, *_) = exclusions(partitioner(text), partitioner(text).roles[0], (), read(ads))
    assert [str(obstacle) for obstacle in first.obstacles] == ["wants room to be hall, which it may not be"]


def test_a_free_parameter_that_pyshacl_judges_keeps_out_by_the_value_that_leaves_the_least() -> None:
    room = ':t a sc:Template ; sc:parameter :room . :room a sc:Parameter ; sc:name "room" .'
    path = "[ sh:alternativePath ( :place :near ) ]"
    shape = f"sh:property [ sh:path {path} ; sh:hasValue :room ] , [ sh:path :name ; sh:uniqueLang true ]"
    asked = partitioner(f"{room} {ROLE} sh:class :A ; {shape} .")
    ads = (":a a sc:Component, :A ; :place :hall ; :name 'a'@en , 'b'@en .", ":b a sc:Component, :A .")
    found = {one.component.short: one.obstacles for one in exclusions(asked, asked.roles[0], (), read(ads))}
    assert [str(one) for one in found["a"]] == ["violates: several of name have one language"]
    assert [str(one) for one in found["b"]] == ["violates: no (place|near) is room"]


def test_what_an_input_accepts_and_cannot_be_judged_is_what_keeps_its_component_out() -> None:
    text = f"{ROLE} sh:class :A ."
    shape = '[ sh:property [ sh:path sc:name ; sh:pattern "(" ] ]'
    odd = f':odd a sc:Component, :A ; sc:hasInput [ sc:name "i" ; sc:signalType :S ; sc:accepts {shape} ] .'
    asked = partitioner(text)
    (one,) = exclusions(asked, asked.roles[0], (), read((odd,)))
    assert [obstacle.code for obstacle in one.obstacles] == ["not-judged"]
    assert near(text, odd) == []


def test_what_cannot_be_judged_in_time_is_no_near_miss() -> None:
    text = f'{ROLE} sh:class :A ; sh:property [ sh:path :model ; sh:pattern "^(?=(\\\\w+)+$)" ] .'
    assert near(text, f':slow a sc:Component, :A ; :model "{"ab" * 40}!" .') == []

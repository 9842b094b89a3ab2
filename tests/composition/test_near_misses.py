"""Near misses that rank: by degree of match and by words, with a mean average precision over judged collections."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import pytest

from selfconf.composition import near_misses
from selfconf.composition.composer import Composer
from selfconf.composition.explanation import explained
from selfconf.composition.near_misses import ranked_exclusions
from selfconf.composition.time_limit import TimeLimit
from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.partition import NearMiss
from selfconf.model.refusal import Refusal
from selfconf.model.term import IRI
from selfconf.rdf.tasks import bindings, templates
from selfconf.rdf.turtle import document as turtle
from tests.rdf.eligibility.test_partitioner import read
from tests.retrieval import (
    PREFIXES,
    Collection,
    Service,
    TangledCollection,
    by_interactions,
    by_shape,
    mean_average_precision,
)

BY_DEGREE, WITH_TEXT = 0.78, 0.83
"""What the published matchmakers reach on OWLS-TC4, in mean average precision."""
SEEDS = (101, 102)
"""Collections that no weight was chosen on."""
Form = Callable[[Service, bool], tuple[str, str]]


advertised = lru_cache(maxsize=8)(lambda ads: tuple(read([ads])))
"""What a text advertises: many requests are made to one collection."""


def near(
    template: str, ads: str, *below: tuple[str, str], others: str = "", sees: Hierarchy = NOTHING_ABOVE
) -> list[NearMiss]:
    """The near misses of a refusal, where the ontologies say that some classes lie below others."""
    task = bindings.complete(templates.read_task(turtle.parse(template, "t.ttl")))
    composer, ecology = Composer(task, sees), {one.component: one for one in (*advertised(ads), *read([others]))}
    refused = composer.compose(ecology, frozenset(), None)
    assert isinstance(refused, Refusal)
    return list(explained(composer, ecology, refused, known(*below), TimeLimit(None)).near_misses)


def known(*below: tuple[str, str]) -> Hierarchy:
    return Hierarchy([(IRI(f"urn:retrieval:{a}"), IRI(f"urn:retrieval:{b}")) for a, b in below])


def precision(collection: Collection | TangledCollection, form: Form, described: bool) -> float:
    rankings: dict[str, list[str]] = {}
    for request in collection.requests:
        template, others = form(request, described)
        found = near(template, collection.advertisements(described), *collection.below(), others=others)
        rankings[request.name] = [miss.component.short for miss in found if miss.role.short == "r"]
    return mean_average_precision(rankings, {one.name: collection.relevant(one) for one in collection.requests})


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("described", "least"), [(False, BY_DEGREE), (True, WITH_TEXT)])
def test_along_interactions_the_relevant_come_first(seed: int, described: bool, least: float) -> None:
    assert precision(Collection(seed), by_interactions, described) >= least


@pytest.mark.parametrize(("described", "least"), [(False, BY_DEGREE), (True, WITH_TEXT)])
def test_by_the_shape_of_the_role_the_relevant_come_first(described: bool, least: float) -> None:
    assert precision(Collection(SEEDS[0], services=120, requests=6), by_shape, described) >= least


@pytest.mark.slow
@pytest.mark.parametrize(("described", "least"), [(False, BY_DEGREE), (True, WITH_TEXT)])
def test_among_many_in_a_tangled_hierarchy_the_relevant_come_first(described: bool, least: float) -> None:
    assert precision(TangledCollection(SEEDS[0], 300, 8), by_interactions, described) >= least


BELOW = ("Taxed", "Price"), ("Price", "Amount"), ("Fee", "Amount"), ("Car", "Vehicle"), ("Bike", "Vehicle")
ROLE = """
:t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class :Service ;
    sh:property [ sh:path ( sc:hasOutput sc:signalType ) ; sh:hasValue :Price ] .
"""


def issuing(name: str, signal: str, more: str = "") -> str:
    return f':{name} a sc:Component , :Service ; sc:hasOutput [ sc:name "o" ; sc:signalType :{signal}{more} ] .\n'


def test_degrees_come_in_their_order_and_are_told() -> None:
    ads = PREFIXES + "".join(issuing(*one) for one in (("a", "Colour"), ("b", "Fee"), ("c", "Amount"), ("d", "Taxed")))
    found = near(PREFIXES + ROLE, ads, *BELOW)
    assert [(miss.component.short, str(miss)) for miss in found] == [
        ("d", "it issues Taxed, which lies below Price"),
        ("c", "it issues Amount, which lies above Price"),
        ("b", "it issues Fee, which is akin to Price"),
        ("a", "it issues no Price"),
    ]
    assert [miss.likeness for miss in found] == sorted((miss.likeness for miss in found), reverse=True)


def test_the_alphabet_cuts_nobody_off() -> None:
    ads = PREFIXES + "".join(issuing(f"a{number:03}", "Colour") for number in range(60)) + issuing("zzz", "Taxed")
    found = near(PREFIXES + ROLE, ads, *BELOW)
    assert found[0].component.short == "zzz"
    assert len(found) == 61


def test_what_a_partition_leaves_out_is_ranked_as_well() -> None:
    task = bindings.complete(templates.read_task(turtle.parse(PREFIXES + ROLE, "t.ttl")))
    names = ("a", "Colour"), ("b", "Taxed"), ("c", "Price")
    ecology = {one.component: one for one in read([PREFIXES + "".join(issuing(*one) for one in names)])}
    found = ranked_exclusions(Composer(task), ecology, 0, known(*BELOW))
    assert [(one.component.short, list(map(str, one.obstacles))) for one in found] == [
        ("b", ["issues Taxed, which lies below Price"]),
        ("a", ["issues no Price"]),
    ]


FEED = """
:t a sc:Template ; sc:roles ( :p :c ) .
:p a sc:Role ; sh:class :Service ; sc:feeds :c .
:c a sc:Role ; sh:class :Client .
"""
CLIENT = ':k a sc:Component , :Client ; sc:hasInput [ sc:name "in" ; sc:signalType :Price%s ] .\n'
QUDT = "@prefix unit: <http://qudt.org/vocab/unit/> .\n" + PREFIXES


def test_for_an_input_that_stays_unfed_those_are_near_that_issue_something_akin() -> None:
    ads = PREFIXES + CLIENT % "" + issuing("a", "Colour") + issuing("b", "Fee") + issuing("c", "Taxed")
    found = near(PREFIXES + FEED, ads, *BELOW)
    assert [(miss.role.short, miss.component.short) for miss in found] == [("p", "c"), ("p", "b")]


def test_what_is_akin_is_looked_for_until_so_many_pairs_of_ports_are_compared(monkeypatch: pytest.MonkeyPatch) -> None:
    ads = PREFIXES + CLIENT % "" + issuing("a", "Colour") + issuing("b", "Fee") + issuing("c", "Taxed")
    monkeypatch.setattr(near_misses, "MOST_COMPARED", 1)
    assert [miss.component.short for miss in near(PREFIXES + FEED, ads, *BELOW)] == ["b"]


def test_another_unit_of_one_dimension_is_near_and_one_of_another_dimension_is_less() -> None:
    unit = " ; sc:unit unit:{}"
    ads = QUDT + CLIENT % unit.format("M")
    ads += issuing("a", "Price", unit.format("KiloGM")) + issuing("b", "Price", unit.format("MilliM"))
    assert [str(miss) for miss in near(PREFIXES + FEED, ads)] == [
        "it issues what is in MilliM, not in M, a unit of the same dimension (output 'o')",
        "it issues what is in KiloGM, not in M, a unit of another dimension (output 'o')",
    ]


def test_a_component_that_feeds_an_input_as_it_asks_is_told_of_no_other_output() -> None:
    ads = QUDT + ':k a sc:Component , :Client ; sc:hasInput [ sc:name "x" ; sc:signalType :Price ; sc:unit unit:M ] ,'
    ads += ' [ sc:name "y" ; sc:signalType :Fee ] .\n'
    ads += issuing("a", "Price", ' ; sc:unit unit:MilliM ] , [ sc:name "p" ; sc:signalType :Price ; sc:unit unit:M')
    found = near(PREFIXES + FEED, ads + issuing("b", "Fee"))
    assert [str(miss) for miss in found] == ["it issues no Fee", "it issues no Price"]


def test_an_output_to_which_no_interaction_leads_is_not_told_of() -> None:
    template = PREFIXES + FEED.replace(" ; sc:feeds :c", "")
    template += '[] a sc:Interaction ; sc:from :p ; sc:to :c ; sc:output "%s" .'
    ads = QUDT + CLIENT % " ; sc:unit unit:M" + issuing("a", "Price", " ; sc:unit unit:MilliM")
    assert [miss.component.short for miss in near(template % "o", ads)] == ["a"]
    assert near(template % "other", ads) == []


@pytest.mark.parametrize(
    ("shape", "said"),
    [
        ("sh:property [ sh:path ( sc:rate sc:value ) ; sh:minInclusive 5 ]", "its rate.value is 3, not at least 5"),
        ("sh:property [ sh:path sc:name ; sh:lessThan sc:name ]", 'its name is "o", not less than its name'),
        ("sh:property [ sh:path sc:name ; sh:disjoint sc:name ]", 'it violates: name and name are both "o"'),
    ],
)
def test_of_an_output_that_is_not_accepted_it_is_told_why(shape: str, said: str) -> None:
    rate = " ; sc:rate [ sc:value 3 ; sc:unit unit:HZ ]"
    ads = QUDT + CLIENT % f" ; sc:accepts [ {shape} ]" + issuing("a", "Price", rate)
    assert [str(miss) for miss in near(PREFIXES + FEED, ads)] == [
        f"it issues what is not accepted: {said} (output 'o')"
    ]


BELOW_REQUESTS = ("Special", "General"), ("Fine", "Coarse")


def requested(offered: str, response: str, mode: str) -> list[str]:
    """The near misses, in words, where an operation is needed that takes a general request."""
    needed = f'sc:needsOperation [ sc:name "n" ; sc:request :General ; sc:response :{response} ]'
    ads = f"{PREFIXES} :k a sc:Component , :Client ; {needed} ."
    ads += f' :a a sc:Component , :Service ; sc:hasOperation [ sc:name "o" ; {offered} ] .'
    sees = known(*BELOW_REQUESTS) if mode == "subclass" else NOTHING_ABOVE
    return [str(miss) for miss in near(PREFIXES + FEED, ads, *BELOW_REQUESTS, sees=sees)]


@pytest.mark.parametrize("mode", ["syntactic", "subclass"])
@pytest.mark.parametrize(
    ("request_taken", "said"), [("sc:request :Special ;", "Special"), ("sc:request :Fine ;", "Fine"), ("", "nothing")]
)
def test_of_an_operation_that_answers_as_wanted_it_is_told_what_it_takes(
    request_taken: str, said: str, mode: str
) -> None:
    assert requested(f"{request_taken} sc:response :Coarse", "Coarse", mode) == [
        f"it offers what takes {said} and would be sent General (operation 'o')"
    ]


@pytest.mark.parametrize(
    ("answered", "wanted", "mode", "said"),
    [
        ("Fine", "Coarse", "subclass", ""),  # which is what the mode takes
        ("Fine", "Coarse", "syntactic", "offers operation -> Fine, which lies below operation -> Coarse and "),
        ("Coarse", "Fine", "subclass", "offers operation -> Coarse, which lies above operation -> Fine and "),
    ],
)
def test_of_an_operation_its_request_is_told_beside_a_response_that_the_mode_does_not_take(
    answered: str, wanted: str, mode: str, said: str
) -> None:
    assert requested(f"sc:request :Special ; sc:response :{answered}", wanted, mode) == [
        f"it {said}offers what takes Special and would be sent General (operation 'o')"
    ]


def test_what_lacks_one_class_of_several_comes_by_its_likeness_and_after_a_slip() -> None:
    asked = (
        ":t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class :Clock , :Display ; sh:property [ sh:path :p ] ."
    )
    ads = ":a a sc:Component , :Clock . :r2 a sc:Component , :Clock , :Large . :c a sc:Component , :Clock , :Displey ."
    found = near(PREFIXES + asked, PREFIXES + ads)
    assert found[0].component.short == "c"
    assert [str(miss) for miss in found][1:] == ["it is no Display", "it is no Display"]


def test_a_type_that_serves_in_the_mode_is_not_told_beside_one_that_does_not() -> None:
    inputs = '[ sc:name "s" ; sc:signalType :Coarse ] , [ sc:name "q" ; sc:signalType :Special ]'
    outputs = '[ sc:name "l" ; sc:signalType :Fine ] , [ sc:name "p" ; sc:signalType :General ]'
    ads = f"{PREFIXES} :k a sc:Component , :Client ; sc:hasInput {inputs} ."
    ads += f" :a a sc:Component , :Service ; sc:hasOutput {outputs} ."
    below = known(*BELOW_REQUESTS)
    above = "it issues General, which lies above Special"
    assert [str(miss) for miss in near(PREFIXES + FEED, ads, *BELOW_REQUESTS, sees=below)] == [above]
    assert [str(miss) for miss in near(PREFIXES + FEED, ads, *BELOW_REQUESTS)] == [
        f"{above} and issues Fine, which lies below Coarse"
    ]


def test_a_type_that_serves_several_inputs_in_the_mode_is_lacking_for_none() -> None:
    two = FEED.replace(":p :c )", ":p :c :d )") + ":d a sc:Role ; sh:class :Other . :p sc:feeds :d ."
    other = (CLIENT % "").replace(":k", ":l").replace(":Client", ":Other")
    ads = PREFIXES + (CLIENT % "").replace(" .", ' , [ sc:name "more" ; sc:signalType :Colour ] .') + other
    ads += issuing("a", "Taxed")
    said = [str(miss) for miss in near(PREFIXES + two, ads, *BELOW, sees=known(*BELOW))]
    assert said == ["it issues no Colour"]

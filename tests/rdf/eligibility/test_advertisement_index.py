"""An ecology by component and by kind, and which components of a kind are alike for the tests of a role."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import pytest

from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement, read_advertisements
from selfconf.rdf.advertisements.reader import read_document
from selfconf.rdf.eligibility.advertisement_index import (
    AdvertisementIndex,
    AdvertisementSignature,
    ClassClosure,
    RelevantPredicates,
)
from selfconf.rdf.eligibility.role_tests import ClassTest, Count, ParameterTest, PropertyTest, RoleTest, SelfTest
from selfconf.rdf.turtle import parse
from selfconf.rdf.vocabulary import SC
from tests.lab import PREFIXES, iri

TEXT = PREFIXES + (
    ":a a sc:Component, :Lamp ; :p 1 ; :q 1 . :b a sc:Component, :Lamp ; :p 1 ; :q 2 ."
    ' :c a sc:Component, :Lamp ; :p 2 ; sc:hasParameter [ sc:name "n" ; sc:parameterType :T ] .'
    " :d a sc:Component, :Bell ; :p 1 ."
)
LAMPS = frozenset((SC.Component, iri("Lamp")))
OF_P = PropertyTest(iri("p"), minimum=1)


def loaded() -> list[Advertisement]:
    """The advertisements as the fast loader reads them."""
    return list(read_advertisements(TEXT.encode(), "a.ttl")[0])


def read() -> list[Advertisement]:
    """The advertisements as the careful reader reads them."""
    return list(read_document(parse(TEXT, "a.ttl"))[0])


def alike(given: Iterable[Advertisement], *tests: RoleTest, hierarchy: Hierarchy = NOTHING_ABOVE) -> list[list[str]]:
    """The lamps, those together that tests cannot tell apart."""
    groups = AdvertisementIndex.of(given).alike(LAMPS, AdvertisementSignature(tests, hierarchy))
    return [[advertisement.component.short for advertisement in group] for group in groups]


def test_components_are_found_by_name_in_the_order_in_which_they_were_gathered() -> None:
    index = AdvertisementIndex.of(reversed(loaded()))
    assert [component.short for component in index] == ["d", "c", "b", "a"]
    assert [advertisement.component for advertisement in index.values()] == list(index)
    assert index[iri("a")].types == LAMPS
    assert len(index) == 4
    with pytest.raises(KeyError):
        index[iri("nobody")]


def test_components_with_the_same_types_are_of_one_kind() -> None:
    kinds = AdvertisementIndex.of(loaded()).type_sets
    assert [len(kinds[LAMPS]), len(kinds)] == [3, 2]


def test_what_is_an_index_already_is_not_made_again() -> None:
    index = AdvertisementIndex.of(loaded())
    assert AdvertisementIndex.of(index) is index
    assert dict(AdvertisementIndex.of(dict(index))) == dict(index)


@pytest.mark.parametrize("given", [loaded, read])
@pytest.mark.parametrize(
    ("test", "groups"),
    [
        (ClassTest(iri("Lamp")), [["a", "b", "c"]]),
        (OF_P, [["a", "b"], ["c"]]),
        (PropertyTest(iri("q")), [["a"], ["b"], ["c"]]),
        (PropertyTest(iri("r")), [["a", "b", "c"]]),
        (ParameterTest(iri("T")), [["a", "b"], ["c"]]),
        (SelfTest(frozenset((iri("a"),))), [["a"], ["b"], ["c"]]),
        (Count(((OF_P,), (ClassTest(iri("Lamp")),)), 1), [["a", "b"], ["c"]]),
    ],
)
def test_those_are_alike_that_say_the_same_of_what_a_test_looks_at(
    given: Callable[[], list[Advertisement]], test: RoleTest, groups: list[list[str]]
) -> None:
    assert alike(given(), test) == groups


def test_a_property_below_the_one_that_is_tested_is_looked_at() -> None:
    below = Hierarchy(properties=[(iri("q"), iri("r"))])
    assert alike(loaded(), PropertyTest(iri("r")), hierarchy=below) == [["a"], ["b"], ["c"]]


def test_signatures_that_look_at_the_same_share_their_groups() -> None:
    index = AdvertisementIndex.of(loaded())
    first, second = AdvertisementSignature([OF_P], NOTHING_ABOVE), AdvertisementSignature([OF_P], NOTHING_ABOVE)
    groups = zip(index.alike(LAMPS, first), index.alike(LAMPS, second), strict=True)
    assert all(one is other for one, other in groups)
    assert not AdvertisementSignature([PropertyTest(iri("q"))], NOTHING_ABOVE).agrees(first)


def test_the_classes_of_types_are_those_above_any_of_them() -> None:
    closure = ClassClosure(Hierarchy([(iri("Lamp"), iri("Light"))]))
    assert closure[LAMPS] == LAMPS | {iri("Light")}
    assert closure[frozenset[IRI]()] == frozenset()


def test_types_and_ports_are_nothing_that_a_property_test_looks_at() -> None:
    relevant = RelevantPredicates([OF_P], NOTHING_ABOVE)
    assert [relevant[f"<{iri('p')}>"], relevant[f"<{iri('q')}>"]] == [True, False]
    assert not relevant["a"]
    assert not relevant[f"<{SC.hasInput}>"]
    assert not relevant[f"<{SC.hasParameter}>"]

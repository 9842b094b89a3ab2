"""What a new component could state of free parameters, as the rest of a role's shape permits."""

from __future__ import annotations

import pytest

from selfconf.model.hierarchy import Hierarchy
from selfconf.model.partition import Mention, Partition
from tests.lab import iri
from tests.rdf.eligibility.test_partitioner import partitioner, read

HEAD = """
    :t a sc:Template ; sc:roles ( :role ) ; sc:parameter :par .
    :par a sc:Parameter ; sc:name "par" ; sh:nodeKind sh:IRI .
"""
ONE_OF = "sh:property [ sh:path rob:support ; sh:in ( :par ) ]"


def partition(shape: str, bound: bool = False) -> Partition:
    """The partition by a role of some shape of an ecology that states Astrid and a literal."""
    given = partitioner(
        f"{HEAD} :role a sc:Role ; {shape} .",
        Hierarchy([], [(iri("under"), iri("over"))]),
        bound=(("par", ":Astrid"),) if bound else (),
    )
    return given.partition(read([":here a sc:Component, :Other ; rob:support :Astrid ."]))


def asked(shape: str) -> Mention:
    """What the shape of the role says of the parameter."""
    ((mention,),) = partition(shape).mentions
    return mention


def values(*names: str) -> frozenset[str]:
    """IRIs by their short names."""
    return frozenset(map(iri, names))


@pytest.mark.parametrize(
    ("shape", "mention"),
    [
        (ONE_OF, Mention(iri("par"))),
        ("sh:property [ sh:path rob:support ; sh:hasValue :par ]", Mention(iri("par"), required=True)),
        ("sh:property [ sh:path rob:support ; sh:in ( :par ) ; sh:minCount 1 ]", Mention(iri("par"), required=True)),
        ("sh:property [ sh:path rob:support ; sh:in ( :par :Emil ) ; sh:minCount 1 ]", Mention(iri("par"))),
        (
            f"{ONE_OF} ; sh:property [ sh:path rob:support ; sh:in ( :Pippi :Emil 1 ) ]",
            Mention(iri("par"), values("Pippi", "Emil")),
        ),
        (
            f"{ONE_OF} ; sh:and ( [ sh:property [ sh:path rob:support ; sh:in ( :Pippi :Emil ) ] ] )",
            Mention(iri("par"), values("Pippi", "Emil")),
        ),
        (
            f"{ONE_OF} ; sh:property [ sh:path rob:support ; sh:hasValue :Pippi ]",
            Mention(iri("par"), values("Pippi"), required=True),
        ),
        (
            f'{ONE_OF} ; sh:property [ sh:path rob:support ; sh:pattern "Pippi$" ]',
            Mention(iri("par")),
        ),
        (
            "sh:property [ sh:path :under ; sh:in ( :par ) ] ; sh:property [ sh:path :over ; sh:in ( :Pippi ) ]",
            Mention(iri("par"), values("Pippi")),
        ),
        (
            "sh:property [ sh:path :over ; sh:in ( :par ) ] ; sh:property [ sh:path :under ; sh:in ( :Pippi ) ]",
            Mention(iri("par")),
        ),
        (
            "sh:property [ sh:path :over ; sh:in ( :par ) ] , [ sh:path :over ; sh:hasValue :Emil ]",
            Mention(iri("par"), values("Emil"), required=True),
        ),
    ],
)
def test_the_rest_of_a_shape_says_what_may_be_stated(shape: str, mention: Mention) -> None:
    assert asked(shape) == mention
    assert not partition(shape).contradictory


def test_of_the_values_that_candidates_state_those_that_fail_another_test_are_told() -> None:
    other = """
        :t a sc:Template ; sc:roles ( :role :any ) ; sc:parameter :par . :par a sc:Parameter ; sc:name "par" .
        :any a sc:Role ; sh:property [ sh:path rob:support ; sh:in ( :par ) ] .
    """
    shape = f':role a sc:Role ; {ONE_OF} ; sh:property [ sh:path rob:support ; sh:pattern "Pippi$" ] .'
    found = partitioner(other + shape).partition(read([":here a sc:Component, :Other ; rob:support :Astrid ."]))
    assert found.mentions[0] == (Mention(iri("par"), never=values("Astrid")),)


@pytest.mark.parametrize(
    "shape",
    [
        f"{ONE_OF} ; sh:property [ sh:path rob:support ; sh:in ( :Pippi ) ; sh:minCount 1 ]",
        "sh:property [ sh:path rob:support ; sh:hasValue :Pippi ] , [ sh:path rob:support ; sh:in ( :par ) ]",
        "sh:property [ sh:path rob:support ; sh:hasValue :par ; sh:maxCount 0 ]",
        'sh:property [ sh:path rob:support ; sh:hasValue :par ; sh:pattern "Pippi$" ]',
    ],
)
def test_a_shape_may_contradict_itself_by_the_value_that_is_bound(shape: str) -> None:
    assert partition(shape, bound=True).contradictory == {0}


@pytest.mark.parametrize(
    "shape",
    [
        "sh:property [ sh:path rob:support ; sh:in ( :par ) ; sh:minCount 2 ]",
        "sh:property [ sh:path rob:support ; sh:in ( :par ) ; sh:hasValue :Pippi , :Emil ]",
        "sh:property [ sh:path rob:support ; sh:hasValue :par ; sh:in ( 1 2 ) ]",
    ],
)
def test_a_shape_may_contradict_itself_whatever_a_parameter_is(shape: str) -> None:
    assert partition(shape).contradictory == {0}


def test_a_component_that_may_state_nothing_can_be_eligible_whatever_the_lists_are() -> None:
    shape = f"{ONE_OF} ; sh:property [ sh:path rob:support ; sh:in ( :Pippi ) ]"
    assert not partition(shape, bound=True).contradictory

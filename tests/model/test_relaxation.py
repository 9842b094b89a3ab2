"""Relaxations word themselves as requests."""

from __future__ import annotations

from typing import get_args

import pytest

from selfconf.model.obstacle import WrongType
from selfconf.model.partition import Candidate, NearMiss
from selfconf.model.profile import Operation, Output, Profile
from selfconf.model.relaxation import (
    AcceptNearMiss,
    AddComponents,
    AddInteraction,
    Addition,
    AddRecruits,
    AskForFewer,
    LetRecruit,
    Relaxation,
)
from tests.lab import iri


def test_a_repair_by_type_says_what_the_component_is_not() -> None:
    near = NearMiss(iri("r0"), iri("c1"), WrongType(iri("A1")))
    assert str(AcceptNearMiss(near, Candidate(Profile(iri("c1"))))) == "let the role r0 take c1, although it is no A1"


EYE, MIND = iri("eye"), iri("mind")
IMAGE = Output("image", (iri("Image"),))
LIKE_A, LIKE_B = (IMAGE._replace(conforms=frozenset((shape,))) for shape in "ab")
WORDED: list[tuple[Relaxation, str]] = [
    (AddComponents((Addition(EYE, 1),)), "add one more component for the role eye"),
    (
        AddComponents((Addition(EYE, 2, (IMAGE, IMAGE)), Addition(MIND, 1, (IMAGE,)))),
        (
            "add 2 more components for the role eye that issue Image and one more component for the role mind"
            " that issues Image"
        ),
    ),
    (
        AddComponents((Addition(EYE, 1, (IMAGE, Output("x", (Operation.of(iri("Image")),)))),)),
        "add one more component for the role eye that issues Image and offers an operation -> Image",
    ),
    (
        AddComponents((Addition(EYE, 1, (Output("c", ()),), frozenset("c")),)),
        "add one more component for the role eye that issues a signal without a type by the output 'c'",
    ),
    (
        AddComponents((Addition(EYE, 1), Addition(MIND, 1)), ("robot",)),
        "add one more component for the role eye and one more component for the role mind, with one robot for both",
    ),
    (
        AddComponents((Addition(EYE, 1, values=(("robot", iri("Pippi")), ("spot", None))),)),
        "add one more component for the role eye, with robot Pippi, with no spot",
    ),
    (AddComponents((Addition(EYE, 3),), ("robot",)), "add 3 more components for the role eye, with one robot for all"),
    (
        AddComponents((Addition(EYE, 2, shared=("robot",)), Addition(MIND, 2)), ("robot",)),
        (
            "add 2 more components for the role eye and 2 more components for the role mind,"
            " with one robot for those for the role eye"
        ),
    ),
    (
        AddComponents((Addition(EYE, 2, (Output("reset()", ()),), frozenset(("reset()",))),)),
        "add 2 more components for the role eye that offer an operation by the name 'reset'",
    ),
    (
        AddRecruits((Addition(EYE, 1, (IMAGE,)), Addition(MIND, 1, (IMAGE,)))),
        (
            "add one more component for the role eye to recruit that issues Image and one more component for the role"
            " mind to recruit that issues Image"
        ),
    ),
    (
        AddRecruits((Addition(EYE, 1, (LIKE_A,)), Addition(EYE, 1, (LIKE_B,)))),
        "add 2 more components for the role eye to recruit that issue Image as the sc:accepts of its input asks",
    ),
    (AskForFewer(EYE, 0), "let the role eye be optional (sc:minCount 0)"),
    (AskForFewer(EYE, 2), "let the role eye ask for 2 (sc:minCount 2)"),
    (AddInteraction(EYE, MIND), "let the role eye feed the role mind (sc:feeds)"),
    (LetRecruit(EYE, (iri("lens"),)), "let the role eye recruit (sc:recruits true): it would bring lens"),
    (LetRecruit(EYE, ()), "let the role eye recruit (sc:recruits true): no recruit would be needed"),
    (
        AcceptNearMiss(NearMiss(EYE, iri("cap"), WrongType(iri("Eye"))), Candidate(Profile(iri("cap")))),
        "let the role eye take cap, although it is no Eye",
    ),
]


def test_every_relaxation_is_worded_and_has_a_code_and_a_role() -> None:
    assert {type(relaxation) for relaxation, _ in WORDED} == set(get_args(Relaxation))
    assert {relaxation.role for relaxation, _ in WORDED} == {EYE}
    assert sorted(kind.code for kind in get_args(Relaxation)) == [
        "accept-near-miss",
        "add-components",
        "add-interaction",
        "add-recruits",
        "ask-for-fewer",
        "let-recruit",
    ]


@pytest.mark.parametrize(("relaxation", "said"), WORDED)
def test_a_relaxation_is_a_request(relaxation: Relaxation, said: str) -> None:
    assert str(relaxation) == said

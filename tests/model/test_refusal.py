"""Refusals: each reason words itself, stands on requirements, and is false as an answer."""

from __future__ import annotations

from typing import get_args

import pytest

from selfconf.model.profile import WantedSignal, needed_operation
from selfconf.model.refusal import (
    Conflict,
    Contradiction,
    DerivationStep,
    InputUnfed,
    MisnamedPort,
    Reason,
    Refusal,
    TooFewDistinct,
    TooFewEligible,
    Undecided,
    ValueUnknown,
)
from selfconf.model.requirement import InputFed, OneRoleEach, OneValue, RolePlayed
from selfconf.model.term import IRI

EYE, MIND, CAP, IMAGE = (IRI(f"urn:{name}") for name in ("eye", "mind", "cap", "Image"))
UNFED = InputUnfed(MIND, CAP, "picture", WantedSignal((IMAGE,)), (EYE,))
WORDED: list[tuple[Reason, str]] = [
    (
        Contradiction(EYE, 3, 2),
        "the role eye asks for no fewer than 3 and no more than 2 components; nothing can satisfy both",
    ),
    (
        ValueUnknown(EYE, "room"),
        "the role eye sets a parameter to room, which is not bound, and no candidate says what it could be; bind room",
    ),
    (TooFewEligible(EYE, 1, 0), "no component is eligible for the role eye"),
    (TooFewEligible(EYE, 2, 1), "the role eye asks for 2 components, and only one is eligible"),
    (TooFewEligible(EYE, 1, 0, held=1), "no component that is free is eligible for the role eye"),
    (
        TooFewEligible(EYE, 3, 2, held=1),
        "the role eye asks for 3 components, and of those that are free only 2 are eligible",
    ),
    (TooFewEligible(EYE, 3, 2), "the role eye asks for 3 components, and only 2 are eligible"),
    (
        TooFewDistinct((EYE, MIND), 2, 1),
        "the roles eye and mind together ask for 2 different components, and only one is eligible",
    ),
    (
        UNFED,
        "the input 'picture' (Image) of cap cannot be fed: no candidate of eye issues an Image for it",
    ),
    (
        InputUnfed(MIND, CAP, "picture", WantedSignal((IMAGE,)), ()),
        "the input 'picture' (Image) of cap cannot be fed: no interaction feeds it in the role mind",
    ),
    (
        InputUnfed(MIND, CAP, "picture", WantedSignal((IMAGE,)), (EYE,), optional=(EYE,)),
        (
            "the input 'picture' (Image) of cap cannot be fed: "
            "what could serve it cannot play the optional role eye (sc:minCount 0)"
        ),
    ),
    (
        InputUnfed(MIND, CAP, "photo()", needed_operation("photo", None, IMAGE).wanted, (EYE,)),
        (
            "the operation 'photo' (-> Image) that cap needs cannot be called: "
            "no candidate of eye offers an operation -> Image for it"
        ),
    ),
    (
        InputUnfed(MIND, CAP, "photo()", needed_operation("photo", IMAGE, None).wanted, ()),
        (
            "the operation 'photo' (Image -> nothing) that cap needs cannot be called: "
            "no interaction feeds it in the role mind"
        ),
    ),
    (
        InputUnfed(MIND, CAP, "reset()", WantedSignal(()), (EYE,)),
        (
            "the operation 'reset' that cap needs cannot be called: "
            "no candidate of eye offers an operation of that name for it"
        ),
    ),
    (Conflict((EYE,), ("room",)), "the role eye cannot be played with one room for all"),
    (
        Conflict((MIND,), requirements=(OneRoleEach(), InputFed(MIND, WantedSignal((IMAGE,))))),
        "the role mind cannot be played with no component used twice so that mind gets the Image that it needs",
    ),
    (
        Conflict((EYE, MIND), requirements=(OneRoleEach(), InputFed(MIND, WantedSignal((IMAGE,))))),
        (
            "the roles eye and mind cannot all be played with a different component for each so that mind gets the "
            "Image that it needs"
        ),
    ),
]


def test_every_reason_is_worded() -> None:
    assert {type(reason) for reason, _ in WORDED} == set(get_args(Reason))


@pytest.mark.parametrize(("reason", "said"), WORDED)
def test_a_reason_is_one_sentence(reason: Reason, said: str) -> None:
    assert str(reason) == said


def test_codes_are_stable_and_different() -> None:
    assert sorted(kind.code for kind in get_args(Reason)) == [
        "conflict",
        "contradictory-count",
        "input-unfed",
        "too-few-distinct",
        "too-few-eligible",
        "value-unknown",
    ]


def test_a_reason_stands_on_requirements() -> None:
    assert Contradiction(EYE, 3, 2).requirements == TooFewEligible(EYE, 1, 0).requirements == (RolePlayed(EYE),)
    assert ValueUnknown(EYE, "room").requirements == (OneValue("room"),)
    assert TooFewDistinct((EYE, MIND), 2, 1).requirements == (RolePlayed(EYE), RolePlayed(MIND), OneRoleEach())


def test_a_reason_about_several_roles_belongs_to_the_first() -> None:
    assert TooFewDistinct((EYE, MIND), 2, 1).role == Conflict((EYE, MIND)).role == EYE


@pytest.mark.parametrize(("more", "who"), [(0, "cap"), (1, "cap and one other"), (5, "cap and 5 others")])
def test_what_follows_is_told_with_how_many_leave_for_it(more: int, who: str) -> None:
    step = DerivationStep(MIND, CAP, more, "picture", WantedSignal((IMAGE,)), (EYE,))
    assert str(step) == f"{who} cannot play the role mind, as no component left in eye issues an Image"
    told = InputUnfed(MIND, CAP, "picture", WantedSignal((IMAGE,)), (EYE,), consequences=(step, step))
    assert str(told).split("; so ") == [str(UNFED), str(step), str(step)]


@pytest.mark.parametrize(
    ("sources", "lack"),
    [
        ((), "no recruit that can be fed itself issues an Image"),
        ((EYE,), "no component left in eye issues an Image, and no recruit that can be fed itself does"),
    ],
)
def test_what_could_be_recruited_if_it_were_fed_itself_is_not_said_to_be_missing(
    sources: tuple[IRI, ...], lack: str
) -> None:
    step = DerivationStep(MIND, CAP, 0, "picture", WantedSignal((IMAGE,)), sources, recruits=True)
    assert str(step) == f"cap cannot play the role mind, as {lack}"


@pytest.mark.parametrize(
    ("meant", "known", "said"),
    [
        ("pose", ("pose",), '(did you mean "pose"?)'),
        (None, (), "(there is none)"),
        (None, ("pose",), '(there is "pose")'),
        (None, ("image", "pose"), '(there are "image" and "pose")'),
    ],
)
def test_a_port_that_no_candidate_has_is_told_with_what_may_be_meant(
    meant: str | None, known: tuple[str, ...], said: str
) -> None:
    misnamed = str(MisnamedPort(EYE, "output", "posse", meant, known))
    assert misnamed == f'no candidate of eye has the output "posse" that an interaction names {said}'


@pytest.mark.parametrize(
    ("smallest", "irreducible", "proved"),
    [(True, True, "smallest"), (False, True, "irreducible"), (False, False, "unproved")],
)
def test_a_refusal_says_what_is_proved_of_its_reasons(smallest: bool, irreducible: bool, proved: str) -> None:
    assert Refusal(EYE, (), smallest=smallest, irreducible=irreducible).minimality == proved


def test_no_answer_is_true() -> None:
    assert not Refusal(EYE, ())
    assert not Undecided()


@pytest.mark.parametrize(
    ("undecided", "said"),
    [
        (Undecided(1), "not decided within 1 step; allow more by steps"),
        (Undecided(9), "not decided within 9 steps; allow more by steps"),
        (
            Undecided(9, unaided=True),
            "not decided within 9 steps; allow more by steps, or install the extra `solvers`",
        ),
        (Undecided(9, seconds=0.5), "not decided within 0.5 s; allow more by seconds"),
    ],
)
def test_what_is_not_decided_says_what_to_allow(undecided: Undecided, said: str) -> None:
    assert str(undecided) == said


def test_what_is_not_decided_is_asked_for_reasons_as_a_refusal_is_and_has_none() -> None:
    assert (Undecided(1).reasons, Undecided(1).near_misses, Undecided(1).repairs) == ((), (), ())
    assert Undecided(1)._repr_html_() == "<pre>not decided within 1 step; allow more by steps</pre>"


def test_a_reason_counts_the_components_that_other_tasks_hold() -> None:
    refusal = Refusal(CAP, (TooFewEligible(EYE, 1, 0), TooFewEligible(MIND, 1, 0), UNFED))
    told = refusal.told_of_held({CAP: (EYE,), IMAGE: (EYE, CAP), MIND: ()})
    assert [reason.held for reason in told.reasons if isinstance(reason, TooFewEligible)] == [2, 0]
    assert told.reasons[2] is UNFED

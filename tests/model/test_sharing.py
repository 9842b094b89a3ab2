"""What a search leaves out for the sake of others, against every choice of what could be left out."""

from __future__ import annotations

from collections.abc import Sequence, Set
from itertools import product

from hypothesis import given
from hypothesis import strategies as st

from selfconf.model.configuration import Assignment, Configuration, Connection
from selfconf.model.holder import Holder
from selfconf.model.immutable import replace
from selfconf.model.partition import Barred
from selfconf.model.refusal import Refusal, TooFewDistinct, TooFewEligible
from selfconf.model.sharing import MOST_AVOIDED, SharedInput, agreed, avoid, avoided_in_vain, contested_by
from selfconf.model.term import IRI

CAMERAS = tuple(IRI(f"urn:c:camera{number}") for number in range(4))
TRACKERS = tuple(IRI(f"urn:c:tracker{number}") for number in range(3))
REFUSAL = Refusal(IRI("urn:t:watch"), ())


EYE, TRACKER, GUARD = range(3)
"""The numbers of the roles."""


def watching(camera: IRI, tracker: IRI, guard: IRI | None = None) -> Configuration:
    """A tracker follows a camera; another camera may keep guard."""
    roles = (("eye", camera), ("tracker", tracker), *([("guard", guard)] if guard else []))
    players = tuple(Assignment(IRI(f"urn:r:{role}"), (component,)) for role, component in roles)
    return Configuration(IRI("urn:t:watch"), players, (Connection(camera, "image", tracker, "image"),))


def first(left_out: Set[Barred], guarded: bool = False) -> Configuration | Refusal:
    """The first configuration without some components, or without some as the players of roles."""

    def free(components: tuple[IRI, ...], role: int) -> list[IRI]:
        return [one for one in components if one not in left_out and (role, one) not in left_out]

    guards: Sequence[IRI | None] = free(CAMERAS, GUARD) if guarded else (None,)
    choices = product(free(TRACKERS, TRACKER), free(CAMERAS, EYE), guards)
    return next((watching(eye, tracker, guard) for tracker, eye, guard in choices if guard != eye), REFUSAL)


def holders(followed: tuple[int | None, ...]) -> dict[IRI, Holder]:
    """Other tasks that hold trackers, each of which follows a camera."""
    return {
        tracker: Holder("other~1", wants=watching(CAMERAS[number], tracker).wants(tracker))
        for tracker, number in zip(TRACKERS, followed, strict=True)
        if number is not None
    }


@given(st.tuples(*[st.sampled_from((None, 0, 1, 2, 3))] * 3), st.sets(st.sampled_from(CAMERAS)), st.booleans())
def test_a_configuration_is_found_that_all_agree_with_if_there_is_one(
    followed: tuple[int | None, ...], gone: set[IRI], guarded: bool
) -> None:
    sharers = holders(followed)
    found, taken = agreed(lambda left_out: first(left_out | gone, guarded), sharers)
    cameras = [camera for camera in CAMERAS if camera not in gone]
    guards: Sequence[IRI | None] = cameras if guarded else (None,)
    choices = [one for one in product(cameras, TRACKERS, guards) if one[0] != one[2]]
    good = [watching(*one) for one in choices if not contested_by(sharers, watching(*one))]
    assert bool(good) == isinstance(found, Configuration)
    if isinstance(found, Configuration):
        assert not contested_by(sharers, found)
        assert not taken.keys() & set(found.components)


def test_a_source_is_avoided_only_where_it_would_feed_the_shared_component() -> None:
    """Of two cameras the tracker is to follow the second, so that the first can keep guard."""
    sharers, others = holders((1, None, None)), frozenset({*CAMERAS[2:], *TRACKERS[1:]})
    found, taken = agreed(lambda left_out: first(left_out | others, guarded=True), sharers)
    assert (found, taken) == (watching(CAMERAS[1], TRACKERS[0], CAMERAS[0]), {})


def test_a_recruit_is_avoided_as_a_recruit() -> None:
    recruited = replace(watching(CAMERAS[0], TRACKERS[0]), assignments=(), recruits=(CAMERAS[0],))
    sharers = holders((1, None, None))
    assert avoid(sharers, recruited, {}) == ({}, {(None, CAMERAS[0]): SharedInput(TRACKERS[0], None)})


def test_a_component_is_taken_after_so_many_sources_were_avoided_for_it() -> None:
    cameras = [IRI(f"urn:c:c{number}") for number in range(MOST_AVOIDED + 5)]
    holder = Holder("other~1", wants=watching(IRI("urn:c:gone"), TRACKERS[0]).wants(TRACKERS[0]))
    searches = 0

    def search(left_out: frozenset[Barred]) -> Configuration | Refusal:
        nonlocal searches
        searches += 1
        free = [camera for camera in cameras if (EYE, camera) not in left_out]
        return watching(free[0], TRACKERS[0]) if TRACKERS[0] not in left_out else REFUSAL

    found, taken = agreed(search, {TRACKERS[0]: holder})
    assert (found, taken) == (REFUSAL, {TRACKERS[0]: holder})
    assert searches <= MOST_AVOIDED + 3


def test_a_component_of_which_others_want_other_values_alone_is_taken_at_once() -> None:
    configuration = watching(CAMERAS[0], TRACKERS[0])
    wants = configuration.wants(TRACKERS[0])
    holder = Holder("other~1", wants=type(wants)(wants.inputs, frozenset({("mode", IRI("urn:fast"))})))
    assert avoid({TRACKERS[0]: holder}, configuration, {}) == ({TRACKERS[0]: holder}, {})


def test_of_several_shared_components_the_reasons_say_for_which_sources_were_avoided_in_vain() -> None:
    eye, screen = IRI("urn:r:eye"), IRI("urn:r:screen")
    for_tracker, for_wall = SharedInput(TRACKERS[0], eye), SharedInput(TRACKERS[1], screen)
    avoided = {(0, CAMERAS[0]): for_tracker, (0, CAMERAS[1]): for_tracker, (1, CAMERAS[2]): for_wall}
    sharers = {tracker: Holder(f"of {tracker}") for tracker in TRACKERS}
    tracker, wall = ({one: sharers[one]} for one in TRACKERS[:2])

    def after(*reasons: TooFewEligible | TooFewDistinct) -> object:
        return avoided_in_vain(avoided, Refusal(IRI("urn:t:watch"), reasons), sharers)

    assert after(TooFewEligible(eye, 1, 0)) == (tracker, {(1, CAMERAS[2]): for_wall})
    assert after(TooFewEligible(screen, 1, 0)) == (wall, dict.fromkeys([*avoided][:2], for_tracker))
    both = tracker | wall, {}
    assert after(TooFewDistinct((screen, eye), 2, 1)) == both
    assert after(TooFewEligible(IRI("urn:r:other"), 1, 0)) == both
    assert after() == both
    assert avoided_in_vain(avoided, Refusal(IRI("urn:t:watch"), ()), wall) == (wall, {})

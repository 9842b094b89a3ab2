"""What a search leaves out for the sake of others, against every choice of what could be left out."""

from __future__ import annotations

from itertools import chain, combinations, product

from hypothesis import given
from hypothesis import strategies as st

from selfconf.model.configuration import Assignment, Configuration, Connection
from selfconf.model.holder import Holder
from selfconf.model.refusal import Refusal
from selfconf.model.sharing import MOST_AVOIDED, agreed, avoid, contested_by
from selfconf.model.term import IRI

CAMERAS = tuple(IRI(f"urn:c:camera{number}") for number in range(4))
TRACKERS = tuple(IRI(f"urn:c:tracker{number}") for number in range(3))
REFUSAL = Refusal(IRI("urn:t:watch"), ())


def watching(camera: IRI, tracker: IRI) -> Configuration:
    """A tracker follows a camera."""
    players = (Assignment(IRI("urn:r:eye"), (camera,)), Assignment(IRI("urn:r:tracker"), (tracker,)))
    return Configuration(IRI("urn:t:watch"), players, (Connection(camera, "image", tracker, "image"),))


def first(left_out: frozenset[IRI]) -> Configuration | Refusal:
    """The first configuration without some components."""
    pairs = ((t, c) for t, c in product(TRACKERS, CAMERAS) if not {t, c} & left_out)
    return next((watching(camera, tracker) for tracker, camera in pairs), REFUSAL)


def holders(followed: tuple[int | None, ...]) -> dict[IRI, Holder]:
    """Other tasks that hold trackers, each of which follows a camera."""
    return {
        tracker: Holder("other~1", wants=watching(CAMERAS[number], tracker).wants(tracker))
        for tracker, number in zip(TRACKERS, followed, strict=True)
        if number is not None
    }


def itself(outcome: Configuration | Refusal) -> object:
    """The outcome of a search that finds nothing else."""
    return outcome


@given(st.tuples(*[st.sampled_from((None, 0, 1, 2, 3))] * 3), st.sets(st.sampled_from(CAMERAS)))
def test_a_configuration_is_found_that_all_agree_with_if_there_is_one(
    followed: tuple[int | None, ...], gone: set[IRI]
) -> None:
    sharers = holders(followed)
    found, taken = agreed(lambda left_out: first(left_out | gone), sharers, itself)
    everybody = (*TRACKERS, *CAMERAS)
    choices = chain.from_iterable(combinations(everybody, count) for count in range(len(everybody)))
    all_of_them = [first(frozenset(some) | gone) for some in choices]
    good = [one for one in all_of_them if isinstance(one, Configuration) and not contested_by(sharers, one)]
    assert bool(good) == isinstance(found, Configuration)
    if isinstance(found, Configuration):
        assert not contested_by(sharers, found)
        assert not taken.keys() & set(found.components)


def test_a_component_is_taken_after_so_many_sources_were_avoided_for_it() -> None:
    cameras = [IRI(f"urn:c:c{number}") for number in range(MOST_AVOIDED + 5)]
    holder = Holder("other~1", wants=watching(IRI("urn:c:gone"), TRACKERS[0]).wants(TRACKERS[0]))
    searches = 0

    def search(left_out: frozenset[IRI]) -> Configuration | Refusal:
        nonlocal searches
        searches += 1
        free = [camera for camera in cameras if camera not in left_out]
        return watching(free[0], TRACKERS[0]) if TRACKERS[0] not in left_out else REFUSAL

    found, taken = agreed(search, {TRACKERS[0]: holder}, itself)
    assert (found, taken) == (REFUSAL, {TRACKERS[0]: holder})
    assert searches <= MOST_AVOIDED + 3


def test_a_component_of_which_others_want_other_values_alone_is_taken_at_once() -> None:
    configuration = watching(CAMERAS[0], TRACKERS[0])
    wants = configuration.wants(TRACKERS[0])
    holder = Holder("other~1", wants=type(wants)(wants.inputs, frozenset({("mode", IRI("urn:fast"))})))
    assert avoid({TRACKERS[0]: holder}, configuration, {}) == ({TRACKERS[0]: holder}, {})

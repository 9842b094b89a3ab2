"""The garbage collector: at rest while much is read, and as it was afterwards."""

from __future__ import annotations

import gc
import weakref
from collections.abc import Iterator

import pytest

from selfconf.api.collector import MANY_COMPONENTS, MANY_VALUES, SELDOM, collector_at_rest, collector_looking_at_new


class Loop:
    """An object that refers to itself, which the collector alone can end."""

    def __init__(self) -> None:
        self.itself = self


@pytest.fixture
def unfrozen() -> Iterator[None]:
    """Nothing is frozen, as a program begins, though the one that runs the tests may have frozen what it has."""
    frozen = gc.get_freeze_count() > 0
    gc.unfreeze()
    yield
    if frozen:
        gc.freeze()


def test_the_collector_rests_and_is_as_it_was_afterwards() -> None:
    def fail() -> None:
        with collector_at_rest():
            assert not gc.isenabled()
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    assert gc.isenabled()


@pytest.mark.usefixtures("unfrozen")
def test_what_was_there_is_looked_at_once_all_is_over() -> None:
    loop = Loop()
    gone = weakref.ref(loop)
    often = gc.get_threshold()
    with collector_looking_at_new(MANY_COMPONENTS):
        assert gc.get_threshold()[0] >= SELDOM
        new = weakref.ref(Loop())
        del loop
        gc.collect()
        assert new() is None
        assert gone() is not None
    gc.collect()
    assert gone() is None
    assert not gc.get_freeze_count()
    assert gc.get_threshold() == often


@pytest.mark.usefixtures("unfrozen")
def test_what_was_there_is_looked_at_where_there_are_few_components() -> None:
    loop = Loop()
    gone = weakref.ref(loop)
    with collector_looking_at_new(MANY_COMPONENTS - 1):
        del loop
        gc.collect()
        assert gone() is None


def test_what_is_frozen_is_not_asked_for_few_new_values(monkeypatch: pytest.MonkeyPatch) -> None:
    gc.disable()
    try:
        old = [[number] for number in range(2 * MANY_VALUES)]
        monkeypatch.setattr(gc, "get_freeze_count", lambda: pytest.fail("it takes as long as there is much frozen"))
        with collector_at_rest():
            new = [[number] for number in range(10)]
        assert len(old) > len(new)
    finally:
        gc.enable()

"""The garbage collector: at rest while much is read, and as it was afterwards."""

from __future__ import annotations

import gc
import subprocess
import sys
import weakref
from collections.abc import Callable
from pathlib import Path

import pytest

from selfconf.api.garbage_collection import (
    FROZEN_BY_PYTHON,
    MANY_COMPONENTS,
    MANY_VALUES,
    SELDOM,
    collector_at_rest,
    collector_looking_at_new,
)

ROOT = Path(__file__).parents[2]


class Loop:
    """An object that refers to itself, which the collector alone can end."""

    def __init__(self) -> None:
        self.itself = self


def in_a_new_process(check: Callable[[], None]) -> None:
    """Run a check where nothing is frozen, and little is there: to look at all that tests are made of takes seconds."""
    command = f"from {check.__module__} import {check.__name__}; {check.__name__}()"
    done = subprocess.run([sys.executable, "-c", command], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_the_collector_rests_and_is_as_it_was_afterwards() -> None:
    def fail() -> None:
        with collector_at_rest():
            assert not gc.isenabled()
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    assert gc.isenabled()


def test_what_was_there_is_looked_at_once_all_is_over() -> None:
    in_a_new_process(look_once_all_is_over)


def look_once_all_is_over() -> None:
    """Make garbage before and while the collector looks at what is new alone."""
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
    assert gc.get_freeze_count() <= FROZEN_BY_PYTHON
    assert gc.get_threshold() == often


def test_what_was_there_is_looked_at_where_there_are_few_components() -> None:
    in_a_new_process(look_where_there_are_few_components)


def look_where_there_are_few_components() -> None:
    """Make garbage before there are few components."""
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

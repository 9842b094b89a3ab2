"""How a copy of the standing process ends, told apart by its status."""

from __future__ import annotations

import signal

import pytest

from selfconf.query import standing_process as process


@pytest.mark.parametrize(
    ("status", "ending"),
    [
        (0, process.DONE),
        (2 << 8, process.REFUSED),
        (3 << 8, process.NO_TYPE),
        (4 << 8, process.NO_MEMORY),
        (1 << 8, process.BROKEN),
        (signal.SIGALRM, process.NO_TIME),
        (signal.SIGKILL, process.NO_MEMORY),
        (signal.SIGSEGV, process.ENGINE_DOWN),
        (signal.SIGTERM, process.BROKEN),
    ],
)
def test_the_status_of_a_copy_says_how_it_has_ended(status: int, ending: bytes) -> None:
    assert process._ending(status) == ending


def test_every_media_type_is_that_of_its_format() -> None:
    for media, form in {**process.RESULT_TYPES, **process.TRIPLE_TYPES}.items():
        assert form.media_type.partition(";")[0] == media

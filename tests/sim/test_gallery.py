"""From what a demo has recorded to what its pictures show."""

from __future__ import annotations

import pytest

from sim.account import Account
from sim.home.apartment import Apartment


@pytest.mark.parametrize(
    ("eyes", "source"),
    [([], "the person tracker"), (["stereo eye"], "the position service")],
    ids=["flat", "composite"],
)
def test_the_first_source_is_called_by_what_it_is_in_the_scene(
    eyes: list[str], source: str, apartment: Apartment
) -> None:
    np = pytest.importorskip("numpy", reason="pictures need numpy: install the extra sim")
    pytest.importorskip("mitsuba", reason="pictures need Mitsuba: install the extra sim")
    from sim.gallery import run_record

    logbook = {
        "times": np.array([0.0, 1.0, 2.0]),
        "poses": np.zeros((3, 3)),
        "sources": np.array(["", "tracker", "odometry"]),
        "sight_times": np.zeros(0),
        "sight_images": np.zeros((0, 1, 1, 3)),
        "sight_poses": np.zeros((0, 3)),
    }
    assert run_record(Account(0.0, eyes=eyes), apartment, logbook).sources[0] == source

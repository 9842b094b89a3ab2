"""What many advertisements cost: less than twice their parsing, and those that no role wants next to nothing more."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator

import pyoxigraph as ox
import pytest

from benchmarks.scale import worlds as scale
from selfconf.api.garbage_collection import collector_at_rest
from selfconf.model.hierarchy import Hierarchy
from selfconf.model.profile import Profile
from selfconf.rdf.advertisements import loader
from selfconf.rdf.advertisements.advertisement import Advertisement
from selfconf.rdf.eligibility.nearly_eligible import near_misses
from selfconf.rdf.eligibility.partitioner import Partitioner
from selfconf.rdf.eligibility.role_tests import CompiledRole

MANY = 4_000


def least(work: Callable[[], object], trials: int = 5) -> float:
    """Seconds of processor time, at best."""
    times = []
    for _ in range(trials):
        began = time.process_time()
        work()
        times.append(time.process_time() - began)
    return min(times)


@pytest.fixture(scope="module")
def text() -> bytes:
    """Generated advertisements."""
    return "".join(scale.ecology(MANY)).encode()


def read(text: bytes) -> list[Advertisement]:
    """All of them; none is malformed."""
    good, bad = loader.read_advertisements(text, "many.ttl", "file:///many.ttl")
    assert not bad
    return good


def test_loading_costs_less_than_twice_the_parsing(text: bytes) -> None:
    with collector_at_rest():
        parsing = least(lambda: sum(1 for _ in ox.parse(text, format=ox.RdfFormat.TURTLE)))
        assert least(lambda: read(text)) < 2 * parsing


def test_components_that_no_role_wants_change_nothing(text: bytes) -> None:
    ads, partitioner = read(text), Partitioner(scale.task("robot0"))
    crowd = read("".join(scale.ecology(MANY, seed=1, wanted=False)).encode())
    assert partitioner.partition(crowd + ads) == partitioner.partition(ads)
    assert list(near_misses(partitioner, crowd + ads)) == list(near_misses(partitioner, ads))
    assert not any(partitioner.partition(crowd).candidates)


def test_equal_signatures_are_tested_once(text: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    ads, partitioner, asked = read(text), Partitioner(scale.task("robot0")), list[object]()
    obstacles = CompiledRole.obstacles

    def counted(role: CompiledRole, profile: Profile, hierarchy: Hierarchy) -> Iterator[str]:
        asked.append(profile)
        return obstacles(role, profile, hierarchy)

    monkeypatch.setattr(CompiledRole, "obstacles", counted)
    partitioner.partition(ads)
    assert 0 < len(asked) <= len(scale.ROLES) * scale.ROBOTS

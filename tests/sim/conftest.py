"""The apartment that the tests of the world share, and how signals are handled after a program has been played."""

from __future__ import annotations

import signal
from collections.abc import Iterator

import pytest
from rdflib import Graph

from sim.home.apartment import PEIS_HOME, Apartment, read_apartment


@pytest.fixture(scope="session")
def apartment() -> Apartment:
    """The PEIS-Home as it is."""
    return read_apartment()


@pytest.fixture(scope="session")
def plan_as_it_is() -> Graph:
    """The PEIS-Home's Turtle as a graph."""
    return Graph().parse(PEIS_HOME, format="turtle")


@pytest.fixture
def plan(plan_as_it_is: Graph) -> Graph:
    """The PEIS-Home's Turtle as a graph that a test may change."""
    return Graph() + plan_as_it_is


@pytest.fixture
def handlers() -> Iterator[None]:
    """Puts back how signals are handled."""
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)}
    yield
    for number, handler in before.items():
        signal.signal(number, handler)

"""The apartment that the tests of the world share."""

from __future__ import annotations

import pytest
from rdflib import Graph

from sim.apartment import PEIS_HOME, Apartment, read_apartment


@pytest.fixture(scope="session")
def apartment() -> Apartment:
    """The PEIS-Home as it is."""
    return read_apartment()


@pytest.fixture
def plan() -> Graph:
    """The PEIS-Home's Turtle as a graph that a test may change."""
    return Graph().parse(PEIS_HOME, format="turtle")

"""Every public name has a docstring with an example, and the examples in the docstrings of the library are true."""

from __future__ import annotations

import doctest
import inspect
import pkgutil
from collections.abc import Iterator
from importlib import import_module
from types import ModuleType
from typing import Any

import pytest

import selfconf as sc
from selfconf import api, testing
from selfconf.sdk import Component

MODULES = [
    import_module(name)
    for name in (
        *(found.name for found in pkgutil.walk_packages(api.__path__, "selfconf.api.")),
        "selfconf.bus.memory",
        "selfconf.errors",
        "selfconf.model.configuration",
        "selfconf.model.refusal",
        "selfconf.model.term",
        "selfconf.testing.bench",
        "selfconf.testing.memory_ecology",
    )
]
LIVING = ("join(", "sites(")
"""What an example says that needs a site."""


def namespace() -> dict[str, Any]:
    """The names that an example may use: those of selfconf and its `testing`, and `Component`."""
    names = {name: getattr(room, name) for room in (sc, testing) for name in room.__all__}
    return {**names, "Component": Component}


def found_examples(module: ModuleType) -> Iterator[doctest.DocTest]:
    """The docstrings of a module that hold examples."""
    return (found for found in doctest.DocTestFinder().find(module, globs={}) if found.examples)


EXAMPLES = [found for module in MODULES for found in found_examples(module)]


def is_living(found: doctest.DocTest) -> bool:
    """Whether a site has to run for an example."""
    return any(word in one.source for one in found.examples for word in LIVING)


def checked(found: doctest.DocTest) -> None:
    """Run the examples of a docstring."""
    found.globs = namespace()
    said: list[str] = []
    result = doctest.DocTestRunner(verbose=False).run(found, out=said.append)
    assert not result.failed, "".join(said)
    assert result.attempted


@pytest.mark.parametrize("found", [one for one in EXAMPLES if not is_living(one)], ids=lambda found: found.name)
def test_the_example_is_true(found: doctest.DocTest) -> None:
    checked(found)


@pytest.mark.process
@pytest.mark.usefixtures("served")
@pytest.mark.parametrize("found", [one for one in EXAMPLES if is_living(one)], ids=lambda found: found.name)
def test_the_example_in_a_living_ecology_is_true(found: doctest.DocTest) -> None:
    checked(found)


@pytest.mark.parametrize("name", [*sc.__all__, *testing.__all__])
def test_every_public_name_has_a_docstring_with_an_example(name: str) -> None:
    text = inspect.getdoc(getattr(sc, name, None) or getattr(testing, name)) or ""
    assert ">>> " in text, name
    assert text.partition("\n")[0].endswith((".", ":")), name


def test_the_public_names_are_all_there_and_sorted_as_ruff_sorts_them() -> None:
    assert set(sc.__all__) == set(sc._HOME)
    assert set(sc.__all__) <= set(dir(sc))
    with pytest.raises(AttributeError, match="no attribute 'configurate'"):
        sc.configurate  # noqa: B018  # that it is asked for is what is tested

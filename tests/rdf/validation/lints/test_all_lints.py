"""All lints, and which of them run when."""

from __future__ import annotations

import inspect
from types import ModuleType

import pytest

from selfconf.rdf.validation.lints import flow, sources, templates, terms
from selfconf.rdf.validation.lints.all_lints import TEMPLATES, WORDS


@pytest.mark.parametrize("module", [flow, sources, templates, terms], ids=lambda module: module.__name__)
def test_no_lint_is_forgotten(module: ModuleType) -> None:
    written = {
        function
        for name, function in inspect.getmembers(module, inspect.isfunction)
        if function.__module__ == module.__name__
        and not name.startswith("_")
        and inspect.signature(function).return_annotation == "Iterator[Diagnostic]"
    }
    assert written
    assert written <= {*WORDS, *TEMPLATES}


def test_no_lint_runs_twice() -> None:
    assert len({*WORDS, *TEMPLATES}) == len(WORDS) + len(TEMPLATES)

"""All lints, and which of them run when."""

from __future__ import annotations

import inspect
from importlib import import_module
from pkgutil import iter_modules

from selfconf.rdf.validation import lints
from selfconf.rdf.validation.lints.all_lints import TEMPLATES, WORDS
from tests.rdf.validation.lints.linted_text import lints as told

LINT = "(file: 'LintedFile') -> 'Iterator[Diagnostic]'"


def test_no_lint_is_forgotten() -> None:
    modules = [import_module(f"{lints.__name__}.{one.name}") for one in iter_modules(lints.__path__)]
    written = {
        function
        for module in modules
        for name, function in inspect.getmembers(module, inspect.isfunction)
        if not name.startswith("_")
        and str(inspect.signature(function)) == "(file: 'LintedFile') -> 'Iterator[Diagnostic]'"
    }
    assert written == {*WORDS, *TEMPLATES}


def test_no_lint_runs_twice() -> None:
    assert len({*WORDS, *TEMPLATES}) == len(WORDS) + len(TEMPLATES)


def test_what_is_wrong_with_a_template_hides_what_is_merely_strange_about_it() -> None:
    text = ":t a sc:Template ; sc:roles :r . :r a sc:Role ; sh:class rob:Lamp ."
    assert {each.code for each in told(text)} == {"SC-T02"}

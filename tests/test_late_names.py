"""Names of a package that are loaded when they are first used."""

from __future__ import annotations

import subprocess
import sys
from importlib import import_module

import pytest


@pytest.mark.parametrize(
    ("package", "name", "module"),
    [
        ("selfconf", "Refusal", "selfconf.model.refusal"),
        ("selfconf.query", "read_endpoint", "selfconf.query.endpoint"),
        ("selfconf.deployment", "TaskRunner", "selfconf.deployment.runner"),
    ],
)
def test_a_name_is_loaded_when_it_is_first_used_and_not_before(package: str, name: str, module: str) -> None:
    program = (
        f"import sys, {package}; assert {module!r} not in sys.modules;"
        f" found = {package}.{name}; assert {module!r} in sys.modules; assert vars({package})[{name!r}] is found"
    )
    subprocess.run([sys.executable, "-c", program], check=True)


@pytest.mark.parametrize("package", ["selfconf", "selfconf.query", "selfconf.deployment"])
def test_a_name_that_a_package_has_not_is_an_attribute_error(package: str) -> None:
    with pytest.raises(AttributeError, match=f"^module '{package}' has no attribute 'nothing'$"):
        _ = import_module(package).nothing

"""requirements.txt: a hash for each file, no registry, and a part for each extra that is closed in itself."""

from __future__ import annotations

import re
import subprocess
import sys
from importlib.metadata import PackageNotFoundError, requires
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from supply import pins
from supply.pins import FILE, ROOT, bundled, installer, requirements, selected

TEXT = FILE.read_text("utf-8")
EXTRAS = ("sim", "solvers", "serve", "keys", "wot", "ros2", "dev", "fast-owl", "bench")


def pinned(text: str) -> dict[str, list[Requirement]]:
    """The requirements of a text by the names of their distributions."""
    found: dict[str, list[Requirement]] = {}
    for line in text.splitlines():
        if not line.startswith(("#", " ")):
            one = Requirement(line.removesuffix("\\"))
            found.setdefault(canonicalize_name(one.name), []).append(one)
    return found


def test_every_version_is_pinned_with_hashes_and_no_registry_is_named() -> None:
    assert "://" not in TEXT
    found = list(requirements(TEXT))
    assert sum(map(len, pinned(TEXT).values())) == len(found) > 100
    for who, requirement in found:
        assert who
        first, *hashes = requirement.splitlines()
        assert re.fullmatch(r"[A-Za-z0-9._-]+==\S+( ; .+)? \\", first), first
        assert hashes
        assert all(re.fullmatch(r"    --hash=sha256:[0-9a-f]{64}( \\)?", line) for line in hashes), first


def installed_needs(name: str) -> list[Requirement]:
    """What an installed distribution needs here; nothing of one that is not installed."""
    try:
        said = list(map(Requirement, requires(name) or ()))
    except PackageNotFoundError:
        return []
    return [one for one in said if not one.marker or one.marker.evaluate({"extra": ""})]


@pytest.mark.parametrize(
    "extras",
    [(), ("build", "sim", "serve", "keys"), ("build", "sim", "solvers", "serve", "keys", "wot", "ros2", "dev")],
    ids=str,
)
def test_what_is_selected_needs_nothing_else(extras: tuple[str, ...]) -> None:
    chosen = pinned(selected(TEXT, extras))
    here = {name for name, pins in chosen.items() if any(not one.marker or one.marker.evaluate() for one in pins)}
    for name in sorted(here):
        lacking = [one for one in installed_needs(name) if canonicalize_name(one.name) not in here]
        assert not lacking, (name, lacking)


@pytest.mark.parametrize("extra", [None, *EXTRAS])
def test_what_the_project_file_asks_for_is_pinned_in_a_version_that_fits(extra: str | None) -> None:
    project = (ROOT / "pyproject.toml").read_text("utf-8")
    start = "dependencies" if extra is None else extra
    section = re.search(rf"^{start} = \[(.*?)\]$", project, re.MULTILINE | re.DOTALL)
    assert section is not None
    chosen = pinned(selected(TEXT, () if extra is None else (extra,)))
    wanted = list(map(Requirement, re.findall(r'"([^"]+)"', section[1])))
    assert wanted
    for one in wanted:
        versions = [next(iter(pin.specifier)).version for pin in chosen[canonicalize_name(one.name)]]
        assert all(one.specifier.contains(version, prereleases=True) for version in versions), one


def test_the_core_is_selected_without_what_it_does_not_need_and_in_a_bare_python() -> None:
    command = [sys.executable, "-I", "-S", str(ROOT / "supply" / "pins.py"), "select"]
    printed = subprocess.run(command, capture_output=True, text=True, check=True, cwd=Path("/")).stdout
    assert printed == selected(TEXT, ())
    assert {"rdflib", "eclipse-zenoh"} <= pinned(printed).keys()
    assert not {"pytest", "mitsuba", "cryptography", "uvicorn", "hatchling"} & pinned(printed).keys()
    assert "hatchling" in pinned(selected(TEXT, ["build"]))


def test_two_halves_are_the_whole() -> None:
    extras = ("dev", "sim")
    whole, one, other = (
        [line for line in selected(TEXT, extras, half).splitlines() if not line.startswith(" ")]
        for half in (None, 1, 2)
    )
    assert sorted([*one, *other]) == sorted(whole)
    assert len(one) - len(other) in (0, 1)


def test_the_installer_is_pip_alone_and_is_selected_in_a_bare_python() -> None:
    command = [sys.executable, "-I", "-S", str(ROOT / "supply" / "pins.py"), "installer"]
    printed = subprocess.run(command, capture_output=True, text=True, check=True, cwd=Path("/")).stdout
    assert printed == installer(TEXT)
    assert pinned(printed).keys() == {"pip"}
    assert "--hash=sha256:" in printed


def test_an_installer_that_is_not_pinned_is_a_sentence() -> None:
    with pytest.raises(SystemExit, match="pip is not pinned"):
        installer(TEXT.replace("\npip==", "\npop=="))


def test_the_pip_that_comes_with_python_runs_from_its_wheel(monkeypatch: pytest.MonkeyPatch) -> None:
    wheel = bundled()
    if wheel is None:
        pytest.skip("no pip comes with this Python")
    command = [sys.executable, "-S", "-m", "pip", "--version"]  # without what is installed
    said = subprocess.run(command, capture_output=True, text=True, check=True, env={"PYTHONPATH": str(wheel)}).stdout
    assert f" from {wheel}" in said
    monkeypatch.setitem(sys.modules, "ensurepip", None)
    assert bundled() is None


def test_an_extra_that_is_not_pinned_is_a_sentence() -> None:
    with pytest.raises(SystemExit, match="nothing is pinned for nonsense"):
        selected(TEXT, ["nonsense"])


def test_the_uv_beside_the_python_that_runs_resolves(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "python").symlink_to(sys.executable)
    monkeypatch.setattr(sys, "executable", str(tmp_path / "python"))
    monkeypatch.setenv("PATH", "")
    with pytest.raises(SystemExit, match="type: pip install uv"):
        pins._compile(["pyproject.toml"], tmp_path / "out")
    (tmp_path / "uv").write_text("#!/bin/sh\nexit 3\n")
    (tmp_path / "uv").chmod(0o755)
    with pytest.raises(SystemExit) as ended:
        pins._compile(["pyproject.toml"], tmp_path / "out")
    assert ended.value.code == 3

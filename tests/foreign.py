"""Programs that nobody here wrote, had by the package managers of their languages into a cache of this user.

They judge what selfconf says to others, at night: packages of npm, and crates of ours that are built with crates of
others. Where a package manager is missing, or reaches no registry, the test is skipped and says why.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import pytest

FETCHING, BUILDING = 300.0, 3000.0
"""Seconds that packages may take to arrive, and crates to be built: some five minutes on an idle core."""


def cache() -> Path:
    """The folder of what was fetched; it may be deleted at any time."""
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "selfconf-tests"


def npm_packages(*packages: str) -> Path:
    """A folder whose `node_modules` has some packages, each named with its version, as `@node-wot/core@0.9.2`."""
    digest = hashlib.sha256(" ".join(packages).encode()).hexdigest()[:12]

    def install(folder: Path) -> None:
        # No script of a package runs: what is wanted is their code alone.
        quiet = ("--no-save", "--no-audit", "--no-fund", "--ignore-scripts", "--loglevel=error")
        _run(("npm", "install", *quiet, *packages), folder, FETCHING)

    return _once(f"npm-{digest}", install)


def node_command(packages: Path, script: Path, *arguments: str) -> tuple[Sequence[str], Mapping[str, str]]:
    """The command, and its environment, that runs a script with some packages of npm."""
    return ("node", str(script), *arguments), {**os.environ, "NODE_PATH": str(packages / "node_modules")}


def built_crate(source: Path) -> Path:
    """The program of a crate, whose folder has a name that is the program's; nothing is written below it."""
    files = sorted(path for path in source.rglob("*") if path.is_file())
    said = b"".join(str(path.relative_to(source)).encode() + b"\0" + path.read_bytes() for path in files)

    def build(folder: Path) -> None:
        shutil.copytree(source, folder / "crate")
        # The crates of others are built once, whatever becomes of ours.
        target = cache() / f"{source.name}-target"
        environment = {**os.environ, "CARGO_TARGET_DIR": str(target)}
        _run(("cargo", "build", "--quiet"), folder / "crate", BUILDING, environment)
        shutil.copy2(target / "debug" / source.name, folder / source.name)

    return _once(f"{source.name}-{hashlib.sha256(said).hexdigest()[:12]}", build) / source.name


def _once(name: str, make: Callable[[Path], None]) -> Path:
    """A folder of the cache that is made at most once; another process may make it at the same time."""
    made = cache() / name
    if not made.is_dir():
        cache().mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=cache()) as folder:
            begun = Path(folder) / name
            begun.mkdir()
            make(begun)
            if not made.is_dir():
                begun.replace(made)
    return made


def _run(command: Sequence[str], folder: Path, seconds: float, environment: Mapping[str, str] | None = None) -> None:
    """Run a package manager, or skip the test."""
    if shutil.which(command[0]) is None:
        pytest.skip(f"{command[0]}, which would have the programs that judge here, is not installed")
    try:
        run = subprocess.run(
            command, cwd=folder, env=environment, capture_output=True, text=True, timeout=seconds, check=False
        )
    except subprocess.TimeoutExpired:
        pytest.skip(f"`{command[0]} {command[1]}` takes longer than {seconds:g} s")
    if run.returncode:
        pytest.skip(f"`{command[0]} {command[1]}` fails: {run.stderr.strip()[-300:]}")

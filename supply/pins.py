"""The pinned versions in requirements.txt: writes them anew, and selects those that some extras need.

    python -m supply.pins installer            prints the part for pip, which installs the others
    python -m supply.pins bundled              prints the path of the pip that comes with Python, if it can run from it
    python -m supply.pins select build sim     prints the part for these extras, for `pip install --require-hashes`
    python -m supply.pins select --half 1 dev  prints half of that part: two pips install it side by side
    python -m supply.pins renew [--upgrade]    writes the file; needs uv (`pip install uv`), and the registry of pip

The file has the SHA-256 of every file of every version, for all platforms, and names no registry. pip takes hashes from
requirements only, and not from constraints, so what is not wanted has to be left out. Therefore each requirement says
in a comment above it who needs it: the core (`-`), an extra, or `build`, which builds the package. `installer`,
`bundled` and `select` need nothing but Python, as they run where nothing is installed.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
FILE = ROOT / "requirements.txt"
CORE, BUILD = "-", "build"
HEAD = """\
# The versions that selfconf is tested with, with the SHA-256 of each of their files; `make` installs exactly these.
# Written by `python -m supply.pins renew`, which see. Who needs one: - is the core, build what builds the package.
"""
OLDEST_PYTHON = "3.10"


def requirements(text: str) -> Iterator[tuple[frozenset[str], str]]:
    """Each requirement of the file with its hashes, and who needs it."""
    for who, requirement in re.findall(r"^# for (.*)\n((?!#).+(?:\n    --hash=.+)*)", text, re.MULTILINE):
        yield frozenset(who.split()), requirement


def selected(text: str, extras: Collection[str], half: int | None = None) -> str:
    """The requirements of the core and of some extras, or of `build`: all, or the first or second half.

    Neither half is all of the large ones. Raises SystemExit for an extra without any.
    """
    found = list(requirements(text))
    unknown = set(extras).difference(*(who for who, _ in found))
    if unknown:
        raise SystemExit(
            f"{FILE}: nothing is pinned for {', '.join(sorted(unknown))}; type: python -m supply.pins renew"
        )
    wanted = {CORE, *extras}
    chosen = [f"{requirement}\n" for who, requirement in found if who & wanted]
    return "".join(chosen if half is None else chosen[half - 1 :: 2])


def installer(text: str) -> str:
    """The requirement of pip. That of Python's `venv` is older, and takes twice as long to install many."""
    for _, requirement in requirements(text):
        if _name(requirement) == "pip":
            return f"{requirement}\n"
    raise SystemExit(f"{FILE}: pip is not pinned; type: python -m supply.pins renew")


def bundled() -> Path | None:
    """The wheel of the pip that comes with Python, from which pip runs without being installed; None without one.

    Python keeps it where `ensurepip` finds it; distributions of Linux may keep it in a folder of their own.
    """
    try:
        import ensurepip
    except ImportError:  # some distributions have a package of its own for it
        return None
    folders = Path(ensurepip.__file__).parent / "_bundled", sysconfig.get_config_var("WHEEL_PKG_DIR")
    return next((wheel for folder in folders if folder for wheel in Path(folder).glob("pip-*.whl")), None)


def renew(upgrade: bool) -> str:
    """The file, written anew: with the versions that it has, as far as they fit, or with the newest."""
    with tempfile.TemporaryDirectory() as folder:
        pins = Path(folder) / "requirements.txt"
        if not upgrade and FILE.is_file():
            pins.write_text(FILE.read_text("utf-8"), "utf-8")
        build = Path(folder) / "build.in"
        build.write_text("".join(f"{one}\n" for one in _build_requirements()), "utf-8")
        _compile(["pyproject.toml", str(build), "--all-extras", "--generate-hashes"], pins)
        lines = pins.read_text("utf-8")
        needed = {CORE: _names(["pyproject.toml"], pins, folder), BUILD: _names([str(build)], pins, folder)}
        for extra in _extras():
            needed[extra] = _names(["pyproject.toml", "--extra", extra], pins, folder) - needed[CORE]
    parts = []
    for requirement in re.findall(r"^[^#\s].*(?:\n    --hash=.+)*", lines, re.MULTILINE):
        who = [one for one, names in needed.items() if _name(requirement) in names]
        parts.append(f"# for {' '.join(who)}\n{requirement}\n")
    return HEAD + "".join(parts)


def _names(what: Sequence[str], pins: Path, folder: str) -> set[str]:
    """The names of the distributions that something needs, in the versions that are pinned."""
    found = Path(folder) / "found.txt"
    found.unlink(missing_ok=True)
    constraints = Path(folder) / "constraints.txt"
    constraints.write_text(re.sub(r" \\\n    --hash=\S+", "", pins.read_text("utf-8")), "utf-8")
    _compile([*what, "--constraint", str(constraints)], found)
    return {_name(line) for line in found.read_text("utf-8").splitlines() if line and not line.startswith("#")}


def _name(requirement: str) -> str:
    return requirement.partition("==")[0]


def _compile(arguments: Sequence[str], out: Path) -> None:
    """Let uv resolve something for all platforms, by the registry that pip is configured for."""
    uv = shutil.which("uv", path=os.pathsep.join((str(Path(sys.executable).parent), os.environ.get("PATH", ""))))
    if uv is None:
        raise SystemExit("uv, which resolves for all platforms, is not installed; type: pip install uv")
    command = [uv, "pip", "compile", *arguments, "--universal", "--python-version", OLDEST_PYTHON, "--quiet"]
    hidden = ["--no-header", "--no-annotate", "--no-emit-index-url", "--no-emit-find-links"]
    asked = [sys.executable, "-m", "pip", "config", "get", "global.index-url"]
    index = subprocess.run(asked, capture_output=True, text=True, check=False).stdout.strip()
    environment = {**({"UV_DEFAULT_INDEX": index} if index else {}), **os.environ}
    try:
        subprocess.run([*command, *hidden, "--output-file", str(out)], cwd=ROOT, env=environment, check=True, stdout=-3)
    except subprocess.CalledProcessError as error:
        raise SystemExit(error.returncode) from None


def _extras() -> list[str]:
    section = _pyproject().partition("[project.optional-dependencies]")[2].partition("\n[")[0]
    return re.findall(r"^([\w-]+) = \[", section, re.MULTILINE)


def _build_requirements() -> list[str]:
    (section,) = re.findall(r"^requires = \[(.*?)\]", _pyproject(), re.MULTILINE | re.DOTALL)
    return re.findall(r'"([^"]+)"', section)


def _pyproject() -> str:
    """The project file; Python 3.10 has no reader for it, and `select` may not need one that is to be installed."""
    return (ROOT / "pyproject.toml").read_text("utf-8")


def main() -> None:
    """Run a command."""
    parser = argparse.ArgumentParser(description="the pinned versions in requirements.txt")
    commands = parser.add_subparsers(dest="command", required=True)
    commands.add_parser("installer", help="print that of pip")
    select = commands.add_parser("select", help="print those of some extras")
    select.add_argument("extras", nargs="*")
    select.add_argument("--half", type=int, choices=[1, 2], help="print one half of them alone")
    commands.add_parser("bundled", help="print the path of the pip that comes with Python")
    commands.add_parser("renew", help="write them anew").add_argument("--upgrade", action="store_true")
    given = parser.parse_args()
    if given.command == "installer":
        sys.stdout.write(installer(FILE.read_text("utf-8")))
    elif given.command == "bundled":
        print(bundled() or "")
    elif given.command == "select":
        sys.stdout.write(selected(FILE.read_text("utf-8"), given.extras, given.half))
    else:
        FILE.write_text(renew(given.upgrade), "utf-8")


if __name__ == "__main__":
    main()

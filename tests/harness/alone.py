"""Run again, one after the other, the few tests that have failed among many: `python -m tests.harness.alone REPORT`.

Many tests start programs and wait for them. Where several do so at once on a busy machine, one may starve; alone it has
no excuse. REPORT is what pytest wrote with `--junitxml`. More than a few failures are no accident, and stand.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

FEW = 5


def failed(report: Path) -> list[str]:
    """The tests that have failed, as pytest takes them; ValueError if the report names none, or a file of tests."""
    try:
        cases = list(ElementTree.parse(report).iter("testcase"))
    except (OSError, ElementTree.ParseError) as error:
        raise ValueError(f"there is no report: {error}") from None
    bad = [case for case in cases if case.find("failure") is not None or case.find("error") is not None]
    files = [str(case.get("name")) for case in bad if not case.get("classname")]
    if files:
        raise ValueError(f"no test has run, as these cannot be read: {', '.join(files)}")
    names = [f"{case.get('classname', '').replace('.', '/')}.py::{case.get('name')}" for case in bad]
    if not names:
        raise ValueError("no test has failed, so something else has")
    return list(dict.fromkeys(names))


def main() -> int:
    """0 if each of them passes alone."""
    try:
        names = failed(Path(sys.argv[1]))
    except ValueError as error:
        print(error, file=sys.stderr)
        return 1
    if len(names) > FEW:
        return 1
    print(f"once more, alone: {', '.join(names)}", flush=True)
    return subprocess.run([sys.executable, "-m", "pytest", *names], check=False).returncode


if __name__ == "__main__":
    sys.exit(main())

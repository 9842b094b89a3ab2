"""`make audit`: whether a vulnerability is known of any version in requirements.txt, as pip-audit finds it.

It asks the vulnerability service of PyPI, which is not the registry that pip is configured for: where there is no
network, or only a mirror of the packages, nobody can be asked. That is said, and is no failure. The exit code is 1 for
a known vulnerability, 0 for none or where nobody could be asked, and 2 where the question itself is at fault.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from supply.pins import FILE, requirements

SECONDS = 300.0
"""How long the service may take for all of them."""
UNREACHABLE = (
    "ConnectionError",
    "ConnectTimeout",
    "ReadTimeout",
    "Max retries exceeded",
    "ServiceError",
    "Could not connect",
    "Failed to establish",
    "HTTPError",
    "JSONDecodeError",
    "ProxyError",
    "SSLError",
)
"""What pip-audit says, among much else, where it gets no answer, or none that it understands."""


def versions(text: str) -> str:
    """The pinned versions alone, each once, whatever the platform: all of them are asked for."""
    pins = {
        requirement.splitlines()[0].removesuffix("\\").partition(";")[0].strip()
        for _, requirement in requirements(text)
    }
    return "".join(f"{pin}\n" for pin in sorted(pins))


def rounds(pins: str) -> list[str]:
    """The versions in as many files as a distribution has versions: pip-audit takes each distribution once a file."""
    files: list[dict[str, str]] = []
    for pin in pins.splitlines():
        name = pin.partition("==")[0]
        file = next((one for one in files if name not in one), None)
        if file is None:
            files.append(file := {})
        file[name] = pin
    return ["".join(f"{pin}\n" for pin in file.values()) for file in files]


def vulnerabilities(report: dict[str, Any]) -> list[str]:
    """A sentence for each vulnerability of a report of pip-audit."""
    return [
        f"{one['name']} {one['version']}: {found['id']}"
        f"{' (' + ', '.join(found['aliases']) + ')' if found.get('aliases') else ''},"
        f" fixed in {', '.join(found['fix_versions']) or 'no version yet'}"
        for one in report.get("dependencies", ())
        for found in one.get("vulns", ())
    ]


def unknown(report: dict[str, Any]) -> list[str]:
    """The distributions of which the service knows nothing."""
    return [f"{one['name']}: {one['skip_reason']}" for one in report.get("dependencies", ()) if "skip_reason" in one]


def audit(pins: str) -> tuple[int, list[str]]:
    """The exit code, and what to say, of asking about some versions."""
    with tempfile.NamedTemporaryFile("w", suffix=".txt", encoding="utf-8") as file:
        file.write(pins)
        file.flush()
        command = [sys.executable, "-m", "pip_audit", "--format=json", "--progress-spinner=off", "--no-deps"]
        try:
            asked = subprocess.run(
                [*command, "--disable-pip", "-r", file.name],
                capture_output=True,
                text=True,
                timeout=SECONDS,
                check=False,
            )
        except subprocess.TimeoutExpired:
            return 0, [f"not audited: the vulnerability service has not answered within {SECONDS:.0f} s"]
    return judged(asked.returncode, asked.stdout, asked.stderr, pins.count("\n"))


def judged(code: int, said: str, complained: str, number: int) -> tuple[int, list[str]]:
    """The exit code, and what to say, of what pip-audit has said of a number of versions."""
    try:
        report = json.loads(said)
    except ValueError:
        last = (complained.strip() or "it says nothing").splitlines()[-1]
        if any(sign in complained for sign in UNREACHABLE):
            return 0, [f"not audited: the vulnerability service cannot be asked from here ({last})"]
        return code or 2, [f"pip-audit has failed: {last}"]
    found, skipped = vulnerabilities(report), unknown(report)
    if len(skipped) == number:
        return 0, [
            f"not audited: the vulnerability service that can be asked from here knows none of {number} versions"
        ]
    words = [*found, *(f"not audited: {one}" for one in skipped)]
    return (1, words) if found else (0, [*words, f"no vulnerability is known of {number - len(skipped)} versions"])


def main(files: Iterable[Path] = (FILE,)) -> int:
    """Audit the file; the exit code."""
    worst = 0
    for pins in rounds("".join(versions(file.read_text("utf-8")) for file in files)):
        code, words = audit(pins)
        print("\n".join(words))
        worst = max(worst, code)
    return worst


if __name__ == "__main__":
    sys.exit(main())

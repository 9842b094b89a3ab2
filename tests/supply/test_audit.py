"""The audit: what is said of each answer of pip-audit, and which exit code it has."""

from __future__ import annotations

import json
from typing import Any

import pytest

from supply.audit import judged, rounds, versions
from supply.pins import FILE, requirements

VULNERABLE = {
    "name": "jinja2",
    "version": "2.4.1",
    "vulns": [{"id": "PYSEC-2019-217", "fix_versions": ["2.10.1"], "aliases": ["CVE-2019-10906"], "description": "d"}],
}
GOOD = {"name": "rdflib", "version": "7.6.0", "vulns": []}
UNKNOWN = {"name": "selfconf", "skip_reason": "Dependency not found on PyPI and could not be audited: selfconf (1)"}


def report(*dependencies: dict[str, Any]) -> str:
    """What pip-audit prints."""
    return json.dumps({"dependencies": dependencies, "fixes": []})


def test_a_known_vulnerability_fails() -> None:
    code, words = judged(1, report(GOOD, VULNERABLE), "Found 1 known vulnerability", 2)
    assert code == 1
    assert words == ["jinja2 2.4.1: PYSEC-2019-217 (CVE-2019-10906), fixed in 2.10.1"]


def test_none_known_is_no_failure_and_what_nobody_knows_is_said() -> None:
    assert judged(0, report(GOOD), "", 1) == (0, ["no vulnerability is known of 1 versions"])
    code, words = judged(0, report(GOOD, UNKNOWN), "", 2)
    assert code == 0
    assert words[0].startswith("not audited: selfconf: ")
    assert words[1] == "no vulnerability is known of 1 versions"


def test_a_registry_without_such_data_is_no_audit_and_no_failure() -> None:
    code, (words,) = judged(0, report(UNKNOWN), "", 1)
    assert code == 0
    assert words.startswith("not audited: ")


@pytest.mark.parametrize(
    "complained",
    [
        "ERROR:pip_audit._cli:Could not connect to PyPI's vulnerability feed",
        "requests.exceptions.ConnectionError: HTTPSConnectionPool(host='x', port=443): Max retries exceeded",
    ],
)
def test_without_a_network_it_is_said_and_no_failure(complained: str) -> None:
    code, (words,) = judged(1, "", complained, 3)
    assert code == 0
    assert words.startswith("not audited: ")


@pytest.mark.parametrize("complained", ["", "usage: pip-audit\npip-audit: error: unrecognized arguments: --x"])
def test_any_other_end_is_a_failure(complained: str) -> None:
    assert judged(2, "", complained, 3)[0] == 2
    assert judged(0, "", complained, 3)[0] == 2


def test_every_version_is_asked_for_once() -> None:
    text = FILE.read_text("utf-8")
    asked = [pin for part in rounds(versions(text)) for pin in part.splitlines()]
    pinned = {one.split()[0] for _, one in requirements(text)}
    assert sorted(asked) == sorted(pinned)
    for part in rounds(versions(text)):
        names = [pin.partition("==")[0] for pin in part.splitlines()]
        assert len(names) == len(set(names))

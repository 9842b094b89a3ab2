"""For code scanning: SARIF 2.1.0 (OASIS), which GitHub, GitLab and editors read."""

from __future__ import annotations

import json
import os
from importlib.metadata import PackageNotFoundError, version
from pathlib import PurePath
from urllib.parse import quote

from selfconf.model.codes import BY_CODE, Code
from selfconf.model.diagnostic import Diagnostic, Report

_SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"


def render(report: Report) -> str:
    """One run with the rules that were broken and a result for each problem."""
    rules = sorted({found.code for found in report.diagnostics})
    driver: dict[str, object] = {
        "name": "selfconf",
        "informationUri": "https://w3id.org/selfconf",
        "rules": [_rule(BY_CODE[code]) for code in rules],
    }
    number = _version()
    if number:
        driver["version"] = number
    run = {
        "tool": {"driver": driver},
        "columnKind": "unicodeCodePoints",
        "invocations": [{"executionSuccessful": not report.unreadable}],
        "results": [_result(found, rules.index(found.code)) for found in report.diagnostics],
    }
    return json.dumps({"$schema": _SCHEMA, "version": "2.1.0", "runs": [run]}, indent=2, ensure_ascii=False) + "\n"


def _version() -> str | None:
    try:
        return version("selfconf")
    except PackageNotFoundError:
        return None  # run from a checkout that is not installed


def _rule(code: Code) -> dict[str, object]:
    return {
        "id": code.code,
        "shortDescription": {"text": code.title},
        "fullDescription": {"text": f"{code.title} {code.why}"},
        "help": {"text": f"{code.why} Ask selfconf validate --explain {code.code} for an example."},
        "defaultConfiguration": {"level": code.severity.value},
    }


def _result(found: Diagnostic, rule: int) -> dict[str, object]:
    return {
        "ruleId": found.code,
        "ruleIndex": rule,
        "level": found.severity.value,
        "message": {"text": f"{found.message} {found.hint}" if found.hint else found.message},
        "locations": [
            {
                "physicalLocation": {
                    "artifactLocation": {"uri": _uri(found.file)},
                    "region": {
                        "startLine": found.line,
                        "startColumn": found.column,
                        "endColumn": found.column + found.width,
                    },
                }
            }
        ],
    }


def _uri(file: str) -> str:
    path = PurePath(file)
    return path.as_uri() if path.is_absolute() else quote(os.fsencode(path.as_posix()))

"""For programs: the report as one JSON object."""

from __future__ import annotations

import json

from selfconf.model.diagnostic import Diagnostic, Report


def render(report: Report) -> str:
    """The counts, and every problem with its file, line, column, severity, code and message."""
    content = {
        "conforms": report.conforms,
        "files": len(report.files),
        "errors": report.errors,
        "warnings": report.warnings,
        "unreadable": sorted(report.unreadable),
        "diagnostics": [_entry(found) for found in report.diagnostics],
    }
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"


def _entry(found: Diagnostic) -> dict[str, object]:
    return {
        "file": found.file,
        "line": found.line,
        "column": found.column,
        "end_column": found.column + found.width,
        "severity": found.severity.value,
        "code": found.code,
        "message": found.message,
        "hint": found.hint,
        "shape": found.shape,
    }

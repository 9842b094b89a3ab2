"""For GitHub Actions: workflow commands, which put each problem beside its line in the pull request."""

from __future__ import annotations

from selfconf.model.diagnostic import Diagnostic, Report


def render(report: Report) -> str:
    """One `::error` or `::warning` a line."""
    return "".join(f"{_command(found)}\n" for found in report.diagnostics)


def _command(found: Diagnostic) -> str:
    properties = {
        "file": found.file,
        "line": found.line,
        "endLine": found.line,
        "col": found.column,
        "endColumn": found.column + found.width,
        "title": found.code,
    }
    listed = ",".join(f"{name}={_property(str(value))}" for name, value in properties.items())
    message = f"{found.message} {found.hint}" if found.hint else found.message
    return f"::{found.severity.value} {listed}::{_data(message)}"


def _data(text: str) -> str:
    """Escaped as the message of a workflow command; the percent sign comes first."""
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    """Escaped as a property of a workflow command, where colon and comma separate."""
    return _data(text).replace(":", "%3A").replace(",", "%2C")

"""The forms in which a validation report is written: for people, for programs, and for three kinds of
machines.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from selfconf.cli.reports import github, json, junit, sarif, text
from selfconf.model.diagnostic import Report

RENDERERS: Mapping[str, Callable[[Report], str]] = {
    "text": text.render,
    "json": json.render,
    "github": github.render,
    "sarif": sarif.render,
    "junit": junit.render,
}
"""The name of each form, and what writes it; the result ends with a line end unless it is empty."""

"""Turtle texts with and without problems, and a report whose words need escaping, for the tests of `validate`."""

from __future__ import annotations

from pathlib import Path

from selfconf.model.codes import PREAMBLE
from selfconf.model.diagnostic import Diagnostic, report

GOOD = PREAMBLE + ":tuner a sc:Component, rob:Tuner .\n"
WRONG = PREAMBLE + ':radio a sc:Component ; sc:preference "high" .\n'
STRANGE = PREAMBLE + ":lamp a sc:Component, rob:Lmap .\n"
BROKEN = PREAMBLE + ":speaker a .\n"
NASTY = report(
    ["a,b:c%.ttl"],
    [Diagnostic("a,b:c%.ttl", 3, 7, "SC-A01", "100 %\r\nof <this> & \x1b[31m that,: so", width=2, hint="Try.")],
)


def write_diagnosed(folder: Path) -> Path:
    """A file for each of the texts: `good.ttl`, `wrong.ttl`, `strange.ttl` and `broken.ttl`."""
    for name, text in (("good", GOOD), ("wrong", WRONG), ("strange", STRANGE), ("broken", BROKEN)):
        (folder / f"{name}.ttl").write_text(text)
    return folder

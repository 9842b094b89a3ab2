"""Importing texts in a temporary folder, and what comes of it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from selfconf.importing import ImportReport, import_descriptions


class Workshop:
    """A folder with sources and a folder for what is made of them."""

    def __init__(self, folder: Path) -> None:
        self.sources, self.out = folder / "sources", folder / "out"
        self.sources.mkdir()

    def write(self, texts: Mapping[str, str]) -> None:
        """Write sources, by their paths below the folder."""
        for name, text in texts.items():
            path = self.sources / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, "utf-8")

    def imported(self, form: str, texts: Mapping[str, str], namespace: str | None = None) -> ImportReport:
        """Write sources and import the whole folder."""
        self.write(texts)
        return import_descriptions(form, [str(self.sources)], self.out, namespace)

    def texts(self) -> dict[str, str]:
        """The files that an import has written, by their paths below the folder."""
        return {
            path.relative_to(self.out).as_posix(): path.read_text("utf-8") for path in sorted(self.out.rglob("*.ttl"))
        }


def left_out(report: ImportReport) -> dict[str, int]:
    """What a report says was left out, with the counts."""
    found: dict[str, int] = {}
    for each in report.left_out:
        found[each.what] = found.get(each.what, 0) + each.number
    return found

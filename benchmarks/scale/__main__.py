"""Measure how long `configure` takes over many advertisements.

    python -m benchmarks.scale [--full] [--smoke] [--write] [--keep FOLDER]

Prints the page, and with `--write` writes it to `docs/benchmarks/scale.md`. `--full` takes some minutes; with `--keep`,
what has been measured is kept in a folder and not measured again.
"""

from __future__ import annotations

import argparse
import json
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable, Collection
from pathlib import Path

from benchmarks.scale.engines import ENGINES, Found
from benchmarks.scale.report import page
from benchmarks.scale.styles import STYLES
from benchmarks.scale.worlds import ecology, labelled, linked, topical, unlike

PAGE = Path(__file__).resolve().parents[2] / "docs" / "benchmarks" / "scale.md"
SIZES = (1_000, 10_000, 100_000)
FULL = 1_000_000
RDFLIB_MOST = 10_000


class Bench:
    """Engines on generated ecologies, each in a process of its own if it is to be apart from the others.

    What is known already is not measured again.
    """

    def __init__(self, folder: Path, apart: Collection[str] = ENGINES) -> None:
        self.folder, self.apart = folder, apart

    def ecology(self, name: str, size: int, form: Callable[[str, int], str] | None = None, wanted: bool = True) -> Path:
        """A file with so many advertisements, in some form."""
        path = self.folder / f"{name}.ttl"
        if not path.exists():
            with path.open("w") as file:
                for number, text in enumerate(ecology(size, wanted=wanted)):
                    file.write(form(text, number) if form and number else text)
        return path

    def files(self, name: str, size: int) -> Path:
        """A folder with a file for each advertisement."""
        path = self.folder / name
        path.mkdir(exist_ok=True)
        head, *advertisements = ecology(size)
        for number, text in enumerate(advertisements):
            (path / f"{number:06}.ttl").write_text(head + text)
        return path

    def styled(self, name: str, size: int, style: Callable[[str], str]) -> Path:
        """A file with so many advertisements, as some program writes it."""
        path = self.folder / f"{re.sub('[^a-z]+', '-', name.lower())}.ttl"
        if not path.exists():
            path.write_text(style("".join(ecology(size))))
        return path

    def measured(self, engine: str, path: Path, trials: int) -> Found:
        """What an engine measures."""
        if engine not in self.apart:
            return ENGINES[engine](path, trials)
        kept = self.folder / f"{path.stem}.{engine}.json"
        if not kept.exists():
            command = [sys.executable, "-m", "benchmarks.scale", "--engine", engine, "--trials", str(trials), str(path)]
            kept.write_text(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
        found: Found = json.loads(kept.read_text())
        return found


def measure(
    bench: Bench, sizes: tuple[int, ...], rdflib_most: int, form_size: int, loadings: int, crowd: tuple[int, int]
) -> str:
    """Everything, as a page; each form of an ecology is loaded so many times."""
    rows = {}
    for size in sizes:
        path = bench.ecology(str(size), size)
        trials = 2 if size > SIZES[-1] else 5
        rows[size] = (
            bench.measured("configure", path, trials),
            bench.measured("store", path, 1) if size < FULL else None,
            bench.measured("rdflib", path, 1) if size <= rdflib_most else None,
        )
    paths = {
        "alike": bench.ecology("alike", form_size),
        "labelled": bench.ecology("labelled", form_size, labelled),
        "files": bench.files("files", form_size),
        "linked": bench.ecology("linked", form_size, linked),
        "topical": bench.ecology("topical", form_size, topical),
        "unlike": bench.ecology("unlike", form_size, unlike),
    }
    forms = {form: bench.measured("loading", path, loadings) for form, path in paths.items()}
    styles = {
        name: bench.measured("loading", bench.styled(name, form_size, style), loadings)
        for name, style in STYLES.items()
    }
    few, unwanted = crowd
    bench.ecology("unwanted", unwanted, wanted=False)
    crowded = bench.measured("crowd", bench.ecology("wanted", few), 1)
    return page(rows, forms, styles, form_size, crowded)


def main() -> int:
    """Print the page."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--full", action="store_true", help="a million components too, and rdflib on 100,000")
    options.add_argument("--smoke", action="store_true", help="200 components, to see that it runs")
    options.add_argument("--write", action="store_true", help="write the page into the documentation")
    options.add_argument("--keep", metavar="FOLDER", type=Path, help="keep what is measured, and go on from there")
    options.add_argument("--engine", choices=ENGINES, help=argparse.SUPPRESS)
    options.add_argument("--trials", type=int, default=1, help=argparse.SUPPRESS)
    options.add_argument("path", nargs="?", type=Path, help=argparse.SUPPRESS)
    given = options.parse_args()
    if given.engine:
        print(json.dumps(ENGINES[given.engine](given.path, given.trials)))
        return 0
    sizes = (200,) if given.smoke else (*SIZES, FULL) if given.full else SIZES
    with tempfile.TemporaryDirectory() as name:
        # Processes of their own are for what is measured: to see that they run, one of them is enough.
        bench = Bench(given.keep or Path(name), {"configure"} if given.smoke else ENGINES)
        bench.folder.mkdir(parents=True, exist_ok=True)
        forms, crowd = ((50, 1), (200, 1_000)) if given.smoke else ((10_000, 5), (10_000, 100_000))
        text = measure(bench, sizes, SIZES[-1] if given.full else RDFLIB_MOST, *forms, crowd)
    print(text)
    if given.write:
        PAGE.write_text(text)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())

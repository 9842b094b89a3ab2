"""The paper's experiment over many seeds: does Astrid arrive, how exactly, and who raised FAIL.

    python -m benchmarks.experiment [--seeds 20] [--first 1]

Each run is the whole demo, with real Zenoh sessions between real processes, as fast as it goes, without pictures.
"""

from __future__ import annotations

import argparse
import json
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from benchmarks.machine import described, table


def experiment(seed: int, folder: Path) -> dict[str, Any]:
    """The figures of one run; raises SystemExit with its last words if it ends without any."""
    out = folder / str(seed)
    command = [sys.executable, "-m", "selfconf", "demo", "--seed", str(seed), "--speed", "max"]
    run = subprocess.run(
        [*command, "--pictures", "none", "--out", str(out)], capture_output=True, text=True, check=False
    )
    figures = out / "result.json"
    if not figures.is_file():
        raise SystemExit(f"seed {seed} ended without a result:\n{run.stdout[-2000:]}{run.stderr[-2000:]}")
    result: dict[str, Any] = json.loads(figures.read_text())
    return result


def main() -> int:
    """Run, print a table, and say whether the goals are met."""
    parser = argparse.ArgumentParser(description="the paper's experiment over many seeds")
    parser.add_argument("--seeds", type=int, default=20, help="how many (default: %(default)s)")
    parser.add_argument("--first", type=int, default=1, help="the first seed (default: %(default)s)")
    given = parser.parse_args()
    results: list[dict[str, Any]] = []
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(given.first, given.first + given.seeds):
            print(f"seed {seed} ...", end="\r", file=sys.stderr, flush=True)
            results.append({"seed": seed, **experiment(seed, Path(folder))})
    rows = [
        [
            str(r["seed"]),
            r["outcome"],
            f"{r['error'] * 100:.1f}",
            f"{r['simulated_seconds']:.1f}",
            ", ".join(r["touched"]) or "nothing",
            f"{r['lost']}: {r['cause']}",
            f"{(r['gap'] or 0) * 1000:.1f}",
        ]
        for r in results
    ]
    print(table(["seed", "outcome", "error cm", "simulated s", "touched", "lost", "gap ms"], rows))
    errors = [r["error"] for r in results]
    arrived = sum(r["outcome"] == "arrived" for r in results)
    clean = sum(not r["touched"] for r in results)
    raised = sum((r["lost"], r["cause"]) == ("person-tracker", "fail") for r in results)
    count = len(results)
    print(
        f"\narrived {arrived} of {count}; error mean {statistics.mean(errors) * 100:.1f} cm, "
        f"worst {max(errors) * 100:.1f} cm; without contact {clean} of {count}; "
        f"FAIL raised by the tracker itself {raised} of {count}"
    )
    print(described("eclipse-zenoh", "pybullet"))
    return 0 if arrived == clean == raised == count and statistics.mean(errors) < 0.25 else 1


if __name__ == "__main__":
    raise SystemExit(main())

"""`selfconf` and `python -m selfconf`: the command line, quiet when it is interrupted while it is still loading."""

from __future__ import annotations

import gc
import sys

COLLECTING = 100_000, 20, 50
"""Objects, and rounds, after which Python looks for garbage: seldom, as what a command makes is kept or freed soon."""


def main() -> int:
    """Run the command line; the exit code."""
    gc.set_threshold(*COLLECTING)
    try:
        from selfconf.cli.main import main as run

        return run()
    except (KeyboardInterrupt, RuntimeError) as error:
        # Until 3.12 Python makes a RuntimeError of what interrupts it while it names the attributes of a new class.
        if not isinstance(error, KeyboardInterrupt) and not isinstance(error.__cause__, KeyboardInterrupt):
            raise
        print("selfconf: interrupted", file=sys.stderr)
        return 130
    finally:
        gc.freeze()  # what is left ends with the process: to look for garbage in it takes a seventh of a small command


if __name__ == "__main__":
    raise SystemExit(main())

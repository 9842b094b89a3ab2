"""`selfconf` and `python -m selfconf`: the command line, quiet when it is interrupted while it is still loading."""

from __future__ import annotations

import _thread
import gc
import sys

COLLECTING = 100_000, 20, 50
"""Objects, and rounds, after which Python looks for garbage: seldom, as what a command makes is kept or freed soon."""

INTERRUPT_AGAIN = 0.01
"""After how many seconds an interrupt that was lost comes again."""


def main() -> int:
    """Run the command line; the exit code."""
    gc.set_threshold(*COLLECTING)
    sys.unraisablehook = _interrupt_again
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


def _interrupt_again(ignored: sys.UnraisableHookArgs) -> None:
    """Let an interrupt not be lost where Python ignores exceptions, as in the callback of a weak reference.

    Such callbacks run at the end of each import: the command would go on, and no one would know of the signal.
    """
    if ignored.exc_type is KeyboardInterrupt:
        _thread.start_new_thread(_interrupt, ())  # here another would be ignored, too
    else:
        sys.__unraisablehook__(ignored)


def _interrupt() -> None:
    import os
    import time

    time.sleep(INTERRUPT_AGAIN)  # until the callback is over in which an exception is ignored
    os.kill(os.getpid(), 2)  # SIGINT; the module `signal` may be what is being loaded


if __name__ == "__main__":
    raise SystemExit(main())

"""What a terminal shows while something takes long: what is done, and for how long already.

It is shown in a line of standard error that is gone once that is over. Nothing is shown within the first two seconds,
nor to a file or a program that reads standard error.
"""

from __future__ import annotations

import os
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from selfconf.cli.terminal import Terminal

SHOWN_AFTER = 2.0
"""Seconds after which it is shown what is done; most is over by then."""
RENEWED_EACH = 1.0
"""Seconds between two looks of the line."""
HELD = 0.2
"""Seconds for which a terminal that is held (Ctrl-S) is waited for, so that it holds up nothing else."""


class ProgressLine:
    """One thing after the other that may take long, shown on the terminal that standard error leads to, if it does."""

    def __init__(self) -> None:
        is_shown = isinstance(sys.stderr, Terminal) and os.environ.get("TERM") != "dumb"
        self._terminal = sys.stderr if is_shown else None
        self._doing: tuple[str, float] | None = None
        """What is done, and since when."""
        self._showing: tuple[threading.Thread, threading.Event] | None = None

    def __enter__(self) -> ProgressLine:
        return self

    def __exit__(self, *_: object) -> None:
        self.end()

    def begin(self, what: str) -> None:
        """From now on this is done, and not what was done before."""
        self.end()
        self._doing = what, time.monotonic()
        self._begin_to_show()

    def _begin_to_show(self) -> None:
        if self._terminal is not None and self._doing is not None:
            over = threading.Event()
            thread = threading.Thread(target=self._show, args=(*self._doing, over), name="progress", daemon=True)
            thread.start()
            self._showing = thread, over

    @contextmanager
    def paused(self) -> Iterator[None]:
        """No thread shows anything in the block, in which the process is forked; then it goes on."""
        self._end_to_show()
        yield
        self._begin_to_show()

    def end(self) -> None:
        """What was done is over: its line is gone, unless the terminal is held."""
        self._doing = None
        self._end_to_show()

    def _end_to_show(self) -> None:
        showing, self._showing = self._showing, None
        if showing is not None:
            thread, over = showing
            over.set()
            thread.join(HELD)

    def _show(self, what: str, began: float, over: threading.Event) -> None:
        assert isinstance(self._terminal, Terminal)
        if over.wait(max(0.0, began + SHOWN_AFTER - time.monotonic())):
            return
        with suppress(OSError):  # the terminal is gone
            while True:
                self._terminal.renew_line(f"{what}, {time.monotonic() - began:.0f} s so far; Ctrl-C ends it")
                if over.wait(RENEWED_EACH):
                    break
            self._terminal.renew_line("")


@contextmanager
def progress(what: str) -> Iterator[None]:
    """Show what is done in a block that may take long."""
    with ProgressLine() as shown:
        shown.begin(what)
        yield

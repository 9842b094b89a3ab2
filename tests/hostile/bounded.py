"""Bounds on what strangers may cost: processor time of this process, and memory that Python holds."""

from __future__ import annotations

import gc
import time
import tracemalloc
from collections.abc import Iterator
from contextlib import contextmanager

MEGABYTE = 1_000_000


@contextmanager
def bounded(seconds: float, peak: float, left: float = 5.0) -> Iterator[None]:
    """Fail if what is done takes more processor time, or at its peak or afterwards more memory, in megabytes.

    Processor time does not depend on what else the machine does. Where memory is traced, it is several times the usual.
    """
    gc.freeze()  # what was there is not traced, so the collector need not look at it
    tracemalloc.start()
    before, began = tracemalloc.get_traced_memory()[0], time.process_time()
    try:
        yield
        spent = time.process_time() - began
        most = (tracemalloc.get_traced_memory()[1] - before) / MEGABYTE
        gc.collect()
        stays = (tracemalloc.get_traced_memory()[0] - before) / MEGABYTE
    finally:
        tracemalloc.stop()
    assert spent <= seconds, f"{spent:.1f} s of processor time"
    assert most <= peak, f"{most:.0f} MB at the peak"
    assert stays <= left, f"{stays:.1f} MB stay"

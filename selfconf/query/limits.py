"""What is said of a query that reaches a limit, or that its engine does not survive."""

from __future__ import annotations

ENGINE_DOWN = "the query brings its engine down, as one does that is nested too deeply; write it simpler"


def too_slow(seconds: float) -> str:
    """What is said of a query that takes longer than so many seconds."""
    return f"the query takes more than {seconds:g} s; ask for less"


def too_large(memory: int) -> str:
    """What is said of a query that takes more than so many bytes."""
    return f"the query takes more than {memory / (1 << 30):.1f} GiB of memory; ask for less"

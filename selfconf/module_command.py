"""How a module of selfconf is run as a program of its own: with the path of imports that this program has.

`python -m` looks for modules in the current folder first. That may be one that a stranger has made: a file `json.py`
in it would be run in place of Python's own.
"""

from __future__ import annotations

import sys


def module_command(module: str, *arguments: str) -> list[str]:
    """The command that runs a module as `python -m` does, but finds what it imports where this program does."""
    path = [folder for folder in sys.path if isinstance(folder, str)]  # else Python passes over it, as over a Path
    run = f"import sys; sys.path[:] = {path!a}; from runpy import run_module as run"
    return [sys.executable, "-c", f"{run}; run({module!r}, run_name='__main__', alter_sys=True)", *arguments]

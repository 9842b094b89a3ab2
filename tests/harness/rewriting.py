"""Assertions of test modules that further processes rewrite while one collects the tests, where none have run yet.

pytest rewrites the assertions of each module that it imports for the first time, and keeps the outcome in a file. In a
fresh clone that is eleven seconds of one processor, for which all tests wait. The further processes take the modules
that are collected last, one after the other, and end at the first that the process which collects has come to.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

import pytest
from _pytest.assertion import rewrite


def begin(config: pytest.Config, processes: int) -> list[int]:
    """Begin that many processes, if the module that is collected last is not rewritten yet; their numbers."""
    folders = [config.invocation_params.dir / folder for folder in config.args]
    modules = [module for folder in folders for module in sorted(folder.rglob("test_*.py"), reverse=True)]
    if not modules or _rewritten(modules[0]).exists():
        return []
    return [_begun(config, modules[number::processes]) for number in range(processes)]


def end(processes: Sequence[int]) -> None:
    """Wait for the end of these processes, which is near when all tests are collected."""
    for process in processes:
        os.waitpid(process, 0)


def _begun(config: pytest.Config, modules: Sequence[Path]) -> int:
    process = os.fork()
    if not process:
        try:
            _rewrite(config, modules)
        finally:
            os._exit(0)
    return process


def _rewrite(config: pytest.Config, modules: Sequence[Path]) -> None:
    state = config.stash[rewrite.assertstate_key]
    for module in modules:
        kept = _rewritten(module)
        if kept.exists():
            return
        with suppress(SyntaxError, OSError):  # which the process tells that collects
            kept.parent.mkdir(exist_ok=True)
            stamp, code = rewrite._rewrite_test(module, config)
            rewrite._write_pyc(state, code, stamp, kept)


def _rewritten(module: Path) -> Path:
    """Where pytest keeps a module with its assertions rewritten."""
    return rewrite.get_cache_dir(module) / (module.stem + rewrite.PYC_TAIL)

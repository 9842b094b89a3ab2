"""Judge untrusted shapes and queries in a process of its own with a time limit: they may ask what never ends."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Mapping
from typing import Any

from selfconf.module_command import module_command


async def judged_apart(module: str, question: Mapping[str, object], seconds: float) -> Any:
    """What a module, run as a program, answers on stdout to a question on stdin, both as JSON.

    Raises asyncio.TimeoutError when its time is over, and ValueError when it does not answer.
    """
    process = await asyncio.create_subprocess_exec(
        *module_command(module),
        stdin=asyncio.subprocess.PIPE,
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.DEVNULL,
        start_new_session=True,  # Ctrl-C is for the program that serves, which ends this one
    )
    try:
        told, _ = await asyncio.wait_for(process.communicate(json.dumps(question).encode()), seconds)
        return json.loads(told)
    finally:
        if process.returncode is None:
            process.kill()
            await process.wait()

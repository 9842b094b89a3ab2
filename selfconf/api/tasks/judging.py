"""How a program answers a question about a task: JSON from stdin to stdout, in a process that can be ended.

A template that a stranger has written may ask what takes forever, or more memory than there is. What asks is
`selfconf.serve.judging_process`.
"""

from __future__ import annotations

import json
import os
import resource
import sys
from collections.abc import Callable
from typing import Any

from selfconf.errors import SelfconfError
from selfconf.model.setting_names import options_named

JUDGING_MEMORY = 1 << 30
"""How many bytes of address space the process may take."""
JUDGING_NICENESS = 5
"""The process gives way to the programs of the ecology on the same processors."""


@options_named()  # the reader of its texts is at the page of `selfconf serve`
def answer_question(answer: Callable[[Any], object]) -> None:
    """Write the answer to the question on stdin, or an object with the `detail` of why there is none."""
    os.nice(JUDGING_NICENESS)
    resource.setrlimit(resource.RLIMIT_AS, (JUDGING_MEMORY, JUDGING_MEMORY))
    question = json.load(sys.stdin)
    try:
        told = answer(question)
    except (SelfconfError, MemoryError, RecursionError) as error:
        told = {"detail": str(error) or type(error).__name__}
    print(json.dumps(told))

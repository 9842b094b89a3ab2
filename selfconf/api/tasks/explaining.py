"""Why a task has no configuration among given advertisements, with near misses and relaxations.

`python -m selfconf.api.tasks.explaining` finds it out in a process of its own, which can be ended. It reads a JSON
object from stdin with the text `record` (a message of the kind `task`), the texts `advertisements` (Turtle, one
component each) and the IRIs `lost` of components that do not count. It writes a refusal, or an object with the `detail`
of why it has none.
"""

from __future__ import annotations

import json
import os
import resource
import sys
from collections.abc import Collection, Mapping

from selfconf.api.tasks.detached import recorded_task
from selfconf.api.tasks.role_fits import JUDGING_MEMORY, JUDGING_NICENESS
from selfconf.composition import TimeLimit, composed, explained
from selfconf.errors import SelfconfError
from selfconf.model.refusal import Refusal
from selfconf.model.setting_names import options_named
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode
from selfconf.protocol.messages import TaskRecord
from selfconf.rdf.advertisements import Advertisement, read_advertisements
from selfconf.render import refusal_body

EXPLAINING_SECONDS = 10.0
"""How long the search and its explanation may take, where the task does not say."""


def explained_refusal(
    record: TaskRecord, ecology: Mapping[IRI, Advertisement], lost: Collection[IRI]
) -> dict[str, object]:
    """The refusal of a task with all that the time allows to find out, or why there is none. Raises SelfconfError."""
    _, method, composer = recorded_task(record)
    limit = TimeLimit(method.seconds or EXPLAINING_SECONDS)
    found = composed(composer, ecology, frozenset(lost), None, limit)
    if not isinstance(found, Refusal):
        return {"detail": "what lives now has a configuration, or the search has not ended in its time"}
    able = {component: one for component, one in ecology.items() if component not in lost}
    return refusal_body(explained(composer, able, found, method.wider(), limit))


@options_named()  # the reader of its texts is at the page of `selfconf serve`
def main() -> None:
    """Find out what stands on stdin."""
    os.nice(JUDGING_NICENESS)
    resource.setrlimit(resource.RLIMIT_AS, (JUDGING_MEMORY, JUDGING_MEMORY))
    asked = json.load(sys.stdin)
    ecology: dict[IRI, Advertisement] = {}
    try:
        for text in asked["advertisements"]:
            good, _ = read_advertisements(text.encode(), "")  # what does not conform plays in no task
            ecology.update({one.component: one for one in good})
        told = explained_refusal(
            decode(asked["record"].encode(), TaskRecord), ecology, set(map(IRI.unchecked, asked["lost"]))
        )
    except (SelfconfError, MemoryError, RecursionError) as error:
        told = {"detail": str(error) or type(error).__name__}
    print(json.dumps(told))


if __name__ == "__main__":
    main()

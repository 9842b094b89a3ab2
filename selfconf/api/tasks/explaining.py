"""Why a task has no configuration among given advertisements, with near misses and relaxations.

`python -m selfconf.api.tasks.explaining` finds it out in a process of its own, which can be ended. It reads a JSON
object from stdin with the text `record` (a message of the kind `task`), the texts `advertisements` (Turtle, one
component each) and the IRIs `lost` of components that do not count. It writes a refusal, or an object with the `detail`
of why it has none.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

from selfconf.api.tasks.detached import recorded_task
from selfconf.api.tasks.judging import answer_question
from selfconf.composition import TimeLimit, composed, explained
from selfconf.model.refusal import Refusal
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


def _answer(question: Mapping[str, Any]) -> dict[str, object]:
    """The explanation that a question asks for, in its form as JSON. Raises SelfconfError."""
    ecology: dict[IRI, Advertisement] = {}
    for text in question["advertisements"]:
        good, _ = read_advertisements(text.encode(), "")  # what does not conform plays in no task
        ecology.update({one.component: one for one in good})
    record = decode(question["record"].encode(), TaskRecord)
    return explained_refusal(record, ecology, set(map(IRI.unchecked, question["lost"])))


if __name__ == "__main__":
    answer_question(_answer)

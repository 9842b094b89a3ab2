"""SPARQL asked of an ecology: in a process that can be ended, or of an endpoint over HTTP.

`answer` puts a `Question` to a dataset or an endpoint and gives the answer as text (`Shown`) in one of
`RESULT_FORMATS`, within `ANSWER_SECONDS` and `MOST_ROWS` unless told otherwise. `read_endpoint` fetches the
advertisements that a task may want. A `StandingDataset` is a process that holds a dataset, for a server: each
`StandingQuestion` is answered in a copy of it, in one of the media types of `RESULT_TYPES` or `TRIPLE_TYPES`; `outcome`
is what has come of it.

Each is loaded when it is first used: the process of a standing dataset needs nothing of what asks endpoints and writes
answers for people, and starts in half the time without.
"""

from typing import TYPE_CHECKING

from selfconf.late_names import late_names

if TYPE_CHECKING:
    from selfconf.query.endpoint import read_endpoint
    from selfconf.query.process import ANSWER_SECONDS, MOST_ROWS, Question, Shown, answer
    from selfconf.query.results import RESULT_FORMATS
    from selfconf.query.standing import StandingDataset, StandingQuestion, outcome
    from selfconf.query.standing_process import RESULT_TYPES, TRIPLE_TYPES

__all__ = [
    "ANSWER_SECONDS",
    "MOST_ROWS",
    "RESULT_FORMATS",
    "RESULT_TYPES",
    "TRIPLE_TYPES",
    "Question",
    "Shown",
    "StandingDataset",
    "StandingQuestion",
    "answer",
    "outcome",
    "read_endpoint",
]

_HOME = {
    "ANSWER_SECONDS": "process",
    "MOST_ROWS": "process",
    "RESULT_FORMATS": "results",
    "RESULT_TYPES": "standing_process",
    "TRIPLE_TYPES": "standing_process",
    "Question": "process",
    "Shown": "process",
    "StandingDataset": "standing",
    "StandingQuestion": "standing",
    "answer": "process",
    "outcome": "standing",
    "read_endpoint": "endpoint",
}
"""Where each name is defined. It is loaded when it is first used."""

__getattr__ = late_names(__name__, _HOME)

"""SPARQL asked of an ecology: in a process that can be ended, or of an endpoint over HTTP.

`answer` puts a `Question` to a dataset or an endpoint and gives the answer as text (`Shown`) in one of
`RESULT_FORMATS`, within `ANSWER_SECONDS` and `MOST_ROWS` unless told otherwise. `read_endpoint` fetches the
advertisements that a task may want.
"""

from selfconf.query.endpoint import read_endpoint
from selfconf.query.process import ANSWER_SECONDS, MOST_ROWS, Question, Shown, answer
from selfconf.query.results import RESULT_FORMATS

__all__ = ["ANSWER_SECONDS", "MOST_ROWS", "RESULT_FORMATS", "Question", "Shown", "answer", "read_endpoint"]

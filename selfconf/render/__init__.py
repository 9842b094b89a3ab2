"""Values for their readers: as text, as JSON, as HTML and as Mermaid. Nothing here decides anything.

Text: `configuration_text`, `consequences_text`, `cost_text`, `refusal_text`, `undecided_text`, `table`;
`unconnected_text` names interactions that connect nothing;
`disobedience_text` names components that are out of control, and `disobedience` says that of one; `Names` shortens IRIs
by prefixes, `short` without, `ecology_names` makes them for an ecology, and a `Name` is either; `alternative_text` says
what speaks for a candidate, `holder_text` who holds a component; `duration` is how long something has lasted,
`clock_time` when something was. JSON: `configuration_body`, `refusal_body`, `undecided_body`, `consequences_body`,
`cost_body`, `alternative_body`, `likeness_body`, `holder_body`, and `value_body` of a term. Diagrams: `mermaid`, and
`diagram` for notebooks, whose tables and texts are `html_table`, `html_text`, `html_sections`. Two doors of their own
are loaded where they are needed: `selfconf.render.run_events` words the events of a run, and `selfconf.render.why` what
a history says of a moment.
"""

from selfconf.render.bodies import (
    alternative_body,
    configuration_body,
    consequences_body,
    cost_body,
    holder_body,
    likeness_body,
    refusal_body,
    undecided_body,
    value_body,
)
from selfconf.render.html import diagram, html_sections, html_table, html_text
from selfconf.render.mermaid_diagram import mermaid
from selfconf.render.names import Names, ecology_names, short
from selfconf.render.tables import clock_time, duration, table
from selfconf.render.text import (
    Name,
    alternative_text,
    configuration_text,
    consequences_text,
    cost_text,
    disobedience,
    disobedience_text,
    holder_text,
    refusal_text,
    unconnected_text,
    undecided_text,
)

__all__ = [
    "Name",
    "Names",
    "alternative_body",
    "alternative_text",
    "clock_time",
    "configuration_body",
    "configuration_text",
    "consequences_body",
    "consequences_text",
    "cost_body",
    "cost_text",
    "diagram",
    "disobedience",
    "disobedience_text",
    "duration",
    "ecology_names",
    "holder_body",
    "holder_text",
    "html_sections",
    "html_table",
    "html_text",
    "likeness_body",
    "mermaid",
    "refusal_body",
    "refusal_text",
    "short",
    "table",
    "unconnected_text",
    "undecided_body",
    "undecided_text",
    "value_body",
]

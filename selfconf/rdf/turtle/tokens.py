"""The tokens of Turtle in which no sign means what it means elsewhere, for what looks at a text without parsing it.

Both are regular expressions without groups, for the flag DOTALL. No part of a text can be taken in two ways, so that a
string without an end takes no longer than one with it.
"""

QUOTED = (
    r'"""[^"\\]*(?:(?:\\.|"(?!""))[^"\\]*)*"""'
    r"|'''[^'\\]*(?:(?:\\.|'(?!''))[^'\\]*)*'''"
    r'|"(?!"")[^"\\\n]*(?:\\.[^"\\\n]*)*"'
    r"|'(?!'')[^'\\\n]*(?:\\.[^'\\\n]*)*'"
)
COMMENT = r"\#[^\n]*"

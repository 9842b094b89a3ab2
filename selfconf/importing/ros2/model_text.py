"""The notation of RosTooling models: names with colons and items with dashes, nested by indentation.

It looks like YAML and is none: a list may be words on lines of their own, `-[a, b]` is an item, `type:"x"` has its
colon without a space, and an item may go on in a line that begins left of its text. So it is read by what its grammar
(Xtext, with synthetic tokens for indentation) and the models that are about have in common. A flow mapping of YAML,
`scan: {type: "x", qos: {depth: 5}}`, is read as what could stand below its name.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from selfconf.errors import AuthorError
from selfconf.importing.sources import SourceDocument

_LINE = re.compile(
    r"""(?P<dash>-(?!>))?\s*(?P<key>"[^"]*"|'[^']*'|[^\s:\[\]"'#,-][^\s:\[\]"'#,]*)\s*:(?!:)\s*(?P<value>.*)"""
)
_WORD = re.compile(r""""[^"]*"|'[^']*'|[^\s\[\]{},"':]+(?:::?[^\s\[\]{},"':]+)*""")
_FLOW_BEGIN = re.compile(r":\s*\{")
_FLOW_KEY = re.compile(r"""\s*(?P<key>"[^"]*"|'[^']*'|[^\s:\[\]{}"'#,]+)\s*:(?!:)\s*""")
_FLOW_VALUE = re.compile(r"""(?P<value>"[^"]*"|'[^']*'|\[[^\[\]{}]*\]|[^\[\]{},"']*)""")
_FLOW_END = re.compile(r"\s*(?P<mark>[,}])\s*")
_QUOTED_OR_COMMENT = re.compile(r""""[^"]*"|'[^']*'|(?P<comment>\#.*)|(?P<open>["'])""")
DEEPEST_MODEL = 50
"""How deep entries may be nested; models need eight levels."""


@dataclass(slots=True)
class ModelEntry:
    """A line of a model: its name, if it has one, what stands behind the colon or the dash, and what is below it."""

    key: str
    text: str
    line: int
    column: int
    below: list[ModelEntry] = field(default_factory=list)

    def child(self, key: str) -> ModelEntry | None:
        """The first entry of a name below this one."""
        return next((each for each in self.below if each.key == key), None)

    def value(self, key: str) -> str:
        """The text of the entry of a name below this one, without quotes; empty if there is none."""
        found = self.child(key)
        return "" if found is None else unquoted(found.text)

    def words(self) -> list[str]:
        """The words of the text, such as the members of a list in brackets, without quotes."""
        return [unquoted(word) for word in _WORD.findall(self.text)]


LINE = "a line is `name:`, `name: value`, `- name: value`, `- [a, b]` or a name"
"""What a line of a model is, for one that is none."""
PERHAPS_NO_MODEL = "; is this a .ros2 or .rossystem model, and no launch file or definition?"
"""What is asked besides where the first line of a document is none of a model."""


def unquoted(text: str) -> str:
    """A text without the quotes around it."""
    text = text.strip()
    return text[1:-1] if len(text) > 1 and text[0] == text[-1] and text[0] in "\"'" else text


def parse_model(source: SourceDocument) -> list[ModelEntry]:
    """The entries at the left margin. Raises AuthorError with line and column where a line is none of the notation."""
    root = ModelEntry("", "", 0, 0)
    open_entries = [(-1, root)]
    for entry in _entries(source):
        while entry.column <= open_entries[-1][0]:
            open_entries.pop()
        if len(open_entries) > DEEPEST_MODEL:
            raise _mistake(source, entry.line, entry.column, f"it is nested more than {DEEPEST_MODEL} levels deep")
        open_entries[-1][1].below.append(entry)
        open_entries.append((entry.column, entry))
    return root.below


def _entries(source: SourceDocument) -> Iterator[ModelEntry]:
    """Each line that says something; a list in brackets may take several."""
    begun = False
    lines = enumerate(source.text().splitlines(), 1)
    for number, raw in lines:
        line = _without_comment(raw.expandtabs(8), source, number)
        column = len(line) - len(line.lstrip())
        text = line.strip()
        if not text or text == "---":
            continue
        while unclosed := _unclosed(text):
            following = next(lines, None)
            if following is None:
                raise _mistake(source, number, column, f"{unclosed} has no end")
            text = f"{text} {_without_comment(following[1], source, following[0]).strip()}"
        found = _LINE.fullmatch(text)
        if found is not None:
            entry = ModelEntry(unquoted(found["key"]), found["value"].strip(), number, column + 1)
            if entry.text.startswith("{") and _read_flow(entry, entry.text, 1, 1) == len(entry.text):
                entry.text = ""
            else:
                entry.below.clear()
            begun = True
            yield entry
        elif _WORD.fullmatch(text.lstrip("- ")) or re.fullmatch(r"-\s*\[.*\]", text):
            yield ModelEntry("", text.removeprefix("-").strip(), number, column + 1)
        else:
            raise _mistake(source, number, column, f"{LINE}, not {text[:40]!r}{'' if begun else PERHAPS_NO_MODEL}")


def _unclosed(text: str) -> str:
    """What goes on in the next line, in words; empty if nothing does."""
    if text.count("[") > text.count("]"):
        return "a list in brackets"
    goes_on = _FLOW_BEGIN.search(text) is not None and text.count("{") > text.count("}")
    return "a mapping in braces" if goes_on else ""


def _read_flow(entry: ModelEntry, text: str, place: int, depth: int) -> int:
    """Put the members of a flow mapping below an entry; where it ends, or -1 where this is none.

    `place` is that behind its brace.
    """
    if text[place:].lstrip().startswith("}"):
        return place + text[place:].index("}") + 1
    while (key := _FLOW_KEY.match(text, place)) is not None and depth < DEEPEST_MODEL:
        member = ModelEntry(unquoted(key["key"]), "", entry.line, entry.column)
        entry.below.append(member)
        place = key.end()
        if text.startswith("{", place):
            place = _read_flow(member, text, place + 1, depth + 1)
        elif (value := _FLOW_VALUE.match(text, place)) is not None:
            member.text, place = value["value"].strip(), value.end()
        end = _FLOW_END.match(text, place) if place >= 0 else None
        if end is None:
            break
        place = end.end()
        if end["mark"] == "}":
            return place
    return -1


def _without_comment(line: str, source: SourceDocument, number: int) -> str:
    for found in _QUOTED_OR_COMMENT.finditer(line):
        if found["comment"] is not None:
            return line[: found.start()]
        if found["open"] is not None:
            raise _mistake(source, number, found.start(), "a quotation has no end")
    return line


def _mistake(source: SourceDocument, line: int, column: int, message: str) -> AuthorError:
    return AuthorError(message, file=source.shown, line=line, column=column + 1)

"""Regular expressions without backtracking: whether one is found in a text, in time linear in the text.

Python's `re` tries one way after another, so that `^(\\w+\\s?)*$` takes years for forty letters and an exclamation
mark. Here the expression, as `re` parses it, becomes a nondeterministic automaton (Thompson's construction), and the
sets of its states become the states of a deterministic one, made when a text first leads there. Which characters a
class stands for is asked of `re`, so the two agree; only whether there is a match is found, so greed and groups do not
matter.

What is no regular language has no automaton: references to groups, looking ahead and behind, atomic groups.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

if sys.version_info >= (3, 11):
    from re import _compiler, _parser  # type: ignore[attr-defined]  # the stubs leave out what is private
else:  # the same modules before they were moved
    import sre_compile as _compiler
    import sre_parse as _parser

MOST_STATES = 1_000
"""States of an automaton; `(a{0,100}){0,100}` would have ten thousand."""
MOST_SETS = 4_000
"""Sets of states that are kept; with more of them they are forgotten, and made anew."""
STRETCH = 256
"""Characters after which a set of states that is still the same is taken to stay for long."""
MOST_COMPILED = 16
"""How often it may be worked out anew which characters do not lead away from a set."""
STEPS, STEPS_OF_A_CHARACTER = 50_000, 10
"""Looks at states while sets are made, for a text and for each of its characters: few texts need a tenth of them.

Of `a[ab]{900}c` each character makes another set of hundreds of states.
"""
_REPEATS = frozenset((_parser.MAX_REPEAT, _parser.MIN_REPEAT))
_CHARACTERS = frozenset((_parser.LITERAL, _parser.NOT_LITERAL, _parser.ANY, _parser.IN))
_IN_LINE = {_parser.AT_BEGINNING: _parser.AT_BEGINNING_LINE, _parser.AT_END: _parser.AT_END_LINE}
_ALPHABETS = int(re.ASCII | re.LOCALE | re.UNICODE)
"""Flags of which one excludes the others."""
_CharacterTest = Callable[[str], object]


class NotRegular(Exception):
    """There is no automaton for an expression, or it would have too many states."""


class TooManySteps(Exception):
    """A text leads to too many sets of states that have not been met."""


def parsed(pattern: str, flags: int) -> Any:
    """An expression as `re` parses it. Raises re.error."""
    return _parser.parse(pattern, flags)


@dataclass(slots=True)
class _State:
    """A state: what it reads or where it may stand, and what comes after; one without either leads on at once."""

    reads: _CharacterTest | None = None
    stands: Any = None
    """The position that it asks for, such as the end of a line."""
    ascii: bool = False
    after: list[int] = field(default_factory=list)


class _Builder:
    """Builds the nondeterministic automaton: each part is added before what comes after it, from the end."""

    def __init__(self, tree: Any) -> None:
        self.states: list[_State] = [_State()]  # the first is the accepting one
        self._tree = tree

    def sequence(self, items: Any, flags: int, after: int) -> int:
        """The state at which a sequence begins that ends in another state."""
        for operator, argument in reversed(list(items)):
            after = self._part(operator, argument, flags, after)
        return after

    def _add(self, state: _State) -> int:
        if len(self.states) == MOST_STATES:
            raise NotRegular
        self.states.append(state)
        return len(self.states) - 1

    def _part(self, operator: Any, argument: Any, flags: int, after: int) -> int:
        if operator in _CHARACTERS:
            return self._add(_State(reads=self._reads(operator, argument, flags), after=[after]))
        if operator is _parser.AT:
            place = _IN_LINE.get(argument, argument) if flags & re.MULTILINE else argument
            return self._add(_State(stands=place, ascii=bool(flags & re.ASCII), after=[after]))
        if operator is _parser.BRANCH:
            return self._add(_State(after=[self.sequence(one, flags, after) for one in argument[1]]))
        if operator is _parser.SUBPATTERN:
            _, added, taken, inner = argument
            kept = flags & ~_ALPHABETS if added & _ALPHABETS else flags
            return self.sequence(inner, (kept | added) & ~taken, after)
        if operator in _REPEATS:
            least, most, inner = argument
            return self._repeat(least, most, inner, flags, after)
        raise NotRegular

    def _repeat(self, least: int, most: Any, inner: Any, flags: int, after: int) -> int:
        if most is _parser.MAXREPEAT:
            again = self._add(_State(after=[after]))
            self.states[again].after.append(self.sequence(inner, flags, again))
            after = again
        else:
            end = after
            for _ in range(int(most) - least):
                after = self._add(_State(after=[end, self.sequence(inner, flags, after)]))
        for _ in range(least):
            before, after = after, self.sequence(inner, flags, after)
            if after == before:  # what says nothing, as `()`, says nothing any number of times
                break
        return after

    def _reads(self, operator: Any, argument: Any, flags: int) -> _CharacterTest:
        """Whether a character is of a class, as `re` has it under some flags."""
        asked = flags & (_ALPHABETS | re.IGNORECASE | re.DOTALL)
        not_asked = (re.IGNORECASE | re.DOTALL) & ~flags
        one = _parser.SubPattern(self._tree.state, [(operator, argument)])
        group = (_parser.SUBPATTERN, (None, int(asked), int(not_asked), one))
        expression = _compiler.compile(_parser.SubPattern(self._tree.state, [group]), 0)
        test: _CharacterTest = lru_cache(maxsize=4096)(expression.match)
        return test


@dataclass(slots=True, eq=False)
class _Set:
    """A state of the deterministic automaton: the states that wait for the next character, and what came before it."""

    waiting: tuple[int, ...]
    before: str
    """The character before, or one that is as good for positions; nothing at the beginning."""
    then: dict[str, _Set | None] = field(default_factory=dict)
    """What follows, by character; None where the expression is found."""
    _staying: re.Pattern[str] | None = None
    _known: int = 0
    _compiled: int = 0

    def after_run(self, text: str, position: int, end: int) -> int:
        """The position behind what leads from here to here, as far as that is known; `re` is quick at finding it."""
        if len(self.then) != self._known and self._compiled < MOST_COMPILED:
            self._known, self._compiled = len(self.then), self._compiled + 1
            staying = "".join(
                re.escape(symbol) for symbol, there in self.then.items() if there is self and len(symbol) == 1
            )
            self._staying = re.compile(f"[{staying}]*") if staying else None
        found = self._staying.match(text, position, end) if self._staying else None
        return found.end() if found else position


_UNKNOWN = _Set((), "")
"""What follows where that has not been found out."""
_LAST = "\n$"
"""A line feed at the end of the text: `$` stands before it as well."""


class Automaton:
    """Tells whether an expression is found in a text. Raises NotRegular where there is no automaton."""

    def __init__(self, pattern: str, flags: int) -> None:
        tree = parsed(pattern, flags)
        builder = _Builder(tree)
        self._start = builder.sequence(tree, tree.state.flags, 0)
        self._states = builder.states
        self._sets: dict[tuple[tuple[int, ...], str], _Set] = {}
        self._left = 0
        """How many looks at states are left for the text that is read."""

    def finds(self, text: str) -> bool:
        """Whether there is a match anywhere in a text. Raises TooManySteps."""
        self._left = STEPS + STEPS_OF_A_CHARACTER * len(text)
        here, there = self._set((self._start,), ""), None
        end = len(text) - 1 if text.endswith("\n") else len(text)
        position = 0
        while position < end:
            before = here
            for character in text[position : min(position + STRETCH, end)]:
                there = here.then.get(character, _UNKNOWN)
                if there is _UNKNOWN:
                    there = self._follow(here, character)
                if there is None:
                    return True
                here = there
            position += STRETCH
            if here is before:
                position = here.after_run(text, position, end)
        for symbol in (_LAST, "") if end < len(text) else ("",):
            there = self._follow(here, symbol)
            if there is None:
                return True
            here = there
        return False

    def _set(self, waiting: tuple[int, ...], before: str) -> _Set:
        found = self._sets.get((waiting, before))
        if found is None:
            if len(self._sets) == MOST_SETS:
                self._sets.clear()
            found = self._sets[waiting, before] = _Set(waiting, before)
        return found

    def _follow(self, here: _Set, symbol: str) -> _Set | None:
        """The set that follows on a character, on the last line feed, or on the end of the text (an empty symbol)."""
        if symbol in here.then:
            return here.then[symbol]
        reached = self._closure(here, symbol)
        self._left -= len(reached)
        if self._left < 0:
            raise TooManySteps
        there: _Set | None = None
        if 0 not in reached:
            after = {self._start}
            for number in reached:
                state = self._states[number]
                if symbol and state.reads is not None and state.reads(symbol[0]):
                    after.update(state.after)
            there = self._set(tuple(sorted(after)), _kind(symbol[:1]))
        here.then[symbol] = there
        return there

    def _closure(self, here: _Set, symbol: str) -> set[int]:
        """The states that can be reached before the next character is read."""
        waiting, reached = list(here.waiting), set[int]()
        while waiting:
            number = waiting.pop()
            if number in reached:
                continue
            reached.add(number)
            state = self._states[number]
            if state.reads is None and (state.stands is None or _stands(state, here.before, symbol)):
                waiting.extend(state.after)
        return reached


# complexity: one case for each position that an expression can ask for
def _stands(state: _State, before: str, symbol: str) -> bool:
    """Whether a place between two characters is the one that a state asks for."""
    place = state.stands
    if place in (_parser.AT_BEGINNING, _parser.AT_BEGINNING_STRING):
        return not before
    if place is _parser.AT_BEGINNING_LINE:
        return before in ("", "\n")
    if place is _parser.AT_END:
        return symbol in ("", _LAST)
    if place is _parser.AT_END_LINE:
        return symbol[:1] in ("", "\n")
    if place is _parser.AT_END_STRING:
        return not symbol
    if place in (_parser.AT_BOUNDARY, _parser.AT_NON_BOUNDARY):
        words = _ASCII_WORD if state.ascii else _WORD
        differ = bool(words.match(before)) != bool(words.match(symbol[:1]))
        is_one = _EMPTY_TEXT_IS_NO_BOUNDARY or before or symbol
        return differ if place is _parser.AT_BOUNDARY else bool(is_one) and not differ
    raise NotRegular


def _kind(character: str) -> str:
    """A character after which the same positions are as after another: so there are few sets, whatever a text says."""
    if character in ("", "\n"):
        return character
    if not _WORD.match(character):
        return " "
    return "a" if _ASCII_WORD.match(character) else "\N{GREEK SMALL LETTER ALPHA}"


_EMPTY_TEXT_IS_NO_BOUNDARY = re.search(r"\B", "") is not None
"""Whether `\\B` is found in an empty text, as from Python 3.14 on."""
_WORD, _ASCII_WORD = re.compile(r"\w"), re.compile(r"\w", re.ASCII)

"""How alike texts are by their words: the cosine of their vectors of term weights (TF-IDF).

The measure of the hybrid matchmakers (OWLS-M3, Klusch et al., 2006): a word weighs more the oftener a text has it and
the fewer texts do (Salton and Buckley, 1988). Words are cut out of names too: `PlanarPose2D` is `planar`, `pose`, `2d`.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence

_SMALL = r"[^\W\d_A-Z]"
_WORDS = re.compile(rf"[0-9]+[A-Za-z]?(?!{_SMALL})|[A-Z]+(?!{_SMALL})|[A-Z]?{_SMALL}+|[0-9]+")
_SILENT = frozenset(
    (
        "a", "an", "and", "are", "as", "at", "be", "by", "can", "for", "from", "has", "have", "in", "into", "is", "it",
        "its", "of", "on", "or", "that", "the", "this", "to", "which", "with",
    )
)  # fmt: skip
"""English words that say nothing of what something is for."""
LONGEST_COMPARED = 10_000
"""Characters of a text that are looked at: it may come from a stranger."""


def words(text: str) -> list[str]:
    """The words of a text or a name in lower case, without those that say nothing, letters, digits and a plural `s`.

    >>> words("PlanarPose2D of the robot_arms")
    ['planar', 'pose', '2d', 'robot', 'arm']
    """
    found = (word.lower() for word in _WORDS.findall(text[:LONGEST_COMPARED]))
    return [_singular(word) for word in found if len(word) > 1 and word not in _SILENT]


def _singular(word: str) -> str:
    return word[:-1] if len(word) > 3 and word.endswith("s") and not word.endswith("ss") else word


class TextLikeness:
    """How alike a question is to each of some texts, from 0 (no word in common) to 1."""

    def __init__(self, question: Iterable[str], texts: Sequence[Iterable[str]]) -> None:
        """`question` and `texts` are given by their words."""
        self._counts = [Counter(text) for text in texts]
        having = Counter(word for counts in self._counts for word in counts)
        self._rarity = {word: math.log(1 + len(texts) / number) for word, number in having.items()}
        self._question = self._weighted(Counter(word for word in question if word in having))

    def of(self, number: int) -> float:
        """How alike the question is to the text of a number."""
        text = self._weighted(self._counts[number])
        product = sum(weight * text.get(word, 0.0) for word, weight in self._question.items())
        return product / (_length(self._question) * _length(text)) if product else 0.0

    def _weighted(self, counts: Counter[str]) -> dict[str, float]:
        return {word: (1 + math.log(number)) * self._rarity[word] for word, number in counts.items()}


def _length(vector: Mapping[str, float]) -> float:
    return math.sqrt(sum(weight * weight for weight in vector.values()))

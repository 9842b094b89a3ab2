"""Signal types that no loaded ontology declares: one warning for each namespace of a run, where it is first used.

Nothing else about a file is wrong because of them. So they are found in what the prefilter has seen, and a file is not
checked in full for their sake, however large it is.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping

from selfconf.model.diagnostic import Diagnostic
from selfconf.model.setting_names import setting
from selfconf.rdf.validation.prefilter import Prefiltered
from selfconf.rdf.validation.term_index import TermIndex, namespace
from selfconf.rdf.validation.text_places import TextPlaces


def undeclared_signals(
    files: Iterable[tuple[str, bytes]], seen: Mapping[str, Prefiltered], index: TermIndex
) -> Iterator[Diagnostic]:
    """A warning for each namespace of undeclared signal types in some files, each a name and its octets."""
    told: set[str] = set()
    for name, octets in files:
        if name not in seen:
            continue
        by_home: dict[str, set[str]] = defaultdict(set)
        for signal in filter(index.foreign, seen[name].signals):
            by_home[namespace(signal) or signal].add(signal)
        text = TextPlaces(name, octets) if by_home.keys() - told else None
        for home in sorted(by_home.keys() - told):
            assert text is not None
            yield _warning(text, home, by_home[home], seen[name], index)
        told |= by_home.keys()


def _warning(text: TextPlaces, home: str, signals: set[str], found: Prefiltered, index: TermIndex) -> Diagnostic:
    message = f"No loaded ontology declares the signal type <{min(signals)}>."
    if len(signals) > 1:
        message = f"No loaded ontology declares the signal types of <{home}>: this file uses {len(signals):,} of them."
    offset = text.first_use(signals, found.prefixes)
    hint = f"Give the ontology that declares it with {setting('ontology', 'FILE')}."
    meant = _declared_elsewhere(signals, index)
    if meant is not None:
        hint = f"Did you mean <{meant}>? If not, g{hint[1:]}"
    return text.at(offset or 0, "SC-L03", message, hint)


def _declared_elsewhere(signals: set[str], index: TermIndex) -> str | None:
    """A class of a loaded ontology that has the name of one of some signal types, which may have its prefix wrong."""
    names = {signal[len(namespace(signal)) :] for signal in signals}
    return min((one for one in index.classes if one[len(namespace(one)) :] in names), default=None)

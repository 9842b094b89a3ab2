"""SPARQL 1.1 as rdflib answers it, corrected where it departs from the recommendation.

pySHACL has rdflib evaluate the queries of `sh:sparql`, and rdflib 7.6 answers some of them wrongly, or fails, because
of a value that any advertisement may have. Within `sparql_corrections`

* a path with `*`, `+` or `?` may begin and end at 0, "" and false, which rdflib takes for no node at all, and is
  followed without recursion (9.1, 18.4);
* `!(^:p)` and `!(:p|^:q)` are paths (9.1); rdflib forgets the property behind `^`, and fails;
* `<` and its like compare values of one value space (17.3); rdflib orders others by the names of their datatypes;
* `=` is an error beside an ill-typed literal or an unknown datatype (17.4.1.7), and `IN` means `=` (17.4.1.9);
* a date, a text with a language and NaN are not true (17.2.2);
* `||` and `&&` have a value if one side alone decides, whichever that is (17.2);
* an expression that fails is an error, by which a filter does not hold, whatever Python raises for it (17.2);
* a negative decimal is a term; `FILTER(false)` and its like hold for nothing; rdflib fails, or leaves them out;
* what a sub-SELECT does not project is its own (12); a sub-SELECT without solutions has no groups (18.5.1);
* a number is cast to any other kind of number, and to a truth value, and back (17.5);
* a text is cast to a date, a time or a duration, and a date to a moment and back, as XPath has it (17.5, 17.6);
* SUM and AVG of what is no number is an error (18.5.1); rdflib fails, or passes over the value;
* MIN and MAX of IRIs is an IRI (18.5.1); rdflib makes a text of it.
"""

from __future__ import annotations

import re
from collections import OrderedDict
from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager
from decimal import Decimal
from functools import partial
from typing import Any

from rdflib import RDF, XSD, Graph, Literal
from rdflib.paths import InvPath, MulPath, NegatedPath, eval_path
from rdflib.plugins.sparql import algebra, evaluate, evalutils, operators, parser
from rdflib.plugins.sparql.aggregates import Aggregator, Average, Extremum, Sum
from rdflib.plugins.sparql.evalutils import _eval
from rdflib.plugins.sparql.parserutils import CompValue, Expr, value
from rdflib.plugins.sparql.sparql import NotBoundError, SPARQLError, SPARQLTypeError
from rdflib.term import Node

from selfconf.rdf.literal_comparison import order_of
from selfconf.rdf.pyshacl_corrections.library_patches import replaced
from selfconf.rdf.rdflib_literals import literal

_Pairs = Iterator[tuple[Node, Node]]
_NUMBERS = (int, float, Decimal)
_NUMERIC_CASTS = (XSD.boolean, XSD.integer, XSD.decimal, XSD.float, XSD.double)
_TIME_CASTS = (XSD.dateTime, XSD.date, XSD.time, XSD.duration, XSD.dayTimeDuration, XSD.yearMonthDuration)
_MOMENT = re.compile(r"(?P<date>-?\d+-\d\d-\d\d)(?:T(?P<time>[\d:.]+))?(?P<zone>Z|[+-][\d:]+)?")
"""What a date, or a date with a time, consists of."""
_FAILURES = (TypeError, ValueError, ArithmeticError, AttributeError, RecursionError, re.error)
"""What rdflib raises by mistake where an expression has an error."""


def _ends(graph: Graph, path: MulPath, start: Node, backward: bool) -> Iterator[Node]:
    """The nodes to which a path leads from one, or from which it leads there, each once (SPARQL 1.1, 18.4)."""
    found = {start} if path.zero else set[Node]()
    yield from found
    waiting = [start]
    while waiting:
        node = waiting.pop()
        steps = eval_path(graph, (None, path.path, node) if backward else (node, path.path, None))
        for end in (before if backward else after for before, after in steps):
            if end not in found:
                found.add(end)
                yield end
                if path.more:
                    waiting.append(end)


def _repeated(path: MulPath, graph: Graph, subj: Node | None = None, obj: Node | None = None) -> _Pairs:
    """The pairs of nodes between which a path with `*`, `+` or `?` leads, each once."""
    if subj is not None and obj is not None:
        if obj in _ends(graph, path, subj, backward=False):
            yield subj, obj
    elif obj is not None:
        for begin in _ends(graph, path, obj, backward=True):
            yield begin, obj
    else:
        for begin in (subj,) if subj is not None else _beginnings(graph, path):
            for end in _ends(graph, path, begin, backward=False):
                yield begin, end


def _beginnings(graph: Graph, path: MulPath) -> Iterable[Node]:
    """Where a path may begin: at every node of a graph if it may have no steps."""
    if path.zero:
        return {node for subject, _, value in graph for node in (subject, value)}
    return {begin for begin, _ in eval_path(graph, (None, path.path, None))}


def _negated(path: NegatedPath, graph: Graph, subj: Node | None = None, obj: Node | None = None) -> _Pairs:
    """The pairs of nodes that another property joins than those of `!( ... )`, forward and backward."""
    backward = {one.arg for one in path.args if isinstance(one, InvPath)}
    forward = {one for one in path.args if not isinstance(one, InvPath)}
    if forward or not backward:
        yield from ((s, o) for s, p, o in graph.triples((subj, None, obj)) if p not in forward)
    if backward:
        yield from ((o, s) for s, p, o in graph.triples((obj, None, subj)) if p not in backward)


_translated_path: Callable[[Any], Any] = vars(algebra)["translatePath"]


def _path(part: Any) -> Any:
    """A path as rdflib evaluates it, from what is parsed."""
    if isinstance(part, CompValue) and part.name == "InversePath":
        return InvPath(part.part)
    return _translated_path(part)


def _effective_boolean_value(term: object) -> bool:
    """What a term is as a condition. Raises SPARQLTypeError if it is neither true nor false."""
    if isinstance(term, Literal):
        if term.datatype == XSD.boolean:
            return term.value is True
        if term.datatype == XSD.string or (term.datatype is None and not term.language):
            return len(term) > 0
        if isinstance(term.value, _NUMBERS):
            return bool(term.value) and term.value == term.value
    raise SPARQLTypeError(f"{term!r} is neither true nor false")


def _compared(expression: Any, context: Any) -> object:
    """The value of `=`, `<` and the others, of IN and of NOT IN."""
    one, operator, other = expression.expr, expression.op, expression.other
    if operator is None:
        return one
    if operator in ("=", "!="):
        return Literal(_equal(one, other) == (operator == "="))
    if operator in ("IN", "NOT IN"):
        among = partial(_equal, one)
        return Literal(_decided(among, () if other == RDF.nil else other, True) == (operator == "IN"))
    if not isinstance(one, Literal) or not isinstance(other, Literal):
        raise SPARQLTypeError("what is no literal has no order")
    if _is_number(one) and _is_number(other) and (one.value != one.value or other.value != other.value):
        return Literal(False)  # NaN
    order = None if one.ill_typed or other.ill_typed else order_of(one, other)
    if order is None:
        raise SPARQLTypeError(f"{one!r} and {other!r} have no order")
    return Literal({"<": order < 0, "<=": order <= 0, ">": order > 0, ">=": order >= 0}[operator])


def _equal(one: object, other: object) -> bool:
    if not isinstance(one, Node) or not isinstance(other, Node):
        raise SPARQLTypeError("an error is equal to nothing")
    if not isinstance(one, Literal) or not isinstance(other, Literal):
        return one == other
    if one != other and (one.value is None or other.value is None or one.ill_typed or other.ill_typed):
        raise SPARQLTypeError(f"it is not known whether {one!r} and {other!r} are equal")
    return bool(one.eq(other))


def _is_number(literal: Literal) -> bool:
    return isinstance(literal.value, _NUMBERS) and literal.datatype != XSD.boolean


def _decided(holds: Callable[[Any], bool], parts: Iterable[Any], by: bool) -> bool:
    """Whether one of some parts decides, or none does. Raises SPARQLError if one that fails could have."""
    failed: SPARQLError | None = None
    for part in parts:
        try:
            if holds(part) is by:
                return by
        except SPARQLError as error:
            failed = error
    if failed is not None:
        raise failed
    return not by


def _connected(expression: Any, context: Any, by: bool) -> object:
    """The value of `||`, which a part decides that is true, or of `&&`, which one decides that is false."""
    others = OrderedDict.get(expression, "other")
    if others is None:
        return expression.expr
    parts = (OrderedDict.__getitem__(expression, "expr"), *others)
    operands = (value(context, part, variables=True, errors=True) for part in parts)
    return Literal(_decided(_effective_boolean_value, operands, by))


def _either(expression: Any, context: Any) -> object:
    return _connected(expression, context, True)


def _both(expression: Any, context: Any) -> object:
    return _connected(expression, context, False)


_collected_filters: Callable[[Any], Any] = vars(algebra)["collectAndRemoveFilters"]


def _filters(parts: Any) -> Any:
    """The condition of all filters of a group; never one that Python takes for none, as a literal may be."""
    condition = _collected_filters(parts)
    return Expr("Condition", _either, expr=condition) if isinstance(condition, Literal) else condition


def _negative(number: Literal) -> Literal:
    """A number with a minus before it."""
    return Literal(f"-{number}", datatype=number.datatype)


_evaluated: Callable[..., Any] = vars(Expr)["eval"]


def _value_or_error(expression: Expr, context: Any = None) -> Any:
    """The value of an expression, or its error."""
    try:
        return _evaluated(expression, {} if context is None else context)
    except _FAILURES as error:
        return SPARQLError(str(error))


_cast_text: Callable[[Any, Any], object] = vars(operators)["default_cast"]


def _cast(call: Any, context: Any) -> object:
    """The value of a call such as `xsd:integer(?v)`; rdflib casts what is written, and so no 5.0 to 5."""
    (given,) = call.expr
    if not isinstance(given, Literal) or given.ill_typed or not isinstance(given.value, _NUMBERS):
        return _cast_text(call, context)
    if call.iri == XSD.boolean:
        return Literal(_effective_boolean_value(given))
    if call.iri == XSD.integer:
        return Literal(int(given.value))
    if call.iri == XSD.decimal:
        return Literal(f"{Decimal(str(given.value)):f}", datatype=XSD.decimal)
    return Literal(float(given.value), datatype=call.iri)


def _cast_in_time(call: Any, context: Any) -> object:
    """The value of a call such as `xsd:date(?v)`, of a text or of a date with or without a time (XPath, 19.1.5)."""
    (given,) = call.expr
    if not isinstance(given, Literal) or given.ill_typed or given.language:
        raise SPARQLTypeError(f"{given!r} is no {call.iri}")
    text, kind = str(given), given.datatype
    moment = _MOMENT.fullmatch(text) if kind in (XSD.date, XSD.dateTime) and kind != call.iri else None
    if moment is not None and call.iri in (XSD.dateTime, XSD.date, XSD.time):
        date, time, zone = moment.groups("")
        text = {
            XSD.dateTime: f"{date}T{time or '00:00:00'}{zone}",
            XSD.date: f"{date}{zone}",
            XSD.time: f"{time}{zone}",
        }[call.iri]
    elif kind not in (None, XSD.string, call.iri):
        raise SPARQLTypeError(f"{given!r} is no {call.iri}")
    found = literal(text, call.iri)
    if found.ill_typed:
        raise SPARQLTypeError(f"{text!r} is no {call.iri}")
    return found


_may_be_joined_lazily: Callable[[Any, Any], bool] = vars(algebra)["analyse"]


def _lazy(part: Any, children: Any) -> bool:
    """Whether a part of a query may be evaluated with the values that variables have outside of it."""
    lazy = _may_be_joined_lazily(part, children)
    return lazy and not (isinstance(part, CompValue) and part.name == "Project")


_aggregated: Callable[[Any, Any], Iterable[Any]] = vars(evaluate)["evalAggregateJoin"]


def _groups(context: Any, part: Any) -> Iterable[Any]:
    """The groups of solutions; rdflib makes one of none, which is right without GROUP BY alone."""
    found = _aggregated(context, part)
    return found if part.p.expr is None else (group for group in found if len(group))


class _OfNumbers:
    """What SUM and AVG have in common: they have no value where what they add is no number."""

    expr: Any
    failed = False

    def update(self, row: Any, aggregator: Any) -> None:
        try:
            operators.numeric(_eval(self.expr, row))
            super().update(row, aggregator)  # type: ignore[misc]  # of the class beside this one
        except NotBoundError:
            pass
        except (SPARQLError, *_FAILURES):
            self.failed = True

    def set_value(self, bindings: Any) -> None:
        if not self.failed:
            super().set_value(bindings)  # type: ignore[misc]  # of the class beside this one


class _Sum(_OfNumbers, Sum):
    """SUM."""


class _Average(_OfNumbers, Average):
    """AVG."""


def _set_extremum(aggregate: Any, bindings: Any) -> None:
    """Have MIN or MAX be the term that was found."""
    if aggregate.value is not None:
        bindings[aggregate.var] = aggregate.value


_GRAMMAR: Any = parser
_INVERSE = _GRAMMAR.PathOneInPropertySet.exprs[-1]
"""What rdflib parses as `^:p` in `!( ... )`, where it forgets the property."""
_CORRECTIONS: tuple[tuple[object, str, object], ...] = (
    (MulPath, "eval", _repeated),
    (NegatedPath, "eval", _negated),
    (_INVERSE, "expr", "^" + _GRAMMAR.Param("part", parser.iri | parser.A)),
    (algebra, "translatePath", _path),
    (algebra, "analyse", _lazy),
    (algebra, "collectAndRemoveFilters", _filters),
    (parser, "neg", _negative),
    (evaluate, "evalAggregateJoin", _groups),
    (operators, "EBV", _effective_boolean_value),
    (evalutils, "EBV", _effective_boolean_value),
    (parser.RelationalExpression, "evalfn", _compared),
    (parser.ConditionalOrExpression, "evalfn", _either),
    (parser.ConditionalAndExpression, "evalfn", _both),
    (Expr, "eval", _value_or_error),
    (
        operators,
        "_CUSTOM_FUNCTIONS",
        {
            **vars(operators)["_CUSTOM_FUNCTIONS"],
            **dict.fromkeys(_NUMERIC_CASTS, (_cast, True)),
            **dict.fromkeys(_TIME_CASTS, (_cast_in_time, True)),
        },
    ),
    (Extremum, "set_value", _set_extremum),
    (
        Aggregator,
        "accumulator_classes",
        {**Aggregator.accumulator_classes, "Aggregate_Sum": _Sum, "Aggregate_Avg": _Average},
    ),
)


def sparql_corrections() -> AbstractContextManager[None]:
    """In the block, rdflib evaluates queries as SPARQL 1.1 says; one that was parsed outside of it, in part."""
    return replaced(_CORRECTIONS)

"""What `rival` starts: reads clauses from standard input, a socket, and writes the least solution to it, as integers.

The first integer says whether there is a solution; then come the options, slot after slot. It imports nothing of
selfconf, so that it starts in a few hundredths of a second. Its argument is where python-sat is installed.
"""

from __future__ import annotations

import marshal
import socket
import sys
from array import array
from typing import Any

CONFLICTS_PER_LOOK = 5_000
"""After so many it looks whether it is still wanted."""


def main() -> None:
    """Answer the question that is asked."""
    sys.path.append(sys.argv[1])
    wanted = socket.socket(fileno=0)
    size = int.from_bytes(_read(wanted, 8), "big")
    name, few, top, clauses, bounds, slots, follows, least = marshal.loads(_read(wanted, size))
    solver = _loaded(name, few, top, clauses, bounds)
    wanted.setblocking(False)
    possible = _solved(solver, [], wanted)
    wanted.sendall(array("i", [possible]).tobytes())
    if possible:
        _descend(solver, slots, follows, least, wanted)
    wanted.setblocking(True)
    wanted.recv(1)  # until the search has read it all, and ends this process


def _read(wanted: socket.socket, size: int) -> bytes:
    data = bytearray()
    while len(data) < size:
        part = wanted.recv(min(1 << 20, size - len(data)))
        if not part:
            sys.exit()
        data += part
    return bytes(data)


def _loaded(
    name: str, few: int, top: int, clauses: list[list[int]], bounds: list[tuple[list[int], int, list[int]]]
) -> Any:
    from pysat import solvers
    from pysat.card import CardEnc, EncType, ITotalizer

    solver = getattr(solvers, name)()
    for clause in clauses:
        solver.add_clause(clause)
    for literals, most, force in bounds:
        if most > 1:
            with ITotalizer(literals, ubound=most, top_id=top) as counter:  # counts to the bound, `CardEnc` to the end
                top, counting = counter.top_id, [[-counter.rhs[most]], *counter.cnf.clauses]
        else:
            kind = EncType.pairwise if len(literals) <= few else EncType.seqcounter
            encoded = CardEnc.atmost(literals, most, top_id=top, encoding=kind)
            top, counting = max(top, encoded.nv), encoded.clauses
        for clause in counting:
            solver.add_clause([*force, *clause])
    return solver


def _solved(solver: Any, assumed: list[int], wanted: socket.socket) -> bool:
    found = None
    while found is None:
        solver.conf_budget(CONFLICTS_PER_LOOK)
        found = solver.solve_limited(assumptions=assumed, expect_interrupt=True)
        try:
            if not wanted.recv(1):
                sys.exit()
        except BlockingIOError:
            pass
    return bool(found)


def _descend(
    solver: Any, slots: list[tuple[int, ...]], follows: list[bool], least: bool, wanted: socket.socket
) -> None:
    """Settle slot after slot; a slot that follows another one of its role begins after the option of that."""
    playing = _positive(solver)
    number = -1
    for literals, follow in zip(slots, follows, strict=True):
        number = number + 1 if follow else 0
        while (abs(literals[number]) in playing) != (literals[number] > 0):
            if least and _solved(solver, [literals[number]], wanted):
                playing = _positive(solver)
                break
            if least:
                solver.add_clause([-literals[number]])
            number += 1
        if least:
            solver.add_clause([literals[number]])
        wanted.sendall(array("i", [number]).tobytes())


def _positive(solver: Any) -> set[int]:
    return {literal for literal in solver.get_model() if literal > 0}


if __name__ == "__main__":
    main()

"""Mangles what is well formed: bytes as they are, and JSON in its structure; each mangling follows from a `Random`.

Hypothesis gives a `Random` of its own (`strategies.randoms`), and so can shrink what it finds.
"""

from __future__ import annotations

import copy
import json
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from random import Random
from typing import Any

DEEP = 2000
"""How deep nested JSON is: deeper than Python recurses."""
VALUES: tuple[Any, ...] = (
    None,
    True,
    -1,
    0,
    1 << 60,
    1 << 63,
    -(1 << 63),
    10**4000,
    1e308,
    float("inf"),
    float("nan"),
    "",
    "\x00",
    "\x1b[2J\u202e\n",
    "\ud800",
    "../../../tmp/x~1",
    "**",
    "selfconf/**",
    "selfconf/lab/conf/*/live/*",
    "@ctl",
    "a" * 5000,
    [],
    {},
    [[]],
    [None] * 100,
    {"iri": "x y"},
    {"literal": "1e999999999", "datatype": "http://www.w3.org/2001/XMLSchema#decimal"},
    {"": {}},
)
"""What a member of a message may turn into."""
TOKENS: tuple[bytes, ...] = (
    b"",
    b"\x00",
    b"\xff\xfe",
    b"\xf0\x9f",
    b"\xed\xa0\x80",
    b"{",
    b"}",
    b"[" * DEEP,
    b"(" * DEEP,
    b'"',
    b'"""',
    b"\\u0000",
    b"\\uD800",
    b"<",
    b"<>",
    b"@prefix : <",
    b"_:a",
    b" .\n",
    b";;;",
    b"^^",
    b"1e999999999",
    b"9" * 5000,
    b"\r\n\r\n",
    b"-----BEGIN CERTIFICATE-----\n",
    b"%00",
    b"\x1b[2J",
)
"""What may be put in between bytes."""


def mangled(text: bytes, random: Random) -> bytes:
    """Some bytes with one to four manglings."""
    for _ in range(random.randint(1, 4)):
        here, there = sorted((random.randint(0, len(text)), random.randint(0, len(text))))
        match random.randrange(7):
            case 0:
                text = text[:here] + text[there:]
            case 1:
                text = text[:here]
            case 2:
                text = text[:there] + text[here:]
            case 3:
                text = text[:here] + random.choice(TOKENS) + text[here:]
            case 4:
                text = text[:here] + random.choice(TOKENS) + text[there:]
            case 5:
                text = text[:here] + bytes([random.randrange(256)]) + text[here + 1 :]
            case _:
                text = text[:here] + text[here:there][:50] * random.randint(2, 200) + text[there:]
    return text


def mangled_json(text: bytes, random: Random) -> bytes:
    """A JSON document with one to three members that are something else, are gone, or are there under another name."""
    body = json.loads(text)
    for _ in range(random.randint(1, 3)):
        inside = body
        while isinstance(inside, dict | list) and inside:
            member: Any = random.choice(list(inside) if isinstance(inside, dict) else range(len(inside)))
            if isinstance(inside[member], dict | list) and inside[member] and random.random() < 0.6:
                inside = inside[member]
                continue
            match random.randrange(6):
                case 0:
                    del inside[member]
                case 1 if isinstance(inside, dict):
                    inside[str(random.choice(VALUES))[:100]] = inside.pop(member)
                case _:
                    inside[member] = copy.deepcopy(random.choice(VALUES))
            break
    return json.dumps(body).encode()


def mangled_either(text: bytes, random: Random) -> bytes:
    """A JSON document mangled as JSON or, once in three times, as bytes."""
    return mangled(text, random) if random.random() < 0.3 else mangled_json(text, random)


def some_mangled(texts: Sequence[bytes], number: int, seed: int) -> Iterator[bytes]:
    """So many manglings of the texts, which follow from a seed."""
    random = Random(seed)
    return (mangled(random.choice(texts), random) for _ in range(number))


@contextmanager
def in_time(seconds: float = 5.0) -> Iterator[None]:
    """Fail if what is done takes more processor time of this process than that."""
    began = time.process_time()
    yield
    spent = time.process_time() - began
    assert spent <= seconds, f"{spent:.1f} s of processor time"

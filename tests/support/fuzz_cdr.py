"""Decodes any number of randomly damaged messages.

``python -m tests.support.fuzz_cdr --cases 1000000 --seed 1``. The result is a message or a
`DecodeError`, and the generated decoder has to agree with the plain one. A failing case is printed
with its seed, type and bytes.
"""

from __future__ import annotations

import argparse
import random
from typing import TYPE_CHECKING, Any

from aionode.engine.wire import cdr
from aionode.engine.wire.cdr._fallback_decoder import decode_slowly
from aionode.errors import DecodeError
from tests.support.samples import all_samples

if TYPE_CHECKING:
    from aionode.message import Message

__all__ = ["FuzzError", "damaged", "fuzz"]

TELLING = (0, 1, 2, 3, 4, 5, 8, 127, 128, 192, 224, 237, 254, 255)
"""Bytes that make lengths, signs and UTF-8 go wrong."""


class FuzzError(AssertionError):
    """The two decoders disagree, or one raised an undocumented error."""


def damaged(data: bytes, source: random.Random) -> bytes:
    """Return the damaged bytes of a message."""
    broken = bytearray(data)
    for _ in range(source.randint(1, 4)):
        place = source.randrange(len(broken)) if broken else 0
        what = source.randrange(5)
        if what == 0:
            del broken[place:]
        elif what == 1:
            broken[place : place + 1] = bytes((source.choice(TELLING),))
        elif what == 2:
            word = place & ~3
            length = source.choice((0, 1, 0xFF, 0xFFFF, 2**31 - 1, 2**31, 2**32 - 1))
            broken[word : word + 4] = length.to_bytes(4, "little")
        elif what == 3:
            broken[place:place] = source.randbytes(source.randint(1, 9))
        else:
            del broken[place : place + source.randint(1, 9)]
    return bytes(broken)


def outcome(decode: Any, cls: type[Message], data: Any) -> bytes | str:
    """Return the result of decoding, in a form that is comparable even with NaN."""
    try:
        return cdr.encode(decode(cls, data))
    except DecodeError as error:
        return str(error)


def fuzz(cases: int, seed: int) -> int:
    """Decode `cases` damaged messages; return how many of them were still valid.

    Raises:
        FuzzError: One was not decoded correctly.
    """
    source = random.Random(seed)  # noqa: S311 - not for secrets: the same again for the same seed
    samples = all_samples()
    readable = 0
    for case in range(cases):
        sample = source.choice(samples)
        cls = type(sample.message)
        data = damaged(sample.data, source)
        try:
            results = [
                outcome(cdr.decode, cls, data),
                outcome(cdr.decode, cls, memoryview(data)),
                outcome(decode_slowly, cls, memoryview(data)),
            ]
        except Exception as error:
            raise FuzzError(f"seed {seed}, case {case}: {sample.name} {data.hex()}") from error
        if len(set(results)) > 1:
            raise FuzzError(f"seed {seed}, case {case}: {sample.name} {data.hex()}: {results}")
        readable += isinstance(results[0], bytes)
    return readable


def main() -> None:
    """Run as a program."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=random.SystemRandom().randrange(2**32))
    options = parser.parse_args()
    readable = fuzz(options.cases, options.seed)
    print(  # noqa: T201 - a program
        f"{options.cases} damaged messages, seed {options.seed}: "
        f"{readable} could be read, all others were refused"
    )


if __name__ == "__main__":
    main()

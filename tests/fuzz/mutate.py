"""Mutates good inputs, and measures each: ``python -m tests.fuzz.mutate TARGET… --inputs 10000``.

An input fails its target that makes the parser raise what it does not document, takes longer than
2 s, or takes 300 MB more memory than there was before it. It is written to ``.fuzz/``, and can be
given to ``python -m tests.fuzz TARGET --input FILE``.
"""

from __future__ import annotations

import argparse
import gc
import random
import sys
import traceback
from pathlib import Path
from typing import NamedTuple

from aionode.clock import perf_ns
from tests.fuzz.targets import TARGETS, Target

FOLDER = Path(".fuzz")
SLOWEST_S = 2.0
MAX_BYTES = 300 << 20
PEAK = Path("/proc/self/clear_refs")
STATUS = Path("/proc/self/status")
STRANGE = (
    b"\0", b"\xff", b"\xff" * 4, b"\xff" * 8, bytes(7) + b"\x80", bytes(4), bytes(8),
    b"\0\0\0\x80", b"\0\0\0\x40", b"\1" + bytes(7), b"9" * 30, b"-1", b"1e999", b"\xed\xa0\x80",
    b"\n", b"'", b'"', b"\\", b"[" * 300, b"{" * 300, b"(" * 300,
)  # fmt: skip
"""Replacements for numbers, lengths and brackets."""


class Result(NamedTuple):
    """The worst of all inputs of one target."""

    inputs: int
    failures: int
    slowest_s: float
    most_bytes: int


def mutated(dice: random.Random, target: Target, seeds: list[bytes]) -> bytes:
    """Return a good input with a few things changed."""
    data = bytearray(dice.choice(seeds))
    words = [*STRANGE, *(word.encode() for word in target.words)]
    for _ in range(dice.choice((1, 1, 1, 2, 3, 8))):
        at = dice.randrange(len(data) + 1)
        kind = dice.randrange(6)
        if kind == 0 and at < len(data):
            data[at] = dice.randrange(256)
        elif kind == 1 and at < len(data):
            data[at] ^= 1 << dice.randrange(8)
        elif kind == 2:
            word = dice.choice(words)
            data[at : at + len(word)] = word
        elif kind == 3:
            data[at:at] = dice.choice(words) * dice.choice((1, 1, 1, 2, 50))
        elif kind == 4:
            del data[at : at + dice.choice((1, 2, 8, 60, len(data)))]
        else:
            other = dice.choice(seeds)
            begin = dice.randrange(len(other) + 1)
            data[at:at] = other[begin : begin + dice.choice((4, 20, 200))]
    return bytes(data)


def memory(what: str) -> int:
    """Return a size that Linux keeps of this process, in bytes."""
    lines = STATUS.read_text(encoding="ascii").splitlines()
    return next(int(line.split()[1]) << 10 for line in lines if line.startswith(f"{what}:"))


def measured(target: Target, data: bytes) -> tuple[str, float, int]:
    """Return what went wrong, the seconds, and the bytes that were taken at most."""
    PEAK.write_text("5", encoding="ascii")  # the peak is that of this input
    before = memory("VmRSS")
    began = perf_ns()
    wrong = ""
    try:
        target.run(data)
    except Exception:  # noqa: BLE001 - each of them is a finding
        wrong = traceback.format_exc()
    return wrong, (perf_ns() - began) / 1e9, memory("VmHWM") - before


def run(target: Target, count: int, seed: int) -> Result:
    """Try so many inputs, and print those that fail."""
    dice = random.Random(f"{target.name} {seed}")  # noqa: S311 - the same inputs again
    seeds = target.seeds()
    failures, slowest, most = 0, 0.0, 0
    for number in range(count):
        data = mutated(dice, target, seeds)
        wrong, seconds, taken = measured(target, data)
        slowest, most = max(slowest, seconds), max(most, taken)
        if wrong or seconds > SLOWEST_S or taken > MAX_BYTES:
            failures += 1
            FOLDER.mkdir(exist_ok=True)
            file = FOLDER / f"{target.name}-{seed}-{number}"
            file.write_bytes(data)
            print(f"{file}: {seconds:.2f} s, {taken >> 20} MB\n{wrong}", flush=True)  # noqa: T201 - a program
        if number % 1000 == 0:
            gc.collect()
    return Result(count, failures, slowest, most)


def main() -> None:
    """Run as a program."""
    parser = argparse.ArgumentParser(description="Mutates good inputs, and measures each.")
    parser.add_argument("targets", nargs="*", help="which (default: all)")
    parser.add_argument("--inputs", type=int, default=10_000, help="for each target (10000)")
    parser.add_argument("--seed", type=int, default=1, help="other inputs for another number (1)")
    options = parser.parse_args()
    failed = []
    for name in options.targets or list(TARGETS):
        result = run(TARGETS[name], options.inputs, options.seed)
        print(  # noqa: T201 - a program
            f"{name}: {result.inputs} inputs, {result.failures} failed, slowest "
            f"{result.slowest_s:.2f} s, {result.most_bytes >> 20} MB at most",
            flush=True,
        )
        failed += [name] * bool(result.failures)
    sys.exit(f"failed: {', '.join(failed)}" if failed else 0)


if __name__ == "__main__":
    main()

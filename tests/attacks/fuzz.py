"""Sends well-formed lies to a node with a true peer: ``python -m tests.attacks.fuzz --seconds 60``.

The node has to stay alive and receive from its true peer, with a responsive loop and constant
memory. Each round takes at most ten seconds and has new processes, one kind of lie and a seed;
``--seed N --kinds tokens`` repeats one. ``--planted submessages`` restores a former defect of
aionode, which has to be found.
"""

from __future__ import annotations

import argparse
import asyncio
import secrets
import sys
from itertools import cycle

import msgspec

from tests.attacks.cases import clouds, pair
from tests.attacks.harness import Attack, Found
from tests.attacks.lies import LIES
from tests.attacks.planted import DEFECTS
from tests.faults.roles import Role

__all__ = ["fuzz"]

ROUND_S = 10.0
MIN_S = 5.0

GROWS = 4.0
"""How many times as much memory as before a node may take: it keeps what is well-formed."""

STANDS_S = 0.5
"""How long a loop may stand still: a fuzzer runs on machines that do other things."""


def victims(planted: tuple[str, ...]) -> tuple[Role, ...]:
    """Return a target node, which does everything that lies are about, and its true peer."""
    talker, listener = pair(publish=clouds(), parameter_size=1000, curious=True)
    if not planted:
        return talker, listener
    return with_defects(talker, planted), with_defects(listener, planted)


def with_defects(role: Role, planted: tuple[str, ...]) -> Role:
    """Return a role whose process has some planted defects."""
    words = ("-m", "tests.attacks.planted", *planted, msgspec.json.encode(role).decode())
    return msgspec.structs.replace(role, command=words)


def one_round(
    seed: int, kinds: list[str], planted: tuple[str, ...], seconds: float
) -> list[str] | None:
    """Lie for some time; return what went wrong, or None if a busy machine started nothing."""
    attack = Attack(
        f"lies with seed {seed}",
        "member",
        "lie_randomly",
        victims(planted),
        seconds,
        env={"AIONODE_LIES": " ".join((str(seed), *kinds))},
    )
    ((_, found),) = asyncio.run(attack.run(asyncio.Semaphore(1)))
    if not isinstance(found, Found):
        return [repr(found)]
    if not found.tries:
        return None
    gap_ms, grown = 1000 * found.outcome.own_gap_s, found.memory_most_bytes >> 20
    print(f"{found.tries} lies, longest gap {gap_ms:.0f} ms, most memory {grown} MiB", flush=True)  # noqa: T201 - a program
    return found.broken(STANDS_S, GROWS)


def fuzz(
    seconds: float, kinds: list[str], planted: tuple[str, ...] = (), seed: int | None = None
) -> str:
    """Run rounds of each kind in turn; return the defects found.

    Args:
        seconds: The total duration.
        kinds: The kinds of lies: names in `LIES`.
        planted: The planted defects: names in `DEFECTS`.
        seed: The seed of each round; by default each has its own.
    """
    round_s = min(max(seconds / len(kinds), MIN_S), ROUND_S)
    for number, kind in enumerate(cycle(kinds)):
        chosen = secrets.randbelow(10**6) if seed is None else seed
        problems = one_round(chosen, [kind], planted, round_s)
        told = "did not begin" if problems is None else "; ".join(problems) or "held"
        print(f"{kind}, seed {chosen}: {told}", flush=True)  # noqa: T201 - a program
        if problems:
            return f"--kinds {kind} --seed {chosen}: {'; '.join(problems)}"
        if (number + 1) * round_s >= seconds and (seed is None or number + 1 >= len(kinds)):
            break
    return ""


def main() -> None:
    """Run as a program."""
    parser = argparse.ArgumentParser(description="Well-formed lies to a node.")
    parser.add_argument("--seconds", type=float, default=60.0, help="how long (60)")
    parser.add_argument("--kinds", nargs="+", choices=LIES, default=list(LIES), help="which lies")
    parser.add_argument("--seed", type=int, help="repeat one round")
    parser.add_argument("--planted", nargs="+", choices=DEFECTS, default=[], help="defects to find")
    options = parser.parse_args()
    found = fuzz(options.seconds, options.kinds, tuple(options.planted), options.seed)
    sys.exit(found or 0)


if __name__ == "__main__":
    main()

"""Nothing can be sent while Zenoh drops the tokens of a lost connection."""

from __future__ import annotations

import time

from tests.zenoh_defects._support import endpoint, listening, process, session, until

COUNT = 4000

ANNOUNCES = """
with session(dialling(sys.argv[1])) as one:
    tokens = [one.liveliness().declare_token(f"t/{number}") for number in range(int(sys.argv[2]))]
    print("announced", flush=True)
    threading.Event().wait()
"""


def test_a_put_waits_while_tokens_are_dropped() -> None:
    """4000 of them take 150 ms, whereas as many separate changes take a tenth of that."""
    there = endpoint()
    changes: list[object] = []
    with session(listening(there)) as one:
        watcher = one.liveliness().declare_subscriber("t/**", changes.append)
        with process(ANNOUNCES, there, str(COUNT)) as running:
            assert until(lambda: len(changes) == COUNT)
            running.kill()
            longest_s = 0.0
            while len(changes) < 2 * COUNT:
                began_s = time.perf_counter()
                one.put("a", b"")
                longest_s = max(longest_s, time.perf_counter() - began_s)

        assert longest_s > 0.08
        watcher.undeclare()

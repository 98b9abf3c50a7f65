"""A late reader that reads nothing blocks the publisher whose history it has requested."""

from __future__ import annotations

from zenoh import ext

from tests.zenoh_defects._support import (
    WAIT,
    endpoint,
    is_frozen,
    listening,
    process,
    session,
    stands_still,
    until,
)

ASKS = """
with session(dialling(sys.argv[1])) as one:
    print("open", flush=True)
    sys.stdin.readline()
    one.get(
        "a/@adv/**?_anyke;_max=1000",
        zenoh.handlers.Callback(
            lambda _: os.kill(os.getpid(), signal.SIGSTOP), indirect=False
        ),
        consolidation=zenoh.ConsolidationMode.NONE,
    )
    threading.Event().wait()
"""


def test_a_put_waits_for_a_reader_of_the_history_that_reads_nothing() -> None:
    """The answer is more than sockets and queues hold, and the reader freezes at its first part."""
    there = endpoint()
    settings = listening(there) | {"timestamping/enabled": True, WAIT: 60_000_000}
    with session(settings) as one, process(ASKS, there) as running:
        publisher = ext.declare_advanced_publisher(one, "a", cache=ext.CacheConfig(1000))
        for _ in range(400):
            publisher.put(bytes(60_000))
        assert running.stdin is not None
        running.stdin.write("\n")
        running.stdin.flush()
        assert until(lambda: is_frozen(running))

        assert stands_still(lambda: publisher.put(b""))
        running.kill()

"""A reader never releases the shared memory of a peer that has ended."""

from __future__ import annotations

from pathlib import Path

import zenoh

from tests.zenoh_defects._support import endpoint, listening, process, session, until

SHARED = {"transport/shared_memory/enabled": True, "transport/shared_memory/mode": "init"}

PUBLISHES = f"""
with session(dialling(sys.argv[1]) | {SHARED}) as one:
    publisher = one.declare_publisher("a")
    until(lambda: publisher.matching_status.matching)
    print("matched", flush=True)
    while True:
        publisher.put(bytes(1_000_000))
        time.sleep(0.05)
"""


def segments() -> int:
    """Return how many pieces of shared memory this process has mapped."""
    return Path("/proc/self/maps").read_text(encoding="utf-8").count("/dev/shm/")  # noqa: S108


def test_each_restart_of_a_publisher_leaves_more_shared_memory() -> None:
    """It is looked at while no publisher runs."""
    there = endpoint()
    left = []
    came: list[int] = []

    def take(sample: zenoh.Sample) -> None:
        came.append(len(sample.payload.to_bytes()))

    with session(listening(there) | SHARED) as one:
        reader = one.declare_subscriber("a", take)
        for _ in range(3):
            came.clear()
            with process(PUBLISHES, there):
                assert until(lambda: len(came) > 5)
            assert until(lambda: not one.info.links())
            left.append(segments())
        reader.undeclare()

    assert left[0] < left[1] < left[2]

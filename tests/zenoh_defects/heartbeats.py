"""Undeclaring a publisher with heartbeats may stop all Python threads of its process."""

from __future__ import annotations

import select
import time

from tests.zenoh_defects._support import process

UNDECLARES = """
from zenoh import ext
one = opened({"timestamping/enabled": True})
heard = one.declare_subscriber(
    "a/@adv/**", zenoh.handlers.Callback(lambda _: sum(range(20_000)), indirect=False)
)

def tell():
    while True:
        os.write(1, b"alive\\n")
        time.sleep(0.02)

threading.Thread(target=tell, daemon=True).start()
while True:
    publishers = [
        ext.declare_advanced_publisher(
            one,
            "a",
            cache=ext.CacheConfig(10),
            sample_miss_detection=ext.MissDetectionConfig(heartbeat=0.001),
        )
        for _ in range(8)
    ]
    for publisher in publishers:
        publisher.put(b"")
    time.sleep(0.01)
    for publisher in publishers:
        publisher.undeclare()
"""


def test_no_thread_runs_while_a_publisher_with_heartbeats_is_undeclared() -> None:
    """Undeclaring waits for the task that sends them, which waits for the GIL in a callback."""
    with process(UNDECLARES) as running:
        assert running.stdout is not None
        ends_s = time.perf_counter() + 4.0
        while time.perf_counter() < ends_s:
            if not select.select([running.stdout], [], [], 1.0)[0]:
                return  # no thread has run for a second
            running.stdout.buffer.read1()  # type: ignore[attr-defined]  # a pipe

    raise AssertionError("some thread ran all the time")

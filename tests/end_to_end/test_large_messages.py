"""Large messages between processes of one host, over Zenoh, leave nothing behind in the reader."""

from __future__ import annotations

import sys
import time  # noqa: TID251  # waits for other processes
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.end_to_end.process import Process

LARGE_BYTES = "300000"
WRITERS = 3


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
def test_a_reader_keeps_nothing_of_publishers_that_have_ended(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Zenoh keeps a peer's shared memory forever: two descriptors for each restart of it."""
    monkeypatch.setenv("AIONODE_LINK", "off")
    with Process("tests/end_to_end/flow_member.py", "lister", "large", "10") as reader:
        reader.expect("open")
        send_large(reader, 1)  # what comes with the first one stays
        before = descriptors(reader.pid)
        for number in range(2, 2 + WRITERS):
            send_large(reader, number)

        assert segments(reader.pid) == 0
        until(lambda: descriptors(reader.pid) <= before + 1)


def send_large(reader: Process, number: int) -> None:
    """Have a process send ten large messages, end it, and then start the next one."""
    with Process("tests/end_to_end/flow_member.py", "sender", "large", "10", LARGE_BYTES) as writer:
        until(lambda: int(reader.ask("count", "count")) == number * 10)
        writer.stop()


def until(holds: Callable[[], bool]) -> None:
    """Wait until something holds."""
    ends_s = time.monotonic() + 50.0
    while not holds():
        assert time.monotonic() < ends_s
        time.sleep(0.02)


def descriptors(pid: int) -> int:
    """Return how many descriptors a process has open."""
    return len(list(Path(f"/proc/{pid}/fd").iterdir()))


def segments(pid: int) -> int:
    """Return how many mappings of Zenoh's shared memory a process has."""
    maps = Path(f"/proc/{pid}/maps").read_text(encoding="utf-8").splitlines()
    return sum(line.rstrip().endswith((".zenoh", ".zenoh (deleted)")) for line in maps)

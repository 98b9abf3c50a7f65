"""A client that sends garbage to a gateway: ``python garbage.py PORT SECONDS RATE KIND``.

It offers so many frames a second, of a kind of `KINDS`, and connects again when it is disconnected.
What the gateway does not read is not sent: then it is the client that has to wait. It prints JSON:
how many frames it offered and how many left, and how often it was disconnected. It has its frames
made beforehand, and sends many at once.
"""

from __future__ import annotations

import contextlib
import json
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[3]))  # it is run as a program

from benchmarks.gateway_parts.reader import MASK, frame_of, opened

TICK_S = 0.01
PING = b"\x89\x80" + MASK

KINDS = {
    "no JSON": frame_of("{garbage"),
    "no op": frame_of('{"op": "nonsense"}'),
    "refused": frame_of('{"op": "publish", "topic": "/refused", "type": "std_msgs/Empty"}'),
    "pings": PING,
}


def main(port: int, seconds: float, rate_hz: float, kind: str) -> None:
    """Send for some seconds."""
    batch = KINDS[kind] * round(rate_hz * TICK_S)
    size = len(KINDS[kind])
    offered = sent_bytes = disconnected = 0
    connection, waiting = None, b""
    end_s = due_s = time.monotonic()
    end_s += seconds
    print("begun", flush=True)
    while due_s < end_s:
        time.sleep(max(due_s - time.monotonic(), 0.0))
        due_s += TICK_S
        if connection is None:
            connection, waiting = opened(port), b""
            connection.setblocking(False)
        offered += len(batch) // size
        waiting = waiting or batch  # what was not read is not offered once more
        try:
            with contextlib.suppress(BlockingIOError):
                while connection.recv(1 << 16):
                    pass
                raise ConnectionResetError
            with contextlib.suppress(BlockingIOError):
                left = connection.send(waiting)
                sent_bytes += left
                waiting = waiting[left:]
        except OSError:
            disconnected += 1
            connection.close()
            connection = None
    print(json.dumps([offered, sent_bytes // size, disconnected]), flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]), float(sys.argv[2]), float(sys.argv[3]), sys.argv[4])

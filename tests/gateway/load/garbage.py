"""A client that sends garbage to a gateway: ``python garbage.py PORT SECONDS RATE KIND``.

It sends a number of frames per second, of one of `KINDS`, and reconnects when it is disconnected.
Frames that the gateway does not read are not sent, so the client has to wait. It prints JSON: the
numbers of frames planned and sent, and of disconnections. Its frames are prepared in advance and
sent many at a time.
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
        waiting = waiting or batch  # unread frames are not sent again
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

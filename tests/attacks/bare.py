"""A Zenoh session without aionode during an attack, to see its effect on Zenoh itself.

``python -m tests.attacks.bare SECONDS`` publishes 100 messages a second, and subscribes to all
liveliness tokens without processing them, as any program with a graph does. It prints ``begun``;
and at its end the longest ``put`` in ms, its memory at the start, and its peak since, in bytes.
"""

from __future__ import annotations

import os
import sys
import time
from typing import Any

import zenoh  # as any program without aionode has it

from tests.attacks.liar import pace
from tests.faults.process import CoreWait
from tests.support.peers import raw_session

__all__: list[str] = []


WARM_UP_S = 0.5
"""How long it publishes before its memory is measured: what every session takes does not count."""


def memory() -> int:
    """Return the peak memory of this process, in bytes."""
    with open("/proc/self/status", encoding="ascii") as lines:  # noqa: PTH123  # as short
        return next(int(line.split()[1]) * 1024 for line in lines if line.startswith("VmHWM:"))


def main() -> None:
    """Run as a program."""
    seconds = float(sys.argv[1])
    with raw_session() as session:
        nothing: Any = zenoh.handlers.Callback(lambda _: None, indirect=False)
        session.liveliness().declare_subscriber("@ros2_lv/**", nothing, history=True)
        session.liveliness().declare_subscriber("@aionode/**", nothing, history=True)
        publisher = session.declare_publisher(
            "bare", congestion_control=zenoh.CongestionControl.DROP
        )
        for _ in pace(WARM_UP_S, 100):
            publisher.put(b"x")
        before, longest_s, core_wait = memory(), 0.0, CoreWait()
        print("begun", flush=True)  # noqa: T201 - a program
        for _ in pace(seconds, 100):
            core_wait.own()
            core_wait.largest_of_others()
            began_s = time.monotonic()
            publisher.put(b"x")
            took_s = time.monotonic() - began_s - core_wait.own()
            if took_s > longest_s:
                longest_s = max(longest_s, took_s - core_wait.largest_of_others())
        print(f"bare {1000 * longest_s:.0f} {before} {memory()}", flush=True)  # noqa: T201 - a program
        os._exit(0)


if __name__ == "__main__":
    main()

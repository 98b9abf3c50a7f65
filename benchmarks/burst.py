"""How many small messages per second arrive from another process, compared with Zenoh alone.

One process sends bursts as fast as it can; this one counts those that arrive in one callback on its
event loop: with aionode (a `Node`, including decoding, queue and statistics) and with zenoh-python
and one `call_soon_threadsafe` per message. Both are measured in turns in the same run. The rate is
that of arrival, from the first message of a burst to its last.

Run it with ``python benchmarks/burst.py``. It prints a table and writes ``burst.json`` to
``benchmarks/results/``; ``--quick`` takes a fifth of the time, for a first look.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import statistics
import subprocess
import sys
import time
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

import zenoh
from roundtrip import (  # type: ignore[import-not-found]  # beside this file when it is run
    ATTACHMENT,
    PORTS,
    RAW_PAYLOAD,
    RAW_PORT,
    loop_factory,
    machine,
    raw_session,
)

from aionode import Context, Node
from aionode.engine.wire import _attachment as attachment
from aionode.engine.wire import cdr
from aionode.engine.wire._key_expression import data_key
from aionode.engine.wire.typehash import type_hash
from aionode.interfaces.std_msgs.msg import String

if TYPE_CHECKING:
    from collections.abc import Iterator

BURST: Final = 50_000
ROUNDS: Final = 7
DEPTH: Final = BURST * 2
RESULTS: Final = Path(__file__).parent / "results"
PAYLOAD: Final = "x" * 23  # 32 bytes of CDR
TYPE_KEY: Final = data_key(0, "/burst", "std_msgs/msg/String", type_hash(String))


@dataclass(frozen=True)
class Row:
    """Messages per second of one kind on one loop, and how many of them arrived."""

    loop: str
    kind: str
    messages: int
    per_second: int
    arrived: float


class Counter:
    """Counts messages, and detects the last one of a burst."""

    def __init__(self) -> None:
        self.count = 0
        self.first_ns = 0
        self.last_ns = 0

    def take(self, _: object = None) -> None:
        """Count one message."""
        self.last_ns = time.perf_counter_ns()
        if self.count == 0:
            self.first_ns = self.last_ns
        self.count += 1

    def reset(self) -> None:
        """Start the next burst."""
        self.count = 0


class RawReceiver(Counter):
    """Zenoh-python, and `call_soon_threadsafe` for each message."""

    def __init__(self, session: zenoh.Session) -> None:
        super().__init__()
        self._loop = asyncio.get_running_loop()
        self._subscriber = session.declare_subscriber("burst", self._on_sample)

    def _on_sample(self, sample: zenoh.Sample) -> None:
        self._loop.call_soon_threadsafe(self._read, sample)

    def _read(self, sample: zenoh.Sample) -> None:
        sample.payload.to_bytes()
        self.take()


def send(port: int, key: str, payload: bytes, extra: bytes) -> None:
    """Send one burst for each line on stdin, without an event loop.

    The sender is the same for both kinds, so that only receiving differs. It uses BLOCK, so that
    everything is received.
    """
    config = zenoh.Config()
    for path, value in {
        "listen/endpoints": ["tcp/127.0.0.1:0"],
        "connect/endpoints": [f"tcp/127.0.0.1:{port}"],
        "scouting/multicast/enabled": False,
        "timestamping/enabled": True,
    }.items():
        config.insert_json5(path, json.dumps(value))
    session = zenoh.open(config)
    publisher = session.declare_publisher(key, congestion_control=zenoh.CongestionControl.BLOCK)
    while not publisher.matching_status.matching:  # type: ignore[attr-defined]  # no bool
        time.sleep(0.01)
    print("ready", flush=True)
    for line in sys.stdin:
        for _ in range(int(line)):
            publisher.put(payload, attachment=extra)
        print("sent", flush=True)
    session.close()


@contextmanager
def sender(kind: str) -> Iterator[subprocess.Popen[str]]:
    """Run the sending process of `kind` within the block."""
    with subprocess.Popen(  # noqa: S603  # this file
        [sys.executable, __file__, "--send", kind],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    ) as process:
        assert process.stdin is not None  # noqa: S101  # it is a pipe
        try:
            yield process
        finally:
            process.stdin.close()


def line_of(process: subprocess.Popen[str]) -> str:
    """Return the next line of a process."""
    assert process.stdout is not None  # noqa: S101  # it is a pipe
    return process.stdout.readline()


async def burst(process: subprocess.Popen[str], receiver: Counter, count: int) -> float:
    """Let a burst be sent; return the rate of arrival in messages per second."""
    receiver.reset()
    assert process.stdin is not None  # noqa: S101  # it is a pipe
    process.stdin.write(f"{count}\n")
    process.stdin.flush()
    await asyncio.to_thread(line_of, process)
    quiet = 0
    while receiver.count < count and quiet < 20:  # half a second without messages
        before = receiver.count
        await asyncio.sleep(0.025)
        quiet = quiet + 1 if receiver.count == before else 0
    return receiver.count / max(receiver.last_ns - receiver.first_ns, 1) * 1e9


async def measure(loop: str, count: int, rounds: int) -> list[Row]:
    """Return one row for each kind."""
    session = await asyncio.to_thread(raw_session, listen=True)
    async with (
        Context(domain_id=0) as context,
        Node("burst", context=context, start_parameter_services=False, enable_rosout=False) as node,
    ):
        raw, ours = RawReceiver(session), Counter()
        node.create_subscription(String, "burst", ours.take, DEPTH)
        receivers: dict[str, Counter] = {"zenoh": raw, "aionode": ours}
        rates: dict[str, list[float]] = {kind: [] for kind in receivers}
        arrived = dict.fromkeys(receivers, 0)
        with sender("zenoh") as raw_sender, sender("aionode") as our_sender:
            senders = {"zenoh": raw_sender, "aionode": our_sender}
            for process in senders.values():
                await asyncio.to_thread(line_of, process)
            for number in range(rounds + 1):
                for kind, receiver in receivers.items():
                    rate = await burst(senders[kind], receiver, count)
                    if number:  # the first one is for warming up
                        rates[kind].append(rate)
                        arrived[kind] += receiver.count
    session.close()
    return [
        Row(
            loop,
            kind,
            count * rounds,
            int(statistics.median(rates[kind])),
            arrived[kind] / (count * rounds),
        )
        for kind in receivers
    ]


def main() -> None:
    """Measure on both loops, print the table and write the file."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="a fifth of the messages")
    parser.add_argument("--loop", choices=["asyncio", "uvloop"], help="only this event loop")
    parser.add_argument("--send", choices=["zenoh", "aionode"], help=argparse.SUPPRESS)
    args = parser.parse_args()
    os.environ["AIONODE_MEETING_PORTS"] = PORTS  # meet no other process
    os.environ["AIONODE_ROUTER_PORT"] = "18465"
    if args.send == "zenoh":
        send(RAW_PORT, "burst", RAW_PAYLOAD, ATTACHMENT)
        return
    if args.send == "aionode":
        extra = attachment.pack(1, 1, b"benchmark sender")
        send(int(PORTS.split(",")[0]), TYPE_KEY, cdr.encode(String(data=PAYLOAD)), extra)
        return
    count = BURST // 5 if args.quick else BURST
    rows: list[Row] = []
    for loop in [args.loop] if args.loop else ["asyncio", "uvloop"]:
        with asyncio.Runner(loop_factory=loop_factory(loop)) as runner:
            rows += runner.run(measure(loop, count, ROUNDS))
    print(f"{'loop':8} {'':8} {'messages/s':>11} {'arrived':>8}   bursts of {count} x 32 bytes")
    for row in rows:
        beside = next(r for r in rows if r.loop == row.loop and r.kind == "zenoh")
        ratio = f"  {row.per_second / beside.per_second:.2f} x zenoh" if row is not beside else ""
        print(f"{row.loop:8} {row.kind:8} {row.per_second:11,} {row.arrived:8.1%}{ratio}")
    RESULTS.mkdir(exist_ok=True)
    result = {**machine(), "burst": count, "rows": [asdict(row) for row in rows]}
    (RESULTS / "burst.json").write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()

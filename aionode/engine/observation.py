"""What a context reports about itself on request: the counts of its endpoints and callbacks.

Everything here is counted anyway. Nothing is collected, sent or computed before a tool asks, and
durations are sent as histograms, so that the tool computes the percentiles.
"""

from __future__ import annotations

import os
import platform
import socket
import sys
from functools import cache
from typing import TYPE_CHECKING, Any, Final

import msgspec

from aionode._process.processor_waits import WAITS
from aionode._version import __version__
from aionode.clock import perf_ns, process_ns

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

__all__ = [
    "DurationReport",
    "EntityReport",
    "NodeReport",
    "ProcessReport",
    "decoded",
    "encoded",
    "process_report",
    "unchanging",
]

MAX_REPORT: Final = 16 * 2**20
"""Maximum bytes of a report of another process."""

MAX_TEXT: Final = 300
"""Maximum characters of the command line of a process."""


class DurationReport(msgspec.Struct, array_like=True):
    """A histogram of durations.

    Attributes:
        buckets: How many durations there were, by the number of their bucket.
        max_ns: The longest, in nanoseconds.
    """

    buckets: dict[int, int] = {}
    max_ns: int = 0


class EntityReport(msgspec.Struct):
    """The counts of one endpoint, timer or action.

    Attributes:
        kind: ``publisher``, ``subscription``, ``service``, ``client``, ``timer`` or ``action
            server``.
        name: Its full name; empty for a timer.
        type_name: The name of its type; empty for a timer.
        callback: The name of its callback; empty if it has none.
        counts: The counts of its `stats`, by their names.
        durations: The durations of its `stats`, by their names.
    """

    kind: str
    name: str
    type_name: str
    callback: str
    counts: dict[str, int]
    durations: dict[str, DurationReport] = {}


class NodeReport(msgspec.Struct):
    """One node.

    Attributes:
        name: Its full name.
        is_running: Whether it calls callbacks.
        unfinished: How many callbacks have started and await something.
        entities: Its endpoints, timers and actions, without infrastructure.
    """

    name: str
    is_running: bool
    unfinished: int
    entities: list[EntityReport]


class ProcessReport(msgspec.Struct):
    """One context and its process.

    Attributes:
        participant: The id of the context in the graph, in hexadecimal.
        host: The name of the host.
        pid: The id of the process.
        program: The command line, shortened.
        version: The version of aionode.
        python: The version of Python.
        now_ns: The time of the report, by a clock of the process with an arbitrary start.
        cpu_ns: Processor time of the process, in nanoseconds.
        memory_bytes: Memory of the process that is in use; 0 if unknown.
        load: The load of the host over a minute; 0 if unknown.
        cores: The processors of the host.
        processor_waits: How many callbacks took too long because no processor was free.
        processor_waited_ns: How long these waited in total, in nanoseconds.
        dropped: How much input was dropped or refused, by reason: see `Context.dropped`.
        nodes: Its nodes.
    """

    participant: str
    host: str
    pid: int
    program: str
    version: str
    python: str
    now_ns: int
    cpu_ns: int
    memory_bytes: int
    load: float
    cores: int
    processor_waits: int
    processor_waited_ns: int
    dropped: dict[str, int]
    nodes: list[NodeReport]


@cache
def unchanging() -> dict[str, Any]:
    """Return what stays the same while the process runs, and takes a while to look up."""
    return {
        "host": socket.gethostname(),
        "program": " ".join(sys.argv)[:MAX_TEXT] or sys.executable,
        "version": __version__,
        "python": platform.python_version(),
        "cores": os.cpu_count() or 1,
    }


def process_report(
    participant: str, dropped: Mapping[str, int], reporters: Iterable[Callable[[], NodeReport]]
) -> ProcessReport:
    """Return the report of a context, whose nodes are reported by `reporters`."""
    return ProcessReport(
        participant=participant,
        pid=os.getpid(),
        now_ns=perf_ns(),
        cpu_ns=process_ns(),
        memory_bytes=memory_bytes(),
        load=os.getloadavg()[0] if hasattr(os, "getloadavg") else 0.0,
        processor_waits=WAITS.count,
        processor_waited_ns=WAITS.total_ns,
        dropped=dict(dropped),
        nodes=[report() for report in reporters],
        **unchanging(),
    )


def memory_bytes() -> int:
    """Return how much memory this process uses; 0 where that is unknown."""
    try:
        with open("/proc/self/statm", "rb") as file:  # noqa: PTH123  # no path is made of it
            return int(file.read(200).split()[1]) * os.sysconf("SC_PAGE_SIZE")
    except (OSError, ValueError, IndexError):
        return 0


ENCODER: Final = msgspec.msgpack.Encoder()
DECODER: Final = msgspec.msgpack.Decoder(ProcessReport)


def encoded(report: ProcessReport) -> bytes:
    """Return a report as bytes."""
    return ENCODER.encode(report)


def decoded(data: bytes) -> ProcessReport | None:
    """Return the report of another process; None if this version cannot read it."""
    if len(data) > MAX_REPORT:
        return None
    try:
        return DECODER.decode(data)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError):
        return None

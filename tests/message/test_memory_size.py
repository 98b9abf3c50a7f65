"""The memory that messages take."""

from __future__ import annotations

import gc
import tracemalloc
from typing import Any

import pytest

from aionode.engine.wire import cdr
from aionode.interfaces.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from aionode.interfaces.geometry_msgs.msg import PoseStamped, Twist
from aionode.interfaces.nav_msgs.msg import Path
from aionode.interfaces.sensor_msgs.msg import Image, LaserScan
from aionode.interfaces.std_msgs.msg import Header, Int32, String
from aionode.message.memory_size import memory_size

LARGE = [
    String(data="x" * 100_000),
    String(data="x" * 100_000 + "\N{SLEEPING SYMBOL}"),
    Image(data=bytes(100_000)),
    LaserScan(ranges=[1.0] * 50_000),
    Path(poses=[PoseStamped(header=Header(frame_id="map" * 10)) for _ in range(100)]),
    DiagnosticArray(
        status=[
            DiagnosticStatus(values=[KeyValue(key="k" * 100, value="v" * 100) for _ in range(20)])
            for _ in range(20)
        ]
    ),
]


@pytest.mark.parametrize("cls", [Int32, Twist])
def test_messages_of_fixed_size_are_not_measured(cls: Any) -> None:
    """A queue of them is bounded by its depth."""
    assert memory_size(cls) is None


@pytest.mark.parametrize("msg", LARGE, ids=[type(msg).__name__ for msg in LARGE])
def test_a_message_is_about_as_large_as_it_is_told(msg: Any) -> None:
    """Within a factor of 3; a string with a character above 65535 takes four bytes for each."""
    cls: Any = type(msg)
    size_of = memory_size(cls)
    assert size_of is not None
    payload = cdr.encode(msg)
    decode = cdr.decoder(cls)
    decode(payload)
    gc.collect()
    tracemalloc.start()
    try:
        decoded = decode(bytes(bytearray(payload)))
        taken, _ = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()

    assert taken / 3 < size_of(decoded) < taken * 3

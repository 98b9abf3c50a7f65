"""How fast messages are encoded and decoded, compared with rosbags in the same run.

For each message the four ways take turns many times, and the fastest turn of each counts: other
load only ever makes a turn slower. Ratios compare within one run; times depend on the machine. The
largest rows also say where the bytes of a decoded array are stored: in the data (a view), or in
separate memory (a copy).

Run it with ``python benchmarks/codec.py``. It prints a table and writes ``codec.json`` to
``benchmarks/results/``; ``--quick`` takes a tenth of the time, for a first look.
"""

from __future__ import annotations

import argparse
import gc
import json
import platform
import time
from dataclasses import asdict, dataclass
from importlib import metadata
from itertools import cycle
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from rosbags.typesys import Stores, get_typestore

from aionode.engine.wire import cdr
from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.geometry_msgs.msg import (
    Point,
    Pose,
    PoseArray,
    Quaternion,
    Transform,
    TransformStamped,
    Twist,
    Vector3,
)
from aionode.interfaces.nav_msgs.msg import Odometry
from aionode.interfaces.sensor_msgs.msg import (
    Image,
    Imu,
    JointState,
    LaserScan,
    PointCloud2,
    PointField,
)
from aionode.interfaces.std_msgs.msg import Header, String
from aionode.interfaces.tf2_msgs.msg import TFMessage
from aionode.message import Message, type_name

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

RESULTS: Final = Path(__file__).parent / "results"
TARGET: Final = 4.0
TARGETED: Final = ("String", "Twist", "Imu", "JointState")
TURNS: Final = 60
TURN_SECONDS: Final = 0.01


@dataclass(frozen=True)
class Row:
    """One message: its size, and what encoding and decoding take, in nanoseconds."""

    name: str
    size_bytes: int
    encode_ns: float
    rosbags_encode_ns: float
    decode_ns: float
    rosbags_decode_ns: float
    payload: str

    @property
    def encode_ratio(self) -> float:
        """How many times as fast as rosbags."""
        return self.rosbags_encode_ns / self.encode_ns

    @property
    def decode_ratio(self) -> float:
        """How many times as fast as rosbags."""
        return self.rosbags_decode_ns / self.decode_ns


def header(number: int = 0) -> Header:
    """Return a header as drivers create it."""
    return Header(stamp=Time(sec=1_700_000_000, nanosec=number), frame_id="base_link")


def subjects() -> dict[str, list[Message]]:
    """Return the messages to measure, by the name of their row."""
    rng = np.random.default_rng(1)
    covariance = rng.random(9)
    joints = [f"joint_{number}" for number in range(7)]
    imu = Imu(
        header=header(),
        orientation=Quaternion(x=0.1, y=0.2, z=0.3, w=0.9),
        orientation_covariance=covariance,
        angular_velocity=Vector3(x=0.1, y=0.2, z=0.3),
        angular_velocity_covariance=covariance,
        linear_acceleration=Vector3(x=0.1, y=0.2, z=9.8),
        linear_acceleration_covariance=covariance,
    )
    cloud = PointCloud2(
        header=header(),
        height=1,
        width=100_000,
        fields=[PointField(name=name, datatype=7, count=1) for name in "xyzi"],
        point_step=16,
        row_step=1_600_000,
        data=rng.bytes(1_600_000),
    )
    transform = Transform(translation=Vector3(x=0.5, y=1.5, z=2.5))
    return {
        "String": [String(data="Hello World: 1")],
        "String, another text each": [String(data=f"Hello World: {n}") for n in range(1000)],
        "Twist": [Twist(linear=Vector3(x=0.5), angular=Vector3(z=-1.25))],
        "Imu": [imu],
        "Imu, another frame each": [
            Imu(header=Header(frame_id=f"imu_{n}"), orientation_covariance=covariance)
            for n in range(1000)
        ],
        "JointState": [joint_state(joints)],
        "JointState, other names each": [
            joint_state([f"{name}_{n}" for name in joints]) for n in range(1000)
        ],
        "Odometry": [Odometry(header=header(), child_frame_id="odom")],
        "TFMessage of 5": [
            TFMessage(
                transforms=[
                    TransformStamped(
                        header=header(n), child_frame_id=f"link_{n}", transform=transform
                    )
                    for n in range(5)
                ]
            )
        ],
        "PoseArray of 100": [
            PoseArray(
                header=header(),
                poses=[Pose(position=Point(x=float(n), y=1.5)) for n in range(100)],
            )
        ],
        "LaserScan of 1080": [
            LaserScan(header=header(), ranges=rng.random(1080, np.float32), angle_max=1.5)
        ],
        "PointCloud2, 1.6 MB": [cloud],
        "Image, 6 MB": [
            Image(
                header=header(),
                height=1080,
                width=1920,
                encoding="rgb8",
                step=5760,
                data=rng.bytes(1080 * 5760),
            )
        ],
    }


def joint_state(names: list[str]) -> JointState:
    """Return the state of an arm."""
    values = np.linspace(0.0, 1.0, len(names))
    return JointState(header=header(), name=names, position=values, velocity=values, effort=values)


def turn(function: Callable[..., object], calls: Sequence[tuple[Any, ...]], repeats: int) -> float:
    """Return how long one of `repeats` calls takes, in nanoseconds."""
    source = cycle(calls)
    work = [next(source) for _ in range(repeats)]
    # Without packing and unpacking arguments, which would count as time of the function.
    if len(work[0]) == 1:
        single = [item for (item,) in work]
        start = time.perf_counter_ns()
        for item in single:
            function(item)
    else:
        start = time.perf_counter_ns()
        for first, second in work:
            function(first, second)
    return (time.perf_counter_ns() - start) / repeats


def measure(name: str, messages: list[Message], turns: int) -> Row:
    """Return the row of one message."""
    store = get_typestore(Stores.ROS2_JAZZY)
    cls = type(messages[0])
    typename = type_name(cls)
    encoded = [cdr.encode(message) for message in messages]
    theirs = [store.deserialize_cdr(data, typename) for data in encoded]
    for data, message in zip(encoded, theirs, strict=True):
        if bytes(store.serialize_cdr(message, typename)) != data:
            raise AssertionError(f"{name}: rosbags encodes it otherwise")

    ways: list[tuple[Callable[..., object], Sequence[tuple[Any, ...]]]] = [
        (cdr.encode, [(message,) for message in messages]),
        (store.serialize_cdr, [(message, typename) for message in theirs]),
        (cdr.decode, [(cls, data) for data in encoded]),
        (store.deserialize_cdr, [(data, typename) for data in encoded]),
    ]
    repeats = [
        max(1, int(TURN_SECONDS * 1e9 / turn(function, calls, 20))) for function, calls in ways
    ]
    best = [float("inf")] * len(ways)
    for _ in range(turns):
        for number, (function, calls) in enumerate(ways):
            best[number] = min(best[number], turn(function, calls, repeats[number]))
    encode, rosbags_encode, decode, rosbags_decode = best
    return Row(
        name=name,
        size_bytes=len(encoded[0]),
        encode_ns=encode,
        rosbags_encode_ns=rosbags_encode,
        decode_ns=decode,
        rosbags_decode_ns=rosbags_decode,
        payload=payload(cls, encoded[0]),
    )


def payload(cls: type[Message], data: bytes) -> str:
    """Return where the largest array of a decoded message is: in `data`, or copied."""
    message = cdr.decode(cls, data)
    values = (getattr(message, name) for name in message.__struct_fields__)
    large = [value for value in values if isinstance(value, np.ndarray | memoryview)]
    if not large:
        return ""
    largest = np.asarray(max(large, key=len))
    return "view" if np.shares_memory(largest, np.frombuffer(data, np.uint8)) else "copy"


def show(rows: list[Row]) -> None:
    """Print the table."""
    head = f"{'message':<30}{'bytes':>9} {'encode':>9} {'msg/s':>10} {'ratio':>6} "
    print(head + f"{'decode':>9} {'msg/s':>10} {'ratio':>6}  array")
    for row in rows:
        print(
            f"{row.name:<30}{row.size_bytes:>9} "
            f"{row.encode_ns:>6.0f} ns {1e9 / row.encode_ns:>10.0f} {row.encode_ratio:>6.1f} "
            f"{row.decode_ns:>6.0f} ns {1e9 / row.decode_ns:>10.0f} {row.decode_ratio:>6.1f}"
            f"  {row.payload}"
        )
    print("ratio: how many times as fast as rosbags in this run")
    for row in rows:
        worst = min(row.encode_ratio, row.decode_ratio)
        if row.name in TARGETED and worst < TARGET:
            print(f"{row.name}: {worst:.2f} times as fast as rosbags, {TARGET:g} is the target")


def main() -> None:
    """Measure, print, and write the JSON."""
    parser = argparse.ArgumentParser(description="Measure the codec beside rosbags.")
    parser.add_argument("--quick", action="store_true", help="a tenth of the time")
    turns = TURNS // 10 if parser.parse_args().quick else TURNS
    gc.collect()
    gc.freeze()
    rows = [measure(name, messages, turns) for name, messages in subjects().items()]
    show(rows)
    RESULTS.mkdir(exist_ok=True)
    report = {
        "what": "nanoseconds for one message, the fastest of several turns; ratios to rosbags",
        "python": platform.python_version(),
        "machine": platform.platform(),
        "versions": {name: metadata.version(name) for name in ("msgspec", "numpy", "rosbags")},
        "turns": turns,
        "rows": [
            asdict(row) | {"encode_ratio": row.encode_ratio, "decode_ratio": row.decode_ratio}
            for row in rows
        ],
    }
    (RESULTS / "codec.json").write_text(json.dumps(report, indent=2) + "\n")


if __name__ == "__main__":
    main()

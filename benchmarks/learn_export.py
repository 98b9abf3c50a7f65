"""How long an export of demonstrations takes, and how much memory.

::

    .venv/bin/python benchmarks/learn_export.py                        # a minute, raw
    .venv/bin/python benchmarks/learn_export.py --minutes 10 --jpeg    # ten minutes of JPEG
    .venv/bin/python benchmarks/learn_export.py --beside               # beside a recorder

Two cameras of 640 by 480 pixels at 30 Hz, joints at 100 Hz and commands at 30 Hz are converted by
default settings. It prints the time as a share of the recording's length, and the memory of the
process in the middle and at the end. With `--beside`, a robot of the same cameras, joints and
commands is recorded by `aionode bag record` meanwhile, and what it published is compared with what
is in the bag.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import Any

import numpy as np

from aionode import Node, bag, image
from aionode.bag import BagWriter, TopicInfo
from aionode.engine.wire import cdr
from aionode.interfaces.sensor_msgs.msg import Image, JointState
from aionode.interfaces.std_msgs.msg import Float64MultiArray
from aionode.learn import Contract, export
from tests.support.demonstrations import START_NS, contract, stamp

HEIGHT, WIDTH, CAMERAS = 480, 640, 2
PICTURES = 60
"""Different pictures, which are repeated: drawing each would take longer than its export."""


def pictures(*, jpeg: bool) -> list[Any]:
    """Return pictures of a moving gradient with noise."""
    random = np.random.default_rng(0)
    ramp = np.linspace(0, 200, WIDTH, dtype=np.uint8)
    found = []
    for number in range(PICTURES):
        pixels = np.tile(np.roll(ramp, number * 5), (HEIGHT, 1))[..., None].repeat(3, axis=2)
        pixels += random.integers(0, 20, pixels.shape, np.uint8)
        shown = image.from_numpy(pixels, "rgb8")
        found.append(image.compress(shown, "jpeg", quality=85) if jpeg else shown)
    return found


def contract_of(*, jpeg: bool) -> Contract:
    """Return the contract."""
    given = contract(CAMERAS).to_dict()
    for each in given["observations"][:CAMERAS]:
        each |= {"height": HEIGHT, "width": WIDTH}
        if jpeg:
            each["type"] = "sensor_msgs/msg/CompressedImage"
    return Contract.from_dict(given)


def record(path: Path, minutes: float, *, jpeg: bool) -> None:
    """Write the bag."""
    shown = pictures(jpeg=jpeg)
    state = JointState(name=["joint"], position=[0.0], velocity=[0.0])
    with BagWriter(path) as writer:
        ids = [
            writer.add_topic(TopicInfo(name=f"/camera{number}", type=contract_type(jpeg=jpeg)))
            for number in range(CAMERAS)
        ]
        joints = writer.add_topic(TopicInfo(name="/joint_states", type=JointState.__ros_type__))
        commands = writer.add_topic(TopicInfo(name="/command", type=Float64MultiArray.__ros_type__))
        for number in range(round(minutes * 60 * 300)):
            now = START_NS + number * 10**9 // 300
            if number % 3 == 0:
                state.position = [number / 1000]
                state.header.stamp = stamp(now)
                writer.write(joints, now, cdr.encode(state))
            if number % 10 == 0:
                writer.write(commands, now, cdr.encode(Float64MultiArray(data=[number / 1000])))
                picture = shown[number // 10 % PICTURES]
                picture.header.stamp = stamp(now)
                for camera in ids:
                    writer.write(camera, now, cdr.encode(picture))


async def publish(length_sec: float) -> None:
    """Be a robot of the same cameras, joints and commands, and print what was published."""
    shown = pictures(jpeg=False)
    published: Counter[str] = Counter()
    async with Node("robot") as node:
        cameras = [
            node.create_publisher(Image, f"/camera{number}", 10) for number in range(CAMERAS)
        ]
        joints = node.create_publisher(JointState, "/joint_states", 10)
        commands = node.create_publisher(Float64MultiArray, "/command", 10)
        publishers: tuple[Any, ...] = (*cameras, joints, commands)
        for publisher in publishers:
            await publisher.wait_for_subscribers()

        def send(publisher: Any, message: Any) -> None:
            publisher.publish(message)
            published[publisher.topic_name] += 1

        def show() -> None:
            picture = shown[published["/camera0"] % PICTURES]
            picture.header.stamp = node.get_clock().now().to_msg()
            for camera in cameras:
                send(camera, picture)
            send(commands, Float64MultiArray(data=[0.0]))

        def turn() -> None:
            state = JointState(name=["joint"], position=[0.0], velocity=[0.0])
            state.header.stamp = node.get_clock().now().to_msg()
            send(joints, state)

        timers = [node.create_timer(1 / 30, show), node.create_timer(1 / 100, turn)]
        await asyncio.sleep(length_sec)
        for timer in timers:
            timer.cancel()
        await asyncio.sleep(1)  # what is on its way arrives
    print(json.dumps(published))


@contextmanager
def recorded(folder: Path, length_sec: float) -> Iterator[None]:
    """Record a robot for some seconds inside the block, and print what became of its messages."""
    program = [sys.executable, "-m", "aionode", "bag", "record", "-a", "-o", str(folder / "beside")]
    environment = os.environ | {"ROS_DOMAIN_ID": "97"}
    with subprocess.Popen(  # noqa: S603  # our own program
        program, env=environment, stdout=subprocess.DEVNULL
    ) as recorder:
        try:
            with subprocess.Popen(  # noqa: S603  # our own program
                [sys.executable, __file__, "--robot", str(length_sec)],
                env=environment,
                stdout=subprocess.PIPE,
            ) as robot:
                yield
                told, _ = robot.communicate()
        finally:
            recorder.send_signal(signal.SIGINT)
    published = json.loads(told)
    with bag.open(folder / "beside") as opened:
        for name, count in published.items():
            print(f"{name}: {count} published, {opened.counts[name]} recorded")
        print(f"lost: {opened.losses or 'nothing'}")


def contract_type(*, jpeg: bool) -> str:
    """Return the type of the pictures."""
    return "sensor_msgs/msg/CompressedImage" if jpeg else "sensor_msgs/msg/Image"


def main() -> None:
    """Record, export, print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=1.0)
    parser.add_argument("--jpeg", action="store_true")
    parser.add_argument("--beside", action="store_true", help="a recorder at the same time")
    parser.add_argument("--robot", type=float, metavar="SEC", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.robot:
        asyncio.run(publish(arguments.robot))
        return
    folder = Path(tempfile.mkdtemp(prefix="learn_export"))
    try:
        record(folder / "run", arguments.minutes, jpeg=arguments.jpeg)
        memory: list[float] = []

        def noted(done: int, whole: int) -> None:
            if len(memory) < 10 * done // max(whole, 1):
                memory.append(resident_mb())

        beside = recorded(folder, arguments.minutes * 20) if arguments.beside else nullcontext()
        with beside:
            begun, used = time.perf_counter(), time.process_time()
            export(
                folder / "out",
                [folder / "run"],
                contract=contract_of(jpeg=arguments.jpeg),
                progress=noted,
            )
            took, used = time.perf_counter() - begun, time.process_time() - used
    finally:
        shutil.rmtree(folder)
    length = arguments.minutes * 60
    print(f"{length:.0f} s of {CAMERAS} cameras: {took:.1f} s, {took / length:.2f} of real time")
    print(f"processor time: {used:.1f} s, {used / length:.2f} of real time")
    print(f"memory by tenths of the work: {' '.join(f'{each:.0f}' for each in memory)} MB")
    print(f"at most: {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MB")


def resident_mb() -> float:
    """Return the memory of this process now."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * resource.getpagesize() / 1e6


if __name__ == "__main__":
    main()

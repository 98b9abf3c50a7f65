"""Bags of demonstrations in which each picture shows the joint angle at its time."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from aionode import image
from aionode.bag import BagWriter
from aionode.bag._writer import topic_info
from aionode.engine.wire import cdr
from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.sensor_msgs.msg import Image, JointState
from aionode.interfaces.std_msgs.msg import Float64MultiArray
from aionode.learn import Contract

Messages: TypeAlias = list[tuple[int, str, Any]]
"""The time of arrival in nanoseconds, the topic and the message of each."""

HEIGHT, WIDTH = 32, 128
START_NS = 1_800_000_000_000_000_000
SPEED = 0.5
"""Radians per second at most."""


def angle(sec: float) -> float:
    """Return the joint angle, which grows at a varying rate from 0 to 2.5 rad in 10 s."""
    return SPEED * 0.5 * (sec - float(np.sin(2 * sec)) / 2)


def picture(sec: float) -> Any:
    """Return a picture that is white on the left, as far as the joint has turned."""
    pixels = np.zeros((HEIGHT, WIDTH, 3), np.uint8)
    pixels[:, : column(angle(sec))] = 255
    return pixels


def column(angle_rad: float) -> int:
    """Return the column up to which a picture is white."""
    return min(round(angle_rad * 50), WIDTH)


def stamp(ns: int) -> Time:
    """Return a time as a message."""
    return Time(sec=ns // 10**9, nanosec=ns % 10**9)


def contract(cameras: int = 1, fps: int = 30, **changes: Any) -> Contract:
    """Return the contract of the demonstrations."""
    return Contract.from_dict(
        {
            "task": "turn the joint",
            "fps": fps,
            "robot": "arm",
            "observations": [
                {
                    "feature": f"observation.images.camera{number}",
                    "topic": f"/camera{number}",
                    "type": "sensor_msgs/msg/Image",
                    "image": "color",
                    "height": HEIGHT,
                    "width": WIDTH,
                }
                for number in range(cameras)
            ]
            + [
                {
                    "feature": "observation.state",
                    "topic": "/joint_states",
                    "type": "sensor_msgs/msg/JointState",
                    "fields": ["position.joint", "velocity.joint"],
                    "names": ["joint", "speed"],
                }
            ],
            "actions": [
                {
                    "feature": "action",
                    "topic": "/command",
                    "type": "std_msgs/msg/Float64MultiArray",
                    "fields": ["data.0"],
                    "names": ["joint"],
                    "stop": "zero",
                }
            ],
            **changes,
        }
    )


@dataclass
class Timing:
    """When a topic has messages.

    Attributes:
        rate_hz: Messages per second.
        phase_sec: The time of the first one.
        jitter_sec: Maximum deviation of each from its time.
        late_sec: How long after its stamp each arrives.
        gaps: Spans without messages, in seconds.
    """

    rate_hz: float
    phase_sec: float = 0.0
    jitter_sec: float = 0.0
    late_sec: float = 0.0
    gaps: Sequence[tuple[float, float]] = field(default_factory=tuple)

    def times(self, length_sec: float, seed: int = 0) -> list[float]:
        """Return the times of the messages, in seconds."""
        random = np.random.default_rng(seed)
        count = int((length_sec - self.phase_sec) * self.rate_hz)
        times = self.phase_sec + np.arange(count) / self.rate_hz
        times += random.uniform(-self.jitter_sec, self.jitter_sec, count)
        return [
            float(each)
            for each in times
            if not any(first <= each < last for first, last in self.gaps)
        ]


def demonstration(
    path: Path,
    *,
    length_sec: float = 2.0,
    cameras: Sequence[Timing] = (Timing(30, late_sec=0.008),),
    joints: Timing | None = Timing(100, phase_sec=0.001),  # noqa: B008  # never changed
    commands: Timing | None = Timing(30, phase_sec=0.004),  # noqa: B008  # never changed
    recorded_with: Contract | None = None,
    draw: Callable[[float], Any] = picture,
    wrap: Callable[[Image], Any] = lambda message: message,
    edit: Callable[[Messages], Messages] = lambda messages: messages,
    seed: int = 0,
    **metadata: str,
) -> Path:
    """Write the bag of a demonstration; `edit` may change what is recorded, in its order."""
    messages: Messages = []

    def add(topic: str, sec: float, late_sec: float, message: Any) -> None:
        messages.append((START_NS + round((sec + late_sec) * 1e9), topic, message))

    for number, timing in enumerate(cameras):
        for sec in timing.times(length_sec, seed + number):
            shown = image.from_numpy(draw(sec), "rgb8")
            shown.header.stamp = stamp(START_NS + round(sec * 1e9))
            add(f"/camera{number}", sec, timing.late_sec, wrap(shown))
    for sec in joints.times(length_sec, seed + 10) if joints else ():
        state = JointState(name=["joint"], position=[angle(sec)], velocity=[SPEED])
        state.header.stamp = stamp(START_NS + round(sec * 1e9))
        assert joints is not None
        add("/joint_states", sec, joints.late_sec, state)
    for sec in commands.times(length_sec, seed + 20) if commands else ():
        assert commands is not None
        add("/command", sec, commands.late_sec, Float64MultiArray(data=[angle(sec)]))
    custom = dict(metadata)
    if recorded_with is not None:
        custom["contract"] = json.dumps(recorded_with.to_dict())
    write_bag(path, edit(sorted(messages, key=lambda each: each[0])), custom)
    return path


def write_bag(path: Path, messages: Messages, metadata: dict[str, str] | None = None) -> None:
    """Write messages to a bag."""
    with BagWriter(path, custom_data=metadata or {}) as writer:
        ids: dict[tuple[str, type], int] = {}
        for time_ns, topic, message in messages:
            key = topic, type(message)
            if key not in ids:
                ids[key] = writer.add_topic(topic_info(topic, type(message)))
            writer.write(ids[key], time_ns, cdr.encode(message))

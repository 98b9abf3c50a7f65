"""Transforms for tests."""

from __future__ import annotations

import re
from math import cos, sin

from aionode.interfaces.builtin_interfaces.msg import Time as TimeMsg
from aionode.interfaces.geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from aionode.interfaces.std_msgs.msg import Header
from aionode.interfaces.tf2_msgs.msg import TFMessage
from aionode.tf import BufferCore

__all__ = ["message", "parts", "senders", "transform"]


def transform(
    parent: str,
    child: str,
    stamp_sec: float = 1.0,
    translation: tuple[float, float, float] = (1.0, 0.0, 0.0),
    rotation: tuple[float, float, float, float] | None = None,
    yaw: float = 0.0,
) -> TransformStamped:
    """Return a transform; its rotation is a quaternion x, y, z, w, or an angle around z."""
    sec, nanosec = divmod(round(stamp_sec * 1e9), 10**9)
    x, y, z = translation
    i, j, k, w = rotation or (0.0, 0.0, sin(yaw / 2), cos(yaw / 2))
    return TransformStamped(
        header=Header(stamp=TimeMsg(sec=sec, nanosec=nanosec), frame_id=parent),
        child_frame_id=child,
        transform=Transform(
            translation=Vector3(x=x, y=y, z=z), rotation=Quaternion(x=i, y=j, z=k, w=w)
        ),
    )


def senders(buffer: BufferCore) -> set[str]:
    """Return the senders of a buffer's transforms."""
    return set(re.findall("broadcaster: '(.*?)'", buffer.all_frames_as_yaml()))


def message(*transforms: TransformStamped) -> TFMessage:
    """Return a message of transforms."""
    return TFMessage(transforms=list(transforms))


def parts(stamped: TransformStamped) -> tuple[float, ...]:
    """Return translation x, y, z and rotation x, y, z, w."""
    translation, rotation = stamped.transform.translation, stamped.transform.rotation
    return (
        translation.x,
        translation.y,
        translation.z,
        rotation.x,
        rotation.y,
        rotation.z,
        rotation.w,
    )

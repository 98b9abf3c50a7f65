"""Transforms between coordinate frames, which one can await: tf2 in Python.

A `Buffer` follows /tf and /tf_static, and answers for any two frames::

    buffer = aionode.tf.Buffer(node)
    stamped = await buffer.wait_for_transform("map", "base_link", timeout_sec=2.0)
    goal = await buffer.transform(pose_stamped, "map")

    async for stamped in buffer.follow("map", "base_link"):
        ...
    async for scan, stamped in buffer.filter(subscription, "map"):
        ...

Names, rules, errors and texts are those of tf2 and tf2_ros. The exceptions are in `aionode.errors`,
and here as well.
"""

from __future__ import annotations

from aionode.errors import (
    BackwardExtrapolationException,
    ConnectivityException,
    ExtrapolationException,
    ForwardExtrapolationException,
    InvalidArgumentException,
    LookupException,
    NoDataForExtrapolationException,
    TimeoutException,
    TransformException,
)
from aionode.tf._broadcasters import StaticTransformBroadcaster, TransformBroadcaster
from aionode.tf._buffer import Buffer
from aionode.tf._changes import Changes
from aionode.tf._filter import Filtered
from aionode.tf._listener import TransformListener
from aionode.tf.apply import do_transform, register_transform, rotation_matrix
from aionode.tf.buffer_core import BufferCore
from aionode.tf.remote import BufferClient, BufferServer

__all__ = [
    "BackwardExtrapolationException",
    "Buffer",
    "BufferClient",
    "BufferCore",
    "BufferServer",
    "Changes",
    "ConnectivityException",
    "ExtrapolationException",
    "Filtered",
    "ForwardExtrapolationException",
    "InvalidArgumentException",
    "LookupException",
    "NoDataForExtrapolationException",
    "StaticTransformBroadcaster",
    "TimeoutException",
    "TransformBroadcaster",
    "TransformException",
    "TransformListener",
    "do_transform",
    "register_transform",
    "rotation_matrix",
]

"""Programs import this as `tf2_py`: the core of transforms, and its exceptions."""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import wraps
from typing import Any, TypeVar

from aionode import tf
from aionode.tf import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TimeoutException,
    TransformException,
)
from aionode.tf.buffer_core import CACHE_TIME_SEC
from rclpy.time import Time
from rosidl_generator_py import from_aionode

__all__ = [
    "BufferCore",
    "ConnectivityException",
    "ExtrapolationException",
    "InvalidArgumentException",
    "LookupException",
    "TimeoutException",
    "TransformException",
]

CallableT = TypeVar("CallableT", bound=Callable[..., Any])


def locked(method: CallableT) -> CallableT:
    """Return a method that threads call one at a time, with tf2_py's six exceptions."""

    @wraps(method)
    def call(self: BufferCore, *args: Any, **options: Any) -> Any:
        with self._BufferCore__lock:
            try:
                return method(self, *args, **options)
            except ExtrapolationException as error:
                if type(error) is ExtrapolationException:
                    raise
                raise ExtrapolationException(str(error)) from None

    return call  # type: ignore[return-value]  # it takes the same arguments


class BufferCore(tf.BufferCore):
    """Keeps transforms for some time; several threads may use it.

    Args:
        cache_time: How long transforms are kept; 10 s by default.
    """

    def __init__(self, cache_time: Any = CACHE_TIME_SEC) -> None:
        super().__init__(cache_time)
        self._BufferCore__lock = threading.RLock()

    def _BufferCore__message(self, *parts: Any) -> Any:
        """Return a transform as a rosidl message."""
        return from_aionode(super()._BufferCore__message(*parts))

    @locked
    def get_latest_common_time(self, target_frame: str, source_frame: str) -> Time:
        """Return the newest time at which a transform is available."""
        latest = super().get_latest_common_time(target_frame, source_frame)
        return Time(nanoseconds=latest.nanoseconds)

    set_transform = locked(tf.BufferCore.set_transform)
    set_transform_static = locked(tf.BufferCore.set_transform_static)
    clear = locked(tf.BufferCore.clear)
    lookup_transform_core = locked(tf.BufferCore.lookup_transform_core)
    lookup_transform_full_core = locked(tf.BufferCore.lookup_transform_full_core)
    can_transform_core = locked(tf.BufferCore.can_transform_core)
    can_transform_full_core = locked(tf.BufferCore.can_transform_full_core)
    lookupVelocityCore = locked(tf.BufferCore.lookupVelocityCore)  # noqa: N815  # tf2's name
    lookupVelocityFullCore = locked(tf.BufferCore.lookupVelocityFullCore)  # noqa: N815  # the same
    all_frames_as_yaml = locked(tf.BufferCore.all_frames_as_yaml)
    all_frames_as_string = locked(tf.BufferCore.all_frames_as_string)
    _allFramesAsDot = locked(tf.BufferCore._allFramesAsDot)  # noqa: N815  # the same
    _frameExists = locked(tf.BufferCore._frameExists)  # noqa: N815  # the same
    _getFrameStrings = locked(tf.BufferCore._getFrameStrings)  # noqa: N815  # the same
    _chain = locked(tf.BufferCore._chain)

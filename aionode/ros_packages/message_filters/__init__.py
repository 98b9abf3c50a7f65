"""Programs import this as `message_filters`: `aionode.message_filters` for nodes of rclpy."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from typing import Any

from aionode import message_filters
from aionode.message_filters import (
    ApproximateMatcher,
    Chain,
    Matcher,
    SimpleFilter,
    Synchronizer,
)
from rclpy.clock import ROSClock
from rclpy.time import Time

__all__ = [
    "ApproximateTimeSynchronizer",
    "Cache",
    "Chain",
    "SimpleFilter",
    "Subscriber",
    "TimeSynchronizer",
]

DEPTH = 10
"""The depth of a subscription's queue if it is not given."""


class Stamps(message_filters.Stamps):
    """Returns the stamp of each message as an rclpy time."""

    def _from_msg(self, stamp: Any) -> Any:
        return Time.from_msg(stamp)

    def _now(self) -> Any:
        return ROSClock().now()


class Subscriber(message_filters.Subscriber):
    """Starts a chain: a subscription that passes its messages to the connected filters.

    Args:
        node: The node that subscribes.
        msg_type: A message class.
        topic: Name of the topic.
        options: Further arguments of `Node.create_subscription`; `qos_profile` defaults to 10.

    Attributes:
        node: The node.
        sub: The subscription.
    """

    def __init__(self, node: Any, msg_type: type[Any], topic: str, **options: Any) -> None:
        super().__init__(node, msg_type, topic, **{"qos_profile": DEPTH, **options})
        self.node = node


class Cache(message_filters.Cache):
    """Stores the newest messages of another filter, and passes them on."""

    def __init__(
        self, f: SimpleFilter, cache_size: int = 1, allow_headerless: bool = False
    ) -> None:
        super().__init__(f, cache_size, allow_headerless)
        self.allow_headerless = allow_headerless
        self._Cache__stamps = Stamps(allow_headerless=allow_headerless)


class TimeSynchronizer(Synchronizer):
    """Calls back with one message of each input, all with the same stamp.

    The inputs may be called from several threads at the same time.
    """

    def __init__(self, fs: Sequence[SimpleFilter], queue_size: int) -> None:
        self._TimeSynchronizer__connect(fs, Matcher(len(fs), queue_size), queue_size)

    def _TimeSynchronizer__connect(
        self,
        fs: Sequence[SimpleFilter],
        matcher: Matcher,
        queue_size: int,
        allow_headerless: bool = False,
    ) -> None:
        self.lock = threading.RLock()  # a callback may pass another message to its own input
        self.queue_size = queue_size
        super().__init__(fs, matcher, Stamps(allow_headerless=allow_headerless))

    def add(self, msg: Any, index: int) -> None:
        """Add a message of an input."""
        with self.lock:
            super().add(msg, index)


class ApproximateTimeSynchronizer(TimeSynchronizer):
    """Calls back with one message of each input, whose stamps differ by less than `slop` seconds.

    The inputs may be called from several threads at the same time.
    """

    def __init__(
        self,
        fs: Sequence[SimpleFilter],
        queue_size: int,
        slop: float,
        allow_headerless: bool = False,
    ) -> None:
        self.allow_headerless = allow_headerless
        matcher = ApproximateMatcher(len(fs), queue_size, slop)
        self._TimeSynchronizer__connect(fs, matcher, queue_size, allow_headerless)

"""A buffer that follows /tf, and whose transforms can be awaited."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

from aionode.tf._changes import Changes
from aionode.tf._filter import Filtered
from aionode.tf._node_buffer_core import LATEST, NodeBufferCore
from aionode.tf.apply import transformer_of
from aionode.tf.buffer_core import time_ns_of

if TYPE_CHECKING:
    from aionode.endpoints.subscription import Subscription
    from aionode.interfaces.geometry_msgs.msg import TransformStamped

__all__ = ["Buffer"]

StampedT = TypeVar("StampedT")


class Buffer(NodeBufferCore):
    """Stores the transforms of /tf and /tf_static, and returns those between any two frames.

    ::

        buffer = aionode.tf.Buffer(node)
        stamped = await buffer.wait_for_transform("map", "base_link")

    It also has the methods of tf2's BufferCore. As in tf2 it is cleared when the node's clock jumps
    back, and also when simulated time is switched on or off. Timeouts are measured by that clock.

    Args:
        node: The node that subscribes; the buffer ends with it.
        cache_time: How long transforms are kept: a Duration, or seconds.
        qos: A profile or depth for /tf; by default 100 messages.
        static_qos: The same for /tf_static; by default also transient local.
        tf_topic: The topic of changing transforms.
        tf_static_topic: The topic of static transforms.

    Raises:
        TypeError: `cache_time` is neither a duration nor a number.
        ValueError: it is negative.
        EntityDestroyedError: the node was destroyed (a RuntimeError).
    """

    # Without waiting

    def lookup_transform(
        self, target_frame: str, source_frame: str, time: Any = LATEST
    ) -> TransformStamped:
        """Return the transform from `source_frame` to `target_frame`.

        It never waits; see `wait_for_transform`.

        Args:
            target_frame: The frame to transform to.
            source_frame: The frame to transform from.
            time: The time; by default the latest common one.

        Raises:
            TransformException: it is not available; the class and the text say why.
        """
        return self.lookup_transform_core(target_frame, source_frame, time)

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
    ) -> TransformStamped:
        """Return the transform between two times; see `lookup_transform_full_core`.

        Raises:
            TransformException: it is not available; the class and the text say why.
        """
        return self.lookup_transform_full_core(
            target_frame, target_time, source_frame, source_time, fixed_frame
        )

    def can_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Any = LATEST,
        *,
        return_debug_tuple: bool = False,
    ) -> bool | tuple[bool, str]:
        """Return whether a transform is available; with `return_debug_tuple`, also why not."""
        answer = self.can_transform_core(target_frame, source_frame, time)
        return answer if return_debug_tuple else answer[0]

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        *,
        return_debug_tuple: bool = False,
    ) -> bool | tuple[bool, str]:
        """Return whether a transform between two times is available; see `can_transform`."""
        answer = self.can_transform_full_core(
            target_frame, target_time, source_frame, source_time, fixed_frame
        )
        return answer if return_debug_tuple else answer[0]

    # Waiting

    async def wait_for_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Any = LATEST,
        *,
        timeout_sec: float | None = None,
    ) -> TransformStamped:
        """Wait until a transform is available, and return it.

        Cancelling ends the wait and changes nothing else; the CancelledError has a note saying why
        the transform was not available, which `asyncio.timeout` shows too.

        Args:
            target_frame: The frame to transform to.
            source_frame: The frame to transform from.
            time: The time; by default the latest common one.
            timeout_sec: How long to wait, in seconds of the node's clock; None forever.

        Raises:
            TimeoutException: it was not available in time; the text says why (a TimeoutError).
            ExtrapolationException: the time is older than the transforms that are kept.
            InvalidArgumentException: a name is empty or begins with a slash (a ValueError).
            EntityDestroyedError: the node was destroyed (a RuntimeError).
            asyncio.CancelledError: the node was destroyed, and the current task is one of its own.
        """
        parts = ((target_frame, source_frame, time_ns_of(time)),)
        return await self._BufferCore__wait(
            parts,
            partial(self.lookup_transform_core, target_frame, source_frame, time),
            timeout_sec,
        )

    async def wait_for_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        *,
        timeout_sec: float | None = None,
    ) -> TransformStamped:
        """Wait until a transform between two times is available, and return it.

        See `lookup_transform_full_core` for the arguments, and `wait_for_transform` otherwise.
        """
        parts = (
            (target_frame, fixed_frame, time_ns_of(target_time)),
            (fixed_frame, source_frame, time_ns_of(source_time)),
        )
        return await self._BufferCore__wait(
            parts,
            partial(
                self.lookup_transform_full_core,
                target_frame,
                target_time,
                source_frame,
                source_time,
                fixed_frame,
            ),
            timeout_sec,
        )

    async def transform(
        self, object_stamped: StampedT, target_frame: str, *, timeout_sec: float | None = None
    ) -> StampedT:
        """Transform a message to another frame, as soon as the transform is available.

        Args:
            object_stamped: A message with a header: one of geometry_msgs, a PointCloud2, or of a
                type that `register_transform` knows.
            target_frame: The frame to transform to.
            timeout_sec: As for `wait_for_transform`.

        Raises:
            TypeError: there is no transform function for this type.
            TransformException: as `wait_for_transform`.
        """
        apply = transformer_of(type(object_stamped))
        header = object_stamped.header  # type: ignore[attr-defined]  # registered types have it
        stamped = await self.wait_for_transform(
            target_frame, header.frame_id, header.stamp, timeout_sec=timeout_sec
        )
        result: StampedT = apply(object_stamped, stamped)
        return result

    async def transform_full(
        self,
        object_stamped: StampedT,
        target_frame: str,
        target_time: Any,
        fixed_frame: str,
        *,
        timeout_sec: float | None = None,
    ) -> StampedT:
        """Transform a message to another frame at another time; see `transform`.

        Raises:
            TypeError: there is no transform function for this type.
            TransformException: as `wait_for_transform_full`.
        """
        apply = transformer_of(type(object_stamped))
        header = object_stamped.header  # type: ignore[attr-defined]  # registered types have it
        transform = await self.wait_for_transform_full(
            target_frame,
            target_time,
            header.frame_id,
            header.stamp,
            fixed_frame,
            timeout_sec=timeout_sec,
        )
        result: StampedT = apply(object_stamped, transform)
        return result

    def follow(self, target_frame: str, source_frame: str) -> Changes:
        """Iterate over the latest transform between two frames, each time it changes.

        ``async for stamped in buffer.follow("map", "base_link")``. A slow loop gets only the newest
        one. It waits while there is none.

        Raises:
            InvalidArgumentException: a name is empty or begins with a slash (a ValueError).
        """
        self._BufferCore__expect_names(target_frame, source_frame)
        return Changes(self, target_frame, source_frame)

    def filter(
        self, subscription: Subscription[StampedT], target_frame: str, *, queue_size: int = 100
    ) -> Filtered[StampedT]:
        """Iterate over messages once their transform is available, like tf2's MessageFilter.

        ``async for msg, stamped in buffer.filter(subscription, "map")``.

        Args:
            subscription: A subscription without a callback, of messages with headers; the iterator
                reads it.
            target_frame: The frame to transform the messages to.
            queue_size: How many messages may wait; beyond that the oldest one is dropped.

        Raises:
            ValueError: `queue_size` is less than 1.
            InvalidArgumentException: the name is empty or begins with a slash (a ValueError).
        """
        self._BufferCore__expect_names(target_frame)
        return Filtered(self, subscription, target_frame, queue_size)

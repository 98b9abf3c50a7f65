"""The core of a node's buffer: fed by topics, cleared by clock jumps, and awaitable."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

from aionode.clock import S_TO_NS, ClockChange, Duration, JumpThreshold, Time
from aionode.endpoints.core.entity import Entity, end_of_wait, refuse_if_destroyed
from aionode.endpoints.core.node_core import core_of
from aionode.errors import TimeoutException, TransformException
from aionode.tf._arithmetic import unit
from aionode.tf._listener import STATIC_TOPIC, TOPIC, TransformListener
from aionode.tf._walk import Failure
from aionode.tf.buffer_core import CACHE_TIME_SEC, BufferCore
from aionode.tf.frame_listing import seconds_text
from aionode.tf.waiters import Part, Waiter, Waiters, problem_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.clock import Alarm, Clock, TimeJump
    from aionode.interfaces.geometry_msgs.msg import TransformStamped
    from aionode.node import Node
    from aionode.qos import QoSProfile
    from aionode.tf._arithmetic import Pose
    from aionode.tf._frames import Frame

__all__ = ["LATEST", "NodeBufferCore"]

LATEST = Time()
"""The latest common time, as in tf2."""


class BufferEnd(Entity):
    """An entity that ends with the node and wakes all tasks that wait for its transforms."""

    def __init__(self, subject: str, on_close: Callable[[], None]) -> None:
        super().__init__(subject)
        self._on_close = on_close

    def _close(self) -> None:
        self._on_close()


class NodeBufferCore(BufferCore):
    """A core that ends with its node, and supports waiting; see `Buffer`."""

    def __init__(
        self,
        node: Node,
        *,
        cache_time: Duration | float = CACHE_TIME_SEC,
        qos: QoSProfile | int | None = None,
        static_qos: QoSProfile | int | None = None,
        tf_topic: str = TOPIC,
        tf_static_topic: str = STATIC_TOPIC,
    ) -> None:
        super().__init__(cache_time)
        self._BufferCore__logger = node.get_logger()
        self._BufferCore__clock: Clock = node.get_clock()
        self._BufferCore__waiters = Waiters(self._BufferCore__frames, self._BufferCore__cache_ns)
        self._BufferCore__followers: dict[str, dict[asyncio.Future[None], None]] = {}
        # Each pending wait, with the alarm that ends it and its timeout in nanoseconds, if any.
        self._BufferCore__pending: dict[asyncio.Future[Any], tuple[int, Alarm | None]] = {}
        self.listener = TransformListener(
            self,
            node,
            qos=qos,
            static_qos=static_qos,
            tf_topic=tf_topic,
            tf_static_topic=tf_static_topic,
        )
        self._BufferCore__entity = core_of(node).add(
            BufferEnd(
                f"transform buffer of {node.get_fully_qualified_name()}",
                self._BufferCore__end_waits,
            )
        )
        self._BufferCore__jumps = self._BufferCore__clock.create_jump_callback(
            JumpThreshold(min_forward=None, min_backward=Duration(nanoseconds=-1)),
            post_callback=self._BufferCore__on_jump,
        )

    # For subclasses

    async def _BufferCore__wait(
        self,
        parts: tuple[Part, ...],
        look_up: Callable[[], TransformStamped],
        timeout_sec: float | None,
    ) -> TransformStamped:
        refuse_if_destroyed(self._BufferCore__entity, "wait for a transform")
        self._BufferCore__expect_names(*(frame for part in parts for frame in part[:2]))
        ended: asyncio.Future[Any] = asyncio.get_running_loop().create_future()
        # The answer is taken at once, as the data may be gone by the time the task runs.
        waiter = Waiter(
            parts,
            lambda failure: settle(ended, look_up if failure is None else failure.exception()),
        )
        self._BufferCore__waiters.add(waiter)
        if not ended.done():
            limit_ns = 0 if timeout_sec is None else max(round(timeout_sec * S_TO_NS), 1)
            self._BufferCore__pending[ended] = limit_ns, self._BufferCore__alarm(ended, limit_ns)
        try:
            result = await ended
        except asyncio.CancelledError as cancelled:
            cancelled.add_note(self._BufferCore__reason(parts))
            raise
        finally:
            self._BufferCore__waiters.remove(waiter)
            _, alarm = self._BufferCore__pending.pop(ended, (0, None))
            if alarm is not None:
                alarm.cancel()
        if result is DESTROYED:
            raise end_of_wait(self._BufferCore__entity)
        if result is TIMED_OUT:
            raise TimeoutException(f"{self._BufferCore__reason(parts)}; waited {timeout_sec:g} s")
        return result  # type: ignore[no-any-return]  # a future has a single type

    def _BufferCore__reason(self, parts: tuple[Part, ...]) -> str:
        """Describe what is awaited, and why it is not available."""
        failure, _ = problem_of(self._BufferCore__frames, parts)
        reason = "it is available now" if failure is None else failure.text
        for part in parts:
            for frame in part[:2]:
                if frame not in self._BufferCore__frames.names:
                    reason = f'frame "{frame}" does not exist; no transform has named it'
        target, source = parts[0][0], parts[-1][1]
        at = seconds_text(parts[-1][2]) if parts[-1][2] else "the latest time"
        return f"Timed out waiting for transform from [{source}] to [{target}] at {at}: {reason}"

    def _BufferCore__expect_names(self, *frames: str) -> None:
        """Refuse invalid frame names, like `lookup_transform_core`."""
        for frame in frames:
            if not frame or frame.startswith("/"):
                self._BufferCore__expect_frame("wait_for_transform", frame)

    def _BufferCore__alarm(self, ended: asyncio.Future[Any], limit_ns: int) -> Alarm | None:
        """Return the alarm that ends a wait after its timeout, on the node's clock."""
        if not limit_ns:
            return None
        until_ns = self._BufferCore__clock.now_ns() + limit_ns
        return self._BufferCore__clock.call_at(until_ns, lambda: settle(ended, lambda: TIMED_OUT))

    def _BufferCore__changed(
        self, child: str, frame: Frame, before: tuple[int, str] | None
    ) -> None:
        self._BufferCore__waiters.changed(child, frame, before)
        if self._BufferCore__followers:
            for follower in self._BufferCore__followers.pop(child, ()):
                settle(follower, lambda: None)

    def _BufferCore__latest_pose(self, target: str, source: str) -> tuple[Pose, int] | None:
        """Return the latest pose of a frame and its stamp; None if there is none."""
        result = self._BufferCore__find(target, source, 0)
        return None if isinstance(result, Failure) else (unit(result[0]), result[1])

    def clear(self) -> None:
        """Clear the history of all frames; static transforms, names and waits are kept."""
        super().clear()
        self._BufferCore__waiters.ask_all()

    def _BufferCore__on_jump(self, jump: TimeJump) -> None:
        """Clear the buffer, as its transforms are from another time."""
        self._BufferCore__logger.warning("Detected jump back in time. Clearing tf buffer.")
        self.clear()
        if jump.clock_change is ClockChange.ROS_TIME_NO_CHANGE:
            return
        for ended, (limit_ns, alarm) in list(self._BufferCore__pending.items()):
            if alarm is not None:  # it belongs to the previous source of time
                alarm.cancel()
                self._BufferCore__pending[ended] = (
                    limit_ns,
                    self._BufferCore__alarm(ended, limit_ns),
                )

    def _BufferCore__end_waits(self) -> None:
        self._BufferCore__jumps.unregister()
        self.listener.unregister()
        for ended in list(self._BufferCore__pending):
            settle(ended, lambda: DESTROYED)
        for followers in list(self._BufferCore__followers.values()):
            for follower in list(followers):
                settle(follower, lambda: None)
        self._BufferCore__followers.clear()


TIMED_OUT: Any = object()
DESTROYED: Any = object()


def settle(future: asyncio.Future[Any], outcome: Callable[[], Any] | Exception) -> None:
    """End a wait with a function's result or an error; no effect if it has ended."""
    if future.done():
        return
    if isinstance(outcome, Exception):
        future.set_exception(outcome)
        return
    try:
        future.set_result(outcome())
    except TransformException as error:
        future.set_exception(error)

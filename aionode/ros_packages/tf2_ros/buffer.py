"""A buffer of transforms for rclpy programs, which several threads may use."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from geometry_msgs.msg import TransformStamped

from aionode.clock import perf_ns
from aionode.tf import ExtrapolationException
from aionode.tf.buffer_core import CACHE_TIME_SEC, time_ns_of
from aionode.tf.waiters import Waiter, Waiters
from rclpy.clock import Clock, JumpThreshold
from rclpy.duration import Duration
from rclpy.logging import get_logger
from rclpy.task import Future
from rosidl_generator_py import service_class
from tf2_py import BufferCore
from tf2_ros.buffer_interface import NOW, BufferInterface

__all__ = [
    "Buffer",
    "Future",
    "TransformStamped",
]


class Buffer(BufferCore, BufferInterface):
    """Keeps transforms; with a node, it offers the service ``tf2_frames``.

    A wait with a time limit blocks its thread, as in tf2_ros, but ends as soon as the transform is
    available. Futures are checked again only when a frame of their chain has the data they need.

    Args:
        cache_time: How long transforms are kept; 10 s by default.
        node: The node that offers the service, and whose clock is followed.
    """

    def __init__(self, cache_time: Duration | None = None, node: Any = None) -> None:
        BufferCore.__init__(self, CACHE_TIME_SEC if cache_time is None else cache_time)
        BufferInterface.__init__(self)
        self._BufferCore__waiters = Waiters(self._BufferCore__frames, self._BufferCore__cache_ns)
        self._BufferCore__new_data = threading.Condition(self._BufferCore__lock)
        if node is None:
            self.clock = Clock()
        else:
            frame_graph = service_class("tf2_msgs/srv/FrameGraph")
            self.srv = node.create_service(frame_graph, "tf2_frames", self._BufferCore__on_frames)
            self.clock = node.get_clock()
        threshold = JumpThreshold(
            min_forward=None, min_backward=Duration(seconds=-1), on_clock_change=True
        )
        self.jump_handle = self.clock.create_jump_callback(
            threshold, post_callback=self.time_jump_callback
        )

    def _BufferCore__on_frames(self, request: Any, response: Any) -> Any:
        response.frame_yaml = self.all_frames_as_yaml()
        return response

    def time_jump_callback(self, time_jump: Any) -> None:
        """Clear the buffer: its transforms are from another time."""
        get_logger("tf2_buffer").warning("Detected jump back in time. Clearing tf buffer.")
        self.clear()

    def _BufferCore__changed(self, child: str, frame: Any, before: Any) -> None:
        self._BufferCore__waiters.changed(child, frame, before)
        self._BufferCore__new_data.notify_all()

    # Waiting

    def lookup_transform(
        self, target_frame: str, source_frame: str, time: Any, timeout: Duration = NOW
    ) -> Any:
        """Return the transform between two frames, waiting for at most `timeout`."""
        self.can_transform(target_frame, source_frame, time, timeout)
        return self.lookup_transform_core(target_frame, source_frame, time)

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Duration = NOW,
    ) -> Any:
        """Return the transform between two times, waiting for at most `timeout`."""
        question = target_frame, target_time, source_frame, source_time, fixed_frame
        self.can_transform_full(*question, timeout)
        return self.lookup_transform_full_core(*question)

    def can_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Any,
        timeout: Duration = NOW,
        return_debug_tuple: bool = False,
    ) -> Any:
        """Return whether a transform is available, waiting for at most `timeout`."""
        answer = self._BufferCore__until(
            lambda: self.can_transform_core(target_frame, source_frame, time), timeout
        )
        return answer if return_debug_tuple else answer[0]

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Duration = NOW,
        return_debug_tuple: bool = False,
    ) -> Any:
        """Return whether a transform between two times is available, waiting if needed."""
        question = target_frame, target_time, source_frame, source_time, fixed_frame
        answer = self._BufferCore__until(lambda: self.can_transform_full_core(*question), timeout)
        return answer if return_debug_tuple else answer[0]

    def _BufferCore__until(
        self, ask: Callable[[], tuple[bool, str]], timeout: Any
    ) -> tuple[bool, str]:
        """Check until the answer is yes, or the time limit has passed."""
        ends_ns = perf_ns() + time_ns_of(timeout)
        with self._BufferCore__new_data:
            while not (answer := ask())[0] and (left_ns := ends_ns - perf_ns()) > 0:
                self._BufferCore__new_data.wait(left_ns / 1e9)
        return answer

    async def lookup_transform_async(self, target_frame: str, source_frame: str, time: Any) -> Any:
        """Await a transform, and return it."""
        return await self.wait_for_transform_async(target_frame, source_frame, time)

    async def lookup_transform_full_async(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
    ) -> Any:
        """Await a transform between two times, and return it."""
        return await self.wait_for_transform_full_async(
            target_frame, target_time, source_frame, source_time, fixed_frame
        )

    def wait_for_transform_async(
        self, target_frame: str, source_frame: str, time: Any
    ) -> Future[Any]:
        """Return a future for a transform."""
        return self._BufferCore__future(
            ((target_frame, source_frame, time_ns_of(time)),),
            lambda: self.lookup_transform_core(target_frame, source_frame, time),
        )

    def wait_for_transform_full_async(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
    ) -> Future[Any]:
        """Return a future for a transform between two times."""
        question = target_frame, target_time, source_frame, source_time, fixed_frame
        return self._BufferCore__future(
            (
                (target_frame, fixed_frame, time_ns_of(target_time)),
                (fixed_frame, source_frame, time_ns_of(source_time)),
            ),
            lambda: self.lookup_transform_full_core(*question),
        )

    def _BufferCore__future(self, parts: Any, look_up: Callable[[], Any]) -> Future[Any]:
        future: Future[Any] = Future()

        def end(failure: Any) -> None:
            if failure is not None:
                future.set_exception(ExtrapolationException(failure.text))
                return
            try:
                future.set_result(look_up())
            except Exception as error:  # noqa: BLE001  # it goes to those who wait
                future.set_exception(error)

        waiter = Waiter(parts, end)
        with self._BufferCore__lock:
            self._BufferCore__waiters.add(waiter)
        future.add_done_callback(lambda _: self._BufferCore__give_up(waiter))
        return future

    def _BufferCore__give_up(self, waiter: Waiter) -> None:
        with self._BufferCore__lock:
            self._BufferCore__waiters.remove(waiter)

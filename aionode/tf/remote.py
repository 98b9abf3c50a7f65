"""One buffer for several programs: a server that looks up transforms, and its client."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any, TypeVar

from aionode.clock import S_TO_NS, Duration
from aionode.engine.rules.goal import CancelResponse
from aionode.errors import (
    ConnectivityException,
    ExtrapolationException,
    GoalAbortedError,
    InvalidArgumentException,
    LookupException,
    TimeoutException,
    TransformException,
)
from aionode.interfaces.builtin_interfaces.msg import Time as TimeMsg
from aionode.interfaces.tf2_msgs.action import LookupTransform
from aionode.interfaces.tf2_msgs.msg import TF2Error
from aionode.interfaces.tf2_msgs.srv import FrameGraph
from aionode.tf._node_buffer_core import LATEST
from aionode.tf.apply import transformer_of
from aionode.tf.buffer_core import time_ns_of
from aionode.tf.frame_listing import FRAMES_SERVICE

if TYPE_CHECKING:
    from aionode.action import ServerGoalHandle
    from aionode.interfaces.geometry_msgs.msg import TransformStamped
    from aionode.node import Node
    from aionode.tf._buffer import Buffer

__all__ = ["SERVER", "BufferClient", "BufferServer"]

StampedT = TypeVar("StampedT")

SERVER = "tf2_buffer_server"
"""The name of tf2's server when it is started as a program."""

PADDING_SEC = 2.0
"""How much longer than the server a client waits, in seconds."""

CODES: tuple[tuple[type[TransformException], int], ...] = (
    (ConnectivityException, TF2Error.CONNECTIVITY_ERROR),
    (LookupException, TF2Error.LOOKUP_ERROR),
    (ExtrapolationException, TF2Error.EXTRAPOLATION_ERROR),
    (InvalidArgumentException, TF2Error.INVALID_ARGUMENT_ERROR),
    (TimeoutException, TF2Error.TIMEOUT_ERROR),
    (TransformException, TF2Error.TRANSFORM_ERROR),
)


class BufferServer:
    """Looks up transforms for other programs: the action LookupTransform, and tf2_frames.

    Args:
        buffer: The buffer that answers.
        node: The node that serves.
        ns: The name of the action.
    """

    def __init__(self, buffer: Buffer, node: Node, ns: str = SERVER) -> None:
        self._BufferServer__buffer = buffer
        self.server = node.create_action_server(
            LookupTransform,
            ns,
            self._BufferServer__look_up,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
            on_client_lost="cancel",
        )
        self.srv = node.create_service(FrameGraph, FRAMES_SERVICE, self._BufferServer__frames)

    async def _BufferServer__look_up(
        self,
        handle: ServerGoalHandle[
            LookupTransform.Goal, LookupTransform.Result, LookupTransform.Feedback
        ],
    ) -> LookupTransform.Result:
        """Answer one request, as soon as the transform is available or it has timed out."""
        try:
            result = LookupTransform.Result(
                transform=await self._BufferServer__transform_of(handle.request)
            )
        except TransformException as error:
            code = next(code for kind, code in CODES if isinstance(error, kind))
            result = LookupTransform.Result(error=TF2Error(error=code, error_string=str(error)))
            if isinstance(error, TimeoutException):
                handle.abort(result)
                return result
        # Errors succeed too, as tf2's C++ client drops the result of an aborted goal.
        handle.succeed(result)
        return result

    async def _BufferServer__transform_of(self, goal: LookupTransform.Goal) -> TransformStamped:
        limit = goal.timeout
        timeout_sec = limit.sec + limit.nanosec / S_TO_NS
        buffer = self._BufferServer__buffer
        if goal.advanced:
            two_times = (
                goal.target_frame,
                goal.target_time,
                goal.source_frame,
                goal.source_time,
                goal.fixed_frame,
            )
            if timeout_sec <= 0:
                return buffer.lookup_transform_full(*two_times)
            return await buffer.wait_for_transform_full(*two_times, timeout_sec=timeout_sec)
        question = goal.target_frame, goal.source_frame, goal.source_time
        if timeout_sec <= 0:
            return buffer.lookup_transform(*question)
        return await buffer.wait_for_transform(*question, timeout_sec=timeout_sec)

    def _BufferServer__frames(
        self, request: FrameGraph.Request, response: FrameGraph.Response
    ) -> FrameGraph.Response:
        del request
        response.frame_yaml = self._BufferServer__buffer.all_frames_as_yaml()
        return response

    def destroy(self) -> None:
        """Destroy the action server and the service."""
        self.server.destroy()
        self.srv.destroy()


class BufferClient:
    """Requests transforms from a `BufferServer` or tf2's server; stores none itself.

    Args:
        node: The node that asks.
        ns: The name of the server's action.
        timeout_padding: How much longer than the server to wait for its answer: a Duration, or
            seconds.
    """

    def __init__(
        self, node: Node, ns: str = SERVER, *, timeout_padding: Duration | float = PADDING_SEC
    ) -> None:
        padding = timeout_padding
        self._BufferClient__padding_sec = (
            padding.nanoseconds / S_TO_NS if isinstance(padding, Duration) else padding
        )
        self.action_client = node.create_action_client(LookupTransform, ns)

    async def lookup_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Any = LATEST,
        *,
        timeout_sec: float = 0.0,
    ) -> TransformStamped:
        """Return the transform that expresses in `target_frame` what is given in `source_frame`.

        Cancelling cancels the request at the server.

        Args:
            target_frame: The frame to express things in.
            source_frame: The frame that they are in.
            time: When; by default the latest common time.
            timeout_sec: How long the server waits for the transform, in seconds.

        Raises:
            TimeoutException: there is no server, it does not answer, or the transform was not
                available in time (a TimeoutError).
            TransformException: the transform is not available; the class and the text say why.
        """
        goal = LookupTransform.Goal(
            target_frame=target_frame,
            source_frame=source_frame,
            source_time=time_msg(time),
            timeout=Duration(seconds=timeout_sec).to_msg(),
        )
        return await self._BufferClient__ask(goal)

    async def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        *,
        timeout_sec: float = 0.0,
    ) -> TransformStamped:
        """Return the transform between two times; see `lookup_transform` for the rest.

        Raises:
            TransformException: as `lookup_transform`.
        """
        goal = LookupTransform.Goal(
            target_frame=target_frame,
            source_frame=source_frame,
            source_time=time_msg(source_time),
            timeout=Duration(seconds=timeout_sec).to_msg(),
            target_time=time_msg(target_time),
            fixed_frame=fixed_frame,
            advanced=True,
        )
        return await self._BufferClient__ask(goal)

    async def can_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Any = LATEST,
        *,
        timeout_sec: float = 0.0,
    ) -> bool:
        """Return whether a transform is available; see `lookup_transform`."""
        try:
            await self.lookup_transform(target_frame, source_frame, time, timeout_sec=timeout_sec)
        except TransformException:
            return False
        return True

    async def transform(
        self, object_stamped: StampedT, target_frame: str, *, timeout_sec: float = 0.0
    ) -> StampedT:
        """Transform a message to another frame; see `Buffer.transform` for the types.

        Raises:
            TypeError: there is no function for this type.
            TransformException: as `lookup_transform`.
        """
        apply = transformer_of(type(object_stamped))
        header = object_stamped.header  # type: ignore[attr-defined]  # of what is registered
        stamped = await self.lookup_transform(
            target_frame, header.frame_id, header.stamp, timeout_sec=timeout_sec
        )
        result: StampedT = apply(object_stamped, stamped)
        return result

    async def _BufferClient__ask(self, goal: LookupTransform.Goal) -> TransformStamped:
        limit_sec = (
            goal.timeout.sec + goal.timeout.nanosec / S_TO_NS + self._BufferClient__padding_sec
        )
        client = self.action_client
        if not await client.wait_for_server(self._BufferClient__padding_sec):
            raise TimeoutException("The BufferServer is not ready.")
        try:
            async with asyncio.timeout(limit_sec):
                result = await client.call(goal)
        except GoalAbortedError as aborted:
            result = aborted.result  # type: ignore[assignment]  # of this action
        except TimeoutError:
            raise TimeoutException(
                "The LookupTransform goal sent to the BufferServer did not come back in the "
                "specified time. Something is likely wrong with the server."
            ) from None
        transform: TransformStamped = transform_in(result)
        return transform

    def destroy(self) -> None:
        """Destroy the action client."""
        self.action_client.destroy()


def transform_in(result: Any) -> Any:
    """Return the transform in a server's answer, whose class may be aionode's or rclpy's.

    Raises:
        TransformException: the answer is an error; the class is that of the error.
    """
    code, text = result.error.error, result.error.error_string
    if code != TF2Error.NO_ERROR:
        raise next((kind for kind, known in CODES if known == code), TransformException)(text)
    return result.transform


def time_msg(time: Any) -> TimeMsg:
    """Convert a time to a message."""
    sec, nanosec = divmod(time_ns_of(time), S_TO_NS)
    return TimeMsg(sec=sec, nanosec=nanosec)

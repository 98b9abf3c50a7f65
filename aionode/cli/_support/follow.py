"""Subscribing to topics whose type is learned from the network."""

from __future__ import annotations

import asyncio
import contextlib
from typing import TYPE_CHECKING, Any

from aionode.cli._support import lookup
from aionode.content_filter import ContentFilterOptions
from aionode.errors import CommandError, ContentFilterError
from aionode.graph import TOPIC_KINDS

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.cli._support.output import Output
    from aionode.endpoints.core.callback_runner import CallbackContext
    from aionode.endpoints.subscription import MessageInfo, Subscription
    from aionode.message import Message
    from aionode.node import Node
    from aionode.qos import QoSProfile

__all__ = ["Follower", "filter_from", "wait_for_type"]


class Follower:
    """Passes the messages of topics to callbacks until one finishes or fails.

    `finished` raises the exceptions of the callbacks unchanged.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._done: asyncio.Future[None] = asyncio.get_running_loop().create_future()

    def follow(
        self,
        msg_type: type[Message],
        topic: str,
        on_message: Callable[[Any, MessageInfo], None],
        qos: QoSProfile,
        *,
        raw: bool = False,
        content_filter: str = "",
    ) -> Subscription[Any]:
        """Call `on_message` with each message of `topic`, or with its bytes if `raw`.

        Raises:
            CommandError: the content filter is malformed, or does not fit the type.
        """

        def while_unfinished(msg: Any, info: MessageInfo) -> None:
            if not self._done.done():
                on_message(msg, info)

        try:
            subscription: Subscription[Any] = self._node.create_subscription(
                msg_type,
                topic,
                while_unfinished,
                qos,
                raw=raw,  # type: ignore[call-overload]  # known only at run time
                on_error=self.fail,
                content_filter_options=ContentFilterOptions(content_filter),
            )
        except ContentFilterError as error:
            raise CommandError(f"--content-filter: {error}") from error
        return subscription

    def fail(self, error: Exception, _: CallbackContext | None = None) -> None:
        """Finish with an error."""
        if not self._done.done():
            self._done.set_exception(error)

    def finish(self) -> None:
        """Finish without an error."""
        if not self._done.done():
            self._done.set_result(None)

    async def finished(self, timeout_s: float | None = None) -> bool:
        """Wait until finished; return False if `timeout_s` passes first.

        Raises:
            Exception: whatever a callback raised.
        """
        try:
            async with asyncio.timeout(timeout_s):
                await self._done
        except TimeoutError:
            return False
        return True


async def wait_for_type(
    node: Node,
    topic: str,
    output: Output,
    given: str | None = None,
    *,
    spinner: bool = True,
) -> type[Message]:
    """Return the class of a topic's messages, waiting for an endpoint if there is none yet.

    Meanwhile a terminal shows a `spinner`, unless it shows something else.

    Raises:
        CommandError: the type cannot be determined.
    """
    msg_type = await lookup.topic_type(node, topic, given)
    if msg_type is None:
        hint = lookup.close_to(topic, lookup.names_and_types(node, *TOPIC_KINDS))
        output.progress(f"WARNING: topic [{topic}] does not appear to be published yet{hint}")
        waiting = output.waiting(f"waiting for a publisher of {topic}")
        with waiting if spinner else contextlib.nullcontext():
            await node.graph.until(
                lambda: bool(lookup.endpoints(node, *TOPIC_KINDS, name=topic)), topic
            )
        msg_type = await lookup.topic_type(node, topic)
    assert msg_type is not None  # noqa: S101  # the topic has an endpoint now
    return msg_type


def filter_from(text: str | None) -> Callable[[Any], bool]:
    """Return the predicate for a ``--filter`` expression, in which ``m`` is the message.

    Raises:
        CommandError: the text is not a Python expression. The predicate raises it if evaluation
            fails.
    """
    if text is None:
        return lambda _: True
    try:
        code = compile(text, "--filter", "eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        problem = error.msg if isinstance(error, SyntaxError) else type(error).__name__
        raise CommandError(
            f"--filter {text!r}: not a Python expression: {problem}; expected one such as 'm.x > 1'"
        ) from error

    def fits(m: Any) -> bool:
        try:
            return bool(eval(code, {"m": m}))  # noqa: S307  # the user's own code
        except Exception as error:  # an expression may raise anything
            raise CommandError(f"--filter {text!r}: {type(error).__name__}: {error}") from error

    return fits

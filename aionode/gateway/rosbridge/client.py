"""The protocol of rosbridge 2 for one client: frames in, calls of its session, frames out.

It does no I/O. The ops are those of rosbridge 4; where rosbridge 4 fails silently, the client gets
a ``status`` if it has requested statuses with ``set_level``.
"""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterable, Awaitable, Callable
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from aionode.errors import AionodeError, MessageError
from aionode.gateway.rosbridge.calls import Calls
from aionode.gateway.rosbridge.link import Link
from aionode.gateway.rosbridge.offers import Offers
from aionode.gateway.rosbridge.request import FragmentStore, full_name, head_of, op_of, text
from aionode.gateway.rosbridge.topics import Topics
from aionode.gateway.session.lanes import Lanes
from aionode.gateway.session.refusals import Refusal

if TYPE_CHECKING:
    from aionode.gateway.session.session import Session

__all__ = ["serve_frames"]

Op = dict[str, Any]
Handler = Callable[..., Awaitable[None]]

AGING: Final = ("publish", "call_service", "send_action_goal")
"""Ops that may be too old after waiting for other ops of the same name, or for a standstill to
end."""

MAX_MALFORMED: Final = 100
"""Number of frames that are not valid ops after which a client is disconnected."""


async def serve_frames(session: Session, frames: AsyncIterable[str | bytes]) -> None:
    """Serve a client until its frames end, or it has sent too many that are not valid ops.

    Answers and messages go to the session's outbox. Cancelling this ends everything that the client
    has started, as when it leaves.

    Args:
        session: The session of the client, which the caller closes.
        frames: What the client sends, each text or bytes with one JSON object.
    """
    async with asyncio.TaskGroup() as tasks:
        client = Client(session, Lanes(tasks))
        try:
            async for frame in frames:
                await client.take(frame)
                if client.malformed > MAX_MALFORMED:
                    break
        finally:
            await client.close()


class Client:
    """One client of rosbridge.

    Args:
        session: Its session.
        lanes: Its tasks.

    Attributes:
        malformed: Number of frames that were not valid ops.
    """

    def __init__(self, session: Session, lanes: Lanes) -> None:
        self._link = link = Link(session)
        self._lanes = lanes
        self._fragments = FragmentStore(session.rights.limits.frame_bytes)
        self._max_parts = session.rights.limits.frame_parts
        self._offers = offers = Offers(link)
        topics, calls = Topics(link), Calls(link, lanes)
        self.malformed = 0
        self._at_once: dict[str, Handler] = {
            "action_feedback": offers.action_feedback,
            "action_result": offers.action_result,
            "auth": self._auth,
            "service_response": offers.service_response,
            "set_level": self._set_level,
        }
        # In order within each name, but one name does not wait for another. Calls and goals start
        # in this order too, so that a client finds the service that it has just advertised.
        self._in_order: dict[str, tuple[str, str, Handler]] = {
            "advertise": ("topic", "topic", topics.advertise),
            "advertise_action": ("serve", "action", offers.advertise_action),
            "advertise_service": ("serve", "service", offers.advertise_service),
            "call_service": ("serve", "service", calls.call_service),
            "cancel_action_goal": ("serve", "action", calls.cancel_action_goal),
            "publish": ("topic", "topic", topics.publish),
            "send_action_goal": ("serve", "action", calls.send_action_goal),
            "subscribe": ("topic", "topic", topics.subscribe),
            "unadvertise": ("topic", "topic", topics.unadvertise),
            "unadvertise_action": ("serve", "action", offers.unadvertise_action),
            "unadvertise_service": ("serve", "service", offers.unadvertise_service),
            "unsubscribe": ("topic", "topic", topics.unsubscribe),
        }

    async def take(self, frame: str | bytes) -> None:
        """Start the op in a frame."""
        try:
            await self._lanes.admit(frame)
        except MessageError as error:
            self._link.session.rights.refused += 1
            self._link.fail(error, head_of(frame))
            return
        try:
            op = await self._op_of(frame)
        except MessageError as error:
            self.malformed += 1
            self._link.session.rights.refused += 1
            self._link.fail(error, head_of(frame))
        else:
            if op is not None:
                await self._begin(op)

    async def _op_of(self, frame: str | bytes) -> Op | None:
        """Return the op in a frame; None if it is a fragment of an incomplete message.

        Raises:
            MessageError: the frame, or the message of its fragments, is not a valid op.
        """
        op = op_of(frame, self._max_parts)
        if op["op"] != "fragment":
            return op
        whole = self._fragments.add(op)
        if whole is None:
            return None
        await self._lanes.admit(whole)
        op = op_of(whole, self._max_parts)
        if op["op"] == "fragment":
            raise MessageError("fragment.data", "it contains further fragments")
        return op

    async def close(self) -> None:
        """End everything that the client has started."""
        self._lanes.cancel()
        await self._offers.close()

    async def _begin(self, op: Op) -> None:
        name = op["op"]
        if name in self._at_once:
            await self._attempt(op, self._at_once[name])
        elif name in self._in_order:
            await self._attempt(op, self._put)
        else:
            self._link.session.rights.refused += 1
            known = ", ".join(sorted(["fragment", *self._at_once, *self._in_order]))
            problem = f"{name[:60]!r} is unknown; use one of {known}"
            self._link.fail(MessageError("op", problem), op, " ")

    async def _put(self, op: Op) -> None:
        kind, field, handler = self._in_order[op["op"]]
        if op["op"] in AGING:
            handler = partial(handler, arrived_ns=self._link.session.arrivals.arrival_ns())
        name = full_name(text(op, field).partition("#")[0])  # an id follows
        await self._lanes.put((kind, name), partial(self._attempt, op, handler))

    async def _attempt(self, op: Op, handler: Handler) -> None:
        """Handle an op, and report a failure to the client."""
        try:
            await handler(op)
        except (AionodeError, TimeoutError) as error:
            # the session has already counted a refusal by the policy
            if isinstance(error, MessageError):
                self._link.session.rights.refused += 1
            self._link.fail(error, op)

    async def _set_level(self, op: Op) -> None:
        self._link.set_level(text(op, "level"))

    async def _auth(self, op: Op) -> None:
        """Ignore the authentication of ROS 1, whose server no longer exists."""
        problem = "it has no effect; connect with a token instead"
        self._link.session.rights.note(Refusal.IGNORED, "auth", problem)
        self._link.status("warning", f"auth: {problem}", op)

"""A rosbridge client in the gateway's process, without a socket."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any, Final

import cbor2
import msgspec

from aionode.gateway.policy.identity import Identity
from aionode.gateway.policy.policy import Policy
from aionode.gateway.rosbridge.client import serve_frames
from aionode.gateway.session.audit import Audit
from aionode.gateway.session.delivery.outbox import Frame, LongFrame
from aionode.gateway.session.encoding.frames import Fragmented
from aionode.gateway.session.robot import Robot
from aionode.gateway.session.session import Session
from aionode.node import Node

__all__ = ["RosbridgeClient", "robot_of", "rosbridge_client"]


ALL: Final = Policy.default(allow_write=True)
SMALL_FRAMES: Final = msgspec.structs.replace(
    ALL, limits=msgspec.structs.replace(ALL.limits, frame_bytes=1000)
)


class RosbridgeClient:
    """Sends to rosbridge like a page or program, and receives from it.

    Attributes:
        session: Its session in the gateway.
    """

    def __init__(self, session: Session) -> None:
        self.session = session
        self._frames: asyncio.Queue[str | bytes | None] = asyncio.Queue()
        self._received = session.outbox.__aiter__()

    def send(self, op: str, **fields: Any) -> None:
        """Send an op."""
        self.send_frame(json.dumps({"op": op, **fields}))

    def send_frame(self, frame: str | bytes) -> None:
        """Send any frame."""
        self._frames.put_nowait(frame)

    def leave(self) -> None:
        """Close the connection."""
        self._frames.put_nowait(None)

    async def frames(self) -> AsyncIterator[str | bytes]:
        """Yield what was sent."""
        while (frame := await self._frames.get()) is not None:
            yield frame

    async def frame(self) -> Frame:
        """Return the next frame that the client gets."""
        return await anext(self._received)

    async def receive(self) -> Any:
        """Return the next op that the client gets, decoded."""
        frame = await self.frame()
        if isinstance(frame, Fragmented):
            return [json.loads(part) for part in frame.parts()]
        is_text = frame.is_text if isinstance(frame, LongFrame) else isinstance(frame, str)
        return json.loads(str(frame)) if is_text else cbor2.loads(bytes(frame))  # type: ignore[arg-type]  # no str

    async def call(self, name: str, /, **args: Any) -> Any:
        """Return the response of a service."""
        self.send("call_service", service=name, id="call", args=args)
        return await self.receive()


@asynccontextmanager
async def robot_of(node: Node, policy: Policy | None = None) -> AsyncIterator[Robot]:
    """Yield the shared state of a gateway's sessions; by default only large frames are refused."""
    audit = Audit(node, "")
    async with asyncio.TaskGroup() as tasks:
        robot = Robot(node, policy or SMALL_FRAMES, audit, tasks)
        try:
            yield robot
        finally:
            robot.close()
            audit.close()


@asynccontextmanager
async def rosbridge_client(robot: Robot) -> AsyncIterator[RosbridgeClient]:
    """Yield a client that is connected until the block ends."""
    async with asyncio.TaskGroup() as tasks:
        identity = Identity("tester", address="127.0.0.1")
        async with Session(robot, identity, "rosbridge") as session:
            client = RosbridgeClient(session)
            serving = tasks.create_task(serve_frames(session, client.frames()))
            try:
                yield client
            finally:
                client.leave()
                await serving

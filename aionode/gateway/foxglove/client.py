"""Foxglove's protocol, ``foxglove.sdk.v1``, for one client and its session."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable, Hashable
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING, Any, Final
from uuid import uuid4

from aionode.engine.wire import cdr
from aionode.errors import AionodeError, EntityDestroyedError, MessageError
from aionode.gateway.foxglove import frames
from aionode.gateway.foxglove.channels import Channels
from aionode.gateway.foxglove.parameters import Parameters
from aionode.gateway.foxglove.playback import Playback
from aionode.gateway.session.assets import asset_of_uri, read_asset
from aionode.gateway.session.encoding.client_json import decoded
from aionode.gateway.session.encoding.values import json_of
from aionode.gateway.session.lanes import Lanes
from aionode.graph import EndpointKind

if TYPE_CHECKING:
    from aionode.bag import Player
    from aionode.gateway.session.delivery.subscribed import Subscribed
    from aionode.gateway.session.session import Session

__all__ = ["serve_frames"]

CAPABILITIES: Final = (
    "clientPublish",
    "services",
    "parameters",
    "parametersSubscribe",
    "connectionGraph",
    "assets",
    "time",
)
ENCODINGS: Final = ("cdr", "json")
SETTLING_SEC: Final = 0.1
"""How long after a change of the graph to wait for further ones: a starting robot makes
hundreds."""

MAX_MALFORMED: Final = 100
"""Number of frames that are not valid ops after which a client is disconnected."""

MAX_CHANNELS: Final = 1000
"""Maximum number of channels that a client may advertise."""

ERROR: Final = 2
"""The level of an error status; 0 is information and 1 a warning."""


async def serve_frames(
    session: Session, incoming: AsyncIterator[bytes | str], player: Player | None = None
) -> None:
    """Serve one client until its frames end.

    Cancelling ends everything that the client has started.

    Args:
        session: The session of the client; its outbox is sent by the caller.
        incoming: The frames of the client.
        player: A bag's player, which Foxglove's timeline controls through the services of its node.
    """
    async with asyncio.TaskGroup() as tasks:
        lanes = Lanes(tasks)
        client = Client(session, lanes, player)
        client.greet()
        watching = tasks.create_task(client.watch())
        playing = tasks.create_task(client.playback.watch())
        try:
            async for frame in incoming:
                await client.take(frame)
                if client.malformed > MAX_MALFORMED:
                    break
        finally:
            watching.cancel()
            playing.cancel()
            lanes.cancel()


class Client:
    """One client.

    Attributes:
        malformed: Number of its frames that were not valid ops.
        playback: The player that it controls.
    """

    def __init__(self, session: Session, lanes: Lanes, player: Player | None) -> None:
        self._session = session
        self._lanes = lanes
        self._published: dict[int, frames.ClientChannel] = {}
        self._graph: Connections | None = None
        self._news = asyncio.Event()
        self.malformed = 0
        self.playback = Playback(session, player)
        self._channels = Channels(session, self.playback.time_ns)
        self._parameters = Parameters(session)
        session.on_policy = self._note_policy

    def greet(self) -> None:
        """Send the name and the capabilities of this server."""
        info = {
            "name": "aionode",
            "capabilities": [*CAPABILITIES, *self.playback.capabilities],
            "supportedEncodings": ENCODINGS,
            "metadata": {"ROS_DISTRO": self._session.robot.node.context.ros_distro},
            "sessionId": str(uuid4()),
            **self.playback.range,
        }
        self._session.outbox.send(frames.op_frame("serverInfo", info))

    async def watch(self) -> None:
        """Announce topics and services again whenever the graph or the policy has changed."""
        robot = self._session.robot
        with suppress(EntityDestroyedError):  # the context has closed
            while True:
                self._news.clear()
                changed = robot.node.graph.changed()
                changed.add_done_callback(lambda _: self._news.set())
                await self._session.graph.turn()
                await self._channels.announce()
                if self._graph is not None:
                    self._graph.tell()
                await self._news.wait()
                if changed.done():
                    changed.result()
                changed.cancel()
                await robot.clock.sleep(SETTLING_SEC)

    def _note_policy(self, ended: list[Subscribed]) -> None:
        """Handle a change of policy that has ended subscriptions."""
        self._channels.tell_ended(ended)
        self._parameters.forget(ended)
        self._news.set()

    async def take(self, frame: bytes | str) -> None:
        """Handle a frame; failures are reported to the client as a status."""
        try:
            max_parts = self._session.rights.limits.frame_parts
            asked = (
                frames.op_of(frame, max_parts)
                if isinstance(frame, str)
                else frames.binary_of(frame)
            )
        except MessageError as error:
            self.malformed += 1
            self._session.rights.refused += 1
            self._refuse(error)
            return
        try:
            await self._lanes.admit(frame)
            await self._begin(asked)
        except MessageError as error:  # too much is in progress
            self._refuse(error)

    async def _begin(self, asked: frames.Asked) -> None:
        """Start the op of a frame, after the ops that it has to wait for."""
        match asked:
            case frames.Advertise():
                for channel in asked.channels:
                    await self._put(("publish", channel.id), self._advertise, channel)
            case frames.Unadvertise():
                for channel_id in asked.channel_ids:
                    await self._put(("publish", channel_id), self._unadvertise, channel_id)
            case frames.ClientMessage():
                # it may wait, and be too old by then
                arrived_ns = self._session.arrivals.arrival_ns()
                await self._put(("publish", asked.channel_id), self._publish, asked, arrived_ns)
            case frames.ServiceCall():
                self._start(self._call, asked, self._session.arrivals.arrival_ns())
            case frames.PlaybackRequest():
                await self._put("playback", self.playback.control, self._start, asked)
            case frames.FetchAsset():
                await self._put("assets", self._fetch, asked)  # one file at a time
            case frames.Subscribe() | frames.Unsubscribe():
                await self._put("channels", self._do, asked)
            case _:
                await self._put(type(asked).__name__.removeprefix("Un"), self._do, asked)

    async def _put(
        self, lane: Hashable, work: Callable[..., Awaitable[None]], *arguments: Any
    ) -> None:
        await self._lanes.put(lane, partial(self._attempt, work, *arguments))

    def _start(self, work: Callable[..., Awaitable[None]], *arguments: Any) -> None:
        self._lanes.start(partial(self._attempt, work, *arguments))

    async def _attempt(self, work: Callable[..., Awaitable[None]], *arguments: Any) -> None:
        """Await work, and report a failure to the client."""
        try:
            await work(*arguments)
        except (AionodeError, TimeoutError) as error:
            self._refuse(error)

    def _refuse(self, error: Exception) -> None:
        self._session.rights.note_failure(error)
        status = {"level": ERROR, "message": str(error) or "no answer in time"}
        self._session.outbox.send(frames.op_frame("status", status))

    async def _do(self, op: frames.Op) -> None:
        """Do an op about channels, parameters or the graph."""
        match op:
            case frames.Subscribe():
                for wish in op.subscriptions:
                    await self._attempt(self._channels.subscribe, wish.id, wish.channel_id)
            case frames.Unsubscribe():
                self._channels.unsubscribe(op.subscription_ids)
            case frames.GetParameters():
                await self._parameters.get(op.parameter_names, op.id)
            case frames.SetParameters():
                await self._parameters.set(op.parameters, op.id)
            case frames.SubscribeParameterUpdates():
                await self._parameters.follow(op.parameter_names)
            case frames.UnsubscribeParameterUpdates():
                self._parameters.unfollow(op.parameter_names)
            case frames.SubscribeConnectionGraph():
                await self._session.graph.turn()
                self._graph = Connections(self._session)
                self._graph.tell()
            case frames.UnsubscribeConnectionGraph():
                self._graph = None

    async def _fetch(self, asked: frames.FetchAsset) -> None:
        try:
            content = await read_asset(self._session, asset_of_uri(asked.uri))
        except (AionodeError, FileNotFoundError) as error:
            if isinstance(error, AionodeError):
                self._session.rights.note_failure(error, "fetchAsset")
            frame = frames.asset_frame(asked.request_id, error=str(error))
        else:
            frame = frames.asset_frame(asked.request_id, content)
        self._session.outbox.send(frame)

    # Messages and calls of the client

    async def _advertise(self, channel: frames.ClientChannel) -> None:
        if channel.encoding not in ENCODINGS:
            problem = f"{channel.encoding!r}; use one of {', '.join(ENCODINGS)}"
            raise MessageError(f"encoding of {channel.topic}", problem)
        if channel.id in self._published:
            raise MessageError("advertise", f"channel {channel.id} is already advertised")
        if len(self._published) >= MAX_CHANNELS:
            raise MessageError("advertise", f"{MAX_CHANNELS} channels are advertised, the limit")
        self._published[channel.id] = channel  # before it waits: others may advertise meanwhile
        try:
            await self._session.advertise(channel.topic, channel.schema_name)
        except BaseException:
            del self._published[channel.id]
            raise

    async def _unadvertise(self, channel_id: int) -> None:
        channel = self._published.pop(channel_id, None)
        if channel is None:
            raise MessageError("unadvertise", f"the client has no channel {channel_id}")
        await self._session.unadvertise(channel.topic)

    async def _publish(self, given: frames.ClientMessage, arrived_ns: int) -> None:
        channel = self._published.get(given.channel_id)
        if channel is None:
            problem = f"the client has no channel {given.channel_id}; advertise it first"
            raise MessageError("message", problem)
        values = values_of(channel.encoding, given.data, self._session.rights.limits.frame_parts)
        await self._session.publish(
            channel.topic, values, channel.schema_name, arrived_ns=arrived_ns
        )

    async def _call(self, call: frames.ServiceCall, arrived_ns: int) -> None:
        try:
            if call.encoding not in ENCODINGS:
                raise MessageError("call", f"encoding {call.encoding!r}; use one of {ENCODINGS}")
            name, type_name = self._channels.service(call.service_id)
            values = values_of(call.encoding, call.data, self._session.rights.limits.frame_parts)
            # The protocol has no time limit.
            response = await self._session.call(
                name,
                values,
                type_name=type_name,
                timeout_sec=self._session.wait_sec(None),
                arrived_ns=arrived_ns,
            )
        except (AionodeError, TimeoutError) as error:
            self._session.rights.note_failure(error, "call")
            failure = {
                "serviceId": call.service_id,
                "callId": call.call_id,
                "message": str(error) or "no answer in time",
            }
            self._session.outbox.send(frames.op_frame("serviceCallFailure", failure))
            return
        data = json_of(response) if call.encoding == "json" else bytes(cdr.encode(response))
        self._session.outbox.send(frames.response_frame(call, data))


def values_of(encoding: str, data: memoryview, max_parts: int) -> Any:
    """Return the values of a message or request: CDR unchanged, JSON decoded.

    Raises:
        MessageError: the bytes are not JSON.
    """
    if encoding == "cdr":
        return bytes(data)
    return decoded(data, max_parts, "message")


class Connections:
    """The connection graph as sent to one client.

    Args:
        session: Its session, which omits names that the policy hides.
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        self._known: list[dict[str, list[str]]] = [{}, {}, {}]

    def tell(self) -> None:
        """Send the changes since the last time, if there are any."""
        now = self._connections()
        changed = [
            {name: nodes for name, nodes in new.items() if old.get(name) != nodes}
            for old, new in zip(self._known, now, strict=True)
        ]
        gone = [
            [name for name in old if name not in new]
            for old, new in zip(self._known, now, strict=True)
        ]
        self._known = now
        if not any(changed) and not any(gone):
            return
        published, subscribed, served = changed
        topics = {*gone[0], *gone[1]}
        # A topic that has only lost its publishers remains, as one without publishers.
        left = {name for name in topics if name in now[0] or name in now[1]}
        for name in left:
            published.update({} if name in now[0] else {name: []})
            subscribed.update({} if name in now[1] else {name: []})
        self._session.outbox.send(
            frames.op_frame(
                "connectionGraphUpdate",
                {
                    "publishedTopics": listed(published, "publisherIds"),
                    "subscribedTopics": listed(subscribed, "subscriberIds"),
                    "advertisedServices": listed(served, "providerIds"),
                    "removedTopics": sorted(topics - left),
                    "removedServices": gone[2],
                },
            )
        )

    def _connections(self) -> list[dict[str, list[str]]]:
        """Return the nodes that publish, subscribe to and serve each name."""
        kinds = (EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION, EndpointKind.SERVER)
        return [self._session.graph.connections(kind) for kind in kinds]


def listed(nodes: dict[str, list[str]], ids: str) -> list[dict[str, Any]]:
    """Return the names with their nodes in the form that the protocol uses."""
    return [{"name": name, ids: nodes[name]} for name in sorted(nodes)]

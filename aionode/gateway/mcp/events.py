"""Events of the robot for listening clients: warnings of its log, and what its program reports."""

from __future__ import annotations

import asyncio
from collections import deque
from typing import TYPE_CHECKING, Any, Final

import anyio
from mcp.server.subscriptions import (
    InMemorySubscriptionBus,
    ListenHandler,
    ResourcesListChanged,
    ResourceUpdated,
    ToolsListChanged,
)
from mcp.shared.exceptions import MCPError
from mcp_types.version import MODERN_PROTOCOL_VERSIONS

from aionode._process.recent import Recent
from aionode.interfaces.rcl_interfaces.msg import Log

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.gateway._clients import Clients
    from aionode.gateway.session.feed import Received

__all__ = ["EVENTS", "Events"]

EVENTS: Final = "robot://events"
"""The resource that lists the events."""

MAX_EVENTS: Final = 100
"""Number of events that are kept; the newest ones."""

MAX_TEXT: Final = 500
"""The longest text of an event, in characters."""

MAX_SESSIONS: Final = 1000
"""Number of sessions of older revisions that are notified of changes; the newest ones."""

PERIOD_SEC: Final = 0.5
"""The least time between two notifications, in seconds; clients then read all new events."""

WARNING: Final = 30
LEVELS: Final = {30: "warn", 40: "error", 50: "fatal"}

LOG: Final = "/rosout"


class Events:
    """Keeps the events, and tells clients when there are new ones.

    Args:
        clients: All clients of the robot.

    Attributes:
        listen: Serves clients that listen by the newest revision.
    """

    def __init__(self, clients: Clients) -> None:
        self._clients = clients
        self._bus = InMemorySubscriptionBus()
        self.listen = ListenHandler(self._bus, max_subscriptions=clients.policy.limits.clients)
        self._kept: deque[dict[str, Any]] = deque(maxlen=MAX_EVENTS)
        self._happened = asyncio.Event()
        self._sessions: Recent[int, Any] = Recent(MAX_SESSIONS)
        self._subscribed: Recent[int, Any] = Recent(MAX_SESSIONS)
        self._leave: Callable[[], None] | None = None

    def tell(self, text: str, level: str = "info", source: str = "") -> None:
        """Keep an event, and notify clients of it."""
        time = round(self._clients.robot.time_base.system_ns() / 1e9, 3)
        event = {"time": time, "level": level, "source": source, "text": text[:MAX_TEXT]}
        self._kept.append(event)
        self._happened.set()

    def seen(self, *, with_log: bool) -> list[dict[str, Any]]:
        """Return the events, oldest first.

        Args:
            with_log: Whether to include those of the robot's log.
        """
        return [event for event in self._kept if with_log or not event["source"]]

    def follow_log(self) -> None:
        """Keep the warnings of the robot's log from now on, and those that its nodes still hold."""
        if self._leave is None:
            self._leave = self._clients.robot.feeds.add(LOG, Log, None, self._take)

    def _take(self, received: Received) -> None:
        message = received.message
        if message.level >= WARNING and message.name != self._clients.node.get_logger().name:
            self.tell(message.msg, LEVELS.get(message.level, "fatal"), message.name)

    # Clients of the older revisions

    def note(self, context: Any) -> None:
        """Notify an older revision's client of changes of its tools from now on."""
        if context.protocol_version not in MODERN_PROTOCOL_VERSIONS:
            self._sessions.put(id(context.session._connection), context.session)

    def subscribe(self, context: Any) -> None:
        """Notify the client of a request of events from now on."""
        self.follow_log()
        self._subscribed.put(id(context.session._connection), context.session)

    def unsubscribe(self, context: Any) -> None:
        """Stop notifying the client of a request of events."""
        self._subscribed.pop(id(context.session._connection), None)

    # Notifying clients

    async def run(self) -> None:
        """Notify clients of events, and of changed tools, until cancelled."""
        try:
            async with asyncio.TaskGroup() as tasks:
                tasks.create_task(self._tell_events())
                tasks.create_task(self._tell_changes())
        finally:
            self.listen.close()
            if self._leave is not None:
                self._leave()

    async def _tell_events(self) -> None:
        while True:
            await self._happened.wait()
            self._happened.clear()
            await self._bus.publish(ResourceUpdated(EVENTS))
            for key, session in list(self._subscribed.items()):
                if not await reached(session.send_resource_updated(EVENTS)):
                    self._subscribed.pop(key, None)
            await self._clients.robot.clock.sleep(PERIOD_SEC)

    async def _tell_changes(self) -> None:
        graph, before = self._clients.node.graph, None
        while True:
            now = (graph.changes, self._clients.policy)
            if before is not None and now != before:
                for event in (ToolsListChanged(), ResourcesListChanged()):
                    await self._bus.publish(event)
                for key, session in list(self._sessions.items()):
                    if not await reached(session.send_tool_list_changed()):
                        self._sessions.pop(key, None)
            before = now
            await self._clients.robot.clock.sleep(2 * PERIOD_SEC)


async def reached(sending: Any) -> bool:
    """Send a notification, and return whether it was sent; a client may be gone, or not read."""
    try:
        async with asyncio.timeout(PERIOD_SEC):
            await sending
    except (MCPError, TimeoutError, anyio.ClosedResourceError, anyio.BrokenResourceError):
        return False
    return True

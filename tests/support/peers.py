"""Other participants for tests over Zenoh, isolated from everything else on the machine."""

from __future__ import annotations

import asyncio
import json
import os
import secrets
import socket
from collections import deque
from collections.abc import AsyncIterator, Iterator, Mapping
from contextlib import ExitStack, asynccontextmanager, closing, contextmanager, suppress
from typing import Any

import pytest
import zenoh  # noqa: TID251  # plays the other participants, without aionode

from aionode.engine.context import Context
from aionode.node import Node
from aionode.qos import DurabilityPolicy, HistoryPolicy, QoSProfile

__all__ = [
    "KEEP_ALL",
    "Collector",
    "contexts_over",
    "free_ports",
    "isolated",
    "isolated_environment",
    "kept",
    "known",
    "quiet_node",
    "raw_session",
    "ros_router",
    "ros_session",
    "ros_value",
    "router_client",
    "two_contexts",
]

DOMAIN_ID = 42

KEEP_ALL = QoSProfile(history=HistoryPolicy.KEEP_ALL)


def kept(depth: int) -> QoSProfile:
    """Return a profile that sends the last messages to late subscriptions."""
    return QoSProfile(depth=depth, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def ros_value(value: Any) -> Any:
    """Return a recorded value in aionode's form: an empty message has no field."""
    if isinstance(value, dict):
        return {
            name: ros_value(each)
            for name, each in value.items()
            if name != "structure_needs_at_least_one_member"
        }
    return value


given_ports = deque[int](maxlen=500)
"""The last ports that were handed out, which are perhaps not listened on yet."""


def free_ports(count: int) -> list[int]:
    """Return free loopback ports that nothing else will use by chance.

    They are below the ephemeral ports, which the system assigns to other sessions, such as those of
    another run of these tests. Each worker of a run has ports of its own: its sessions look for
    each other also at those that nobody listens on, and would join a test of another worker.
    """
    workers = int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1"))
    worker = int(os.environ.get("PYTEST_XDIST_WORKER", "gw0").removeprefix("gw"))
    found: list[int] = []
    with ExitStack() as until_all_are_found:
        while len(found) < count:
            port = 10_000 + secrets.randbelow(22_000 // workers) * workers + worker
            if port in given_ports:
                continue
            one = until_all_are_found.enter_context(socket.socket())
            with suppress(OSError):
                one.bind(("127.0.0.1", port))
                found.append(port)
                given_ports.append(port)
    return found


def isolated_environment() -> dict[str, str]:
    """Return environment variables with which processes see only each other."""
    ports = free_ports(4)
    return {
        "ROS_DOMAIN_ID": str(DOMAIN_ID),
        "AIONODE_MEETING_PORTS": ",".join(str(p) for p in ports[:3]),
        "AIONODE_ROUTER_PORT": str(ports[3]),
    }


@pytest.fixture(autouse=True)
def isolated(monkeypatch: pytest.MonkeyPatch) -> None:
    """Contexts and processes of a test reach each other, and nothing else on the machine."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)


@asynccontextmanager
async def two_contexts(**options: Any) -> AsyncIterator[tuple[Context, Context]]:
    """Two participants that know each other, in one process."""
    async with Context(**options) as first, Context(**options) as second:
        yield first, second


@asynccontextmanager
async def contexts_over(way: str, **options: Any) -> AsyncIterator[tuple[Context, Context]]:
    """One context twice, or two connected by a link or only by Zenoh, like processes.

    Args:
        way: ``local``, ``link`` or ``zenoh``.
        options: Further options of the contexts.
    """
    if way == "local":
        async with Context(transport="local", **options) as context:
            yield context, context
    else:
        async with two_contexts(link=way == "link", **options) as both:
            yield both


@contextmanager
def router_client(port: str) -> Iterator[zenoh.Session]:
    """A plain Zenoh program that sees only the session that it dials."""
    config = zenoh_config(
        {
            "mode": "client",
            "connect/endpoints": [f"tcp/127.0.0.1:{port}"],
            "scouting/multicast/enabled": False,
        }
    )
    with closing(zenoh.open(config)) as session:
        yield session


def quiet_node(name: str, context: Context | None = None, **options: Any) -> Node:
    """Return a node without services and parameters, by default in a context of its own."""
    options = {"enable_rosout": False, "start_parameter_services": False, **options}
    return Node(name, context=context or Context(), **options)


class Collector:
    """Collects items from other threads, and lets a test wait for them."""

    def __init__(self) -> None:
        self._loop = asyncio.get_running_loop()
        self._changed = asyncio.Event()
        self.items: list[Any] = []

    def __call__(self, item: Any) -> None:
        """Add one item; from any thread."""
        self.items.append(item)
        self._loop.call_soon_threadsafe(self._changed.set)

    async def have(self, count: int) -> list[Any]:
        """Wait for `count` items, and return them."""
        while len(self.items) < count:
            self._changed.clear()
            if len(self.items) < count:
                await self._changed.wait()
        return self.items


def zenoh_config(settings: Mapping[str, Any]) -> zenoh.Config:
    """Return a configuration with these settings."""
    config = zenoh.Config()
    for key, value in settings.items():
        config.insert_json5(key, json.dumps(value))
    return config


@contextmanager
def raw_session(listen: str = "tcp/127.0.0.1:0") -> Iterator[zenoh.Session]:
    """A plain Zenoh session that dials the first meeting port, unless it listens there itself."""
    port = os.environ["AIONODE_MEETING_PORTS"].split(",")[0]
    config = zenoh_config(
        {
            "listen/endpoints": [listen],
            "connect/endpoints": [] if listen.endswith(port) else [f"tcp/127.0.0.1:{port}"],
            "open/return_conditions/connect_scouted": False,
            "scouting/multicast/enabled": False,
            "timestamping/enabled": True,
        }
    )
    with closing(zenoh.open(config)) as session:
        yield session


async def known(session: zenoh.Session, tokens: str, count: int = 1) -> list[str]:
    """Wait until a session sees `count` matching tokens, and return them."""
    found = Collector()
    subscriber = session.liveliness().declare_subscriber(tokens, found, history=True)
    try:
        # One may come twice: with the history, and as news.
        while len(keys := list(dict.fromkeys(str(each.key_expr) for each in found.items))) < count:
            await found.have(len(found.items) + 1)
    finally:
        subscriber.undeclare()
    return keys


EVERYBODY = ["router", "peer"]


def ros_session() -> zenoh.Session:
    """Return a session like that of a ROS 2 node on rmw_zenoh_cpp, except for the router's port."""
    return zenoh.open(
        zenoh_config(
            {
                "mode": "peer",
                "connect/endpoints": [f"tcp/localhost:{os.environ['AIONODE_ROUTER_PORT']}"],
                "connect/timeout_ms": -1,
                "connect/exit_on_failure": False,
                "connect/retry": {
                    "period_init_ms": 1000,
                    "period_max_ms": 4000,
                    "period_increase_factor": 2,
                },
                "listen/endpoints": ["tcp/localhost:0"],
                "open/return_conditions/connect_scouted": False,
                "scouting/multicast/enabled": False,
                "scouting/gossip/enabled": True,
                "scouting/gossip/target": {"router": EVERYBODY, "peer": ["router"]},
                "scouting/gossip/autoconnect": {"router": [], "peer": EVERYBODY},
                "scouting/gossip/autoconnect_strategy": {
                    "peer": {"to_router": "always", "to_peer": "greater-zid"}
                },
                "timestamping/enabled": True,
                "queries_default_timeout": 600_000,
                "transport/link/tx/lease": 60_000,
                "transport/link/tx/keep_alive": 2,
                "transport/shared_memory/enabled": False,
            }
        )
    )


def ros_router() -> zenoh.Session:
    """Return a router with the settings of `rmw_zenohd`, but another port and only loopback."""
    return zenoh.open(
        zenoh_config(
            {
                "mode": "router",
                "listen/endpoints": [f"tcp/127.0.0.1:{os.environ['AIONODE_ROUTER_PORT']}"],
                "connect/endpoints": [],
                "open/return_conditions/connect_scouted": False,
                "scouting/multicast/enabled": False,
                "scouting/gossip/enabled": True,
                "scouting/gossip/target": {"router": EVERYBODY, "peer": ["router"]},
                "scouting/gossip/autoconnect": {"router": [], "peer": EVERYBODY},
                "timestamping/enabled": True,
                "queries_default_timeout": 600_000,
                "transport/link/tx/lease": 60_000,
                "transport/link/tx/keep_alive": 2,
                "transport/shared_memory/enabled": False,
                "adminspace/enabled": True,
            }
        )
    )

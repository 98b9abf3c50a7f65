"""The movers and wheels of fault cases, and records of what wheels have received.

A `Mover` commands motion, a `Wheel` obeys; both are part of a `Role`. Each command says when and by
which process it was sent. What a wheel receives goes to the harness as `Handed`, with a time of the
monotonic clock, which all processes of a host share.
"""

from __future__ import annotations

from typing import Literal

import msgspec

__all__ = ["Asks", "Handed", "Mover", "Program", "Way", "What", "Wheel"]

Asks = Literal["lease", "publisher", "finally", "goal", "goal left", "policy", "policy apart"]
"""How it requests motion: by a lease of a publisher, by a plain publisher, by one whose ``finally``
publishes a last message, by a goal that it awaits or does not await, or by the chunks of a policy
in a thread or in another process."""

Program = Literal["run", "asyncio", "uvicorn", "page"]
"""How it runs: by `aionode.run`, `asyncio.run`, in a route of FastAPI, or as a client of a gateway.
"""

Way = Literal[
    "rosbridge",
    "foxglove json",
    "foxglove cdr",
    "http",
    "mcp stdio new",
    "mcp stdio old",
    "mcp http new",
    "mcp http old",
]
"""The protocol by which it is a client of a gateway; for MCP, with the transport and revision."""

What = Literal["move", "stop", "silence"]
"""A command to move; a command to stop, or the end of a goal; or a call of ``on_silence``."""


class Mover(msgspec.Struct, frozen=True):
    """A program that requests motion, 20 times a second if by messages.

    Attributes:
        topic: The topic or the action.
        asks: How it requests motion.
        program: How it runs.
        ttl_sec: The time to live of its lease.
        period_s: Time between two commands.
        transient: Whether its publisher keeps its last messages for late subscriptions.
        port: The port of its web server; 0 without one.
        route: The route that moves.
        graceful_s: How long its web server waits for connections at its end; None for no limit.
        cleans_up_s: How long it continues within its lease after it was cancelled, or how long its
            ``finally`` takes before it publishes.
        old_signals: Whether SIGHUP, or a second signal however soon it comes, ends it without
            cleanup, for comparison with aionode's handling of signals.
        way: The protocol by which it drives through a gateway.
        client: Its identity there, which is also its token.
        host: The host of the gateway.
        seconds: How long a call by MCP moves at most.
        has_defaults: Whether it sends a type whose definition has defaults, which only the wheels
            know: see `Wheel`.
        sends_zeros: Whether it sends zeros instead of these defaults.
    """

    topic: str
    asks: Asks = "lease"
    program: Program = "run"
    ttl_sec: float = 0.3
    period_s: float = 0.05
    transient: bool = False
    port: int = 0
    route: Literal["awaited", "streamed"] = "awaited"
    graceful_s: int | None = 1
    cleans_up_s: float = 0.0
    old_signals: bool = False
    way: Way = "rosbridge"
    client: str = "page"
    host: str = "127.0.0.1"
    seconds: float = 10.0
    has_defaults: bool = False
    sends_zeros: bool = False


class Wheel(msgspec.Struct, frozen=True):
    """Wheels, which obey.

    Attributes:
        topic: The topic or the action.
        action: Whether it obeys goals; otherwise it obeys messages.
        silence_sec: The ``silence_sec`` of its subscription; 0 if it has no ``on_silence``.
        lost_sec: The ``client_lost_sec`` of its action server; 0 if it does not detect lost
            clients.
        accepts: Whether its action server has a ``cancel_callback`` that accepts.
        continues: Whether its action server has ``on_client_lost="continue"``.
        transient: Whether it requests the messages that its publishers have kept.
        has_defaults: Whether its type belongs to the package ``minibot_interfaces``, whose fields
            have defaults: it drives until the target is within the tolerance of the goal, or for as
            long as a command says.
    """

    topic: str
    action: bool = False
    silence_sec: float = 0.0
    lost_sec: float = 0.0
    accepts: bool = True
    continues: bool = False
    transient: bool = False
    has_defaults: bool = False


class Handed(msgspec.Struct, frozen=True, array_like=True):
    """Something that a wheel has received.

    Attributes:
        topic: The topic or the action.
        what: What it was.
        time_s: When it was received.
        by: The process that requested it; 0 if unknown.
        sent_s: When it was sent; 0 if unknown.
    """

    topic: str
    what: What
    time_s: float
    by: int = 0
    sent_s: float = 0.0

"""The movers and wheels of fault cases, and records of what wheels were given.

A `Mover` commands motion, a `Wheel` obeys; both are part of a `Role`. Each command says when and by
which process it was sent. What a wheel is given goes to the harness as `Handed`, with a time of the
monotonic clock, which all processes of a host share.
"""

from __future__ import annotations

from typing import Literal

import msgspec

__all__ = ["Asks", "Handed", "Mover", "Program", "Way", "What", "Wheel"]

Asks = Literal["lease", "publisher", "finally", "goal", "goal left", "policy", "policy apart"]
"""By what it asks for motion: a lease of a publisher, a plain publisher, one whose ``finally``
publishes a last message, a goal that it awaits, one that it does not await, or the chunks of a
policy, in a thread or in another process."""

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
"""By which way in it is a client of a gateway; by MCP, with which transport and revision."""

What = Literal["move", "stop", "silence"]
"""A command to move; a command to stop, or the end of a goal; a call of ``on_silence``."""


class Mover(msgspec.Struct, frozen=True):
    """What asks for motion, 20 times a second if it is by messages.

    Attributes:
        topic: The topic or the action.
        asks: By what.
        program: How it runs.
        ttl_sec: The time to live of its lease.
        period_s: Time between two commands.
        transient: Whether its publisher keeps its last messages for late subscriptions.
        port: On which its web server listens; 0 without one.
        route: The route of it that moves.
        graceful_s: How long its web server waits for connections at its end; None without limit.
        cleans_up_s: How long it goes on within its lease after it was cancelled; or what its
            ``finally`` does before it publishes.
        old_signals: Whether SIGHUP ends it without cleanup, and so does a second signal, however
            soon it comes: what aionode's handling of signals is compared with.
        way: By which way in it drives through a gateway.
        client: Who it is there, and its token.
        host: Where the gateway is.
        seconds: For how long a call by MCP moves at most.
        has_defaults: Whether it sends what has defaults in its definition, which only the wheels
            have: see `Wheel`.
        sends_zeros: Whether it sends zeros in their place.
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
    """What obeys.

    Attributes:
        topic: The topic or the action.
        action: Whether it obeys goals; else messages.
        silence_sec: After which it is told of silence; 0 if it does not ask.
        lost_sec: After which it takes the client of a goal for lost; 0 if it does not look.
        accepts: Whether its server of goals has a callback that accepts to cancel them.
        continues: Whether it says that the goals of lost clients go on.
        transient: Whether it asks for what its publishers have kept.
        has_defaults: Whether its type is one of the package ``minibot_interfaces``, whose fields
            have defaults: it goes to a target until that is within the tolerance of the goal, or
            as long as a command says.
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
    """What a wheel was handed.

    Attributes:
        topic: The topic or the action.
        what: What it was.
        time_s: When.
        by: The process that asked for it; 0 if nobody says.
        sent_s: When it was sent; 0 if nobody says.
    """

    topic: str
    what: What
    time_s: float
    by: int = 0
    sent_s: float = 0.0

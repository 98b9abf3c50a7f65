"""The robot for browsers, programs and apps: several protocols on one port, governed by one policy.

It needs the extra ``gateway``::

    from aionode.gateway import Gateway, Policy

    async with Gateway(node, policy=Policy.load("policy.toml"), port=9090) as gateway:
        ...

Clients of rosbridge and Foxglove, browsers and curl all connect to one port. One file defines what
each of them may do; see `Policy`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from aionode._process.first_use import imported_on_first_use

if TYPE_CHECKING:
    from aionode.gateway._clients import GatewayStats
    from aionode.gateway._gateway import Gateway
    from aionode.gateway.http.typescript import typescript
    from aionode.gateway.mcp.assistant import Assistant
    from aionode.gateway.policy.identity import Credentials, Identity
    from aionode.gateway.policy.policy import (
        Decision,
        FieldLimit,
        LeaseRule,
        Limits,
        Policy,
        Rule,
        Tls,
        Verb,
        Who,
    )
    from aionode.gateway.session.session import Session

__all__ = [
    "Assistant",
    "Credentials",
    "Decision",
    "FieldLimit",
    "Gateway",
    "GatewayStats",
    "Identity",
    "LeaseRule",
    "Limits",
    "Policy",
    "Rule",
    "Session",
    "Tls",
    "Verb",
    "Who",
    "typescript",
]

PLACES: Final = {
    "Credentials": "policy.identity",
    "Gateway": "_gateway",
    "GatewayStats": "_clients",
    "Identity": "policy.identity",
    "Session": "session.session",
    "typescript": "http.typescript",
}
"""The module of each public name outside the policy, which alone needs no web server."""

_OF_GATEWAY = imported_on_first_use(
    __name__, dict.fromkeys(__all__, "policy.policy") | PLACES, "gateway"
)
_OF_ASSISTANT = imported_on_first_use(__name__, {"Assistant": "mcp.assistant"}, "mcp")


def __getattr__(name: str) -> Any:
    return _OF_ASSISTANT(name) if name == "Assistant" else _OF_GATEWAY(name)

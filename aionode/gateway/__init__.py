"""The robot for browsers, programs and apps: one policy, and several ways in.

It needs the extra ``gateway``::

    from aionode.gateway import Gateway, Policy

    async with Gateway(node, policy=Policy.load("policy.toml"), port=9090) as gateway:
        ...

Clients of rosbridge and of Foxglove connect to one port, and so do browsers and curl. What each of
them may do is said in one file; see `Policy`.
"""

from __future__ import annotations

from aionode.gateway._clients import GatewayStats
from aionode.gateway._gateway import Gateway
from aionode.gateway._identity import Credentials, Identity
from aionode.gateway._policy import Decision, FieldLimit, LeaseRule, Limits, Policy, Rule, Verb, Who
from aionode.gateway._session import Session

__all__ = [
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
    "Verb",
    "Who",
]

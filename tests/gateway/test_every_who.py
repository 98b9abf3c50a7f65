"""Every `[[who]]` of a policy, and every page that may not connect, over every protocol."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass, field
from typing import Any, Final

import pytest
from websockets.exceptions import InvalidStatus

from aionode.engine.context import Context
from aionode.gateway import Gateway, Policy
from aionode.gateway.server import connection as _connection
from aionode.gateway.server import http11
from aionode.gateway.session import audit as _audit
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node
from aionode.qos import DurabilityPolicy, QoSProfile
from tests.support.ways_in import WAYS, Ask, until, way_in


def bearer(token: str) -> dict[str, str]:
    """Return the header with a token."""
    return {"Authorization": f"Bearer {token}"}


@dataclass(frozen=True)
class Stranger:
    """What a client shows of itself, and as whom the gateway lets it in.

    Attributes:
        who: The name by the policy; empty if it is refused.
        headers: The headers of its request.
        address: Where it connects from.
        certificate: The common name of its certificate.
        host: By which name it knows the gateway.
    """

    who: str
    headers: dict[str, str] = field(default_factory=dict)
    address: str = "127.0.0.1"
    certificate: str = ""
    host: str = "127.0.0.1"


REFUSED: Final = "401 unauthorized"
ELSEWHERE: Final = "192.0.2.7"
DASHBOARD: Final = {"Origin": "https://dash.example.org"}

STRANGERS: Final = {
    "a token": Stranger("pilot", bearer("secret"), ELSEWHERE),
    "a token, of which the policy has the hash": Stranger("doctor", bearer("hush"), ELSEWHERE),
    "a wrong token": Stranger("", bearer("sesame"), ELSEWHERE),
    "a wrong token on loopback": Stranger("", bearer("sesame")),
    "a certificate": Stranger("arm", {}, ELSEWHERE, certificate="arm-7"),
    "another certificate": Stranger("", {}, ELSEWHERE, certificate="arm-8"),
    "loopback": Stranger("local"),
    "nothing": Stranger("", {}, ELSEWHERE),
    "an origin": Stranger("dashboard", DASHBOARD),
    "an origin, which a program may claim": Stranger("", DASHBOARD, ELSEWHERE),
    "another origin": Stranger("", {"Origin": "https://evil.example"}),
    "another origin, and a token": Stranger(
        "", {"Origin": "https://e.example", **bearer("secret")}
    ),
    "an opaque origin": Stranger("", {"Origin": "null"}),
    "another site": Stranger("", {"Sec-Fetch-Site": "cross-site"}),
    "a name of this host": Stranger("local", host="robot.local"),
    "another name for this host": Stranger("", host="evil.example"),
}

WHO: Final = """
hosts = ["robot.local"]
[[who]]
name = "pilot"
token = "secret"
[[who]]
name = "doctor"
token_sha256 = "HASH"
[[who]]
name = "arm"
certificate = "arm-7"
[[who]]
name = "dashboard"
origin = "https://dash.example.org"
[[who]]
name = "local"
loopback = true
[[allow]]
subscribe = "/status"
see = "/status"
""".replace("HASH", hashlib.sha256(b"hush").hexdigest())


@pytest.mark.parametrize("way", WAYS)
async def test_every_who_is_let_in_or_refused(
    context: Context, way: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Over each protocol; a refused client gets status 401, and a line in the audit log."""
    failed: dict[str, str] = {}
    now = STRANGERS["nothing"]
    monkeypatch.setattr(_audit, "REFUSALS_PER_SEC", 10_000)
    monkeypatch.setattr(http11, "common_name", lambda _: now.certificate)
    monkeypatch.setattr(_connection, "client_address", lambda _: (now.address, 1))
    lines: list[dict[str, Any]] = []
    async with (
        Node("robot", context=context) as robot,
        Node("gateway", context=context) as node,
        Gateway(node, Policy.parse(WHO), port=0) as gateway,
    ):
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        robot.create_publisher(String, "/status", latched).publish(String())
        robot.create_subscription(
            String, "/gateway/audit", lambda line: lines.append(json.loads(line.data)), 1000
        )
        for case, now in STRANGERS.items():
            lines.clear()
            told = await answer_of(way, gateway.port, now)
            line = await until(lambda: lines and lines[-1])
            found = (told, line["action"], line["who"], line["address"], line.get("code", ""))
            wanted = (REFUSED, "connect", "", now.address, "unauthorized")
            if now.who:
                wanted = ("", "subscribe", now.who, now.address, "")
            if found != wanted:
                failed[f"{way}, {case}"] = f"{found} is not {wanted}"

    assert not failed, "\n".join(f"{cell}: {why}" for cell, why in failed.items())


async def answer_of(way: str, port: int, stranger: Stranger) -> str:
    """Return the status and code with which a subscribing client is refused; empty if it may."""
    asked = Ask("subscribe", "/status", "std_msgs/msg/String", None, lambda: False)
    try:
        async with way_in(way, port, stranger.headers, stranger.host) as client:
            return (await client.do(asked)).code
    except InvalidStatus as error:
        return f"{error.response.status_code} {json.loads(error.response.body)['code']}"

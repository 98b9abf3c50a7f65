"""Certificates of the gateway and of its clients, over real TLS."""

from __future__ import annotations

import asyncio
import contextlib
import json
import ssl
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from pathlib import Path

import httpx
import pytest
import trustme
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import InvalidMessage, InvalidStatus

from aionode.gateway import Gateway, Policy
from aionode.interfaces.std_msgs.msg import String
from tests.support.gateway_server import serving, sessions_of
from tests.support.waiting import until

TOKEN = "secret"  # of this test

POLICY = """
[tls]
certificate = "{folder}/server.pem"
key = "{folder}/server-key.pem"
clients = "{folder}/clients.pem"
[[who]]
name = "driver"
certificate = "driver.example"
[[who]]
name = "holder"
token = "secret"
[[allow]]
who = "driver"
see = "/**"
publish = "/**"
subscribe = "/**"
[limits]
handshake_sec = 0.3
"""
LOCAL = '\n[[who]]\nname = "local"\nloopback = true\n'

Trust = Callable[..., ssl.SSLContext]


@pytest.fixture(scope="module")
def authorities() -> dict[str, trustme.CA]:
    """Create the authority of the gateway, that of its clients, and an unknown one."""
    return {name: trustme.CA() for name in ("server", "clients", "stranger")}


@pytest.fixture
def folder(tmp_path: Path, authorities: dict[str, trustme.CA]) -> Path:
    """Return a folder with the certificates that the policy names."""
    made = authorities["server"].issue_cert("localhost", "127.0.0.1")
    made.private_key_pem.write_to_path(tmp_path / "server-key.pem")
    made.cert_chain_pems[0].write_to_path(tmp_path / "server.pem")
    authorities["clients"].cert_pem.write_to_path(tmp_path / "clients.pem")
    return tmp_path


@pytest.fixture
def trust(authorities: dict[str, trustme.CA]) -> Trust:
    """Return a function that creates a client's TLS context, with or without a certificate."""

    def make(authority: str | None, name: str = "driver.example") -> ssl.SSLContext:
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
        authorities["server"].configure_trust(context)
        if authority is not None:
            made = authorities[authority].issue_cert(name, common_name=name)
            made.configure_cert(context)
        return context

    return make


@asynccontextmanager
async def websocket(
    gateway: Gateway, context: ssl.SSLContext, protocol: str = "", token: str = ""
) -> AsyncIterator[ClientConnection]:
    """Connect over TLS."""
    async with connect(
        f"wss://127.0.0.1:{gateway.port}/",
        ssl=context,
        proxy=None,
        subprotocols=[protocol] if protocol else None,  # type: ignore[list-item]  # a name
        additional_headers={"authorization": f"Bearer {token}"} if token else None,
    ) as made:
        yield made


async def get(gateway: Gateway, context: ssl.SSLContext, token: str = "") -> httpx.Response:
    """Return the topics that a client sees."""
    headers = {"authorization": f"Bearer {token}"} if token else None
    async with httpx.AsyncClient(trust_env=False, verify=context, timeout=50) as client:
        return await client.get(f"https://127.0.0.1:{gateway.port}/topics", headers=headers)


def policy(folder: Path, more: str = "") -> Policy:
    """Return the policy of the tests."""
    return Policy.parse(POLICY.format(folder=folder) + more)


@pytest.mark.parametrize("protocol", ["", "foxglove.sdk.v1"], ids=["rosbridge", "foxglove"])
async def test_a_certificate_tells_who_a_client_is(
    folder: Path, trust: Trust, protocol: str
) -> None:
    """By its common name, over every protocol; a certificate needs no token."""
    async with serving(policy(folder, LOCAL)) as gateway:
        names = []
        for context, token in ((trust("clients"), ""), (trust(None), TOKEN), (trust(None), "")):
            async with websocket(gateway, context, protocol, token):
                await until(lambda: gateway.stats.sessions)
                names += [session.identity.name for session in sessions_of(gateway)]
            await until(lambda: not gateway.stats.sessions)
            sees = (await get(gateway, context, token)).json() != []
            assert sees is (names[-1] == "driver")
        assert names == ["driver", "holder", "local"]


async def test_an_unsigned_certificate_cannot_connect(folder: Path, trust: Trust) -> None:
    """Even if its name is right, and the policy knows this machine."""
    async with serving(policy(folder, LOCAL)) as gateway:
        stranger = trust("stranger")
        with pytest.raises((httpx.ReadError, httpx.ConnectError, httpx.RemoteProtocolError)):
            await get(gateway, stranger)
        for protocol in ("", "foxglove.sdk.v1"):
            with pytest.raises((OSError, InvalidMessage)):
                async with websocket(gateway, stranger, protocol):
                    pass
        assert gateway.stats.sessions == {}


async def test_without_a_certificate_it_is_what_the_policy_says(folder: Path, trust: Trust) -> None:
    """Nothing here: it knows neither this machine nor a client without secrets."""
    async with serving(policy(folder)) as gateway:
        assert (await get(gateway, trust(None))).status_code == 401
        assert (await get(gateway, trust("clients"), "wrong")).status_code == 401
        for protocol in ("", "foxglove.sdk.v1"):
            with pytest.raises(InvalidStatus, match="401"):
                async with websocket(gateway, trust(None), protocol):
                    pass


async def test_a_name_that_the_policy_does_not_know_identifies_nobody(
    folder: Path, trust: Trust
) -> None:
    """The authority may sign certificates of others as well."""
    other = trust("clients", "other.example")
    async with serving(policy(folder)) as gateway:
        assert (await get(gateway, other)).status_code == 401


async def test_who_does_not_speak_tls_is_disconnected(folder: Path) -> None:
    """At once, or when the time for the handshake has passed: asyncio would allow a minute."""
    async with serving(policy(folder)) as gateway:
        for beginning in (b"", b"\x16\x03\x01", b"GET /topics HTTP/1.1\r\n\r\n"):
            reader, writer = await asyncio.open_connection("127.0.0.1", gateway.port)
            writer.write(beginning)
            with contextlib.suppress(ConnectionResetError):
                assert b"HTTP" not in await asyncio.wait_for(reader.read(), 20)
            writer.close()


async def test_large_and_many_frames_pass_through_tls(folder: Path, trust: Trust) -> None:
    """They arrive in other pieces than over plain TCP."""
    got: list[int] = []
    async with (
        serving(policy(folder)) as gateway,
        websocket(gateway, trust("clients")) as client,
    ):
        gateway.node.create_subscription(String, "/x", lambda msg: got.append(len(msg.data)), 1000)
        op = {"op": "publish", "topic": "/x", "type": "std_msgs/String"}
        sizes = [900_000, *[10] * 300, 500_000]
        for size in sizes:
            await client.send(json.dumps({**op, "msg": {"data": "x" * size}}))
        await until(lambda: len(got) == len(sizes))
        assert got == sizes

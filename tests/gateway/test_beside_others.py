"""Several clients: none can take the place of others, and no page can act for its reader."""

from __future__ import annotations

import asyncio
import logging
import socket
from collections.abc import Awaitable, Callable
from contextlib import AsyncExitStack, suppress

import httpx
import pytest
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed, InvalidStatus

from aionode.gateway import Gateway, Policy
from tests.support.gateway_server import (
    address,
    get,
    http_client,
    serving,
    sessions_of,
    upgraded,
)
from tests.support.waiting import until

POLICY = """
[[who]]
name = "viewer"
token = "viewer"
[[who]]
name = "admin"
token = "admin"
[[allow]]
see = "/**"
subscribe = "/**"
[limits]
clients = 4
"""
VIEWER = {"authorization": "Bearer viewer"}
ADMIN = {"authorization": "Bearer admin"}
FOREIGN = (
    {"origin": "http://evil.example"},
    {"origin": "null"},
    {"sec-fetch-site": "cross-site"},
    {"host": "evil.example"},
)
BROWSER = {"user-agent": "Mozilla/5.0 (X11; Linux x86_64)"}


async def open_websocket(stack: AsyncExitStack, gateway: Gateway) -> None:
    """Keep a WebSocket open."""
    made = connect(address(gateway), additional_headers=VIEWER, proxy=None)
    await stack.enter_async_context(made)


async def open_poll(stack: AsyncExitStack, gateway: Gateway) -> None:
    """Keep a request open that waits for a message."""
    await open_request(stack, gateway, "timeout_sec=3600", {})


async def open_events(stack: AsyncExitStack, gateway: Gateway) -> None:
    """Keep a stream of events open."""
    await open_request(stack, gateway, "", {"accept": "text/event-stream"})


async def open_request(
    stack: AsyncExitStack, gateway: Gateway, query: str, headers: dict[str, str]
) -> None:
    """Keep a request open."""
    client = await stack.enter_async_context(httpx.AsyncClient(timeout=None))  # noqa: S113

    async def wait() -> None:
        url = f"http://127.0.0.1:{gateway.port}/topics/x?type=std_msgs/msg/String&{query}"
        with suppress(httpx.HTTPError):
            await client.get(url, headers=VIEWER | headers)

    task = asyncio.get_running_loop().create_task(wait())  # a client of the test
    stack.callback(task.cancel)


Way = Callable[[AsyncExitStack, Gateway], Awaitable[None]]
WAYS: list[Way] = [open_websocket, open_poll, open_events]


def count(gateway: Gateway, name: str) -> int:
    """Return how many clients of an identity remain."""
    return sum(
        each.identity.name == name and not each.ended.is_set() for each in sessions_of(gateway)
    )


@pytest.mark.parametrize("way", WAYS)
async def test_a_viewer_with_all_places_leaves_one_to_another_identity(way: Way) -> None:
    """Otherwise a viewer could keep out the person who has to stop the robot."""
    async with serving(Policy.parse(POLICY)) as gateway, AsyncExitStack() as stack:
        for _ in range(4):
            await way(stack, gateway)
        await until(lambda: count(gateway, "viewer") == 4)

        assert (await get(gateway, "/topics", VIEWER)).status_code == 429  # it has its share
        assert (await get(gateway, "/topics", ADMIN)).status_code == 200
        async with connect(address(gateway), additional_headers=ADMIN, proxy=None) as first:
            async with connect(address(gateway), additional_headers=ADMIN, proxy=None):
                await until(lambda: count(gateway, "viewer") == count(gateway, "admin") == 2)
                third = connect(address(gateway), additional_headers=ADMIN, proxy=None)
                with pytest.raises(InvalidStatus):  # it has as many as the viewer
                    await third.__aenter__()
            await first.ping()


async def test_a_client_that_has_to_leave_is_told_why() -> None:
    """The newest client leaves: long-running ones continue."""
    async with (
        serving(Policy.parse(POLICY)) as gateway,
        AsyncExitStack() as stack,
    ):
        clients = [
            await stack.enter_async_context(
                connect(address(gateway), additional_headers=VIEWER, proxy=None)
            )
            for _ in range(4)
        ]
        await until(lambda: count(gateway, "viewer") == 4)
        assert (await get(gateway, "/topics", ADMIN)).status_code == 200
        with pytest.raises(ConnectionClosed) as closed:
            await clients[-1].recv()

        assert closed.value.rcvd is not None
        assert closed.value.rcvd.code == 1013
        assert closed.value.rcvd.reason.startswith("there are 4 clients, which is the limit, and v")
        for client in clients[:-1]:
            await (await client.ping())


@pytest.mark.slow
async def test_a_client_that_leaves_public_data_unread_keeps_nobody_out() -> None:
    """A stranger needs no token for the page, so it could open any number of connections."""
    async with serving(Policy.parse(POLICY)) as gateway, AsyncExitStack() as stack:
        request = b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n" * 2000
        for _ in range(30):
            reader = stack.enter_context(socket.socket())
            reader.setblocking(False)
            await asyncio.get_running_loop().sock_connect(reader, ("127.0.0.1", gateway.port))
            reader.send(request)

        assert (await get(gateway, "/topics", ADMIN)).status_code == 200


async def test_a_websocket_that_makes_room_ends_as_others_do(
    caplog: pytest.LogCaptureFixture,
) -> None:
    """Without a session it stays open until its client sends a close frame, which never comes.

    It is then the oldest one without a session, and so the first to be closed.
    """
    viewer = "Authorization: Bearer viewer\r\n"
    async with serving(Policy.parse(POLICY)) as gateway, AsyncExitStack() as stack:
        clients = [await upgraded(gateway, viewer) for _ in range(4)]
        await until(lambda: count(gateway, "viewer") == 4)
        assert (await get(gateway, "/topics", ADMIN)).status_code == 200
        await until(lambda: len(sessions_of(gateway)) == 3)
        for _ in range(30):
            idle = stack.enter_context(socket.socket())
            idle.setblocking(False)
            await asyncio.get_running_loop().sock_connect(idle, ("127.0.0.1", gateway.port))
        await clients[-1][0].read()  # to its end
        for _, writer, _ in clients:
            writer.close()
        await until(lambda: not gateway.stats.sessions)

    assert [each for each in caplog.records if each.levelno >= logging.ERROR] == []


@pytest.mark.parametrize("headers", FOREIGN)
async def test_a_page_of_another_origin_cannot_lock_out_who_reads_it(
    headers: dict[str, str],
) -> None:
    """It would only need some images with wrong tokens in their addresses."""
    async with serving(Policy.parse(POLICY)) as gateway:
        for number in range(20):
            path = f"/topics/x.jpeg?token={number}"
            assert (await get(gateway, path, headers)).status_code == 401

        assert (await get(gateway, "/topics", ADMIN)).status_code == 200
        assert (await get(gateway, "/topics?token=admin")).status_code == 200


async def test_nor_can_a_page_whose_browser_does_not_name_it() -> None:
    """Over plain HTTP to another machine, browsers do not reveal which page requests an image."""
    async with serving(Policy.parse(POLICY)) as gateway:
        answers = [
            await get(gateway, f"/topics/x.jpeg?token={number}", BROWSER) for number in range(20)
        ]

        assert 429 in [answer.status_code for answer in answers]  # each second, one more is taken
        assert (await get(gateway, "/topics", BROWSER | ADMIN)).status_code == 200
        own = BROWSER | {"sec-fetch-site": "same-origin"}
        assert (await get(gateway, "/topics?token=admin", own)).status_code == 200
        async with http_client() as client:
            url = f"http://127.0.0.1:{gateway.port}/topics"
            assert (await client.get(url, headers=ADMIN)).status_code == 200

"""The files of the page, as requested by a browser."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import httpx
import pytest
from websockets import connect
from websockets.exceptions import InvalidStatus

from aionode.gateway import Gateway
from aionode.gateway.page.files import FOLDER

if TYPE_CHECKING:
    from collections.abc import AsyncIterator

    from aionode.node import Node

ADDRESS = re.compile(r"""(?:src|href|from)\s*=?\s*["']([^"']+)["']""")


@pytest.fixture
async def web(node: Node) -> AsyncIterator[httpx.AsyncClient]:
    """An HTTP client of a gateway."""
    async with (
        Gateway(node, port=0) as gateway,
        httpx.AsyncClient(base_url=f"http://127.0.0.1:{gateway.port}", timeout=50) as client,
    ):
        yield client


async def test_the_page_and_all_that_it_needs_come_from_the_gateway(
    web: httpx.AsyncClient,
) -> None:
    """It works without Internet access."""
    places, seen = [httpx.URL("/")], set()
    while places:
        place = places.pop()
        seen.add(place.path.rpartition("/")[2])
        answer = await web.get(place)
        assert answer.status_code == 200, place
        found = [each for each in ADDRESS.findall(answer.text) if not each.startswith("data:")]
        places += [place.join(each) for each in found if place.join(each).path not in seen]

    names = {path.name for path in FOLDER.iterdir()} - {"index.html"}
    assert names <= seen


async def test_a_browser_runs_nothing_else_on_the_page(web: httpx.AsyncClient) -> None:
    """Neither a text of the robot nor a page around this one can drive anything."""
    answer = await web.get("/")

    policy = answer.headers["content-security-policy"]
    assert "default-src 'none'; script-src 'self'" in policy
    assert "frame-ancestors 'none'" in policy
    assert answer.headers["content-type"] == "text/html; charset=utf-8"


@pytest.mark.parametrize("name", ["nothing.js", "..%2f__init__.py", "%2fetc%2fpasswd"])
async def test_other_files_are_not_served(web: httpx.AsyncClient, name: str) -> None:
    """A name is looked up among the files of the page, and never opened as a path."""
    assert (await web.get(f"/page/{name}")).status_code == 404


async def test_a_path_that_is_not_there_is_answered_with_what_to_do(
    web: httpx.AsyncClient,
) -> None:
    """Behind a proxy that keeps its prefix, nothing else would explain an empty page."""
    answer = await web.get("/robot/page/main.js")

    assert answer.status_code == 404
    assert "a proxy has to remove its own prefix" in answer.json()["error"]


async def test_a_websocket_at_another_path_is_answered_with_what_to_do(
    web: httpx.AsyncClient,
) -> None:
    """A bare 403 would say nothing."""
    address = str(web.base_url.copy_with(scheme="ws", path="/robot/"))
    with pytest.raises(InvalidStatus) as refused:
        await connect(address)

    assert refused.value.response.status_code == 404
    assert b"A WebSocket connects to / or /ws" in refused.value.response.body


async def test_a_post_tells_the_page_why_its_websocket_is_refused(web: httpx.AsyncClient) -> None:
    """Browsers hide the answer to a WebSocket; the origin is public behind a TLS proxy."""
    refused = await web.post("/healthz", headers={"Origin": "https://robot.example.org"})
    passed = await web.post("/healthz", headers={"Origin": str(web.base_url)})

    assert refused.status_code == 401
    assert "list the origin under `origins`" in refused.json()["error"]
    assert passed.status_code == 405


@pytest.mark.parametrize("path", ["/page/main.js", "/page/style.css"])
async def test_the_page_comes_whatever_its_origin_is(web: httpx.AsyncClient, path: str) -> None:
    """Browsers send it with scripts: behind a proxy the page could not explain the refusal."""
    origin = {"Origin": "https://robot.example.org", "Sec-Fetch-Site": "same-origin"}

    whole = await web.get(path, headers=origin)
    of_the_robot = await web.get("/topics", headers=origin)
    rebound = await web.get(path, headers={"Host": "evil.example"})

    assert whole.status_code == 200
    assert whole.headers["cross-origin-resource-policy"] == "same-origin"
    assert (of_the_robot.status_code, rebound.status_code) == (401, 401)

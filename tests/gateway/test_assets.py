"""Files of packages for clients: only what the policy allows."""

from __future__ import annotations

import asyncio
import struct
from typing import TYPE_CHECKING

import httpx
import pytest
from hypothesis import given
from hypothesis import strategies as st
from websockets import connect

from aionode.errors import MessageError
from aionode.gateway import Gateway, Identity, Policy
from aionode.gateway.session.assets import asset_of_uri

if TYPE_CHECKING:
    from collections.abc import AsyncIterator
    from pathlib import Path

    from aionode.node import Node

POLICY = Policy.parse("""
[[who]]
name = "local"
loopback = true
[[allow]]
subscribe = "/**"
[[allow]]
asset = "/rover/meshes/**"
max_bytes = 1000
[[refuse]]
asset = "/rover/meshes/private/**"
because = "it is private"
""")
MESH = b"solid rover"


@pytest.fixture
def share(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The share folder of an installed package, with a mesh; beside it is a secret."""
    marker = tmp_path / "install/share/ament_index/resource_index/packages"
    marker.mkdir(parents=True)
    (marker / "rover").touch()
    folder = tmp_path / "install/share/rover"
    (folder / "meshes/private").mkdir(parents=True)
    (folder / "meshes/base link.stl").write_bytes(MESH)
    (folder / "meshes/large.stl").write_bytes(b"x" * 1001)
    (folder / "meshes/private/a.stl").write_bytes(MESH)
    (folder / "config.yaml").write_text("secret")
    (tmp_path / "install/share/secret.txt").write_text("secret")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "install"))
    return folder


@pytest.fixture
async def gateway(node: Node, share: Path) -> AsyncIterator[Gateway]:
    """A gateway that serves the meshes."""
    async with Gateway(node, POLICY, port=0) as gateway:
        yield gateway


@pytest.fixture
async def web(gateway: Gateway) -> AsyncIterator[httpx.AsyncClient]:
    """An HTTP client of the gateway."""
    async with httpx.AsyncClient(base_url=f"http://127.0.0.1:{gateway.port}", timeout=50) as client:
        yield client


async def fetched(gateway: Gateway, *uris: str) -> list[tuple[int, str, bytes]]:
    """Return Foxglove's answers: the status, error and content of each file."""
    answers = []
    address = f"ws://127.0.0.1:{gateway.port}"
    async with connect(address, subprotocols=["foxglove.sdk.v1"], max_size=None) as socket:  # type: ignore[list-item]
        for number, uri in enumerate(uris):
            await socket.send(f'{{"op":"fetchAsset","uri":"{uri}","requestId":{number}}}')
            while True:
                frame = await asyncio.wait_for(socket.recv(), 20)
                if isinstance(frame, bytes) and frame[0] == 4:
                    break
            opcode, request, status, length = struct.unpack_from("<BIBI", frame)
            assert (opcode, request) == (4, number)
            answers.append((status, frame[10 : 10 + length].decode(), frame[10 + length :]))
    return answers


async def test_a_mesh_is_read_over_http(web: httpx.AsyncClient) -> None:
    """As bytes: a page among a package's files must not run as one of the gateway's."""
    answer = await web.get("/assets/rover/meshes/base%20link.stl")

    assert (answer.status_code, answer.content) == (200, MESH)
    assert answer.headers["content-type"] == "application/octet-stream"
    assert answer.headers["x-content-type-options"] == "nosniff"


async def test_foxglove_reads_a_mesh(gateway: Gateway) -> None:
    """By its package:// address; errors answer the request rather than appear as a status."""
    good, gone = await fetched(
        gateway, "package://rover/meshes/base%20link.stl", "package://rover/meshes/no.stl"
    )

    assert good == (0, "", MESH)
    assert gone[0] == 1
    assert "no such file" in gone[1]


@pytest.mark.parametrize(
    ("path", "status"),
    [
        ("rover/config.yaml", 403),
        ("rover/meshes/private/a.stl", 403),
        ("other/meshes/a.stl", 403),
        ("rover/meshes/no.stl", 404),
        ("rover/meshes", 403),
        ("rover/meshes/private", 404),
        ("rover/meshes/%2e%2e/config.yaml", 400),
        ("rover/meshes/..%2f..%2fsecret.txt", 400),
        ("rover/meshes/%2fetc%2fpasswd", 400),
        ("rover/meshes/.%2fbase link.stl", 400),
        ("rover/meshes/a%00.stl", 400),
        ("rover/meshes/a%5c..%5cconfig.yaml", 400),
        ("rover/meshes/x:/../../config.yaml", 400),
        ("..%2frover/meshes/a.stl", 400),
        ("rover", 400),
        ("rover/meshes/large.stl", 413),
    ],
)
async def test_nothing_else_is_served(gateway: Gateway, path: str, status: int) -> None:
    """Written exactly as on the wire, since an HTTP client would resolve the dots itself."""
    reader, writer = await asyncio.open_connection("127.0.0.1", gateway.port)
    request = (
        f"GET /assets/{path.replace(' ', '%20')} HTTP/1.1\r\nHost: 127.0.0.1:{gateway.port}\r\n"
    )
    writer.write(f"{request}Connection: close\r\n\r\n".encode())
    answer = await asyncio.wait_for(reader.read(), 20)
    writer.close()

    assert int(answer.split()[1]) == status
    assert b"secret" not in answer.partition(b"\r\n\r\n")[2].replace(b"secret.txt", b"")


async def test_a_link_to_a_file_of_something_else_is_not_followed(
    web: httpx.AsyncClient, share: Path, tmp_path: Path
) -> None:
    """Only links to sources of the same package are, as left by ``--symlink-install``."""
    source = tmp_path / "src/rover"
    source.mkdir(parents=True)
    (source / "package.xml").write_text("<package><name>rover</name></package>")
    (source / "wheel.stl").write_bytes(MESH)
    (share / "meshes/wheel.stl").symlink_to(source / "wheel.stl")
    (share / "meshes/secret.stl").symlink_to(share.parent / "secret.txt")
    (share / "meshes/all").symlink_to("/etc")

    assert (await web.get("/assets/rover/meshes/wheel.stl")).content == MESH
    assert (await web.get("/assets/rover/meshes/secret.stl")).status_code == 404
    assert (await web.get("/assets/rover/meshes/all/passwd")).status_code == 404


async def test_refused_files_are_counted_and_logged(
    gateway: Gateway, web: httpx.AsyncClient, caplog: pytest.LogCaptureFixture
) -> None:
    """For each protocol, with the reason of the rule."""
    answer = await web.get("/assets/rover/meshes/private/a.stl")
    (told,) = await fetched(gateway, "package://rover/config.yaml")

    assert "it is private" in answer.json()["error"]
    assert "does not allow" in told[1]
    assert gateway.stats.refusals["not_allowed"] == 2
    assert "asset /rover/meshes/private/a.stl: refused: it is private" in caplog.text
    assert "fetchAsset: asset /rover/config.yaml: refused" in caplog.text


async def test_a_gateway_without_a_policy_serves_the_packages_it_is_given(
    node: Node, share: Path
) -> None:
    """None by default, and the refusal says how to serve them."""
    async with (
        Gateway(node, port=0) as plain,
        Gateway(node, Policy.default(assets=["rover"]), port=0) as given,
        httpx.AsyncClient(timeout=50) as client,
    ):
        path = "assets/rover/config.yaml"
        refused = await client.get(f"http://127.0.0.1:{plain.port}/{path}")
        served = await client.get(f"http://127.0.0.1:{given.port}/{path}")

    assert refused.status_code == 403
    assert "--assets PACKAGE" in refused.json()["error"]
    assert served.text == "secret"


def test_a_rule_for_files_shows_no_topic() -> None:
    """A topic may have the same name as a package."""
    policy = Policy.parse('[[who]]\nname="a"\nloopback=true\n[[allow]]\nasset="/rover/**"')

    decision = policy.decide(Identity("a"), "see", "/rover/scan", "sensor_msgs/msg/LaserScan")
    assert not decision.allowed


@given(st.text(max_size=30))
def test_any_address_is_a_name_or_refused(text: str) -> None:
    """Foxglove sends whatever a robot description contains."""
    try:
        name = asset_of_uri(text)
    except MessageError:
        assert not text.startswith("package://")
    else:
        assert name.startswith("/")

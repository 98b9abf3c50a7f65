"""``aionode gateway``: what it serves, and when it refuses to start."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import httpx
import pytest

from aionode.cli._main import main
from aionode.cli._nouns.gateway import serving, types
from aionode.errors import CommandError, ConfigurationError
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node
from tests.cli.conftest import Running, Screen
from tests.support.peers import isolated_environment
from tests.support.waiting import until


async def test_it_serves_until_it_is_stopped(
    tool: Node, screen: Screen, running: Running, node_factory: Callable[..., Node]
) -> None:
    """It prints the port, since port 0 means any free one."""
    async with running(serving(None, False, "127.0.0.1", 0)(tool, screen.output)):
        await until(lambda: "listening on 127.0.0.1:" in screen.text)
        port = screen.text.rpartition(":")[2].strip()
        async with httpx.AsyncClient(trust_env=False, timeout=50) as client:
            answer = await client.get(f"http://127.0.0.1:{port}/nothing")
    assert answer.status_code == 404


@pytest.mark.slow
@pytest.mark.processes
def test_its_node_describes_types_that_only_it_has() -> None:
    """Others see topics and services of rosbridge and rosapi, and have no package for these."""
    aionode = [sys.executable, "-m", "aionode"]
    env = {**os.environ, **isolated_environment()}
    with subprocess.Popen(
        [*aionode, "gateway", "--port", "0"], env=env, stdout=subprocess.PIPE, text=True
    ) as gateway:
        assert gateway.stdout is not None
        assert "listening" in gateway.stdout.readline()
        shown = subprocess.run(
            [*aionode, "interface", "show", "rosbridge_msgs/msg/ConnectedClients"],
            env=env, capture_output=True, text=True, timeout=60, check=False,
        )  # fmt: skip
        gateway.send_signal(signal.SIGINT)

    assert "ConnectedClient[] clients" in shown.stdout, shown.stderr


async def test_a_port_that_is_taken_is_an_error_in_one_line(tool: Node, screen: Screen) -> None:
    """With what to do about it."""
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        with pytest.raises(CommandError, match="choose another --port"):
            await serving(None, False, "127.0.0.1", other.getsockname()[1])(tool, screen.output)


async def test_other_machines_need_a_policy(tool: Node, screen: Screen) -> None:
    """Nobody serves a robot to a network by mistake."""
    with pytest.raises(ConfigurationError, match="token or certificate"):
        await serving(None, True, "0.0.0.0", 0)(tool, screen.output)  # noqa: S104  # refused


def test_what_does_not_fit_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Before a node is created, in one line."""
    wrong = tmp_path / "policy.toml"
    wrong.write_text("[[allow]]\npublsh = '/x'")

    assert main(["gateway", "--policy", str(wrong)]) == 1
    assert "publsh" in capsys.readouterr().err
    assert main(["gateway", "--policy", str(tmp_path / "none.toml")]) == 1
    assert main(["gateway", "--policy", str(wrong), "--allow-write"]) == 2
    assert "allow it in the policy" in capsys.readouterr().err
    assert main(["gateway", "--policy", str(wrong), "--limit", "clients=3"]) == 2
    assert "write it under [limits] there" in capsys.readouterr().err
    assert main(["gateway", "--limit", "speed=3"]) == 1
    assert "'speed=3' is not a limit; use one of clients, " in capsys.readouterr().err


async def test_types_writes_what_is_in_use(
    tool: Node, screen: Screen, node_factory: Callable[..., Node]
) -> None:
    """The maps use the robot's names, so that a page names a topic and gets its type."""
    node_factory("robot").create_publisher(String, "/chatter", 10)

    await types(tool, screen.output)

    assert '  "/chatter": std_msgs.msg.String;' in screen.text
    request = '  "/robot/get_parameters": { request: rcl_interfaces.srv.GetParameters_Request'
    assert request in screen.text


async def test_types_writes_a_type_that_is_named(tool: Node, screen: Screen) -> None:
    """Without a robot."""
    await types(tool, screen.output, type_names=["geometry_msgs/msg/Twist"])

    assert '  "geometry_msgs/msg/Twist": geometry_msgs.msg.Twist;' in screen.text
    assert "std_msgs" not in screen.text


def test_a_package_of_assets_that_is_not_there_is_an_error() -> None:
    """A misspelled name would only show as files that are missing."""
    with pytest.raises(CommandError, match="--assets: no package 'no_such_package' in"):
        serving(None, False, "127.0.0.1", 0, assets=["no_such_package"])

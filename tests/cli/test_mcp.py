"""``aionode mcp``: the settings of programs, tools without a model, and how it starts."""

from __future__ import annotations

import asyncio
import json
import subprocess
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import mcp
import pytest

from aionode.cli._main import main
from aionode.cli._nouns.mcp import kept, policy_of, settings, try_tool, words_of
from aionode.errors import CommandError
from aionode.gateway.mcp.hosts import HOSTS, settings_for
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node
from aionode.testing import settle
from tests.cli.conftest import Screen
from tests.support.peers import isolated_environment

OPTIONS: dict[str, Any] = {"name": "", "about": "", "bags": ""}


async def test_a_tool_is_called_without_a_model(
    tool: Node, screen: Screen, node_factory: Callable[..., Node]
) -> None:
    """Its answer is printed."""
    node_factory("talker").create_publisher(String, "/text", 10)
    await settle()
    status = await try_tool(
        tool, screen.output, tool="list", arguments=["kind=topics"],
        policy=policy_of(None, allow_write=False), **OPTIONS,
    )  # fmt: skip

    assert status == 0
    assert json.loads(screen.text)["topics"]["/text"] == ["std_msgs/msg/String"]


async def test_without_a_tool_they_are_listed(tool: Node, screen: Screen) -> None:
    """With their descriptions; without a policy, none that changes anything."""
    await try_tool(
        tool, screen.output, tool=None, arguments=[],
        policy=policy_of(None, allow_write=False), **OPTIONS,
    )  # fmt: skip

    assert "stop: Stop everything that you move" in screen.text
    assert "publish" not in [line.partition(":")[0] for line in screen.text.splitlines()]


async def test_a_tool_that_fails_has_status_1(tool: Node, screen: Screen) -> None:
    """As with any command."""
    status = await try_tool(
        tool, screen.output, tool="read", arguments=["topic=/nothing"],
        policy=policy_of(None, allow_write=False), **OPTIONS,
    )  # fmt: skip

    assert status == 1
    assert "no such topic" in screen.text


def test_arguments_are_json_or_text() -> None:
    """A topic needs no quotes."""
    words = ["topic=/cmd_vel", "seconds=1", 'message={"linear": {"x": 0.1}}', "name=a=b"]

    assert words_of(words) == {
        "topic": "/cmd_vel", "seconds": 1, "message": {"linear": {"x": 0.1}}, "name": "a=b",
    }  # fmt: skip
    with pytest.raises(CommandError, match="NAME=VALUE"):
        words_of(["seconds"])


COMMAND = ["python", "-m", "aionode", "mcp", "--policy", 'a "b".toml']


@pytest.mark.parametrize("host", ["claude-desktop", "cursor", "vscode", "windsurf", "gemini-cli"])
def test_the_settings_of_a_program_are_json(host: str) -> None:
    """Below the line that says where they belong."""
    lines = settings_for(host, COMMAND).splitlines()
    (servers,) = json.loads("\n".join(lines[1:])).values()

    assert lines[0].startswith("# ")
    assert servers["robot"]["command"] == "python"
    assert servers["robot"]["args"] == COMMAND[1:]


def test_the_settings_of_codex_are_toml() -> None:
    """Names with quotes are escaped."""
    values = tomllib.loads(settings_for("codex", COMMAND))

    assert values["mcp_servers"]["robot"] == {"command": "python", "args": COMMAND[1:]}


def test_the_settings_have_whole_paths_and_the_options_given() -> None:
    """The program starts the command in another folder."""
    text = settings("claude-code", ["mcp", "--policy", "p.toml", "--domain", "7", "--print-config"])

    assert f"mcp --policy {Path.cwd() / 'p.toml'} --domain 7" in text
    assert "print-config" not in text
    assert kept(["mcp", "--print-config", "zed", "--domain", "7"]) == ["mcp", "--domain", "7"]
    assert kept(["mcp", "--print-config=zed"]) == ["mcp"]
    assert all(f"# {place}" in settings("all", ["mcp"]) for place, _ in HOSTS.values())
    with pytest.raises(CommandError, match="claude-desktop"):
        settings("netscape", [])


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["--as", "arm"], "--as is the name of a [[who]]"),
        (["--policy", "x.toml", "--allow-write"], "--allow-write is for"),
        (["--bags", "/nowhere"], "no such folder"),
        (["--about", "@/nowhere"], "cannot be read"),
        (["--policy", "/nowhere.toml"], "cannot be read"),
        (["--domain", "300"], "300"),
    ],
)
def test_a_wrong_option_says_what_fits(
    words: list[str], expected: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """On stderr, since stdout belongs to the protocol."""
    assert main(["mcp", *words]) != 0
    shown = capsys.readouterr()
    assert expected in shown.err
    assert shown.out == ""


@pytest.mark.slow
@pytest.mark.processes
@pytest.mark.one_loop
async def test_it_serves_over_standard_streams_in_the_domain_given() -> None:
    """A desktop program passes no environment variables on."""
    words = ["-m", "aionode", "mcp", "--domain", "7"]
    server = mcp.StdioServerParameters(
        command=sys.executable, args=words, env=isolated_environment()
    )
    async with mcp.Client(server) as client:
        answered = await client.call_tool("list", {})
        assert "domain 7, with no nodes" in str(client.instructions)

    assert not answered.is_error


@pytest.mark.slow
@pytest.mark.processes
@pytest.mark.one_loop
@pytest.mark.timeout(180)
async def test_it_ends_with_its_client_while_a_call_is_under_way() -> None:
    """The kernel closes the streams of a killed client; nothing else notifies the command."""
    command = await asyncio.create_subprocess_exec(
        sys.executable, "-m", "aionode", "mcp",
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        env=isolated_environment(),
    )  # fmt: skip
    assert command.stdin is not None
    assert command.stdout is not None
    hello = {"protocolVersion": "2025-11-25", "capabilities": {},
             "clientInfo": {"name": "raw", "version": "1"}}  # fmt: skip
    watch = {"name": "watch", "arguments": {"topic": "/parameter_events", "seconds": 30}}
    requests: list[dict[str, Any]] = [
        {"id": 1, "method": "initialize", "params": hello},
        {"method": "notifications/initialized"},
        {"id": 2, "method": "tools/call", "params": watch},
        {"id": 3, "method": "ping"},
    ]
    try:
        for request in requests:
            command.stdin.write(json.dumps({"jsonrpc": "2.0", **request}).encode() + b"\n")
        answers = [json.loads(await command.stdout.readline())["id"] for _ in range(2)]
        command.stdin.close()
        status = await command.wait()
    finally:
        if command.returncode is None:  # uvloop would wait for it when the loop is closed
            command.kill()

    assert answers == [1, 3]
    assert status == 0


@pytest.mark.slow
def test_nothing_of_mcp_is_imported_unless_asked_for() -> None:
    """It takes a second, and 60 MB."""
    program = (
        "import sys, aionode, aionode.gateway, aionode.cli._main\n"
        "from aionode.gateway import Gateway, Policy\n"
        "import aionode.cli._nouns.gateway, aionode.cli._nouns.mcp\n"
        "print([name for name in sys.modules if name.partition('.')[0] in "
        "{'mcp', 'mcp_types', 'pydantic', 'uvicorn'}])\n"
    )
    shown = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )

    assert shown.stdout == "[]\n"


@pytest.mark.parametrize(
    "words",
    [
        pytest.param(["mcp"], marks=pytest.mark.slow),
        pytest.param(["mcp", "try"], marks=pytest.mark.slow),
        ["mcp", "try", "stop"],
    ],
)
def test_a_missing_extra_is_named(words: list[str]) -> None:
    """It differs from that of the gateway."""
    program = (
        "import sys\nsys.modules['mcp'] = None\n"
        f"from aionode.cli import main\nsys.exit(main({words}))\n"
    )
    shown = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False,
        env={**isolated_environment(), "PATH": "/usr/bin"},
    )  # fmt: skip

    assert shown.returncode == 1
    assert "pip install 'aionode[mcp]'" in shown.stderr

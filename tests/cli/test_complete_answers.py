"""Answers are complete, or come with a warning that they may not be."""

from __future__ import annotations

import asyncio
import os
import signal
import socket
import subprocess
import sys
from contextlib import closing
from typing import Any

import pytest

from aionode.cli._support.session import wait_until_known
from aionode.engine.transport.zenoh.session.local_sessions import announce, reserve_port
from aionode.engine.wire._liveliness import endpoint_token
from aionode.graph import EndpointInfo, EndpointKind, NodeInfo
from aionode.node import Node
from aionode.qos import qos_profile_default
from tests.support.fork_server import run
from tests.support.peers import DOMAIN_ID, isolated_environment, raw_session

TOPICS = 3000

SILENT = """
import socket, sys, time
from aionode.engine.transport.zenoh.session.local_sessions import announce
servers = [socket.create_server(("127.0.0.1", 0)) for _ in range(2)]
presence = [announce(int(sys.argv[1]), each.getsockname()[1]) for each in servers]
print("there", flush=True)
time.sleep(600)
"""


@pytest.fixture
def env(monkeypatch: pytest.MonkeyPatch) -> dict[str, str]:
    """An environment isolated from all other processes on the machine."""
    isolated = isolated_environment()
    for name, value in isolated.items():
        monkeypatch.setenv(name, value)
    return {**os.environ, **isolated}


@pytest.mark.slow
def test_three_thousand_topics_are_all_listed(env: dict[str, str]) -> None:
    """The first answer has to be complete; once it contained 0 to 2 of them."""
    node = NodeInfo("8b20917502ee955ac4476e0266340d5c", 0, "many", "/")
    qos = qos_profile_default.resolved()
    chatter = ("std_msgs/msg/String", "RIHS01_0")
    port = env["AIONODE_MEETING_PORTS"].split(",")[0]
    with raw_session(listen=f"tcp/127.0.0.1:{port}") as session:
        tokens = [
            session.liveliness().declare_token(endpoint_token(DOMAIN_ID, endpoint))
            for endpoint in (
                EndpointInfo(EndpointKind.PUBLISHER, node, n, f"/t{n}", *chatter, qos, b"")
                for n in range(1, TOPICS + 1)
            )
        ]
        done = run(["-m", "aionode", "topic", "list", "-c"], env=env, timeout=60)

    assert len(tokens) == TOPICS
    assert done.stdout == f"{TOPICS}\n", done.stderr
    assert "may be incomplete" not in done.stderr


def test_an_answer_that_may_be_incomplete_says_so(env: dict[str, str]) -> None:
    """A process that accepts connections and sends nothing is frozen, or not a node."""
    port = int(env["AIONODE_MEETING_PORTS"].split(",")[0])
    with closing(socket.create_server(("127.0.0.1", port))):
        done = run(["-m", "aionode", "topic", "list", "-c"], env=env, timeout=60)

    assert (done.returncode, done.stdout) == (0, "0\n")
    assert "this may be incomplete" in done.stderr


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only Linux lists sessions")
def test_listed_sessions_that_do_not_listen_are_none(env: dict[str, str]) -> None:
    """Any user can list some, and no command waits for them."""
    group = int(env["AIONODE_MEETING_PORTS"].split(",")[0])
    reserved = reserve_port("127.0.0.1")
    with closing(reserved), closing(announce(group, reserved.getsockname()[1])):
        done = run(["-m", "aionode", "topic", "list", "-c"], env=env, timeout=60)

    assert (done.returncode, done.stdout, done.stderr) == (0, "0\n", "")


@pytest.mark.slow
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only Linux lists sessions")
@pytest.mark.parametrize("is_stopped", [True, False])
def test_each_command_names_a_process_that_does_not_answer(
    env: dict[str, str], *, is_stopped: bool
) -> None:
    """It listens on ports of its own, like every process after the third, and is named once."""
    group = int(env["AIONODE_MEETING_PORTS"].split(",")[0])
    with subprocess.Popen(
        [sys.executable, "-c", SILENT, str(group)], stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "there\n"
        if is_stopped:
            process.send_signal(signal.SIGSTOP)
        lists = [run(["-m", "aionode", "topic", "list"], env=env, timeout=60) for _ in range(2)]
        doctor = run(["-m", "aionode", "doctor"], env=env, timeout=60)
        process.kill()

    said = f"is stopped (kill -CONT {process.pid})" if is_stopped else "does not answer"
    for done in lists:
        (warning,) = [line for line in done.stderr.splitlines() if "WARNING" in line]
        assert f"process {process.pid} (" in warning
        assert f") {said}: this may be incomplete" in warning
    assert f"problem: process: process {process.pid} (" in doctor.stdout
    assert doctor.returncode == 1


async def test_a_long_wait_is_reported_on_stderr(
    tool: Node, screen: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A second without output is long, and stdout is reserved for the answer."""
    monkeypatch.setattr("aionode.cli._support.session.PROGRESS_S", 0.001)
    said = asyncio.Event()
    monkeypatch.setattr(screen.stderr, "flush", said.set)

    async def all_known(_: float) -> bool:
        await said.wait()
        return False

    (transport,) = tool.context.transports
    monkeypatch.setattr(transport, "all_known", all_known)

    await wait_until_known(tool, screen.output)

    assert screen.text == ""
    assert screen.errors.startswith("Waiting for discovery: 3 nodes and endpoints")
    assert screen.errors.endswith("this may be incomplete\n")

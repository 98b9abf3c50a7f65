"""``aionode system``."""

from __future__ import annotations

import io
import json
from collections.abc import AsyncIterator
from typing import Any

import pytest

from aionode import Context, Node
from aionode.cli._nouns.system import (
    list_systems,
    print_log,
    print_status,
    restart_member,
    stop_member,
)
from aionode.cli._support.output import Output
from aionode.errors import CommandError
from aionode.graph import EndpointKind
from aionode.system import System, SystemLog
from tests.support.waiting import until


@pytest.fixture
async def system(aionode_context: Context) -> AsyncIterator[System]:
    """A system with one program."""
    async with System("robot", context=aionode_context, log=SystemLog(io.StringIO())) as system:
        system.process("driver", ["sleep", "1000"])
        await system.ready()
        yield system


async def test_list_prints_the_running_systems(tool: Node, system: System, screen: Any) -> None:
    """By their names, which are options of the other commands."""
    await list_systems(tool, output=screen.output)

    assert screen.text == "robot\n"


async def test_status_prints_a_table(tool: Node, system: System, screen: Any) -> None:
    """A line for each member, with its process."""
    await print_status(tool, output=screen.output)
    heading, line = screen.text.splitlines()

    assert heading.split()[:4] == ["NAME", "STATE", "READY", "PID"]
    assert line.split()[:4] == ["driver", "running", "yes", str(system.status()["driver"].pid)]


async def test_status_as_json_has_a_record_for_each_member(tool: Node, system: System) -> None:
    """With the memory of its process."""
    text = io.StringIO()
    await print_status(tool, output=Output(text, json=True))
    record = json.loads(text.getvalue())

    assert (record["name"], record["state"]) == ("driver", "running")
    assert record["memory_bytes"] > 0


async def test_a_member_is_restarted_and_stopped(tool: Node, system: System, screen: Any) -> None:
    """The system continues."""
    before = system.status()["driver"].pid
    await restart_member(tool, "driver", output=screen.output)
    await system.ready()
    after = system.status()["driver"]
    await stop_member(tool, "driver", output=screen.output)

    assert (after.restarts, after.pid == before) == (1, False)
    assert system.status()["driver"].state == "stopped"
    assert screen.text == "driver restarts\ndriver is stopped\n"


async def test_log_prints_the_lines_from_now_on(
    tool: Node, system: System, screen: Any, running: Any
) -> None:
    """With time and name, as the terminal of the system has them."""
    async with running(print_log(tool, output=screen.output)):
        topic = "/aionode_system_robot/log"
        await until(lambda: system.graph_node.graph.count(EndpointKind.SUBSCRIPTION, topic) > 0)
        system.log.note("hello")
        await until(lambda: "system | hello" in screen.text)


async def test_the_whole_system_is_ended(tool: Node, system: System, screen: Any) -> None:
    """`wait` returns in the system's program."""
    await stop_member(tool, None, every=True, output=screen.output)
    await system.wait()

    assert screen.text == "system robot ends\n"


async def test_unknown_members_and_systems_are_named(
    tool: Node, system: System, screen: Any
) -> None:
    """Together with the existing ones."""
    with pytest.raises(CommandError, match="nope: no such member; the system has driver"):
        await restart_member(tool, "nope", output=screen.output)
    with pytest.raises(CommandError, match="no system nope runs: choose one with --system: robot"):
        await print_status(tool, system_name="nope", output=screen.output)
    with pytest.raises(CommandError, match="name a member, or use --all for the whole system"):
        await stop_member(tool, None, output=screen.output)


async def test_without_a_system_the_error_says_how_to_start_one(tool: Node, screen: Any) -> None:
    """The usual mistake is another domain."""
    with pytest.raises(CommandError, match="no system is running in this domain"):
        await print_status(tool, output=screen.output)

"""`aionode why`: what it prints, and when it fails."""

from __future__ import annotations

import json
import re

import pytest

from aionode import Context, Node
from aionode.cli._nouns.why import explain
from aionode.cli._support.output import Output
from aionode.errors import CommandError
from aionode.interfaces.std_msgs.msg import Int32


async def test_it_prints_a_chain_or_records(capsys: pytest.CaptureFixture[str]) -> None:
    """From the message back to its origin, with the times."""
    async with (
        Context(transport="local", causes=True) as context,
        Node("planner", context=context) as node,
    ):
        drive = node.create_publisher(Int32, "drive", 10)

        def on_map(_: Int32) -> None:
            drive.publish(Int32())

        node.create_subscription(Int32, "map", on_map)
        done = node.create_subscription(Int32, "drive")
        node.create_publisher(Int32, "map", 10).publish(Int32())
        await done.receive()

        status = await explain(node, "drive", output=Output())
        text = capsys.readouterr().out
        await explain(node, "planner", output=Output(json=True))
        record = json.loads(capsys.readouterr().out)

    time = r"[\d.]+ (us|ms|s)"
    assert status == 0
    assert re.fullmatch(
        f"/drive {time} ago ← planner.on_map \\(run {time}, waited {time}\\) ← "
        f"/map \\(planner, not in a callback\\) {time} ago\n",
        text,
    )
    assert [each["name"] for each in record["sent"]] == ["/drive", "/map"]


async def test_an_unknown_name_is_an_error_and_a_silent_topic_is_said(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """The exit status is 1 if nothing is known."""
    async with (
        Context(transport="local", causes=True) as context,
        Node("planner", context=context) as node,
    ):
        node.create_subscription(Int32, "map", lambda _: None)

        with pytest.raises(CommandError, match="no topic, service"):
            await explain(node, "nowhere", output=Output())
        assert await explain(node, "map", output=Output()) == 1
    assert "/map: nothing is known to have been sent under this name" in capsys.readouterr().out

"""Names in bags that ROS does not allow are shown escaped and left out; the rest is used."""

from __future__ import annotations

from pathlib import Path

import pytest
from mcap.writer import Writer

from aionode import bag
from aionode.cli import main
from aionode.engine.wire import cdr
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node
from aionode.testing import local_context, settle

NAME = "/a\x1b[31m\nTopic: /fake | Type: std_msgs/msg/String | Count: 9"
TYPE = "std_msgs/msg/String"


def strange_bag(file: Path) -> Path:
    """Write a bag with a topic whose name forges a line, and a good one."""
    with file.open("wb") as stream:
        out = Writer(stream)
        out.start("ros2", "test")
        schema = out.register_schema(TYPE, "ros2msg", b"string data\n")
        for name in (NAME, "/words"):
            channel = out.register_channel(name, "cdr", schema)
            out.add_message(channel, 1, bytes(cdr.encode(String(data="a"))), 1)
        out.finish()  # type: ignore[no-untyped-call]  # of the library
    return file


@pytest.mark.parametrize("options", [[], ["--verbose"], ["--topic-name"]])
def test_a_name_in_a_bag_forges_no_line_and_no_colour(
    options: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Even in a pipe, as a program may read the lines."""
    main(["bag", "info", str(strange_bag(tmp_path / "x.mcap")), *options])
    out = capsys.readouterr().out
    assert "\x1b" not in out
    assert not any(line.startswith("Topic: /fake") for line in out.splitlines())


async def test_a_topic_that_no_node_can_have_is_not_played_and_the_rest_is(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """One bad topic must not keep the others from being played."""
    heard: list[str] = []
    file = strange_bag(tmp_path / "x.mcap")
    async with local_context() as context, Node("ear", context=context) as node:
        node.create_subscription(String, "/words", lambda msg: heard.append(msg.data), 10)
        async with bag.Player(file, context=context) as player:
            await settle()
            assert await player.play()
        await settle()
    assert heard == ["a"]
    error = capfd.readouterr().err
    assert "is not played: " in error
    assert "\x1b" not in error


async def test_a_topic_that_no_node_can_have_is_left_out_of_a_replay(tmp_path: Path) -> None:
    """As when it is played."""
    async with bag.replay(strange_bag(tmp_path / "x.mcap")) as run:
        heard: list[str] = []
        node = Node("ear", context=run.context)
        node.create_subscription(String, "/words", lambda msg: heard.append(msg.data), 10)
        await run.play()
    assert heard == ["a"]

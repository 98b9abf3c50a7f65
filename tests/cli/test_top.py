"""`aionode top`: what it shows, as text, as records, and live."""

from __future__ import annotations

import json
from typing import Any

import pytest

from aionode import Node
from aionode.cli._nouns.top import top
from aionode.cli._nouns.top.screen import TopApp
from aionode.cli._support.output import Output
from aionode.errors import CommandError
from aionode.interfaces.rcl_interfaces.msg import Log
from aionode.interfaces.std_msgs.msg import Int32
from aionode.testing import local_context, settle


@pytest.fixture
async def robot() -> Any:
    """A node that receives from itself on /numbers, five times before each look."""
    async with Node("robot", context=local_context()) as node:
        publisher = node.create_publisher(Int32, "numbers", 10)
        node.create_subscription(Int32, "numbers", lambda _: None)

        async def speak() -> None:
            for number in range(5):
                publisher.publish(Int32(data=number))
            await settle()

        node.speak = speak  # type: ignore[attr-defined]  # for the tests
        yield node


async def test_one_look_is_text_or_a_record(
    robot: Node, capsys: pytest.CaptureFixture[str]
) -> None:
    """The numbers are those of the endpoints."""
    await robot.speak()  # type: ignore[attr-defined]  # as above
    await top(robot, output=Output(), once=True, interval=0.01)
    text = capsys.readouterr().out
    await top(robot, output=Output(json=True), once=True, interval=0.01)
    record = json.loads(capsys.readouterr().out)

    assert "/numbers" in text
    assert "waits for cpu" in text
    (topic,) = record["topics"]
    assert (topic["topic"], topic["publishers"], topic["dropped"]) == ("/numbers", 1, 0)
    assert [each["node"] for each in record["nodes"]] == ["/robot"]
    assert record["notes"] == []


async def test_the_live_view_needs_a_terminal(robot: Node) -> None:
    """In a pipe nobody could see it."""
    with pytest.raises(CommandError, match="use --once or --json"):
        await top(robot, output=Output())


async def test_the_live_view_shows_filters_and_sorts(robot: Node) -> None:
    """Driven by keys, as by a person."""
    app = TopApp(robot, interval=1000.0)
    async with app.run_test(size=(160, 40)) as pilot:
        await robot.speak()  # type: ignore[attr-defined]  # as above
        await app.look()
        await pilot.press("3")
        await pilot.pause()
        table = app.query_one("#topics-table")
        assert (app.shown, table.row_count) == ("topics", 1)  # type: ignore[attr-defined]  # a DataTable
        await pilot.press("s", "r", "slash", *"none")
        await pilot.pause()
        assert table.row_count == 0  # type: ignore[attr-defined]  # as above
        await pilot.press(*["backspace"] * 4, "enter", "1")
        await pilot.pause()
        assert app.shown == "processes"
        assert app.query_one("#processes-table").row_count == 1  # type: ignore[attr-defined]  # as above


async def test_the_log_is_subscribed_to_when_it_is_looked_at(robot: Node) -> None:
    """Nothing else is subscribed to at all."""
    app = TopApp(robot, interval=1000.0)
    async with app.run_test() as pilot:
        await app.look()
        before = [each.msg_type for each in robot.subscriptions]
        await pilot.press("7")
        await pilot.pause()
        after = [each.msg_type for each in robot.subscriptions]

    assert Log not in before
    assert after.count(Log) == 1

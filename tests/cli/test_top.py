"""`aionode top`: what it shows, as text, as records, and live."""

from __future__ import annotations

import json
from typing import Any

import pytest

from aionode import Node
from aionode.cli._nouns.top import top
from aionode.cli._nouns.top.screen import TopApp
from aionode.cli._support.output import Output
from aionode.engine.observation import unchanging
from aionode.errors import CommandError
from aionode.interfaces.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from aionode.interfaces.rcl_interfaces.msg import Log
from aionode.interfaces.std_msgs.msg import Int32
from aionode.lifecycle import LifecycleNode, State, TransitionCallbackReturn
from aionode.qos import DurabilityPolicy, QoSProfile
from aionode.testing import local_context, settle


class Managed(LifecycleNode):
    """A managed node that notes that it was configured."""

    is_configured = False

    def on_configure(self, state: State) -> TransitionCallbackReturn:
        """Note it."""
        self.is_configured = True
        return super().on_configure(state)


async def until_said(app: TopApp, pilot: Any, selector: str, fits: Any) -> None:
    """Wait until a part of the screen shows something."""
    for _ in range(500):
        found = app.screen.query(selector)
        if found and fits(found.first()):
            return
        await pilot.pause()
    raise AssertionError(f"{selector} does not show it")


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


async def test_the_name_of_a_program_forges_no_row(
    robot: Node, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its command line comes from its own report, and may contain a new line."""
    monkeypatch.setitem(unchanging(), "program", "robot\n/other  0 Hz")
    await top(robot, output=Output(), once=True, interval=0.01)

    out = capsys.readouterr().out
    assert "robot\\n/other  0 Hz" in out
    assert "\n/other" not in out


async def test_the_live_view_needs_a_terminal(robot: Node) -> None:
    """In a pipe nobody could see it."""
    with pytest.raises(CommandError, match="use --once or --json"):
        await top(robot, output=Output())


@pytest.mark.slow
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


@pytest.mark.slow
async def test_the_log_is_subscribed_to_when_it_is_looked_at(robot: Node) -> None:
    """Nothing else is subscribed to at all."""
    app = TopApp(robot, interval=1000.0)
    async with app.run_test() as pilot:
        await app.look()
        before = [each.msg_type for each in robot.subscriptions]
        await pilot.press("8")
        await pilot.pause()
        after = [each.msg_type for each in robot.subscriptions]

    assert Log not in before
    assert after.count(Log) == 1


@pytest.mark.parametrize("before", [[], ["slash", "x"]], ids=["a table", "typing a filter"])
async def test_ctrl_c_ends_the_view(tool: Node, before: list[str]) -> None:
    """As it ends every other command; Textual's own binding only names another key."""
    app = TopApp(tool)

    async with app.run_test() as pilot:
        await pilot.press(*before, "ctrl+c")

    assert app.return_code == 0
    assert not app.is_running


@pytest.mark.slow
async def test_what_nodes_say_of_themselves_is_a_table(robot: Node) -> None:
    """It is subscribed to when it is looked at; the worst is first."""
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    publisher = robot.create_publisher(DiagnosticArray, "/diagnostics", latched)
    status = [
        DiagnosticStatus(name="fine", level=DiagnosticStatus.OK),
        DiagnosticStatus(name="bad", level=DiagnosticStatus.ERROR, message="no device"),
    ]
    app = TopApp(robot, interval=1000.0)
    async with app.run_test(size=(160, 40)) as pilot:
        await app.look()
        await pilot.press("7")
        await pilot.pause()
        publisher.publish(DiagnosticArray(status=status))
        await settle()
        await app.look()
        table: Any = app.query_one("#diagnostics-table")

        assert [str(each) for each in table.get_row_at(0)[:3]] == ["bad", "2 error", "no device"]


@pytest.mark.slow
async def test_a_field_is_plotted_over_time(robot: Node) -> None:
    """A key plots a field of the topic under the cursor, and ends the plot and its subscription."""
    app = TopApp(robot, interval=1000.0)
    before = len(list(robot.subscriptions))
    async with app.run_test(size=(160, 40)) as pilot:
        await app.look()
        await pilot.press("3")
        await pilot.pause()
        await pilot.press("f", *"wrong", "enter")
        await pilot.pause()
        refused = str(app.query_one("#of").render())
        await pilot.press("f", *["backspace"] * 5, *"data", "enter")
        await pilot.pause()
        await robot.speak()  # type: ignore[attr-defined]  # as above
        await app.look()
        plot: Any = app.query_one("#plot")
        shown = list(plot.data), str(app.query_one("#of").render())
        await pilot.press("f")
        await pilot.pause()

    assert "no 'wrong' in it" in refused
    assert shown == ([0, 1, 2, 3, 4], "/numbers.data: 4   (f plots rates again)")
    assert len(list(robot.subscriptions)) == before


@pytest.mark.slow
async def test_a_parameter_and_a_state_are_changed_in_place() -> None:
    """The answer of the node is shown, also if it refuses."""
    context = local_context()
    async with (
        Managed("arm", context=context) as arm,
        Node("_top", context=context) as tool,
    ):
        arm.declare_parameter("speed", 0.5)
        app = TopApp(tool, interval=1000.0)
        async with app.run_test(size=(160, 40)) as pilot:
            await app.look()
            await pilot.press("2")
            await pilot.pause()
            await pilot.press("n")
            await until_said(app, pilot, "#rows", lambda rows: rows.row_count > 1)
            rows: Any = app.screen.query_one("#rows")
            rows.move_cursor(row=rows.get_row_index("parameter speed"))
            await pilot.press("enter", *["backspace"] * 3, *"0.25", "enter")
            await until_said(app, pilot, "#said", lambda said: "speed" in str(said.render()))
            said = str(app.screen.query_one("#said").render())
            await until_said(app, pilot, "#rows", lambda rows: rows.row_count > 1)
            rows.move_cursor(row=rows.get_row_index("transition configure"))
            await pilot.press("enter")
            await until_said(app, pilot, "#said", lambda said: "configure" in str(said.render()))
            changed = str(app.screen.query_one("#said").render())
            await pilot.press("escape")

        assert (said, arm.get_parameter("speed").value) == ("speed: set", 0.25)
        assert (changed, arm.is_configured) == ("configure: done", True)
        assert not list(tool.clients)

"""The number of goals that a server takes and keeps, and how often it lists them."""

from __future__ import annotations

import asyncio
import logging
from typing import TYPE_CHECKING, Any

import pytest

from aionode.action import ActionServer, GoalRejectedError, GoalResponse, GoalStatus
from aionode.engine.rules.goal_store import GoalStore
from aionode.engine.rules.status_pace import StatusPace
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.std_msgs.msg import String
from aionode.testing import settle
from tests.support.actions import PlainClient, Worker

if TYPE_CHECKING:
    from collections.abc import Sequence

    from aionode.node import Node
    from aionode.testing import ManualClock

MANY = [bytes([number]) for number in range(255)] * 100_000
"""So many goals that the interval between two lists is far longer than a test."""


class Lists:
    """Counts the lists that are sent for a number of goals."""

    def __init__(self, goals: Sequence[bytes]) -> None:
        self.sent = 0
        self.has_sent = asyncio.Event()
        self.pace = StatusPace(self._send, goals)

    def _send(self) -> None:
        self.sent += 1
        self.has_sent.set()

    async def change(self) -> int:
        """Note a change, and return how many lists were sent by then."""
        self.pace.note_change()
        await settle()
        return self.sent


async def test_of_few_goals_each_change_is_sent_at_once() -> None:
    """Most servers have one goal at a time, and tools show its state as it changes."""
    lists = Lists(MANY[:10])

    assert [await lists.change() for _ in range(3)] == [1, 2, 3]


async def test_with_many_goals_the_list_is_not_sent_for_each_change() -> None:
    """Otherwise lists of a thousand goals cost ten times what the goals do."""
    lists = Lists(MANY)

    assert [await lists.change() for _ in range(3)] == [1, 1, 1]
    lists.pace.flush()


async def test_the_last_change_of_many_goals_is_always_sent() -> None:
    """Late subscriptions get the last list, and ROS clients rely on it."""
    lists = Lists(MANY[:11])
    await lists.change()
    lists.has_sent.clear()
    lists.pace.note_change()

    async with asyncio.timeout(5):
        await lists.has_sent.wait()

    lists.pace.flush()
    assert lists.sent == 2


async def test_a_server_that_ends_sends_the_changes_that_wait(node: Node) -> None:
    """A result reached just before the end counts."""
    client, worker = PlainClient(node), Worker()
    worker.may_end.set()
    server = node.create_action_server(Fibonacci, "fibonacci", worker)
    await asyncio.gather(*(client.send(number) for number in range(1, 21)))
    await client.send(21)
    await client.result(21)

    server.destroy()
    await settle()

    assert client.statuses[-1] == dict.fromkeys(range(1, 22), GoalStatus.SUCCEEDED)


# How many


def serve(
    node: Node, worker: Worker, max_goals: int, **options: Any
) -> ActionServer[Any, Any, Any]:
    """Make a server with a limit."""
    return node.create_action_server(Fibonacci, "fibonacci", worker, max_goals=max_goals, **options)


async def test_goals_beyond_the_limit_are_rejected(node: Node) -> None:
    """Clients that send goals which never end do not take unlimited memory."""
    client = PlainClient(node)
    server = serve(node, Worker(), 3)

    answers = await asyncio.gather(*(client.send(number) for number in range(1, 101)))

    assert [answer.accepted for answer in answers] == [True] * 3 + [False] * 97
    assert "active=3 kept=0 " in repr(server)


async def test_the_limit_is_that_of_goals_which_are_active(node: Node) -> None:
    """An ended goal makes room, though its result is kept."""
    client, worker = PlainClient(node), Worker()
    serve(node, worker, 1)
    await client.send(1)
    assert not (await client.send(2)).accepted

    worker.may_end.set()
    await client.result(1)

    assert (await client.send(3)).accepted


class Large:
    """The handle of a goal whose message is large."""

    def __init__(self, size: int) -> None:
        self.request = String(data="x" * size)


def test_goals_are_limited_in_bytes() -> None:
    """A thousand active goals of some megabytes each would fill the memory, and so would kept ones.

    A single one always fits.
    """
    goals = GoalStore(lambda: 0, limit=10, kept_ns=-1, limit_bytes=10_000)
    assert not goals.refusal(Large(20_000).request)
    goals[b"a"] = Large(6_000)
    assert not goals.refusal(Large(100).request)
    assert "AIONODE_QUEUE_BYTES" in goals.refusal(Large(6_000).request)

    goals.keep(b"a")
    assert not goals.refusal(Large(6_000).request)
    goals[b"b"] = Large(6_000)
    goals.keep(b"b")
    assert list(goals) == [b"b"]


def test_all_goals_that_make_room_for_a_large_one_are_told_of() -> None:
    """Otherwise state kept for each of them elsewhere would stay forever."""
    goals = GoalStore(lambda: 0, limit=10, kept_ns=-1, limit_bytes=10_000)
    small = [Large(3_000) for _ in range(3)]
    for number, handle in enumerate(small):
        goals[bytes([number])] = handle
        assert goals.keep(bytes([number])) == []

    goals[b"large"] = Large(9_000)

    assert goals.keep(b"large") == small


def test_forgotten_goals_leave_room_for_as_many_bytes() -> None:
    """The sizes are added up as goals come and go, not counted anew for each goal."""
    now_ns = 0
    goals = GoalStore(lambda: now_ns, limit=10, kept_ns=5, limit_bytes=10_000)
    for number in range(20):
        goal_id = bytes([number])
        assert not goals.refusal(Large(6_000).request)
        goals[goal_id] = Large(6_000)
        assert goals.refusal(Large(6_000).request)
        assert goals.keep(goal_id) == []
        now_ns += 5
        assert len(goals.expire()) == 1


async def test_a_full_server_tells_its_client_why_it_rejects(node: Node) -> None:
    """The caller waits and sends the goal again, or the robot's owner raises the limit."""
    serve(node, Worker(), 1)
    client = node.create_action_client(Fibonacci, "fibonacci")
    await client.send_goal(Fibonacci.Goal(order=1))

    with pytest.raises(GoalRejectedError, match="was rejected: 1 are active: max_goals=1"):
        await client.send_goal(Fibonacci.Goal(order=2))


async def test_a_full_server_says_why_it_rejects_once_a_second(
    node: Node, caplog: pytest.LogCaptureFixture
) -> None:
    """ROS sends the client no reason; and clients must not fill the log."""
    client, asked = PlainClient(node), []

    def decide(goal: Fibonacci.Goal) -> GoalResponse:
        asked.append(goal)
        return GoalResponse.ACCEPT

    serve(node, Worker(), 1, goal_callback=decide)

    for number in range(1, 5):
        await client.send(number)

    (line,) = [each for each in caplog.records if "rejected" in each.message]
    assert (line.levelno, line.message) == (
        logging.WARNING,
        "action server /fibonacci: rejected a goal, as 1 are active: max_goals=1",
    )
    assert len(asked) == 1


async def test_of_too_many_results_the_oldest_is_forgotten(node: Node) -> None:
    """A client that sends a thousand short goals a second would fill the memory with results."""
    client, worker = PlainClient(node), Worker()
    worker.may_end.set()
    server = serve(node, worker, 2)
    for number in (1, 2, 3):
        await client.send(number)
        await client.result(number)

    statuses = [(await client.result(number)).status for number in (1, 2, 3)]
    assert statuses == [GoalStatus.UNKNOWN, GoalStatus.SUCCEEDED, GoalStatus.SUCCEEDED]
    assert "active=0 kept=2 " in repr(server)


async def test_a_result_is_forgotten_ten_seconds_after_its_own_end(
    manual_clock: ManualClock, node: Node
) -> None:
    """One alarm serves all, so each has to be set for the next."""
    client, worker = PlainClient(node), Worker()
    worker.may_end.set()
    server = serve(node, worker, 10, result_timeout=10)
    for number in (1, 2):
        await client.send(number)
        await client.result(number)
        await manual_clock.advance(4)

    await manual_clock.advance(2)
    assert (await client.result(1)).status == GoalStatus.UNKNOWN
    assert (await client.result(2)).status == GoalStatus.SUCCEEDED
    await manual_clock.advance(4)
    assert (await client.result(2)).status == GoalStatus.UNKNOWN
    assert "active=0 kept=0 " in repr(server)


async def test_without_a_timeout_a_callback_that_returns_late_leaves_nothing(node: Node) -> None:
    """Its last state was published before, so that nothing else would forget the goal."""
    client, may_return = PlainClient(node), asyncio.Event()

    async def execute(goal: Any) -> Fibonacci.Result:
        goal.succeed()
        await may_return.wait()
        return Fibonacci.Result()

    server = node.create_action_server(Fibonacci, "fibonacci", execute, result_timeout=0)
    await client.send()
    await settle()
    may_return.set()
    await settle()

    assert "active=0 kept=0 " in repr(server)


@pytest.mark.parametrize(
    ("wrong", "error"), [(0, ValueError), (-1, ValueError), (1.5, TypeError), (True, TypeError)]
)
async def test_a_limit_that_is_no_number_of_goals_is_refused(
    node: Node, wrong: Any, error: type[Exception]
) -> None:
    """With none at all, the server would reject everything."""
    with pytest.raises(error, match=r"action server /fibonacci: max_goals="):
        serve(node, Worker(), wrong)

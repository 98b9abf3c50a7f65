"""`aionode.diagnostics`: what an updater publishes, and what its tasks say."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

import pytest

from aionode.diagnostics import (
    CompositeDiagnosticTask,
    DiagnosedPublisher,
    DiagnosticStatusWrapper,
    DiagnosticTask,
    FrequencyStatus,
    FrequencyStatusParam,
    FunctionDiagnosticTask,
    HeaderlessTopicDiagnostic,
    Heartbeat,
    TimeStampStatus,
    TimeStampStatusParam,
    Updater,
)
from aionode.interfaces.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from aionode.interfaces.sensor_msgs.msg import LaserScan
from aionode.interfaces.std_msgs.msg import String
from aionode.parameter import Parameter
from aionode.testing import settle

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode import Node
    from aionode.testing import ManualClock

OK, WARN, ERROR = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR


@pytest.fixture
async def node(node_factory: Callable[..., Node], manual_clock: ManualClock) -> Node:
    """A node of a driver, in time set by hand."""
    return node_factory("driver", namespace="/arm")


@pytest.fixture
async def heard(node: Node) -> list[DiagnosticArray]:
    """The statuses published on /diagnostics."""
    arrays: list[DiagnosticArray] = []
    node.create_subscription(DiagnosticArray, "/diagnostics", arrays.append, 100)
    return arrays


def good(stat: Any) -> Any:
    """Fill a status."""
    stat.summary(OK, "fine")
    stat.add("temperature", 21.5)
    return stat


async def test_tasks_are_published_once_a_period(
    node: Node, heard: list[DiagnosticArray], manual_clock: ManualClock
) -> None:
    """A function, a coroutine function, and an object; each begins with the node's name."""
    updater = Updater(node)
    updater.setHardwareID("lidar 42")

    async def slow(stat: Any) -> Any:
        await node.get_clock().sleep(0.1)
        stat.summary(WARN, "slow")
        return stat

    updater.add("sync", good)
    updater.add(FunctionDiagnosticTask("async", slow))
    updater.add(Heartbeat())
    await settle()
    starting = [each.status[0].message for each in heard]
    heard.clear()
    await manual_clock.advance(1.2)

    assert starting == ["Node starting up"] * 3
    assert [each.name for each in heard[0].status] == [
        "driver: sync", "driver: async", "driver: Heartbeat"
    ]  # fmt: skip
    assert [each.level for each in heard[0].status] == [OK, WARN, OK]
    assert heard[0].status[0].values[0].value == "21.5"
    assert {each.hardware_id for each in heard[0].status} == {"lidar 42"}
    assert heard[0].header.stamp.sec > 0


async def test_a_task_that_fails_does_not_hold_up_the_others(
    node: Node, heard: list[DiagnosticArray]
) -> None:
    """Its status is an error with the reason; one that forgets to return its status is taken."""
    updater = Updater(node, period=0.05)

    def bad(_stat: Any) -> Any:
        raise OSError("no such device")

    def forgetful(stat: Any) -> None:
        stat.summary(OK, "forgotten")

    async def hanging(_stat: Any) -> Any:
        await asyncio.Event().wait()

    for task in (bad, forgetful, hanging):
        updater.add(task.__name__, task)
    await settle()
    heard.clear()
    await updater.force_update()
    await settle()

    bad_one, forgotten, hung = heard[0].status
    assert (bad_one.level, forgotten.level, hung.level) == (ERROR, OK, ERROR)
    assert bad_one.message == "the task has failed: OSError: no such device"
    assert hung.message == "the task has failed: TimeoutError: no answer in time"


async def test_the_period_is_a_parameter_that_may_change(
    node_factory: Callable[..., Node], manual_clock: ManualClock
) -> None:
    """The program's period is its default; two updaters of a node share it."""
    driver = node_factory(
        "driver", parameter_overrides=[Parameter("diagnostic_updater.period", value=0.5)]
    )
    updater, second = Updater(driver, period=2.0), Updater(driver)
    before = updater.period
    driver.set_parameters([Parameter("diagnostic_updater.period", value=0.1)])
    await manual_clock.advance(0.6)

    assert (before, second.period) == (0.5, 0.1)
    assert updater.period == 0.1


async def test_statuses_may_begin_with_the_full_name(
    node_factory: Callable[..., Node],
) -> None:
    """By the parameter use_fqn, as in C++."""
    driver = node_factory(
        "driver",
        namespace="/arm",
        parameter_overrides=[Parameter("diagnostic_updater.use_fqn", value=True)],
    )

    assert Updater(driver).node_name == "/arm/driver"


async def test_all_statuses_can_be_told_something(node: Node, heard: list[DiagnosticArray]) -> None:
    """Before a shutdown, for example; a task that was removed is not told."""
    updater = Updater(node)
    updater.add("one", good)
    updater.add("two", good)
    await settle()
    heard.clear()
    removed = updater.removeByName("one"), updater.removeByName("one")
    updater.broadcast(ERROR, "going down")
    await settle()

    assert removed == (True, False)
    assert [(each.name, each.message) for each in heard[0].status] == [
        ("driver: two", "going down")
    ]


def test_several_tasks_have_one_status_with_the_worst_level() -> None:
    """Its message has those of all that are as bad, and the values of each."""
    task = CompositeDiagnosticTask("all")
    for name, level in {"a": OK, "b": WARN, "c": ERROR}.items():
        text = f"{name} says so"

        def fill(stat: Any, level: bytes = level, text: str = text) -> Any:
            stat.summary(level, text)
            stat.add(text, level[0])
            return stat

        task.addTask(FunctionDiagnosticTask(name, fill))
    stat = task.run(DiagnosticStatusWrapper())

    assert (stat.level, stat.message) == (ERROR, "b says so; c says so")
    assert [each.value for each in stat.values] == ["0", "1", "2"]


@pytest.mark.parametrize(
    ("mine", "other", "merged"),
    [
        ((OK, "old"), (OK, "new"), (OK, "old; new")),
        ((OK, ""), (OK, "new"), (OK, "new")),
        ((OK, "old"), (WARN, "new"), (WARN, "new")),
        ((WARN, "old"), (OK, "new"), (WARN, "old")),
        ((WARN, "old"), (ERROR, "new"), (ERROR, "old; new")),
    ],
)
def test_summaries_are_merged(mine: Any, other: Any, merged: Any) -> None:
    """As upstream: the message of what is wrong replaces that of what is not."""
    stat = DiagnosticStatusWrapper()
    stat.summary(*mine)
    stat.mergeSummary(*other)

    assert (stat.level, stat.message) == merged


async def frequency(manual_clock: ManualClock, node: Node, events: int, seconds: float) -> Any:
    """Return the status of a frequency of 9 to 11 Hz after so many events in so many seconds."""
    task = FrequencyStatus(FrequencyStatusParam({"min": 10, "max": 10}), clock=node.get_clock())
    for _ in range(events):
        task.tick()
    await manual_clock.advance(seconds)
    return task.run(DiagnosticStatusWrapper())


@pytest.mark.parametrize(
    ("events", "level", "message"),
    [
        (0, ERROR, "No events recorded."),
        (8, WARN, "Frequency too low."),
        (10, OK, "Desired frequency met"),
        (12, WARN, "Frequency too high."),
    ],
)
async def test_a_frequency_is_judged(
    manual_clock: ManualClock, node: Node, events: int, level: bytes, message: str
) -> None:
    """By the clock of the node, within the tolerance."""
    stat = await frequency(manual_clock, node, events, 1.0)
    values = {each.key: each.value for each in stat.values}

    assert (stat.level, stat.message) == (level, message)
    assert values["Actual frequency (Hz)"] == f"{events:f}"
    assert values["Target frequency (Hz)"] == "10.000000"
    assert values["Minimum acceptable frequency (Hz)"] == "9.000000"


async def test_a_frequency_without_time_is_no_error(node: Node) -> None:
    """Two updates may come at once, when one of them is forced."""
    task = FrequencyStatus(FrequencyStatusParam({"min": 1}), clock=node.get_clock())
    task.tick()

    assert task.run(DiagnosticStatusWrapper()).message == "Frequency too low."


@pytest.mark.parametrize(
    ("ages", "level", "message"),
    [
        ([], WARN, "No data since last update."),
        ([0.1, 4.9], OK, "Timestamps are reasonable."),
        ([0.1, 5.1], ERROR, "Timestamps too far in past seen."),
        ([-1.1, 0.1], ERROR, "Timestamps too far in future seen."),
    ],
)
async def test_ages_of_stamps_are_judged(
    node: Node, ages: list[float], level: bytes, message: str
) -> None:
    """The stamps since the last run count."""
    task = TimeStampStatus(clock=node.get_clock())
    now = node.get_clock().now().nanoseconds / 1e9
    for age in ages:
        task.tick(now - age)
    stat = task.run(DiagnosticStatusWrapper())
    again = task.run(DiagnosticStatusWrapper())

    assert (stat.level, stat.message) == (level, message)
    assert again.message == "No data since last update."


def test_a_stamp_that_nobody_set_is_an_error() -> None:
    """This holds even where it is the only one: upstream reports no data then."""
    task = TimeStampStatus()
    task.tick(LaserScan().header.stamp)

    assert task.run(DiagnosticStatusWrapper()).message == "Zero timestamp seen."


async def test_a_publisher_is_diagnosed(
    node: Node, heard: list[DiagnosticArray], manual_clock: ManualClock
) -> None:
    """By the stamps and the number of its messages; one without a header by their number."""
    updater = Updater(node)
    limits = FrequencyStatusParam({"min": 5, "max": 15})
    scans = DiagnosedPublisher(
        node.create_publisher(LaserScan, "/scan", 1), updater, limits, TimeStampStatusParam()
    )
    words = HeaderlessTopicDiagnostic("/words", updater, limits)
    node.create_publisher(String, "/words", 1)

    def publish() -> None:
        scan = LaserScan()
        scan.header.stamp = node.get_clock().now().to_msg()
        scans.publish(scan)
        words.tick()

    node.create_timer(0.1, publish)
    await manual_clock.advance(1.05)

    shown = {each.name: (each.level, each.message) for each in heard[-1].status}
    assert shown == {
        "driver: /scan topic status": (OK, "Desired frequency met; Timestamps are reasonable."),
        "driver: /words topic status": (OK, "Desired frequency met"),
    }


def test_a_task_needs_nothing_but_its_methods() -> None:
    """Programs have tasks of their own, as upstream's examples have."""
    assert DiagnosticTask("mine").getName() == "mine"

"""`diagnostic_updater`, as used by rclpy programs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

import diagnostic_updater
import rclpy
from rosidl_generator_py import message_class
from tests.support.peers import isolated_environment

if TYPE_CHECKING:
    from collections.abc import Iterator

DiagnosticArray = message_class("diagnostic_msgs/msg/DiagnosticArray")
DiagnosticStatus = message_class("diagnostic_msgs/msg/DiagnosticStatus")
LaserScan = message_class("sensor_msgs/msg/LaserScan")


@pytest.fixture
def node(monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """A node of rclpy, without other participants."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
    rclpy.init(args=[])
    yield rclpy.create_node("driver")
    rclpy.try_shutdown()


def test_an_updater_publishes_while_its_node_spins(node: Any) -> None:
    """With rclpy's messages; a task of the program only needs a name and `run`."""
    heard: list[Any] = []
    node.create_subscription(DiagnosticArray, "/diagnostics", heard.append, 10)
    updater = diagnostic_updater.Updater(node, 0.05)
    updater.setHardwareID("none")

    class Task:
        def getName(self) -> str:  # noqa: N802  # ROS's name
            return "mine"

        def run(self, stat: Any) -> Any:
            stat.summary(DiagnosticStatus.WARN, "warm")
            stat.add("celsius", "61")
            return stat

    updater.add(Task())
    scans = diagnostic_updater.DiagnosedPublisher(
        node.create_publisher(LaserScan, "/scan", 1),
        updater,
        diagnostic_updater.FrequencyStatusParam({"min": 1}),
        diagnostic_updater.TimeStampStatusParam(),
    )
    scan = LaserScan()
    scan.header.stamp = node.get_clock().now().to_msg()
    scans.publish(scan)
    while not any(each.status[0].message == "warm" for each in heard):
        rclpy.spin_once(node, timeout_sec=10.0)

    mine, topic = heard[-1].status
    assert type(mine) is DiagnosticStatus
    assert (mine.name, mine.level) == ("driver: mine", DiagnosticStatus.WARN)
    assert (mine.values[0].key, mine.values[0].value) == ("celsius", "61")
    assert topic.name == "driver: /scan topic status"


def test_an_update_can_be_forced(node: Any) -> None:
    """It is a function here; a task that raises is an error, and the program continues."""
    heard: list[Any] = []
    node.create_subscription(DiagnosticArray, "/diagnostics", heard.append, 10)
    updater = diagnostic_updater.Updater(node, 1000.0)

    def bad(_stat: Any) -> Any:
        raise OSError("no device")

    updater.add("bad", bad)
    updater.force_update()
    while len(heard) < 2:
        rclpy.spin_once(node, timeout_sec=10.0)

    assert heard[1].status[0].level == DiagnosticStatus.ERROR
    assert heard[1].status[0].message == "the task has failed: OSError: no device"


def test_a_status_is_a_message() -> None:
    """Programs create one from its fields, like any message."""
    stat = diagnostic_updater.DiagnosticStatusWrapper(name="x", level=DiagnosticStatus.ERROR)

    assert isinstance(stat, DiagnosticStatus)
    assert (stat.name, stat.level) == ("x", DiagnosticStatus.ERROR)

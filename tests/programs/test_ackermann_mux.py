"""The program by which several command one car."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from aionode.interfaces.ackermann_msgs.msg import AckermannDrive, AckermannDriveStamped
from aionode.interfaces.diagnostic_msgs.msg import DiagnosticArray
from aionode.interfaces.std_msgs.msg import Bool
from aionode.programs._command_mux.ackermann_mux import AckermannMux
from aionode.testing import ManualClock, settle
from tests.programs.conftest import Start

PARAMETERS: dict[str, Any] = {
    "topics.navigation.topic": "drive",
    "topics.navigation.timeout": 0.2,
    "topics.navigation.priority": 10,
    "topics.joystick.topic": "teleop",
    "topics.joystick.timeout": 0.2,
    "topics.joystick.priority": 100,
    "locks.pause.topic": "pause",
    "locks.pause.timeout": 0.0,
    "locks.pause.priority": 50,
}


class Car:
    """The commanding nodes, and the commands that the car receives."""

    def __init__(self, node: Any) -> None:
        self.commands: list[AckermannDriveStamped] = []
        self.publishers = {
            topic: node.create_publisher(AckermannDriveStamped, topic, 10)
            for topic in ("drive", "teleop")
        }
        self.pause = node.create_publisher(Bool, "pause", 10)
        node.create_subscription(AckermannDriveStamped, "ackermann_cmd", self.commands.append)

    async def drive(self, topic: str, speed: float) -> list[float]:
        """Command a speed, and return those that have arrived."""
        drive = AckermannDrive(speed=speed, steering_angle=0.25)
        self.publishers[topic].publish(AckermannDriveStamped(drive=drive))
        await settle()
        return [command.drive.speed for command in self.commands]


@pytest.fixture
async def car(manual_clock: ManualClock, start: Start, node_factory: Callable[..., Any]) -> Car:
    """Start the program with the sources of F1TENTH's car, and a lock."""
    await manual_clock.advance(100.0)
    start(AckermannMux, **PARAMETERS)
    car = Car(node_factory("people"))
    await settle()
    return car


async def test_the_joystick_has_the_car_until_it_falls_silent(
    car: Car, manual_clock: ManualClock
) -> None:
    """It is the one with the higher priority."""
    assert await car.drive("drive", 1.0) == [1.0]
    assert await car.drive("teleop", 2.0) == [1.0, 2.0]
    assert await car.drive("drive", 3.0) == [1.0, 2.0]
    await manual_clock.advance(0.3)
    assert await car.drive("drive", 4.0) == [1.0, 2.0, 4.0]


async def test_a_command_passes_as_it_is(car: Car) -> None:
    """With its steering angle."""
    await car.drive("drive", 1.0)

    assert car.commands[0].drive == AckermannDrive(speed=1.0, steering_angle=0.25)


async def test_a_lock_stops_sources_of_lower_priority(car: Car) -> None:
    """Those of higher priority drive on."""
    car.pause.publish(Bool(data=True))
    await settle()

    assert await car.drive("drive", 1.0) == []
    assert await car.drive("teleop", 2.0) == [2.0]


async def test_diagnostics_have_the_name_of_the_program(
    car: Car, manual_clock: ManualClock, node_factory: Callable[..., Any]
) -> None:
    """A robot may have a twist_mux as well."""
    del car
    names: list[str] = []
    node_factory("watcher").create_subscription(
        DiagnosticArray, "/diagnostics", lambda msg: names.append(msg.status[0].name)
    )
    await settle()
    await manual_clock.advance(1.0)
    await settle()

    assert names == ["ackermann_mux: Ackermann mux status"]

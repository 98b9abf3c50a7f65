"""The driver of a VESC, beside a stand-in on a pseudo-terminal."""

from __future__ import annotations

import asyncio
import math
import os
import signal
import subprocess
import sys
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager
from typing import Any

import pytest

from aionode import Node
from aionode.errors import CommandError
from aionode.interfaces.sensor_msgs.msg import Imu
from aionode.interfaces.std_msgs.msg import Float64
from aionode.interfaces.vesc_msgs.msg import VescImuStamped, VescStateStamped
from aionode.programs._serial import SerialPort
from aionode.programs._vesc.packets import GET_FIRMWARE, GET_VALUES, RELEASE, command, framed
from aionode.programs._vesc.vesc_driver_node import VescDriver
from aionode.testing import ManualClock, settle
from tests.programs.conftest import Start
from tests.support.fork_server import start as start_program
from tests.support.peers import isolated_environment
from tests.support.vesc import Vesc, values
from tests.support.waiting import until

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="pseudo-terminals are of Unix")

LIMITS: dict[str, Any] = {
    "duty_cycle_min": -0.5, "duty_cycle_max": 0.5,
    "current_min": -20.0, "current_max": 20.0,
    "brake_min": 0.0, "brake_max": 30.0,
    "speed_min": -23250.0, "speed_max": 23250.0,
    "position_min": -3.0, "position_max": 3.0,
    "servo_min": 0.15, "servo_max": 0.85,
}  # fmt: skip


class Car:
    """A driver, its VESC, and who commands and listens."""

    def __init__(self, driver: VescDriver, vesc: Vesc, clock: ManualClock, node: Node) -> None:
        self.vesc = vesc
        self.clock = clock
        self.states: list[VescStateStamped] = []
        self.imus: list[VescImuStamped] = []
        self.raw_imus: list[Imu] = []
        self.servos: list[float] = []
        self.driver = driver
        self.publishers = {
            name: node.create_publisher(Float64, f"commands/{name}", 10)
            for name in (
                *("motor/speed", "motor/brake", "motor/duty_cycle", "motor/current"),
                *("motor/position", "servo/position"),
            )
        }
        node.create_subscription(VescStateStamped, "sensors/core", self.states.append)
        node.create_subscription(VescImuStamped, "sensors/imu", self.imus.append)
        node.create_subscription(Imu, "sensors/imu/raw", self.raw_imus.append)
        node.create_subscription(
            Float64, "sensors/servo_position_command", lambda msg: self.servos.append(msg.data)
        )

    async def step(self, seconds: float = 0.02) -> None:
        """Let time pass, and the VESC work; everything has arrived afterwards."""
        await self.clock.advance(seconds)
        await settle()
        self.vesc.work()
        await asyncio.sleep(0)  # noqa: TID251  # the loop looks at the terminal
        await settle()

    async def drive(self, name: str, value: float) -> bytes:
        """Command something, and return what the VESC has got last."""
        self.publishers[name].publish(Float64(data=value))
        await settle()
        self.vesc.work()
        return self.vesc.commands[-1] if self.vesc.commands else b""


@pytest.fixture
def vesc() -> Iterator[Vesc]:
    """Plug in a VESC."""
    with Vesc() as made:
        yield made


@pytest.fixture
def driving(
    vesc: Vesc, manual_clock: ManualClock, start: Start, node_factory: Callable[..., Any]
) -> Callable[..., Any]:
    """Start the driver, and wait until it passes commands."""

    async def make(**parameters: Any) -> Car:
        await manual_clock.advance(100.0)
        driver = start(VescDriver, port=vesc.path, **LIMITS | parameters)
        car = Car(driver, vesc, manual_clock, node_factory("people"))
        for _ in range(50):
            if not vesc.commands:
                await car.step()
        return car

    return make


@pytest.fixture
async def car(driving: Callable[..., Any]) -> Car:
    """Start the driver with limits as those of a car."""
    made: Car = await driving()
    return made


async def test_the_motor_is_released_first_of_all(car: Car) -> None:
    """It may still turn as another program has left it."""
    assert car.vesc.commands == [RELEASE]


@pytest.mark.parametrize(
    ("name", "value", "sent"),
    [
        ("motor/speed", 4614.0, command("speed", 4614.0)),
        ("motor/brake", 3.0, command("brake", 3.0)),
        ("motor/duty_cycle", -0.25, command("duty_cycle", -0.25)),
        ("motor/current", 2.0, command("current", 2.0)),
        ("motor/position", 1.0, command("position", 1.0)),
        ("servo/position", 0.5, command("servo", 0.5)),
        ("motor/speed", 1e9, command("speed", 23250.0)),
        ("motor/speed", -1e9, command("speed", -23250.0)),
        ("servo/position", 7.0, command("servo", 0.85)),
    ],
)
async def test_commands_are_passed_within_their_limits(
    car: Car, name: str, value: float, sent: bytes
) -> None:
    """Each topic is one command."""
    assert await car.drive(name, value) == sent


async def test_the_position_of_the_servo_is_published(car: Car) -> None:
    """The VESC does not say it; odometry needs it."""
    await car.drive("servo/position", 0.9)
    await settle()

    assert car.servos == [0.85]


async def test_the_limits_are_zero_by_default(driving: Callable[..., Any]) -> None:
    """As in the original: who gives none cannot drive."""
    car = await driving(speed_min=0.0, speed_max=0.0)

    assert await car.drive("motor/speed", 1000.0) == command("speed", 0.0)


async def test_what_the_vesc_measures_is_published(car: Car) -> None:
    """Fifty times a second, stamped with the time of its arrival."""
    car.vesc.answers[GET_VALUES] = values(-4000)
    for _ in range(3):
        await car.step()
    await until(lambda: car.states and car.imus)

    assert car.states[-1].state.speed == -4000.0
    assert car.states[-1].state.voltage_input == 11.6
    assert car.states[-1].header.stamp.sec > 0
    assert car.imus[-1].imu.linear_acceleration.z == 5.0
    assert car.raw_imus[-1].orientation == car.imus[-1].imu.orientation


async def test_commands_that_stop_coming_release_the_motor(car: Car) -> None:
    """Whoever drove may be dead."""
    await car.drive("motor/speed", 4614.0)
    await car.step(0.4)

    assert car.vesc.commands[-2:] == [command("speed", 4614.0), RELEASE]


async def test_the_timeout_of_commands_is_a_parameter(driving: Callable[..., Any]) -> None:
    """For planners that are slower."""
    car = await driving(command_timeout=2.0)
    await car.drive("motor/speed", 4614.0)
    await car.step(1.0)
    assert car.vesc.commands[-1] == command("speed", 4614.0)
    await car.step(1.1)

    assert car.vesc.commands[-1] == RELEASE


async def test_the_silence_of_a_command_that_was_replaced_releases_nothing(car: Car) -> None:
    """Who has changed from driving to braking goes on to brake."""
    await car.drive("motor/speed", 4614.0)
    for _ in range(5):
        await car.drive("motor/brake", 5.0)
        await car.step(0.1)

    assert RELEASE not in car.vesc.commands[1:]
    await car.step(0.4)
    assert car.vesc.commands[-1] == RELEASE


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
async def test_a_command_that_is_no_number_releases_the_motor(car: Car, value: float) -> None:
    """In C++ it would become an arbitrary one."""
    await car.drive("motor/speed", 4614.0)

    assert await car.drive("motor/speed", value) == RELEASE


async def test_a_steering_command_that_is_no_number_is_ignored(car: Car) -> None:
    """The servo stays where it is."""
    await car.drive("servo/position", math.nan)

    assert (car.vesc.commands, car.servos) == ([RELEASE], [])


async def test_the_end_of_the_node_releases_the_motor(car: Car) -> None:
    """Whatever ends it."""
    await car.drive("motor/speed", 4614.0)
    car.driver.destroy_node()
    await settle()
    car.vesc.work()

    assert car.vesc.commands[-1] == RELEASE


async def test_the_name_of_the_hardware_is_logged_escaped(
    vesc: Vesc, driving: Callable[..., Any], caplog: pytest.LogCaptureFixture
) -> None:
    """A device could otherwise clear the terminal."""
    vesc.answers[GET_FIRMWARE] = b"\x00\x06\x02VESC\x1b[2J\0" + bytes(13)
    caplog.set_level("INFO")
    await driving()

    assert r"-=VESC\x1b[2J=-" in caplog.text


async def test_no_command_is_passed_before_the_vesc_has_answered(
    vesc: Vesc, manual_clock: ManualClock, start: Start, node_factory: Callable[..., Any]
) -> None:
    """It may be something else."""
    vesc.answers[GET_FIRMWARE] = b""
    driver = start(VescDriver, port=vesc.path, **LIMITS)
    car = Car(driver, vesc, manual_clock, node_factory("people"))
    await car.step()

    assert await car.drive("motor/speed", 4614.0) == b""


async def test_a_vesc_that_does_not_answer_is_named(
    vesc: Vesc,
    manual_clock: ManualClock,
    start: Start,
    node_factory: Callable[..., Any],
    caplog: pytest.LogCaptureFixture,
) -> None:
    """Once, after two seconds; the original waits without a word."""
    vesc.answers[GET_FIRMWARE] = b""
    driver = start(VescDriver, port=vesc.path, **LIMITS)
    car = Car(driver, vesc, manual_clock, node_factory("people"))
    for _ in range(250):
        await car.step()

    assert caplog.text.count(f"no VESC answers on '{vesc.path}'") == 1


async def test_after_noise_the_answers_are_found(
    car: Car, caplog: pytest.LogCaptureFixture
) -> None:
    """A cable beside a motor is not quiet."""
    car.vesc.send(b"\x02\xff\x03" + bytes(range(256)) * 8 + framed(values(1))[:-2] + b"xx")
    car.vesc.answers[GET_VALUES] = values(777)
    for _ in range(10):
        await car.step()
    await until(lambda: car.states and car.states[-1].state.speed == 777.0)

    assert {state.state.speed for state in car.states} <= {0.0, 777.0}
    assert caplog.text.count("Out-of-sync with VESC") == 1


async def test_answers_that_are_too_short_are_named(
    car: Car, caplog: pytest.LogCaptureFixture
) -> None:
    """Old firmware has fewer values."""
    car.vesc.answers[GET_VALUES] = values(1)[:56]
    for _ in range(5):
        await car.step()
    await until(lambda: "ignored an answer of the VESC, 4 with 56 bytes" in caplog.text)


async def test_a_vesc_that_reads_nothing_blocks_nobody(car: Car) -> None:
    """Of what waits for it, the newest commands are kept."""
    for _ in range(1000):  # the kernel takes several buffers, one after the other
        car.driver.send(bytes(200))
    car.publishers["motor/speed"].publish(Float64(data=1000.0))
    await settle()
    await car.step(0.4)

    def newest() -> list[bytes]:
        car.vesc.work()
        return car.vesc.commands[-2:]

    await until(lambda: newest() == [command("speed", 1000.0), RELEASE])


@pytest.mark.parametrize(
    ("parameters", "text"),
    [
        ({}, "parameter 'port' is missing; it names a device: /dev/ttyACM0"),
        (
            {"port": "x", "speed_max": math.nan},
            "parameter 'speed_max' is nan; it has to be a finite number",
        ),
        *(
            (
                {"port": "x", "command_timeout": seconds},
                rf"'command_timeout' is {seconds:g}; it has to be from 0.01 to 3600 seconds",
            )
            for seconds in (-1.0, 0.0, 1e-300)
        ),
        ({"port": "x", "command_timeout": 1e300}, r"is 1e\+300; it has to be from 0.01 to 3600"),
        ({"port": "x", "command_timeout": math.inf}, "'command_timeout' is inf; it has to be"),
    ],
)
async def test_parameters_that_do_not_fit_are_named(
    start: Start, parameters: dict[str, Any], text: str
) -> None:
    """In one line."""
    with pytest.raises(CommandError, match=text):
        start(VescDriver, **LIMITS | parameters)


async def test_a_port_that_is_none_is_named(start: Start) -> None:
    """The original says what failed as well."""
    with pytest.raises(CommandError, match=r"Failed to connect to the VESC, /nowhere does not exi"):
        await start(VescDriver, port="/nowhere").serve()


async def test_a_port_that_another_program_uses_is_refused(vesc: Vesc, start: Start) -> None:
    """Two drivers would each read half of the answers."""
    port = await SerialPort.open(vesc.path, 115200)
    with pytest.raises(CommandError, match="is in use by another program"):
        await start(VescDriver, port=vesc.path).serve()
    port.close()


async def test_limits_that_do_not_fit_are_moved(
    driving: Callable[..., Any], caplog: pytest.LogCaptureFixture
) -> None:
    """With the warnings of the original."""
    car = await driving(servo_max=1.5, speed_min=100.0, speed_max=-100.0)

    assert "Parameter servo_max (1.5) is greater than the feasible maximum (1)." in caplog.text
    assert "speed_max (-100) is less than parameter speed_min (100)." in caplog.text
    assert await car.drive("motor/speed", -500.0) == command("speed", -100.0)


# In processes

COMMANDER = """
import aionode
from aionode.interfaces.std_msgs.msg import Float64

class Commander(aionode.Node):
    def __init__(self):
        super().__init__("commander")
        self.publisher = self.create_publisher(Float64, "commands/motor/speed", 10)
        self.create_timer(0.05, lambda: self.publisher.publish(Float64(data=1000.0)))

aionode.run(Commander)
"""
LIMITED = ("-p", "speed_min:=-2000.0", "-p", "speed_max:=2000.0")


@asynccontextmanager
async def processes(vesc: Vesc) -> AsyncIterator[tuple[Any, Any]]:
    """Start a driver and who commands it, until the motor turns."""
    streams: dict[str, Any] = {
        "stdin": subprocess.DEVNULL,
        "stdout": subprocess.PIPE,
        "stderr": subprocess.PIPE,
    }
    env = {**os.environ, **isolated_environment()}
    run = ["-m", "aionode.programs", "vesc_driver", "vesc_driver_node", "--ros-args"]
    driver = start_program([*run, "-p", f"port:={vesc.path}", *LIMITED], env=env, **streams)
    commander = start_program(["-c", COMMANDER], env=env, **streams)
    loop = asyncio.get_running_loop()
    loop.add_reader(vesc.fd, vesc.work)
    try:
        async with asyncio.timeout(30):
            await until(lambda: command("speed", 1000.0) in vesc.commands)
        yield driver, commander
    finally:
        if vesc.fd >= 0:
            loop.remove_reader(vesc.fd)
        for process in (driver, commander):
            process.kill()
            process.communicate()


IN_PROCESSES = [pytest.mark.timeout(90), pytest.mark.one_loop]


@pytest.mark.slow
@pytest.mark.processes
@pytest.mark.parametrize(
    "how", [pytest.param(how, marks=IN_PROCESSES) for how in ("SIGKILL", "SIGSTOP", "SIGTERM")]
)
async def test_the_motor_is_released_however_the_commander_goes(vesc: Vesc, how: str) -> None:
    """Killed, frozen, or ended."""
    async with processes(vesc) as (_, commander):
        commander.send_signal(signal.Signals[how])
        async with asyncio.timeout(10):
            await until(lambda: vesc.commands[-1] == RELEASE)


@pytest.mark.slow
@pytest.mark.processes
@pytest.mark.parametrize(
    "how", [pytest.param(how, marks=IN_PROCESSES) for how in ("SIGINT", "SIGTERM", "SIGHUP")]
)
async def test_the_motor_is_released_when_the_driver_ends(vesc: Vesc, how: str) -> None:
    """While commands still come."""
    async with processes(vesc) as (driver, _):
        driver.send_signal(signal.Signals[how])
        async with asyncio.timeout(10):
            await until(lambda: driver.poll() is not None)

        vesc.work()
        assert vesc.commands[-1] == RELEASE


@pytest.mark.slow
@pytest.mark.processes
@pytest.mark.timeout(90)
@pytest.mark.one_loop
async def test_a_driver_that_was_frozen_releases_the_motor_first(vesc: Vesc) -> None:
    """Old commands do not move it."""
    async with processes(vesc) as (driver, commander):
        driver.send_signal(signal.SIGSTOP)
        commander.kill()
        commander.wait()
        vesc.work()
        before = len(vesc.commands)
        await asyncio.sleep(0.5)  # noqa: TID251  # it is to be frozen for longer than the timeout
        driver.send_signal(signal.SIGCONT)
        async with asyncio.timeout(10):
            await until(lambda: RELEASE in vesc.commands[before:])

        assert vesc.commands[before:] == [RELEASE]


@pytest.mark.slow
@pytest.mark.processes
@pytest.mark.timeout(90)
@pytest.mark.one_loop
async def test_a_vesc_that_is_unplugged_ends_the_driver(vesc: Vesc) -> None:
    """With one error that says so, so that who started it may start it again."""
    async with processes(vesc) as (driver, _):
        asyncio.get_running_loop().remove_reader(vesc.fd)
        path = vesc.path
        vesc.unplug()
        async with asyncio.timeout(10):
            await until(lambda: driver.poll() is not None)
        errors = driver.stderr.read()

        assert driver.returncode == 1
        assert errors.count(f"Unexpectedly disconnected from serial port: {path} is gone") == 1
        assert "Traceback" not in errors

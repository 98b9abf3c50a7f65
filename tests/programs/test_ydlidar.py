"""The program that reads a YDLIDAR; a pseudo-terminal with a stand-in is in the lidar's place."""

from __future__ import annotations

import asyncio
import math
import os
import signal
import struct
import subprocess
from collections.abc import AsyncIterator, Callable, Sequence
from functools import reduce
from operator import xor
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.errors import CommandError
from aionode.interfaces.sensor_msgs.msg import LaserScan
from aionode.interfaces.std_srvs.srv import Empty
from aionode.programs._serial import SerialPort
from aionode.programs._ydlidar import ydlidar_ros2_driver_node
from aionode.programs._ydlidar.packets import SAMPLES, Kind, Packets
from aionode.programs._ydlidar.ydlidar_ros2_driver_node import YdlidarDriver
from aionode.qos import qos_profile_sensor_data
from tests.programs.conftest import Start
from tests.support.fork_server import start as start_program
from tests.support.peers import isolated_environment
from tests.support.waiting import until

X4, G2B, G4, TG30 = 6, 15, 5, 101

FORCE_STOP, STOP, SCAN, INFO, HEALTH = 0x00, 0x65, 0x60, 0x90, 0x92
FASTER, SLOWER, SLIGHTLY_FASTER, SLIGHTLY_SLOWER, SPEED = 0x0B, 0x0C, 0x09, 0x0A, 0x0D
SET_RATE, RATE, OFFSET = 0xD0, 0xD1, 0x93

TRIANGLE = Kind(4000.0, 21.8, 155.3)
WHOLE = Kind(1000.0)
"""A kind whose angles are those in the packet."""

PLAIN: dict[str, Any] = {"reversion": False, "inverted": False, "lidar_type": 0, "range_max": 20.0}
"""Parameters with which angles and ranges are those in the packet, in degrees and millimetres."""


def encoded(
    first: float, last: float, *points: Sequence[int], is_start: bool = False, bits: int = 0
) -> bytes:
    """Return a packet as the lidar makes it: angles in degrees, points as they are sent."""
    ends = [int(angle * 64) << 1 | 1 for angle in (first, last)]
    form = {0: "<H", 8: "<BH", 10: "<BH", 16: "<HH"}[bits]
    body = b"".join(struct.pack(form, *point) for point in points)
    words = [
        0x55AA,
        int(is_start) | len(points) << 8,
        *ends,
        *(x for point in points for x in point),
    ]
    head = struct.pack("<HBBHHH", 0x55AA, is_start, len(points), *ends, reduce(xor, words))
    return head + body


class YdLidar:
    """A stand-in for a lidar at the other end of a pseudo-terminal.

    Attributes:
        heard: The commands that it got.
        is_well: Whether it answers.
    """

    def __init__(self, model: int = X4) -> None:
        self.end, other = os.openpty()
        self.path = os.ttyname(other)
        os.close(other)
        os.set_blocking(self.end, False)
        self.model = model
        self.heard: list[int] = []
        self.pending = b""
        self.is_well = self.is_plugged = True
        self.speed, self.rate = 700, 0

    def hear(self) -> None:
        """Take commands, and answer them."""
        try:
            self.pending += os.read(self.end, 1000)
        except OSError:  # nobody has opened the port
            return
        while len(self.pending) >= 2:
            command, self.pending = self.pending[1], self.pending[2:]
            self.heard.append(command)
            if self.is_well:
                self.answer(command)

    def answer(self, command: int) -> None:
        """Answer a command."""
        steps = {FASTER: 100, SLOWER: -100, SLIGHTLY_FASTER: 10, SLIGHTLY_SLOWER: -10}
        self.speed += steps.get(command, 0)
        self.rate = (self.rate + 1) % 4 if command == SET_RATE else self.rate
        answers = {
            INFO: (0x04, bytes((self.model, 7, 1, 3, *range(8), *range(8)))),
            HEALTH: (0x06, b"\0\0\0"),
            RATE: (0x04, bytes((self.rate,))),
            SET_RATE: (0x04, bytes((self.rate,))),
            OFFSET: (0x04, struct.pack("<i", -40)),
            **dict.fromkeys((SPEED, *steps), (0x04, struct.pack("<I", self.speed))),
        }
        if command in answers:
            kind, body = answers[command]
            os.write(self.end, b"\xa5\x5a" + struct.pack("<IB", len(body), kind) + body)
        if command == SCAN:
            os.write(self.end, b"\xa5\x5a\x05\0\0\x40\x81")

    def send(self, data: bytes) -> None:
        """Send bytes."""
        os.write(self.end, data)

    def turn(self, *millimetres: int, times: int = 1) -> None:
        """Send revolutions of points; the first ends the one before."""
        points = [(each,) for each in millimetres]
        last = 360.0 - 360.0 / max(len(points), 1)
        for _ in range(times):
            self.send(encoded(0.0, 0.0, (0,), is_start=True))
            if points:
                self.send(encoded(0.0, last, *points))

    def unplug(self) -> None:
        """Take the lidar away."""
        if self.is_plugged:
            os.close(self.end)
        self.is_plugged = False


@pytest.fixture
async def device() -> AsyncIterator[YdLidar]:
    """A lidar that answers."""
    device = YdLidar()
    loop = asyncio.get_running_loop()
    loop.add_reader(device.end, device.hear)
    yield device
    loop.remove_reader(device.end)
    device.unplug()


class Desk:
    """The lidar, its driver and what that publishes."""

    def __init__(self, start: Start, node: Any, device: YdLidar) -> None:
        self.start = start
        self.node = node
        self.device = device
        self.scans: asyncio.Queue[LaserScan] = asyncio.Queue()
        node.create_subscription(LaserScan, "scan", self.scans.put_nowait, qos_profile_sensor_data)

    async def begin(self, **parameters: Any) -> Any:
        """Start the program, and wait until the lidar is told to scan."""
        driver = self.start(YdlidarDriver, port=self.device.path, **PLAIN | parameters)
        await until(lambda: SCAN in self.device.heard)
        return driver

    async def scan(self) -> LaserScan:
        """Return the next scan."""
        async with asyncio.timeout(10):
            return await self.scans.get()

    async def call(self, name: str) -> None:
        """Call a service of the driver."""
        await self.node.create_client(Empty, name).call(Empty.Request(), timeout_sec=10.0)


@pytest.fixture
async def desk(device: YdLidar, start: Start, node_factory: Callable[..., Any]) -> Desk:
    """A lidar, and nothing that reads it yet."""
    return Desk(start, node_factory("desk"), device)


# Packets


def test_a_packet_of_the_protocols_description_is_read() -> None:
    """Its example: a zero packet at 348.64 degrees."""
    data = bytes((0xAA, 0x55, 1, 1, 0x53, 0xAE, 0x53, 0xAE, 0xAB, 0x54, 0, 0))
    (packet,) = Packets(0).feed(data)
    assert (packet.is_start, packet.first, packet.last) == (
        True,
        0xAE53 / 128 - 1 / 128,
        348.640625,
    )


def test_angles_of_triangle_lidars_are_corrected() -> None:
    """By the values in the protocol's description, at 1 and 8 metres."""
    (packet,) = Packets(0).feed(encoded(223.78125, 243.46875, (4000,), (32000,)))
    points = packet.points(TRIANGLE)
    assert np.degrees(points.angles) == pytest.approx([217.0191, 235.6314], abs=1e-3)
    assert list(points.ranges) == [1.0, 8.0]


def test_angles_go_on_past_the_zero() -> None:
    """A packet may begin before it and end after it."""
    (packet,) = Packets(0).feed(encoded(350.0, 10.0, (1,), (1,), (1,)))
    assert np.degrees(packet.points(WHOLE).angles) == pytest.approx([350.0, 0.0, 10.0])


@pytest.mark.parametrize(
    ("bits", "point", "intensity", "distance"),
    [
        (8, (31, 4003), 31, 4000),
        (10, (31, 4001), 31 + 256, 4000),
        (16, (3100, 4001), 3100, 4001),
    ],
)
def test_intensities_have_as_many_bits_as_given(
    bits: int, point: tuple[int, int], intensity: int, distance: int
) -> None:
    """Two bits of the distance are those of ten."""
    (packet,) = Packets(bits).feed(encoded(0.0, 0.0, point, bits=bits))
    points = packet.points(WHOLE)
    assert (points.intensities[0], round(points.ranges[0] * 1000)) == (intensity, distance)


def test_a_wrong_checksum_costs_one_packet_only() -> None:
    """Also if the damage is in the number of points."""
    good = encoded(0.0, 90.0, (1000,), (1000,))
    damaged = bytearray(good)
    damaged[3] = 80
    packets = Packets(0)
    found = packets.feed(bytes(damaged) + good * 20)
    assert len(found) >= 16
    assert packets.errors == 0


def test_points_of_another_size_are_noticed() -> None:
    """By the checksums, as the SDK does."""
    packets = Packets(0)
    found = packets.feed(encoded(0.0, 90.0, (1, 1000), (1, 1000), bits=8) * 30)
    assert found
    assert found[-1].bits == 8


@given(st.lists(st.binary(max_size=50)), st.sampled_from(sorted(SAMPLES)))
def test_no_bytes_fill_the_memory(pieces: list[bytes], bits: int) -> None:
    """What is no packet is dropped."""
    packets = Packets(bits)
    for piece in [*pieces, b"\xaa\x55\x00\x50\x01\x01\x01"]:
        packets.feed(piece)
        assert len(packets.buffer) < 10 + 80 * 4


@given(st.integers(1, 11), st.sampled_from(sorted(SAMPLES)))
def test_packets_in_pieces_are_the_same(size: int, bits: int) -> None:
    """Wherever the bytes are cut."""
    point = (7,) * (1 if bits == 0 else 2)
    data = b"\x01\xaa" + encoded(1.0, 2.0, point, point, bits=bits) * 3
    packets = Packets(bits)
    found = [
        each for at in range(0, len(data), size) for each in packets.feed(data[at : at + size])
    ]
    assert [packet.first for packet in found] == [1.0] * 3


# Scans


async def test_a_revolution_is_a_scan(desk: Desk) -> None:
    """Of the points between two starts."""
    await desk.begin(frame_id="mast")
    desk.device.turn(1000, 2000, 3000, 4000, times=2)
    scan = await desk.scan()
    assert scan.header.frame_id == "mast"
    assert (scan.angle_min, scan.angle_max) == pytest.approx((-math.pi, math.pi))
    assert scan.angle_increment == pytest.approx(math.tau / 4)
    # The start packet is a fifth point, without a range; 180 degrees is the last step.
    assert list(scan.ranges) == [0.0, 4.0, 1.0, 2.0, 3.0]
    assert scan.header.stamp.sec > 0


@pytest.mark.parametrize(
    ("parameters", "ranges"),
    [
        ({"inverted": True}, [0, 2, 1, 4, 3]),
        ({"reversion": True}, [0, 2, 3, 4, 1]),
        ({"reversion": True, "inverted": True}, [0, 4, 3, 2, 1]),
        ({"ignore_array": "-100, -80, 80, 100"}, [0, 0, 1, 0, 3]),
        ({"range_min": 1.5, "range_max": 3.5}, [0, 0, 0, 2, 3]),
        ({"range_max": 3.5, "invalid_range_is_inf": True}, [math.inf, math.inf, 1, 2, 3]),
        ({"angle_min": -90.0, "angle_max": 90.0}, [4, 1, 2]),
        ({"angle_min": 90.0, "angle_max": -90.0}, [4, 1, 2]),
    ],
)
async def test_a_scan_is_as_the_parameters_say(
    desk: Desk, parameters: dict[str, Any], ranges: list[float]
) -> None:
    """With one point ahead at 1 m, and one each 90 degrees clockwise."""
    await desk.begin(**parameters)
    desk.device.turn(1000, 2000, 3000, 4000, times=2)
    assert list((await desk.scan()).ranges) == ranges


async def test_a_fixed_resolution_follows_from_rate_and_frequency(desk: Desk) -> None:
    """Of the model: an X4 measures 5000 points a second."""
    await desk.begin(fixed_resolution=True, frequency=5.0, lidar_type=1)
    desk.device.turn(*[4000] * 40, times=2)
    assert len((await desk.scan()).ranges) == 1060


async def test_a_damaged_packet_is_left_out(desk: Desk) -> None:
    """The others make the scan."""
    await desk.begin(angle_min=-90.0, angle_max=90.0)
    desk.device.turn(1000, 2000, 3000, 4000)
    damaged = bytearray(encoded(0.0, 10.0, (9000,), (9000,)))
    damaged[-1] ^= 1
    desk.device.send(bytes(damaged))
    desk.device.turn(1000)
    assert list((await desk.scan()).ranges) == [4.0, 1.0, 2.0]


async def test_a_revolution_without_end_does_not_fill_the_memory(desk: Desk) -> None:
    """As when the sensor of the zero is broken."""
    driver = await desk.begin()
    desk.device.turn()
    for _ in range(80):
        desk.device.send(encoded(0.0, 350.0, *[(1000,)] * 80))
        await until(lambda: driver.parts)
    desk.device.turn()
    scan = await desk.scan()
    assert len(scan.ranges) <= 5000 + 80


# Commands


async def test_the_lidar_is_asked_what_it_is_before_it_scans(desk: Desk) -> None:
    """In the order of the SDK."""
    await desk.begin(lidar_type=1)
    assert desk.device.heard == [FORCE_STOP, STOP, HEALTH, INFO, FORCE_STOP, STOP, SCAN]


async def test_the_frequency_is_set_in_steps(desk: Desk) -> None:
    """Of one hertz, and of a tenth."""
    desk.device.model = G2B
    await desk.begin(frequency=9.3, lidar_type=1)
    assert desk.device.speed == 930


async def test_an_absurd_frequency_is_left_alone(
    desk: Desk, capsys: pytest.CaptureFixture[str]
) -> None:
    """Steps from there would take years."""
    desk.device.model, desk.device.speed = G2B, 2**32 - 1
    await desk.begin(frequency=9.3, lidar_type=1)
    assert SLOWER not in desk.device.heard
    assert "Current scan frequency: 9.30Hz" in capsys.readouterr().err


async def test_the_sample_rate_is_set(desk: Desk) -> None:
    """Each command selects the next one."""
    desk.device.model = G4
    await desk.begin(sample_rate=9, frequency=7.0, lidar_type=1)
    assert desk.device.rate == 2


async def test_the_zero_of_the_lidar_is_used(desk: Desk) -> None:
    """It is told in quarters of a degree."""
    desk.device.model = G2B
    await desk.begin(frequency=7.0)
    desk.device.turn(*[0] * 100, times=1)
    desk.device.send(encoded(90.0, 90.0, (1000,)))
    desk.device.turn(times=2)
    scan = await desk.scan()
    (at,) = np.nonzero(scan.ranges)[0]
    angle = scan.angle_min + at * scan.angle_increment
    assert math.degrees(angle) == pytest.approx(80.0, abs=math.degrees(scan.angle_increment))


async def test_a_tof_lidar_measures_millimetres(desk: Desk) -> None:
    """Whatever `lidar_type` says, by its model; old firmware counts half ones."""
    desk.device.model = TG30
    await desk.begin(lidar_type=1, frequency=7.0)
    desk.device.turn(1000, 1000, times=2)
    assert max((await desk.scan()).ranges) == 1.0


async def test_a_lidar_with_one_channel_is_not_asked(desk: Desk) -> None:
    """It only sends."""
    desk.device.is_well = False
    await desk.begin(isSingleChannel=True)
    desk.device.turn(1000, 1000, 1000, times=2)
    assert (await desk.scan()).ranges[2] == 1.0
    assert HEALTH not in desk.device.heard


async def test_stop_scan_stops_the_lidar_until_start_scan(desk: Desk) -> None:
    """Both are services."""
    await desk.begin()
    desk.device.heard.clear()
    await desk.call("stop_scan")
    await until(lambda: desk.device.heard == [FORCE_STOP, STOP])
    await desk.call("start_scan")
    await until(lambda: SCAN in desk.device.heard)
    desk.device.turn(1000, times=2)
    await desk.scan()


async def test_stop_scan_stops_a_lidar_that_is_being_started(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its scans and its motor, whenever the answer to the command to scan arrives."""
    motor: list[bool] = []
    monkeypatch.setattr(SerialPort, "set_dtr", lambda _, *, is_on: motor.append(is_on))
    answer = desk.device.answer
    monkeypatch.setattr(desk.device, "answer", lambda each: None if each == SCAN else answer(each))
    await desk.begin(support_motor_dtr=True)
    await desk.call("stop_scan")
    desk.device.heard.clear()
    answer(SCAN)
    await until(lambda: desk.device.heard == [FORCE_STOP, STOP])
    assert motor[-2:] == [True, False]


async def test_stop_scan_is_heard_just_before_the_lidar_is_started(desk: Desk) -> None:
    """It is not undone by the command to scan that follows."""
    desk.start(YdlidarDriver, port=desk.device.path, **PLAIN)
    await until(lambda: desk.device.heard.count(STOP) == 2)
    await desk.call("stop_scan")
    await until(lambda: SCAN in desk.device.heard and desk.device.heard[-1] == STOP)


async def test_scans_are_published_before_simulated_time_runs(desk: Desk) -> None:
    """The lidar turns whatever the time is."""
    await desk.begin(use_sim_time=True)
    desk.device.turn(1000, 2000, times=2)
    assert (await desk.scan()).header.stamp.sec == 0


async def test_the_end_of_the_node_stops_the_lidar(desk: Desk) -> None:
    """Its motor would go on otherwise."""
    driver = await desk.begin()
    desk.device.heard.clear()
    driver.destroy_node()
    await until(lambda: desk.device.heard == [FORCE_STOP, STOP])


@pytest.mark.parametrize("runs_with_dtr", [True, False])
async def test_the_motor_turns_by_dtr_while_it_scans(
    desk: Desk, monkeypatch: pytest.MonkeyPatch, runs_with_dtr: bool
) -> None:
    """With it or without it; a pseudo-terminal has no such line."""
    ports: list[SerialPort] = []
    set_to: list[bool] = []

    def set_dtr(port: SerialPort, *, is_on: bool) -> None:
        ports.append(port)
        set_to.append(is_on)

    monkeypatch.setattr(SerialPort, "set_dtr", set_dtr)
    await desk.begin(support_motor_dtr=runs_with_dtr)
    await until(lambda: runs_with_dtr in set_to)
    assert set_to[-1] == runs_with_dtr
    assert ports[-1].device.dtr != runs_with_dtr  # as the port was opened
    await desk.call("stop_scan")
    await until(lambda: set_to[-1] != runs_with_dtr)


# Failures


async def test_a_lidar_that_is_silent_is_connected_again(
    desk: Desk, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """With one warning, by `auto_reconnect`."""
    monkeypatch.setattr(ydlidar_ros2_driver_node, "SILENCE_SEC", 0.2)
    monkeypatch.setattr(ydlidar_ros2_driver_node, "RETRY_SEC", 0.01)
    await desk.begin()
    desk.device.turn(1000, times=2)
    await desk.scan()
    desk.device.heard.clear()
    await until(lambda: SCAN in desk.device.heard)
    desk.device.turn(2000, times=2)
    assert max((await desk.scan()).ranges) == 2.0
    assert capsys.readouterr().err.count("has sent no scan for 0.2 s") == 1


@pytest.mark.parametrize(
    ("parameters", "text"),
    [
        ({"lidar_type": 3}, r"lidar_type is 3; use 0 \(TOF\), 1 \(triangle\) or 4 \(SCL\)"),
        ({"device_type": 1}, r"device_type is 1 \(TCP\), which is not available; use 0"),
        ({"intensity_bit": 9}, "intensity_bit is 9; use 0, 8, 10 or 16"),
        ({"frequency": 0.0}, "frequency is 0.0; use a number above 0"),
        ({"angle_min": 10.0, "angle_max": 10.0}, "use two angles from -180 to 180"),
        ({"angle_max": 270.0}, "use two angles from -180 to 180"),
        ({"range_min": -1.0}, "use two ranges from 0, in metres"),
        ({"ignore_array": "1,2,3"}, "ignore_array is '1,2,3'; use pairs of angles in degrees"),
        ({"ignore_array": "left"}, "ignore_array is 'left'; use pairs"),
    ],
)
async def test_what_does_not_fit_is_refused(
    start: Start, parameters: dict[str, Any], text: str
) -> None:
    """The error says what is valid."""
    with pytest.raises(CommandError, match=text):
        start(YdlidarDriver, **parameters)


@pytest.fixture
async def program(device: YdLidar) -> AsyncIterator[Callable[..., subprocess.Popen[str]]]:
    """Start the program as a process of its own."""
    started = []

    def begin(**parameters: Any) -> subprocess.Popen[str]:
        given_values = {"port": device.path, "auto_reconnect": False, **parameters}
        words = [w for name, value in given_values.items() for w in ("-p", f"{name}:={value}")]
        name = "ydlidar_ros2_driver"
        command = ["-m", "aionode", "run", name, f"{name}_node", "--ros-args", *words]
        pipes: dict[str, Any] = dict.fromkeys(("stdin", "stdout"), subprocess.DEVNULL)
        env = {**os.environ, **isolated_environment()}
        started.append(start_program(command, env=env, stderr=subprocess.PIPE, **pipes))
        return started[-1]

    yield begin
    for process in started:
        process.kill()
        process.communicate()


def errors_of(process: subprocess.Popen[str]) -> str:
    """Return what a program that ends printed as errors."""
    assert process.stderr is not None
    return process.stderr.read()


@pytest.mark.slow
@pytest.mark.processes
@pytest.mark.one_loop
async def test_ctrl_c_stops_the_lidar(
    device: YdLidar, program: Callable[..., subprocess.Popen[str]]
) -> None:
    """The process ends with status 0."""
    process = program()
    await until(lambda: SCAN in device.heard)
    device.heard.clear()
    process.send_signal(signal.SIGINT)
    await until(lambda: process.poll() is not None)
    await until(lambda: device.heard == [FORCE_STOP, STOP])
    assert process.returncode == 0


@pytest.mark.slow
@pytest.mark.processes
@pytest.mark.one_loop
async def test_an_unplugged_lidar_ends_the_program(
    device: YdLidar, program: Callable[..., subprocess.Popen[str]]
) -> None:
    """With one line and status 1, unless it is to connect again."""
    process = program()
    await until(lambda: SCAN in device.heard)
    asyncio.get_running_loop().remove_reader(device.end)
    device.unplug()
    await until(lambda: process.poll() is not None)
    assert f"error: {device.path} is gone; plug it in again" in errors_of(process)
    assert process.returncode == 1


@pytest.mark.slow
@pytest.mark.processes
@pytest.mark.one_loop
async def test_a_device_that_does_not_answer_ends_the_program(
    device: YdLidar, program: Callable[..., subprocess.Popen[str]]
) -> None:
    """Something else may be at that port, or at another rate."""
    device.is_well = False
    process = program()
    await until(lambda: process.poll() is not None)
    assert f"error: {device.path} does not answer; check that a lidar is there" in errors_of(
        process
    )
    assert process.returncode == 1

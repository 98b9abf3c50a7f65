"""The program that reads a Hokuyo; a server with SCIP 2.0 is in the lidar's place."""

from __future__ import annotations

import asyncio
import math
import os
from collections.abc import AsyncIterator, Callable, Sequence
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode import Parameter
from aionode.errors import CommandError
from aionode.interfaces.diagnostic_msgs.msg import DiagnosticArray
from aionode.interfaces.sensor_msgs.msg import LaserScan, MultiEchoLaserScan
from aionode.interfaces.std_srvs.srv import Trigger
from aionode.programs._urg import urg_node_driver
from aionode.programs._urg.scip import MAX_BYTES, MAX_LINES, Reply, Scip, Socket, echoes_in
from aionode.programs._urg.urg_node_driver import UrgNode
from tests.programs.conftest import Start
from tests.support.waiting import until

PERIOD_MS = 25

LIMITS = {
    "MODL": "UST-10LX", "DMIN": "20", "DMAX": "30000", "ARES": "1440", "AMIN": "0",
    "AMAX": "1080", "AFRT": "540", "SCAN": "2400",
}  # fmt: skip

VERSION = {
    "VEND": "Hokuyo Automatic Co., Ltd.", "PROD": "UST-10LX", "FIRM": "3.0.0(12/Feb/2013)",
    "PROT": "SCIP 2.2", "SERI": "H1234567",
}  # fmt: skip

STATE = {
    "MODL": "UST-10LX", "LASR": "OFF", "SCSP": "2400", "MESM": "Idle", "SBPS": "Ethernet",
    "TIME": "000000", "STAT": "Stable 000 no error.",
}  # fmt: skip


def summed(line: str) -> str:
    """Return a line with its checksum."""
    return line + chr((sum(line.encode()) & 0x3F) + 0x30)


def coded(value: int, size: int = 3) -> str:
    """Return a number as characters of six bits."""
    return "".join(chr((value >> 6 * at & 0x3F) + 0x30) for at in reversed(range(size)))


def reply_of(command: str, status: str, *lines: str) -> bytes:
    """Return a reply whose lines have their checksums."""
    return "\n".join([command, summed(status), *lines, "", ""]).encode()


def listed(command: str, values: dict[str, str]) -> bytes:
    """Return a reply with named values; the semicolon is not part of the checksum."""
    lines = [f"{name}:{value};{summed(f'{name}:{value}')[-1]}" for name, value in values.items()]
    return reply_of(command, "00", *lines)


def scan_reply(command: str, points: Sequence[Sequence[int]], time_ms: int = 1234) -> bytes:
    """Return a scan: each point is a distance, with an intensity, or several echoes in a row."""
    size = 2 if command[1] == "E" else 1
    text = "".join(
        "&".join("".join(map(coded, point[at : at + size])) for at in range(0, len(point), size))
        for point in points
    )
    lines = [summed(text[at : at + 64]) for at in range(0, len(text), 64)]
    return reply_of(command, "99", summed(coded(time_ms, 4)), *lines)


class Hokuyo:
    """A stand-in for a lidar.

    Attributes:
        heard: The commands that it got.
        measuring: The command that started the scans; None if there are none.
        port: Where it listens.
        connections: How many there were.
        ended: How the last one ended.
    """

    def __init__(self) -> None:
        self.heard: list[str] = []
        self.measuring: str | None = None
        self.port = self.connections = 0
        self.ended = ""
        self.limits, self.state = dict(LIMITS), dict(STATE)
        self.answers: dict[str, bytes] = {}
        self.writer: Any = None

    async def serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Answer the commands of a connection."""
        self.connections += 1
        self.writer = writer
        try:
            await self.answer_all(reader)
            self.ended = "closed"
        except ConnectionError:
            self.ended = "reset"
        writer.close()

    async def answer_all(self, reader: asyncio.StreamReader) -> None:
        """Answer commands until there are no more."""
        while command := (await reader.readline()).decode().strip():
            self.heard.append(command)
            if command[:2] in {"MD", "ME", "ND", "NE"}:
                self.measuring = command
            elif command == "QT":
                self.measuring = None
            self.send(self.answers.get(command[:2], self.usual_answer(command)))

    def usual_answer(self, command: str) -> bytes:
        """Return the answer of a lidar that is well."""
        if command in {"PP", "VV", "II"}:
            values = {"PP": self.limits, "VV": VERSION, "II": self.state}[command]
            return listed(command, values)
        if command == "TM1":
            return reply_of(command, "00", summed(coded(1_000_000, 4)))
        return reply_of(command, "00")

    def send(self, data: bytes) -> None:
        """Send bytes."""
        self.writer.write(data)

    def scan(self, *points: Sequence[int]) -> None:
        """Send a scan."""
        assert self.measuring
        self.send(scan_reply(self.measuring, points))


@pytest.fixture
async def lidar() -> AsyncIterator[Hokuyo]:
    """A lidar on a free port."""
    lidar = Hokuyo()
    server = await asyncio.start_server(lidar.serve, "127.0.0.1", 0)
    lidar.port = server.sockets[0].getsockname()[1]
    yield lidar
    server.close()
    if lidar.writer is not None:
        lidar.writer.close()


@pytest.fixture(autouse=True)
def patient(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let a slow machine take its time."""
    monkeypatch.setattr(urg_node_driver, "PERIODS", 1000)


class Desk:
    """The lidar, its driver and what that publishes."""

    def __init__(self, start: Start, node: Any, lidar: Hokuyo) -> None:
        self.start = start
        self.node = node
        self.lidar = lidar
        self.seen: asyncio.Queue[Any] = asyncio.Queue()

    def look(self, kind: Any, topic: str) -> None:
        """Subscribe to a topic."""
        self.node.create_subscription(kind, topic, self.seen.put_nowait)

    async def begin(self, **parameters: Any) -> Any:
        """Start the program, and wait until the lidar measures."""
        given_values = {"ip_address": "127.0.0.1", "ip_port": self.lidar.port, **parameters}
        driver = self.start(UrgNode, **given_values)
        await until(lambda: driver.is_started)
        return driver

    async def next(self) -> Any:
        """Return the next message."""
        async with asyncio.timeout(10):
            return await self.seen.get()


@pytest.fixture
async def desk(lidar: Hokuyo, start: Start, node_factory: Callable[..., Any]) -> Desk:
    """A lidar, and nothing that reads it yet."""
    return Desk(start, node_factory("desk"), lidar)


# Scans


async def test_a_scan_has_the_limits_of_the_lidar(desk: Desk) -> None:
    """In radians, metres and seconds."""
    desk.look(LaserScan, "scan")
    await desk.begin(laser_frame_id="mast", angle_min=-math.pi / 2, angle_max=math.pi / 2)
    desk.lidar.scan(*[(1000,)] * 721)
    scan = await desk.next()

    assert scan.header.frame_id == "mast"
    assert (scan.angle_min, scan.angle_max) == pytest.approx((-math.pi / 2, math.pi / 2))
    assert scan.angle_increment == pytest.approx(math.tau / 1440)
    assert (scan.range_min, scan.range_max) == pytest.approx((0.02, 30.0))
    assert (scan.scan_time, scan.time_increment) == pytest.approx((0.025, 0.025 / 1440))
    assert len(scan.ranges) == 721


async def test_ranges_are_metres_or_no_number(desk: Desk) -> None:
    """A distance of 0 was not measured."""
    desk.look(LaserScan, "scan")
    await desk.begin()
    desk.lidar.scan((1000,), (0,), (262143,))
    assert list((await desk.next()).ranges) == pytest.approx([1.0, math.nan, 262.143], nan_ok=True)


async def test_the_command_says_what_to_measure(desk: Desk) -> None:
    """From the first step to the last, with cluster and skip."""
    await desk.begin(angle_min=-1.0, angle_max=0.5, cluster=3, skip=2)
    assert desk.lidar.measuring == "MD0311065503200"


async def test_angles_beyond_those_of_the_lidar_are_its_own(desk: Desk) -> None:
    """As with the default, which is a whole turn."""
    await desk.begin()
    assert desk.lidar.measuring == "MD0000108001000"


async def test_a_cluster_makes_steps_larger(desk: Desk) -> None:
    """Each point stands for several of them."""
    desk.look(LaserScan, "scan")
    await desk.begin(cluster=4)
    desk.lidar.scan(*[(1000,)] * 271)
    scan = await desk.next()
    assert scan.angle_increment == pytest.approx(4 * math.tau / 1440)
    assert len(scan.ranges) == 271


async def test_intensities_are_published(desk: Desk) -> None:
    """With the ranges that were measured."""
    desk.look(LaserScan, "scan")
    await desk.begin(publish_intensity=True)
    desk.lidar.scan((1000, 300), (0, 400))
    scan = await desk.next()
    assert scan.ranges[0] == 1.0
    assert list(scan.intensities) == [300.0, 0.0]


async def test_several_echoes_are_published(desk: Desk) -> None:
    """Of each step, as many as there were."""
    desk.look(MultiEchoLaserScan, "echoes")
    await desk.begin(publish_multiecho=True)
    desk.lidar.scan((1000,), (1000, 2000, 3000), (0,))
    scan = await desk.next()
    assert [list(each.echoes) for each in scan.ranges] == [[1.0], [1.0, 2.0, 3.0], []]


@pytest.mark.parametrize(
    ("topic", "ranges", "intensities"),
    [
        ("first", [1.0, 1.0, math.nan], [10.0, 10.0, 0.0]),
        ("last", [1.0, 3.0, math.nan], [10.0, 20.0, 0.0]),
        ("most_intense", [1.0, 2.0, math.nan], [10.0, 30.0, 0.0]),
    ],
)
async def test_one_of_several_echoes_is_published(
    desk: Desk, topic: str, ranges: list[float], intensities: list[float]
) -> None:
    """As laser_proc does."""
    desk.look(LaserScan, topic)
    await desk.begin(publish_multiecho=True, publish_intensity=True)
    desk.lidar.scan((1000, 10), (1000, 10, 2000, 30, 3000, 20), (0, 0))
    scan = await desk.next()
    assert list(scan.ranges) == pytest.approx(ranges, nan_ok=True)
    assert list(scan.intensities) == intensities


async def test_the_time_of_a_scan_is_that_of_its_first_step(desk: Desk) -> None:
    """Which is later than the revolution's, and has the latency of the user added."""
    desk.look(LaserScan, "scan")
    driver = await desk.begin(default_user_latency=-1000.0)
    desk.lidar.scan((1000,))
    scan = await desk.next()
    now = driver.get_clock().now().nanoseconds / 1e9
    assert scan.header.stamp.sec + scan.header.stamp.nanosec / 1e9 == pytest.approx(
        now - 1000.0, abs=5.0
    )


async def test_the_latency_of_scans_is_measured(desk: Desk) -> None:
    """By the clock of the lidar, with `calibrate_time`."""
    server = desk.lidar

    def answer(command: str) -> bytes:
        data = Hokuyo.usual_answer(server, command)
        if command.startswith("MD"):
            data += scan_reply(command, [(1000,)], time_ms=999_900)
        return data

    server.usual_answer = answer  # type: ignore[method-assign]
    driver = await desk.begin(calibrate_time=True)
    assert driver.latency_sec == pytest.approx(-0.1, abs=0.09)


# Damage


async def test_a_scan_with_a_wrong_checksum_is_left_out(desk: Desk) -> None:
    """The next one is published."""
    desk.look(LaserScan, "scan")
    driver = await desk.begin()
    damaged = bytearray(scan_reply(desk.lidar.measuring or "", [(1000,)] * 50))
    damaged[-5] ^= 1
    desk.lidar.send(bytes(damaged))
    desk.lidar.scan((2000,))
    assert list((await desk.next()).ranges) == [2.0]
    assert driver.error_count == 1


async def test_a_scan_in_pieces_is_whole(desk: Desk) -> None:
    """Wherever the network cuts it."""
    desk.look(LaserScan, "scan")
    await desk.begin()
    for byte in scan_reply(desk.lidar.measuring or "", [(1000,)] * 30):
        desk.lidar.send(bytes((byte,)))
        await desk.lidar.writer.drain()
    assert list((await desk.next()).ranges) == [1.0] * 30


async def test_more_points_than_asked_for_are_not_published(desk: Desk) -> None:
    """Nor are they kept."""
    driver = await desk.begin(angle_min=0.0, angle_max=0.01)
    desk.lidar.scan(*[(1000,)] * 100)
    await until(lambda: driver.error_count)


async def test_five_damaged_scans_connect_again(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One more than `error_limit`."""
    monkeypatch.setattr(urg_node_driver, "RECONNECT_SEC", 0.0)
    driver = await desk.begin()
    for _ in range(4):
        desk.lidar.scan((1000,) * 4)
    await until(lambda: driver.error_count == 4)
    assert driver.is_started
    desk.lidar.scan((1000,) * 4)
    await until(lambda: desk.lidar.connections == 2)


async def test_a_lidar_that_is_silent_is_connected_again(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    """And asked to measure again."""
    monkeypatch.setattr(urg_node_driver, "RECONNECT_SEC", 0.0)
    monkeypatch.setattr(urg_node_driver, "PERIODS", 1)
    desk.look(LaserScan, "scan")
    await desk.begin(error_limit=0)

    def is_seen() -> bool:
        if desk.lidar.connections > 1 and desk.lidar.measuring:
            desk.lidar.scan((1000,))
        return not desk.seen.empty()

    await until(is_seen)


async def test_a_closed_connection_is_opened_again(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As when the lidar was switched off."""
    monkeypatch.setattr(urg_node_driver, "RECONNECT_SEC", 0.0)
    await desk.begin()
    desk.lidar.writer.close()
    await until(lambda: desk.lidar.connections == 2)


async def test_a_lidar_that_comes_later_is_found(
    start: Start, lidar: Hokuyo, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """What is wrong until then is said, but not each time."""
    monkeypatch.setattr(urg_node_driver, "RETRY_SEC", 0.01)
    driver = start(UrgNode, ip_address="127.0.0.1", ip_port=1)
    errors = "Error connecting to Hokuyo: 127.0.0.1:1 cannot be reached: Connection refused"
    text = ""

    def is_said() -> bool:
        nonlocal text
        text += capsys.readouterr().err
        return errors in text

    await until(is_said)
    driver.port = lidar.port
    await until(lambda: driver.is_started)
    assert (text + capsys.readouterr().err).count("cannot be reached") == 1


@pytest.mark.parametrize("host", ["192.168..10", "a" * 70])
async def test_an_address_that_is_none_is_named(host: str) -> None:
    """Python's own error is about encodings."""
    with pytest.raises(OSError, match="is neither an address nor a host name; check ip_address"):
        await Socket.open(host, 10940)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("SCAN", "0"),
        ("ARES", "0"),
        ("AMAX", "99999"),
        ("AMAX", "many"),
        ("DMAX", "-1"),
        ("AFRT", ""),
    ],
)
async def test_impossible_parameters_are_refused(
    desk: Desk, capsys: pytest.CaptureFixture[str], name: str, value: str
) -> None:
    """Rather than divided by, or counted to."""
    desk.lidar.limits[name] = value
    desk.start(UrgNode, ip_address="127.0.0.1", ip_port=desk.lidar.port)
    text = ""

    def is_said() -> bool:
        nonlocal text
        text += capsys.readouterr().err
        return "the lidar has impossible parameters: DMIN" in text

    await until(is_said)


class Babbler:
    """A connection to something that always sends the same.

    Args:
        data: What it sends.
    """

    def __init__(self, data: bytes) -> None:
        self.data = data

    async def read(self) -> bytes:
        """Return it."""
        return self.data

    def write(self, data: bytes) -> None:
        """Hear nothing."""

    def close(self) -> None:
        """Go on."""


async def test_a_reply_without_end_is_not_kept() -> None:
    """A server of another protocol may send anything."""
    scip = Scip(Babbler(b"x" * 5000))
    with pytest.raises(OSError, match="it does not end; is this a lidar"):
        await scip.receive()
    assert len(scip.buffer) <= MAX_BYTES + 5000


async def test_a_reply_of_very_short_lines_is_a_checksum_error() -> None:
    """To check each of them would take half a second, in which no other node works."""
    line = b"0\n"  # an empty one, with its checksum
    reply = await Scip(Babbler(b"MD\n99b\n" + line * 50_000 + b"\n")).receive()
    assert len(reply.lines) <= MAX_LINES
    with pytest.raises(OSError, match="checksum error"):
        reply.check()


@given(st.binary(max_size=300), st.booleans())
def test_no_characters_are_more_than_an_error(data: bytes, has_intensities: bool) -> None:
    """Each number that is found has eighteen bits."""
    try:
        found = echoes_in(data, 40, has_intensities=has_intensities)
    except OSError as error:
        assert "receive error" in str(error)  # noqa: PT017  # it need not be raised
    else:
        assert found.shape[1] <= 40
        assert 0 <= found.min() <= found.max() < 2**18


@given(st.lists(st.binary(max_size=70), max_size=5))
def test_no_lines_are_more_than_a_checksum_error(lines: list[bytes]) -> None:
    """Whatever they contain."""
    reply = Reply("PP", "00", [line for line in lines if line])
    for is_text in (True, False):
        try:
            reply.check(is_text=is_text)
        except OSError as error:
            assert "checksum error" in str(error)  # noqa: PT017  # as above


@given(
    st.lists(st.lists(st.integers(1, 2**18 - 1), min_size=1, max_size=3), min_size=1, max_size=40)
)
def test_echoes_are_read_as_they_were_written(points: list[list[int]]) -> None:
    """By step, in their order."""
    lines = scan_reply("ND", points).splitlines()[3:-1]
    data = b"".join(line[:-1] for line in lines)
    found = echoes_in(data, len(points), has_intensities=False)
    assert [[int(x) for x in row if x] for row in found[0]] == points


# The lidar itself


async def test_the_lidar_is_asked_before_it_measures(desk: Desk) -> None:
    """In the order of urg_c."""
    await desk.begin()
    assert desk.lidar.heard == ["QT", "PP", "VV", "II", "MD0000108001000"]


async def test_a_lidar_that_measures_already_is_stopped(desk: Desk) -> None:
    """Scans that are on their way are not the answer."""
    old = "MD0000108001000"
    desk.lidar.answers["QT"] = scan_reply(old, [(1,)]) * 3 + reply_of("QT", "00")
    await desk.begin()
    assert desk.lidar.measuring


async def test_scip_1_is_switched_to_2(desk: Desk) -> None:
    """As a URG-04LX needs it."""
    count = 0

    def answer(command: str) -> bytes:
        nonlocal count
        count += command == "QT"
        if command == "QT" and count == 1:
            return b"QT\nE\n\n"
        return Hokuyo.usual_answer(desk.lidar, command)

    desk.lidar.usual_answer = answer  # type: ignore[method-assign]
    await desk.begin()
    assert desk.lidar.heard[:3] == ["QT", "SCIP2.0", "QT"]


async def test_the_end_of_the_node_stops_the_lidar(desk: Desk) -> None:
    """Its laser would stay on otherwise; scans on their way must not reset the connection."""
    driver = await desk.begin()
    desk.lidar.send(scan_reply(desk.lidar.measuring or "", [(1000,)] * 1081) * 200)
    driver.destroy_node()
    await until(lambda: desk.lidar.ended)
    assert (desk.lidar.heard[-1], desk.lidar.ended) == ("QT", "closed")


async def test_diagnostics_say_what_the_lidar_is(desk: Desk) -> None:
    """And whether it is well."""
    seen: list[DiagnosticArray] = []
    desk.node.create_subscription(DiagnosticArray, "/diagnostics", seen.append)
    driver = await desk.begin()
    await driver.updater.force_update()
    await until(lambda: seen and len(seen[-1].status) > 1)
    status = {each.name: each for each in seen[-1].status}["urg_node: Hardware Status"]
    values = {each.key: each.value for each in status.values}

    assert (status.level, status.message) == (b"\0", "Streaming")
    assert status.hardware_id == values["Device ID"] == "H1234567"
    assert (values["Firmware Version"], values["Firmware Date"]) == ("3.0.0", "12/Feb/2013")


async def test_update_laser_status_asks_the_lidar(desk: Desk) -> None:
    """While it measures."""
    driver = await desk.begin()
    desk.lidar.state["STAT"] = "unstable"
    answer = await desk.node.create_client(Trigger, "update_laser_status").call(
        Trigger.Request(), timeout_sec=10.0
    )
    assert (answer.success, answer.message) == (True, "Status retrieved")
    assert driver.status == "unstable"


async def test_several_echoes_need_a_lidar_that_has_them(
    desk: Desk, capsys: pytest.CaptureFixture[str]
) -> None:
    """The error names the parameter."""
    desk.lidar.answers["ND"] = reply_of("ND0000108001000", "0E")
    desk.start(UrgNode, ip_address="127.0.0.1", ip_port=desk.lidar.port, publish_multiecho=True)
    text = ""

    def is_said() -> bool:
        nonlocal text
        text += capsys.readouterr().err
        return "ask for; reconnecting" in text

    await until(is_said)
    assert "status 0E; check whether this lidar measures what publish_intensity" in text


async def test_a_serial_port_has_the_same_protocol(start: Start) -> None:
    """It is used without an `ip_address`."""
    lidar = Hokuyo()
    end, other = os.openpty()
    path = os.ttyname(other)
    os.close(other)
    os.set_blocking(end, False)
    loop = asyncio.get_running_loop()
    reader = asyncio.StreamReader()
    loop.add_reader(end, lambda: reader.feed_data(os.read(end, 1000)))

    class Writer:
        def write(self, data: bytes) -> None:
            os.write(end, data)

        def close(self) -> None:
            pass

    async with asyncio.TaskGroup() as group:
        serving = group.create_task(lidar.serve(reader, Writer()))  # type: ignore[arg-type]
        driver = start(UrgNode, serial_port=path)
        await until(lambda: driver.is_started)
        driver.destroy_node()
        await until(lambda: lidar.heard[-1] == "QT")
        serving.cancel()
    loop.remove_reader(end)
    os.close(end)


# Parameters


@pytest.mark.parametrize(
    ("parameters", "text"),
    [
        ({"cluster": 100}, "cluster is 100; use a number from 1 to 99"),
        ({"skip": 10}, "skip is 10; use a number from 0 to 9"),
        ({"error_limit": -1}, "error_limit is -1; use a number from 0"),
        ({"angle_min": math.nan}, "angle_min is nan; use a number from"),
        ({"ip_port": 70000}, "ip_port is 70000; use a number from 1 to 65535"),
        (
            {"diagnostics_window_time": 0.0},
            "window_time 0.0; use at least 0 and at least 1 s",
        ),
    ],
)
async def test_what_does_not_fit_is_refused(
    start: Start, parameters: dict[str, Any], text: str
) -> None:
    """The error says what is valid."""
    with pytest.raises(CommandError, match=text):
        start(UrgNode, **parameters)


async def test_a_parameter_that_does_not_fit_is_refused_later_as_well(desk: Desk) -> None:
    """The value stays what it was."""
    driver = await desk.begin()
    (result,) = driver.set_parameters([Parameter("cluster", value=0)])
    assert not result.successful
    assert result.reason == "cluster is 0; use a number from 1 to 99"


async def test_without_a_lidar_the_diagnostics_say_so(
    start: Start, node_factory: Callable[..., Any]
) -> None:
    """As an error."""
    seen: list[DiagnosticArray] = []
    node_factory("desk").create_subscription(DiagnosticArray, "/diagnostics", seen.append)
    driver = start(UrgNode, ip_address="127.0.0.1", ip_port=1)
    await driver.updater.force_update()
    await until(lambda: seen)
    assert seen[-1].status[0].message == "Not Connected"


def test_checksums_of_scans_are_those_of_the_protocol() -> None:
    """An example of its description: a distance of 1234 mm is 0CB."""
    assert coded(1234) == "0CB"
    assert int(np.squeeze(echoes_in(b"0CB", 1, has_intensities=False))[0]) == 1234

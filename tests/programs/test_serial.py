"""Serial ports on the event loop; pseudo-terminals stand in for them."""

from __future__ import annotations

import asyncio
import contextlib
import errno
import os
import sys
import termios
from collections.abc import AsyncIterator
from contextlib import suppress
from pathlib import Path

import pytest

from aionode.errors import CommandError
from aionode.programs._serial import SerialPort
from aionode.testing import settle

EVERY_BYTE = bytes(range(256))


class Cable:
    """A pseudo-terminal.

    Attributes:
        end: The descriptor of the device's end.
        path: The name of the computer's end.
    """

    def __init__(self) -> None:
        self.end, other = os.openpty()
        self.path = os.ttyname(other)
        os.close(other)
        self.is_plugged = True

    def unplug(self) -> None:
        """Close the device's end."""
        if self.is_plugged:
            os.close(self.end)
        self.is_plugged = False


@pytest.fixture
async def cable() -> AsyncIterator[Cable]:
    """A cable with nothing at its end."""
    cable = Cable()
    yield cable
    cable.unplug()


@pytest.fixture
async def port(cable: Cable) -> AsyncIterator[SerialPort]:
    """The open port of the cable."""
    port = await SerialPort.open(cable.path, 115200)
    yield port
    port.close()


async def test_bytes_arrive_as_they_were_sent(cable: Cable, port: SerialPort) -> None:
    """A terminal would echo them, end at Ctrl-C, and change line ends."""
    os.write(cable.end, EVERY_BYTE)
    data = b""
    while len(data) < len(EVERY_BYTE):
        data += await port.read()
    assert data == EVERY_BYTE


async def test_bytes_are_sent_as_they_were_written(cable: Cable, port: SerialPort) -> None:
    """As above, the other way."""
    port.write(EVERY_BYTE)
    assert os.read(cable.end, 1000) == EVERY_BYTE


async def test_a_read_waits_for_bytes(cable: Cable, port: SerialPort) -> None:
    """A read of nothing is not the end of the stream."""
    async with asyncio.TaskGroup() as group:
        reading = group.create_task(port.read())
        await settle()
        os.write(cable.end, b"late")
    assert reading.result() == b"late"


async def test_a_rate_without_a_constant_can_be_set(cable: Cable) -> None:
    """Lidars have rates that termios has no name for, such as 128000."""
    port = await SerialPort.open(cable.path, 128000)
    port.close()
    assert not port.device.is_open


async def test_a_port_that_was_unplugged_ends_a_read(cable: Cable, port: SerialPort) -> None:
    """Systems report it as an error or as the end of the stream."""
    cable.unplug()
    with pytest.raises(OSError, match=f"{cable.path} is gone; plug it in again"):
        await port.read()


async def test_a_port_that_was_unplugged_cannot_be_written(cable: Cable, port: SerialPort) -> None:
    """The system's error says nothing of the port."""
    cable.unplug()
    with pytest.raises(OSError, match="is gone; plug it in again"):
        port.write(b"stop")


async def test_a_closed_port_cannot_be_written(port: SerialPort) -> None:
    """Its descriptor may belong to another file by then."""
    port.close()
    with pytest.raises(OSError, match="is gone"):
        port.write(b"stop")


async def test_a_device_that_takes_no_bytes_does_not_fill_the_memory(port: SerialPort) -> None:
    """What the kernel does not take is an error rather than kept."""
    with pytest.raises(OSError, match=r"does not send: \d+ of 10000000 bytes were accepted"):
        port.write(bytes(10_000_000))


async def test_the_latest_bytes_replace_those_that_a_device_does_not_take(
    cable: Cable, port: SerialPort
) -> None:
    """A stop is no use behind old commands."""
    with pytest.raises(OSError, match="does not send"):
        port.write(bytes(10_000_000))
    port.write_latest(b"stop")

    os.set_blocking(cable.end, False)
    arrived = b""
    with suppress(BlockingIOError):
        while True:
            arrived += os.read(cable.end, 10_000)
    assert arrived.endswith(b"stop")


async def test_a_device_that_sends_without_end_does_not_fill_the_memory(
    cable: Cable, port: SerialPort
) -> None:
    """Bytes that are not read wait in the kernel, which then takes no more."""
    os.set_blocking(cable.end, False)
    with contextlib.suppress(BlockingIOError):
        for _ in range(1000):
            os.write(cable.end, bytes(1000))
            await settle()
        pytest.fail("all bytes were taken")
    assert len(await port.read()) <= 4096


async def test_a_descriptor_is_closed_once(port: SerialPort) -> None:
    """Its number may be that of another file right after that."""
    number = port.device.fileno()
    port.close()
    other = os.open(os.devnull, os.O_RDONLY)
    assert other == number
    await settle()
    os.close(other)


async def test_closing_a_port_ends_its_read(port: SerialPort) -> None:
    """The reader may be another task."""
    asyncio.get_running_loop().call_soon(port.close)
    with pytest.raises(OSError, match="is gone"):
        await port.read()


async def test_a_second_program_cannot_open_the_port(cable: Cable, port: SerialPort) -> None:
    """Each of them would read a part of the bytes."""
    with pytest.raises(OSError, match=f"{cable.path} is in use by another program; stop that"):
        await SerialPort.open(cable.path, 115200)
    assert port.device.is_open


async def test_a_port_that_does_not_exist_is_named() -> None:
    """The error lists the ports of this machine."""
    with pytest.raises(OSError, match="/dev/ttyNONE does not exist; serial ports here: "):
        await SerialPort.open("/dev/ttyNONE", 115200)


async def test_a_file_is_no_serial_port(tmp_path: Path) -> None:
    """It has no rate to set."""
    file = tmp_path / "port"
    file.touch()
    with pytest.raises(OSError, match=f"{file} is not a serial port; use a device such as"):
        await SerialPort.open(str(file), 115200)


async def test_a_port_that_vanishes_while_it_is_opened_is_named(
    cable: Cable, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The error of termios is no OSError, and would end programs that connect again."""

    def gone(*_: object) -> None:
        raise termios.error(errno.EIO, "Input/output error")

    monkeypatch.setattr(termios, "tcsetattr", gone)
    with pytest.raises(OSError, match=f"{cable.path} cannot be opened: Input/output error"):
        await SerialPort.open(cable.path, 115200)


@pytest.mark.parametrize("rate", [-1, 2**40])
async def test_an_impossible_rate_is_named(cable: Cable, rate: int) -> None:
    """No driver knows it."""
    with pytest.raises(OSError, match=f"cannot be set to {rate} baud; use a rate that its driver"):
        await SerialPort.open(cable.path, rate)


async def test_a_port_without_dtr_is_left_alone(port: SerialPort) -> None:
    """Pseudo-terminals and some adapters have no such line."""
    port.set_dtr(is_on=False)
    assert termios.tcgetattr(port.device.fileno())


async def test_without_pyserial_the_extra_is_named(
    cable: Cable, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The package is optional."""
    monkeypatch.setitem(sys.modules, "serial", None)
    with pytest.raises(CommandError, match=r"pip install 'aionode\[serial\]'"):
        await SerialPort.open(cable.path, 115200)

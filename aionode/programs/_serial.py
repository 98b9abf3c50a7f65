"""Serial ports on the event loop, opened by pyserial."""

from __future__ import annotations

import asyncio
import errno
import os
from contextlib import suppress
from typing import TYPE_CHECKING, Final, Self

from aionode.errors import CommandError

if TYPE_CHECKING:
    from serial import Serial

__all__ = ["SerialPort"]

CHUNK: Final = 4096
"""The most bytes that one `read` returns; the kernel buffers about as many."""


class SerialPort:
    """An open serial port, which one task at a time may read.

    The event loop's own streams are not used: uvloop's close the descriptor a second time, and read
    it where they should only write.

    Args:
        device: The port, as pyserial opened it.
    """

    def __init__(self, device: Serial) -> None:
        self.device = device
        self.path = str(device.port)
        self.loop = asyncio.get_running_loop()
        self.is_readable: asyncio.Future[None] | None = None

    @classmethod
    async def open(cls, path: str, baudrate: int, *, dtr: bool = True) -> Self:
        """Open a port for eight data bits, no parity and one stop bit, for this process alone.

        Args:
            path: The device, such as ``/dev/ttyUSB0``.
            baudrate: Any rate that the driver of the port can set.
            dtr: The state of the line DTR, which starts the motor of some lidars.

        Raises:
            CommandError: The package pyserial is not installed.
            OSError: It cannot be opened; the text says why.
        """
        try:
            import serial
        except ModuleNotFoundError:
            raise CommandError(
                "serial ports need the package pyserial, which is not installed: pip install "
                "'aionode[serial]'"
            ) from None
        # With `inter_byte_timeout` a read of nothing is EAGAIN rather than the end of the stream.
        device = serial.Serial(timeout=0, inter_byte_timeout=0, exclusive=True)
        device.dtr = dtr
        device.port = path
        try:
            device.baudrate = baudrate
            device.open()
        except Exception as error:  # noqa: BLE001  # also termios.error, which is no OSError
            raise OSError(problem(path, baudrate, error)) from None
        return cls(device)

    async def read(self) -> bytes:
        """Wait for bytes, and return those that have arrived.

        Raises:
            OSError: The port is gone, or was closed.
        """
        while self.device.is_open:
            await self.wait()
            try:
                data = os.read(self.device.fileno(), CHUNK)
            except BlockingIOError:
                continue
            except OSError:  # EIO, where others report the end of the stream; or it was closed
                break
            if not data:
                break
            return data
        raise self.gone()

    async def wait(self) -> None:
        """Wait for bytes, the end of the stream, or until the port is closed."""
        descriptor = self.device.fileno()
        self.is_readable = self.loop.create_future()
        self.loop.add_reader(descriptor, set_done, self.is_readable)
        try:
            await self.is_readable
        finally:
            if self.device.is_open:
                self.loop.remove_reader(descriptor)

    def write(self, data: bytes) -> None:
        """Hand bytes to the kernel, without waiting for them to be sent.

        Raises:
            OSError: The port is gone, or the kernel still holds too many earlier bytes.
        """
        if not self.device.is_open:
            raise self.gone()
        try:
            count = os.write(self.device.fileno(), data)
        except BlockingIOError:
            count = 0
        except OSError:
            raise self.gone() from None
        if count < len(data):
            raise OSError(f"{self.path} does not send: {count} of {len(data)} bytes were accepted")

    def write_latest(self, data: bytes) -> None:
        """Write bytes, replacing earlier ones if the kernel still holds too many.

        Raises:
            OSError: The port is gone, or does not take even these.
        """
        try:
            self.write(data)
        except OSError as error:
            if error.errno == errno.ENODEV:
                raise
            self.device.reset_output_buffer()
            self.write(data)

    def set_dtr(self, *, is_on: bool) -> None:
        """Set the line DTR, if the port has one; does nothing if the port is gone."""
        if self.device.is_open:
            with suppress(OSError):
                self.device.dtr = is_on

    def gone(self) -> OSError:
        """Return the error for a port that is no longer there."""
        return OSError(errno.ENODEV, f"{self.path} is gone; plug it in again")

    def close(self) -> None:
        """Close the port once the kernel has sent what was written; this ends a pending read."""
        if self.device.is_open:
            self.loop.remove_reader(self.device.fileno())
            self.device.close()
        if self.is_readable is not None:
            set_done(self.is_readable)


def set_done(future: asyncio.Future[None]) -> None:
    """Set the result of a future that has none."""
    if not future.done():
        future.set_result(None)


def problem(path: str, baudrate: int, error: Exception) -> str:
    """Return why a port cannot be opened, and what to do."""
    code = next((each for each in error.args[:1] if isinstance(each, int)), None)
    if code == errno.ENOENT:
        from serial.tools.list_ports import comports

        there = ", ".join(sorted(str(each.device) for each in comports())) or "none"
        return f"{path} does not exist; serial ports here: {there}"
    if code in {errno.EACCES, errno.EPERM}:
        return f"{path} may not be opened; add your user to its group, often dialout"
    if code == errno.EAGAIN:
        return f"{path} is in use by another program; stop that first"
    if isinstance(error, OverflowError | ValueError):
        return f"{path} cannot be set to {baudrate} baud; use a rate that its driver knows"
    if code is None:
        return f"{path} is not a serial port; use a device such as /dev/ttyUSB0"
    return f"{path} cannot be opened: {os.strerror(code)}"

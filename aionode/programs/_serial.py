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
"""The most bytes that one `read` returns; the kernel keeps about as many of those not yet read."""


class SerialPort:
    """An open serial port.

    Args:
        device: The port, as pyserial opened it.
        reader: Its incoming bytes.
        transport: What fills the reader.
    """

    def __init__(
        self, device: Serial, reader: asyncio.StreamReader, transport: asyncio.ReadTransport
    ) -> None:
        self.device = device
        self.path = str(device.port)
        self.reader = reader
        self.transport = transport

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
        except (OSError, OverflowError, ValueError) as error:
            raise OSError(problem(path, baudrate, error)) from None
        reader = asyncio.StreamReader(limit=CHUNK)
        transport, _ = await asyncio.get_running_loop().connect_read_pipe(
            lambda: asyncio.StreamReaderProtocol(reader), device
        )
        return cls(device, reader, transport)

    async def read(self) -> bytes:
        """Wait for bytes, and return all that have arrived.

        Raises:
            OSError: The port is gone.
        """
        with suppress(OSError):  # EIO, where others report the end of the stream
            data = await self.reader.read(CHUNK)
            if data:
                return data
        raise self.gone()

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
        """Write bytes; if the kernel still holds too many earlier ones, in place of those.

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
        """Set the line DTR, if the port has one; one that is gone is left alone."""
        if self.device.is_open:
            with suppress(OSError):
                self.device.dtr = is_on

    def gone(self) -> OSError:
        """Return the error for a port that is no longer there."""
        return OSError(errno.ENODEV, f"{self.path} is gone; plug it in again")

    def close(self) -> None:
        """Close the port once the kernel has sent what was written."""
        self.transport.close()
        self.device.close()


def problem(path: str, baudrate: int, error: Exception) -> str:
    """Return why a port cannot be opened, and what to do."""
    code = getattr(error, "errno", None)
    if code == errno.ENOENT:
        from serial.tools.list_ports import comports

        there = ", ".join(sorted(str(each.device) for each in comports())) or "none"
        return f"{path} does not exist; serial ports here: {there}"
    if code in {errno.EACCES, errno.EPERM}:
        return f"{path} may not be opened; add your user to its group, often dialout"
    if code == errno.EAGAIN:
        return f"{path} is in use by another program; stop that first"
    if not isinstance(error, OSError):
        return f"{path} cannot be set to {baudrate} baud; use a rate that its driver knows"
    if code is None:
        return f"{path} is not a serial port; use a device such as /dev/ttyUSB0"
    return f"{path} cannot be opened: {os.strerror(code)}"

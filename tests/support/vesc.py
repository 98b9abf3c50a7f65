"""A VESC at the other end of a pseudo-terminal."""

from __future__ import annotations

import os
import struct
from collections.abc import Iterator
from typing import Self

from aionode.programs._vesc.packets import GET_FIRMWARE, GET_IMU, GET_VALUES, Frames, framed

__all__ = ["FIRMWARE", "IMU", "Vesc", "values"]

FIRMWARE = b"\x00\x05\x02HW60\x00" + bytes(12) + b"\x00"
IMU = struct.pack(">BH16f", 65, 0xFFFF, *range(16))


def values(speed: int) -> bytes:
    """Return the answer of a motor that turns at a speed, in electrical RPM, at 11.6 V."""
    return struct.pack(">B22xih44x", 4, speed, 116)


class Vesc:
    """Answers questions, and keeps the other payloads that it gets.

    Attributes:
        path: The device that a driver opens.
        answers: The answer to each question.
        commands: What else it was sent, in its order.
    """

    def __init__(self) -> None:
        self.fd, self._slave = os.openpty()
        os.set_blocking(self.fd, False)
        self.path = os.ttyname(self._slave)
        self.answers = {GET_FIRMWARE: FIRMWARE, GET_VALUES: values(0), GET_IMU: IMU}
        self.commands: list[bytes] = []
        self._frames = Frames()

    def work(self) -> None:
        """Process what has arrived."""
        for payload in self._frames.feed(self._arrived()):
            if payload not in self.answers:
                self.commands.append(payload)
            elif self.answers[payload]:
                self.send(framed(self.answers[payload]))

    def _arrived(self) -> bytes:
        return b"".join(self._pieces())

    def _pieces(self) -> Iterator[bytes]:
        while True:
            try:
                yield os.read(self.fd, 4096)
            except OSError:  # nothing more, or its driver has closed the port
                return

    def send(self, data: bytes) -> None:
        """Send bytes."""
        os.write(self.fd, data)

    def unplug(self) -> None:
        """Be gone."""
        for fd in (self.fd, self._slave):
            if fd >= 0:
                os.close(fd)
        self.fd = self._slave = -1

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.unplug()

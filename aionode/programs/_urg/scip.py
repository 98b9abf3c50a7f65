"""SCIP 2.0, the protocol of Hokuyo's lidars: commands, answers and the points in them."""

from __future__ import annotations

import asyncio
import errno
import math
import os
import re
from typing import Any, Final, NamedTuple, Protocol, Self

import numpy as np
import numpy.typing as npt

from aionode.errors import escaped

__all__ = ["ANSWER_SEC", "Limits", "Link", "Reply", "Scip", "Socket", "echoes_in", "time_of"]

END: Final = b"\n\n"
MAX_BYTES: Final = 200_000
"""The most bytes of a reply; a scan of 5000 steps with three echoes has fewer."""

MAX_LINES: Final = MAX_BYTES // 65
"""The most lines of a reply: scans have 64 characters and a checksum on each."""

MAX_STEPS: Final = 5000
MAX_ECHOES: Final = 3
CHUNK: Final = 65536
ANSWER_SEC: Final = 1.0
CONNECT_SEC: Final = 2.0
CLOSE_SEC: Final = 0.3

ZERO: Final = 0x30
"""The character of the digit 0; each character has six bits."""

MORE: Final = ord("&")
"""What precedes another echo of the same step."""

NUMBERS: Final = ("DMIN", "DMAX", "ARES", "AMIN", "AMAX", "AFRT", "SCAN")


class Link(Protocol):
    """A connection; each method raises OSError if it is gone."""

    async def read(self) -> bytes:
        """Wait for bytes, and return those that have arrived."""

    def write(self, data: bytes) -> None:
        """Send bytes."""

    def close(self) -> None:
        """Close the connection."""


class Socket:
    """A TCP connection.

    Args:
        name: The host and port.
        reader: Its incoming bytes.
        writer: Sends bytes.
    """

    def __init__(
        self, name: str, reader: asyncio.StreamReader, writer: asyncio.StreamWriter
    ) -> None:
        self.name = name
        self.reader = reader
        self.writer = writer

    @classmethod
    async def open(cls, host: str, port: int) -> Self:
        """Connect.

        Raises:
            OSError: It cannot be reached; the text says why.
        """
        name = f"{host}:{port}"
        try:
            async with asyncio.timeout(CONNECT_SEC):
                reader, writer = await asyncio.open_connection(host, port, limit=CHUNK)
        except TimeoutError:
            raise OSError(f"{name} does not answer; check ip_address and the network") from None
        except ValueError:  # it cannot be encoded as a name, or has a null character
            raise OSError(
                f"{host!r} is neither an address nor a host name; check ip_address"
            ) from None
        except OSError as error:
            # asyncio's text is the address; the numbers of getaddrinfo are negative.
            number = error.errno or 0
            text = os.strerror(number) if number > 0 else error.strerror or str(error)
            raise OSError(f"{name} cannot be reached: {text}") from None
        return cls(name, reader, writer)

    async def read(self) -> bytes:
        """Wait for bytes, and return those that have arrived.

        Raises:
            OSError: The connection is gone.
        """
        data = await self.reader.read(CHUNK)
        if not data:
            raise OSError(errno.ECONNRESET, f"{self.name} has closed the connection")
        return data

    def write(self, data: bytes) -> None:
        """Send bytes."""
        self.writer.write(data)

    def close(self) -> None:
        """Close the connection, after what was written."""
        self.writer.close()


class Limits(NamedTuple):
    """What a lidar can measure.

    Attributes:
        dmin: The least distance, in millimetres.
        dmax: The greatest distance.
        ares: Steps of a whole turn.
        amin: The first step that is measured.
        amax: The last one.
        afrt: The step at the front.
        scan: Revolutions per minute.
    """

    dmin: int
    dmax: int
    ares: int
    amin: int
    amax: int
    afrt: int
    scan: int

    @property
    def period_sec(self) -> float:
        """The time of a revolution."""
        return 60.0 / self.scan

    def angle(self, step: int) -> float:
        """Return the angle of a step, in radians; 0 is at the front."""
        return math.tau * (step - self.afrt) / self.ares

    def step(self, angle: float) -> int:
        """Return the step nearest to an angle."""
        step = math.floor(self.ares * angle / math.tau + 0.5) + self.afrt
        return min(max(step, 0), self.amax)

    @property
    def is_possible(self) -> bool:
        """Whether a lidar can have these limits."""
        return (
            0 <= self.dmin < self.dmax < 10**6
            and 0 <= self.amin <= self.afrt <= self.amax < MAX_STEPS
            and self.amin < self.amax < self.ares < 10**5
            and 0 < self.scan < 10**5
        )


class Reply(NamedTuple):
    """A reply.

    Attributes:
        echo: The command that it answers.
        status: The outcome; "00" means success, and "99" precedes a scan.
        lines: The lines that follow, with their checksums.
    """

    echo: str
    status: str
    lines: list[bytes]

    def check(self, *, is_text: bool = False) -> None:
        """Compare the checksums of the lines with their characters.

        Args:
            is_text: Whether the character before a checksum may be left out of it.

        Raises:
            OSError: One is wrong.
        """
        for line in self.lines:
            total, last = sum(line[:-1]), line[-1:]
            right = {checksum(total), checksum(total - sum(line[-2:-1]) * is_text)}
            if last not in right:
                raise OSError(errno.EBADMSG, f"checksum error in the answer to {quoted(self.echo)}")

    def data(self) -> bytes:
        """Return what the lines contain, without their checksums."""
        return b"".join(line[:-1] for line in self.lines)

    def text(self, name: str, pattern: str = r"[^;\n]*") -> str:
        """Return the text after the name of a value, as far as it matches a pattern."""
        found = re.search(rf"^{name}:({pattern})", "\n".join(map(latin, self.lines)), re.MULTILINE)
        return quoted(found[1]) if found else "receive error."


def checksum(total: int) -> bytes:
    """Return the checksum character for the sum of other characters."""
    return bytes(((total & 0x3F) + ZERO,))


def latin(data: bytes) -> str:
    """Return bytes as text: each byte is a character."""
    return data.decode("latin-1")


def quoted(text: str) -> str:
    """Return the start of a lidar's text for people to read, with control characters escaped."""
    return escaped(text[:64], one_line=True)


class Scip:
    """A conversation with a lidar.

    Args:
        link: The connection to it.
    """

    def __init__(self, link: Link) -> None:
        self.link = link
        self.buffer = bytearray()

    def send(self, command: str) -> None:
        """Send a command.

        Raises:
            OSError: The connection is gone.
        """
        self.link.write(f"{command}\n".encode())

    async def receive(self) -> Reply:
        """Wait for the next reply, and return it.

        Raises:
            OSError: The connection is gone, or the device does not speak SCIP 2.0.
        """
        done = 0
        while (end := self.buffer.find(END, max(done - 1, 0))) < 0:
            done = len(self.buffer)
            if done > MAX_BYTES:
                raise OSError("invalid response: it does not end; is this a lidar with SCIP 2.0?")
            self.buffer += await self.link.read()
        # Lines beyond the limit stay joined to the last one, whose checksum is wrong then.
        lines = bytes(self.buffer[:end]).strip(b"\n").split(b"\n", MAX_LINES)
        del self.buffer[: end + len(END)]
        echo, status, *rest = [*lines, b""] if len(lines) < 2 else lines
        return Reply(latin(echo), latin(status[:2]), [line for line in rest if line])

    async def command(self, command: str, *statuses: str) -> Reply:
        """Send a command, and return the reply to it; others that come before are skipped.

        Args:
            command: The command.
            statuses: The statuses that also mean success, besides "00"; "*" stands for all.

        Raises:
            OSError: No such reply came, it has another status or a wrong checksum.
        """
        self.send(command)
        try:
            async with asyncio.timeout(ANSWER_SEC):
                while (reply := await self.receive()).echo != command:
                    pass
        except TimeoutError:
            raise OSError(errno.ETIMEDOUT, f"no response to {quoted(command)}") from None
        reply.check(is_text=True)
        if reply.status not in {"00", *statuses} and "*" not in statuses:
            raise OSError(
                errno.EPROTO, f"{quoted(command)} was answered by status {quoted(reply.status)}"
            )
        return reply

    async def begin(self) -> None:
        """Stop what the lidar does, and have it use SCIP 2.0.

        Raises:
            OSError: It does not answer.
        """
        reply = await self.command("QT", "*")
        if reply.status == "0E":  # it tells the time
            await self.command("TM2")
        elif reply.status != "00":
            await self.command("SCIP2.0", "*")
            await self.command("QT")

    async def limits(self) -> Limits:
        """Return what it can measure.

        Raises:
            OSError: It does not answer, or answers with impossible numbers.
        """
        reply = await self.command("PP")
        texts = [reply.text(name, r"-?\d{1,9}(?!\d)") for name in NUMBERS]
        if all(re.fullmatch(r"-?\d+", text) for text in texts):
            limits = Limits(*map(int, texts))
            if limits.is_possible:
                return limits
        given = ", ".join(f"{name} {text}" for name, text in zip(NUMBERS, texts, strict=True))
        raise OSError(errno.EPROTO, f"the lidar has impossible parameters: {given}")

    async def time_ms(self) -> int:
        """Return the time of the lidar, in milliseconds, in the mode that TM0 begins.

        Raises:
            OSError: It does not answer.
        """
        return time_of(await self.command("TM1"))

    async def close(self) -> None:
        """Stop the lidar, and close the connection; what is still on its way would reset it."""
        try:
            async with asyncio.timeout(CLOSE_SEC):
                await self.command("QT", "*")
        except OSError:  # it is gone
            pass
        finally:
            self.link.close()


def time_of(reply: Reply) -> int:
    """Return the time in a reply, in milliseconds.

    Raises:
        OSError: There is none.
    """
    data = reply.lines[0][:-1] if reply.lines else b""
    if len(data) != 4:
        raise OSError(errno.EBADMSG, f"{quoted(reply.echo)} was not answered by a time")
    return int(numbers(np.frombuffer(data, np.uint8), 4)[0])


def numbers(characters: npt.NDArray[np.uint8], size: int) -> npt.NDArray[np.int64]:
    """Return numbers that are encoded with a fixed number of characters each."""
    digits = (characters.reshape(-1, size).astype(np.int64) - ZERO) & 0x3F
    return np.asarray(digits @ (64 ** np.arange(size - 1, -1, -1)))


def echoes_in(data: bytes, steps: int, *, has_intensities: bool) -> npt.NDArray[Any]:
    """Return the echoes of a scan.

    Args:
        data: The characters of a scan, without its time and checksums.
        steps: The most steps that it can have.
        has_intensities: Whether each distance is followed by an intensity.

    Returns:
        An array of distances, and with intensities of these, by step and echo: zeros where there
        is none.

    Raises:
        OSError: The scan is cut off, or has more steps or echoes than requested.
    """
    parts = 2 if has_intensities else 1
    characters = np.frombuffer(data, np.uint8)
    is_more = characters == MORE
    characters = characters[~is_more]
    before = np.flatnonzero(is_more) - np.arange(np.count_nonzero(is_more))
    values, rest = divmod(len(characters), 3 * parts)
    is_echo = np.zeros(values + 1, bool)
    is_echo[np.minimum(before // (3 * parts), values)] = True
    if not values or rest or np.any(before % (3 * parts)) or is_echo[0] or is_echo[values]:
        raise OSError(errno.EBADMSG, "receive error: a scan is incomplete")
    step = np.cumsum(~is_echo[:values]) - 1
    echo = np.arange(values) - np.flatnonzero(~is_echo[:values])[step]
    if step[-1] >= steps or echo.max() >= MAX_ECHOES:
        raise OSError(errno.EBADMSG, "receive error: a scan has more points than asked for")
    found = np.zeros((parts, step[-1] + 1, MAX_ECHOES), np.int64)
    found[:, step, echo] = numbers(characters, 3).reshape(values, parts).T
    return found

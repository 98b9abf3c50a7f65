"""Communication with a YDLIDAR: its identity, its settings and its scans."""

from __future__ import annotations

import asyncio
import math
import re
import struct
from contextlib import suppress
from typing import Final

from aionode import Clock
from aionode.logging import RcutilsLogger
from aionode.programs._serial import SerialPort
from aionode.programs._ydlidar.packets import Kind

__all__ = ["TRIANGLE", "TYPES", "Lidar"]

TOF: Final = 0
TRIANGLE: Final = 1
SCL: Final = 4
TYPES: Final = (TOF, TRIANGLE, SCL)
"""The values of `lidar_type` with this protocol."""

ASK: Final = 0xA5
ANSWER: Final = b"\xa5\x5a"
MAX_BYTES: Final = 4096
"""How many bytes are kept while an answer is awaited."""

FORCE_STOP, STOP, SCAN = 0x00, 0x65, 0x60
GET_INFO, GET_HEALTH, GET_OFFSET = 0x90, 0x92, 0x93
SET_RATE, GET_RATE = 0xD0, 0xD1
GET_SPEED, FASTER, SLOWER, SLIGHTLY_FASTER, SLIGHTLY_SLOWER = 0x0D, 0x0B, 0x0C, 0x09, 0x0A

IS_VALUE, IS_HEALTH, IS_SCAN = 0x04, 0x06, 0x81
"""The types of answers."""

INFO_SIZE: Final = 20
SCAN_SIZE: Final = 5
"""The size in the answer to the command to scan, which is followed by packets."""

BROKEN: Final = 2
PAUSE_SEC: Final = 0.03
FASTEST_HZ: Final = 100.0
TG_TOO_FAST: Final = 0.4
"""How much too high the frequency reported by TG models is, in hertz."""

SOON_SEC: Final = 1.0
LATER_SEC: Final = 2.0
"""The times to wait for an answer."""

S4, G4, X4, G4PRO, F4PRO, R2 = 4, 5, 6, 7, 8, 9
S4B, S2, G6, G2A, G2B, G2C, G1, G5, G7, SCL_MODEL, R3 = 11, 12, 13, 14, 15, 16, 19, 20, 21, 22, 23
GS2, GS1, GS5 = 51, 52, 53
TG15, TG30, TG50, TEA, TSA_PRO, TMINI, T15 = 100, 101, 102, 110, 131, 140, 200
TMINIS: Final = {TSA_PRO, TMINI, 150, 151}

NAMES: Final = {
    1: "F4", 2: "T1", 3: "F2", S4: "S2PRO", G4: "G4", X4: "X4", G4PRO: "G4PRO", F4PRO: "F4PRO",
    R2: "R2", 10: "G10", S4B: "S4B", S2: "S2", G6: "G6", G2A: "G2A", G2B: "G2B", G2C: "G2C",
    17: "G4B", 18: "G4C", G1: "G1", G5: "G5", G7: "G7", SCL_MODEL: "SCL", R3: "R3", GS2: "GS2",
    GS1: "GS1", GS5: "GS5", TG15: "TG15", TG30: "TG30", TG50: "TG50", TEA: "TEA", 130: "TSA",
    TSA_PRO: "TSA Pro", TMINI: "Tmini", 150: "Tmini Pro", 151: "Tmini Plus", 152: "Tmini Plus SH",
    T15: "T15",
}  # fmt: skip

RATES: Final = {
    S4: (3, 4), G4: (9,), X4: (5,), G4PRO: (9,), R2: (5,), 10: (10,), S2: (3,), G6: (18,),
    G2A: (5,), G2B: (5,), G1: (9,), G5: (9,), G7: (18,), TG15: (20,), TG30: (10, 20), TG50: (20,),
    TEA: (30,), T15: (20,),
}  # fmt: skip
"""The sample rates of models, in thousands of points per second; 4 for others."""

WITH_RATE: Final = {G4, G5, G4PRO, F4PRO, G7, TG15, TG30, TG50, TEA}
WITH_OFFSET: Final = {R2, G2A, G2B, G2C, G1, TG15, TG30, TG50, TEA}
WITHOUT_SPEED: Final = {S4, S4B, S2, X4, GS1, GS2, GS5}


class Lidar:
    """A lidar at an open port.

    Args:
        port: The port.
        lidar_type: One of `TYPES`.
        logger: Says what the lidar is and does.
        clock: Waits for the lidar.
        has_answers: Whether it answers commands; some only send.
        runs_with_dtr: Whether the line DTR has to be on while the motor turns, or off.
        shows_bytes: Whether what is sent and answered is logged.

    Attributes:
        model: The code of its model; 0 while that is not known.
        firmware: Its version, as major and minor number.
        rates: The possible sample rates, in thousands of points per second.
        frequency: Revolutions per second.
        offset: The angle of its zero, in radians.
    """

    def __init__(
        self,
        port: SerialPort,
        lidar_type: int,
        logger: RcutilsLogger,
        clock: Clock,
        *,
        has_answers: bool = True,
        runs_with_dtr: bool = False,
        shows_bytes: bool = False,
    ) -> None:
        self.port = port
        self.lidar_type = lidar_type
        self.logger = logger
        self.clock = clock
        self.has_answers = has_answers
        self.runs_with_dtr = runs_with_dtr
        self.shows_bytes = shows_bytes
        self.model = 0
        self.firmware = (0, 0)
        self.rates: tuple[int, ...] = ()
        self.frequency = 0.0
        self.offset = 0.0

    # Commands

    def send(self, command: int) -> None:
        """Send a command.

        Raises:
            OSError: The port is gone.
        """
        if self.shows_bytes:
            self.logger.info(f"[send] a5{command:02x}")
        self.port.write(bytes((ASK, command)))

    async def ask(
        self, command: int, kind: int, size: int, timeout_sec: float = LATER_SEC
    ) -> bytes:
        """Send a command, and return what the answer holds, and what came after it.

        Raises:
            TimeoutError: No such answer came.
            OSError: The port is gone.
        """
        start, end = ANSWER + struct.pack("<I", size)[:3], bytes((kind,))
        head = re.compile(re.escape(start) + b"." + re.escape(end), re.DOTALL)
        data = b""
        self.send(command)
        async with asyncio.timeout(timeout_sec):
            while True:
                data = (data + await self.port.read())[-MAX_BYTES:]
                found = head.search(data)
                if found and (kind == IS_SCAN or len(data) >= found.end() + size):
                    if self.shows_bytes:
                        self.logger.info(f"[recv] {data[found.start() : found.end() + size].hex()}")
                    return data[found.end() :]

    async def value(self, command: int, form: str) -> int:
        """Return the number that answers a command.

        Raises:
            TimeoutError: No answer came.
            OSError: The port is gone.
        """
        answer = await self.ask(command, IS_VALUE, struct.calcsize(form))
        found: int = struct.unpack_from(form, answer)[0]
        return found

    # Before the scans

    async def prepare(self, frequency: float, rate: int) -> None:
        """Stop it, find out what it is, and set how fast it turns and measures.

        Args:
            frequency: The wanted revolutions per second.
            rate: The wanted thousands of points per second.

        Raises:
            OSError: It does not answer, or the port is gone.
        """
        self.frequency = frequency
        self.stop()
        if not self.has_answers:
            return
        await self.check_health()
        try:
            await self.identify()
        except TimeoutError:
            raise OSError(
                f"{self.port.path} does not answer; check that a lidar is there, its baudrate, and "
                "isSingleChannel, which is for lidars without answers"
            ) from None
        try:
            await self.set_rate(rate)
            await self.set_frequency(frequency)
            await self.read_offset()
        except TimeoutError:
            self.logger.warning("The lidar does not answer all commands; it is used as it is")

    async def check_health(self) -> None:
        """Log the lidar's health status.

        Raises:
            OSError: The port is gone.
        """
        try:
            answer = await self.ask(GET_HEALTH, IS_HEALTH, 3, SOON_SEC)
        except TimeoutError:
            self.logger.warning("Error, cannot retrieve Lidar health code")
            return
        status, code = struct.unpack_from("<BH", answer)
        text = "bad" if status else "good"
        self.logger.info(f"Lidar running correctly! The health status {text}")
        if status == BROKEN:
            self.logger.error(
                f"Error, Lidar internal error[0x{code:X}] detected. Please reboot the device to "
                "retry."
            )

    async def identify(self) -> None:
        """Find out its model.

        Raises:
            TimeoutError: It does not answer.
            OSError: The port is gone.
        """
        answer = await self.ask(GET_INFO, IS_VALUE, INFO_SIZE, SOON_SEC)
        self.model, minor, major, hardware = answer[:4]
        self.firmware = (major, minor)
        serial = "".join(str(digit) for digit in answer[4:INFO_SIZE])
        name = NAMES.get(self.model, f"unknown ({self.model})")
        self.logger.info(
            f"Model: {name}, firmware version: {major}.{minor}, hardware version: {hardware}, "
            f"serial: {serial}"
        )
        if TG15 <= self.model <= TG50 and self.lidar_type != TOF:
            self.logger.error(f"lidar_type is {self.lidar_type}, but a {name} is of type {TOF}")
            self.lidar_type = TOF
        self.rates = RATES.get(self.model, (4,))

    async def set_rate(self, wanted: int) -> None:
        """Set its sample rate, if there is a choice.

        Raises:
            TimeoutError: It does not answer.
            OSError: The port is gone.
        """
        if self.model not in WITH_RATE:
            return
        rates = {0: 10, 1: 16, 2: 18, 3: 20, 4: 10}
        if self.model == F4PRO:
            rates = {0: 4, 1: 6}
        elif self.model != G7 and not TG15 <= self.model <= TG50:
            rates = {0: 4, 1: 8, 2: 9, 3: 10}
        code = await self.value(GET_RATE, "<B")
        if not TG15 <= self.model <= TG50 and wanted in rates.values():
            for _ in rates:  # each command selects the next rate
                if rates.get(code) == wanted:
                    break
                code = await self.value(SET_RATE, "<B")
        self.rates = (rates.get(code, max(code, 1)),)
        self.logger.info(f"Current sample rate: {self.rates[0]}K")

    async def set_frequency(self, wanted: float) -> None:
        """Set how fast it turns, if it can be set.

        Raises:
            TimeoutError: It does not answer.
            OSError: The port is gone.
        """
        if self.model in WITHOUT_SPEED and self.lidar_type != TOF:
            return
        highest = 50.0 if self.model >= T15 else 30.0 if self.model == TEA else 18.0
        lowest, highest = (5.0, 16.0) if self.model < TG15 else (1.0, highest)
        now = await self.read_frequency()
        if not lowest <= wanted <= highest:
            self.logger.error(
                f"Current scan frequency[{wanted:g}] is out of range; use {lowest:g} to {highest:g}"
            )
        elif abs(wanted - now) <= highest:
            whole, tenths = divmod(abs(round((wanted - now) * 10)), 10)
            coarse, fine = (FASTER, SLIGHTLY_FASTER) if wanted > now else (SLOWER, SLIGHTLY_SLOWER)
            for command in [coarse] * whole + [fine] * tenths:
                await self.value(command, "<I")
            now = await self.read_frequency()
        if 0.0 < now <= FASTEST_HZ:
            self.frequency = now
        self.logger.info(f"Current scan frequency: {self.frequency:.2f}Hz")

    async def read_frequency(self) -> float:
        """Return how fast it turns.

        Raises:
            TimeoutError: It does not answer.
            OSError: The port is gone.
        """
        found = await self.value(GET_SPEED, "<I") / 100
        return found - TG_TOO_FAST if TG15 <= self.model <= TG50 else found

    async def read_offset(self) -> None:
        """Find out where its zero is.

        Raises:
            TimeoutError: It does not answer.
            OSError: The port is gone.
        """
        if self.model not in WITH_OFFSET:
            return
        parts = 100.0 if self.model == R2 and self.firmware > (1, 7) else 4.0
        degrees = await self.value(GET_OFFSET, "<i") / parts
        if abs(degrees) <= 360.0:
            self.offset = math.radians(degrees)

    # Scans

    def kind(self) -> Kind:
        """Return how it measures distances."""
        if self.model in {G6, G7}:
            return Kind(2000.0, 21.8, 155.3)
        if self.model == R3:
            return Kind(40000.0)
        if self.lidar_type == TOF:
            is_old = TG15 <= self.model <= TG50 and self.firmware[0] <= 1 and self.firmware[1] <= 2
            return Kind(2000.0 if is_old else 1000.0)
        if self.lidar_type == SCL or self.model == SCL_MODEL:
            return Kind(4000.0, 17.8)
        return Kind(4000.0) if self.model in TMINIS else Kind(4000.0, 21.8, 155.3)

    async def start(self) -> bytes:
        """Start the scans and the motor; return the first bytes of the scans.

        Raises:
            OSError: It does not answer, or the port is gone.
        """
        self.stop()
        await self.clock.sleep(PAUSE_SEC)
        data = b""
        try:
            if self.has_answers:
                data = await self.ask(SCAN, IS_SCAN, SCAN_SIZE)
            else:
                self.send(SCAN)
        except TimeoutError:
            raise OSError(f"Failed to start the lidar at {self.port.path}: no answer") from None
        self.port.set_dtr(is_on=self.runs_with_dtr)
        return data

    def stop(self) -> None:
        """Stop the scans and the motor, if the port is still there."""
        with suppress(OSError):
            self.send(FORCE_STOP)
            self.send(STOP)
        self.port.set_dtr(is_on=not self.runs_with_dtr)

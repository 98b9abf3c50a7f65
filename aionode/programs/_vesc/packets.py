"""The serial protocol of the VESC: frames with a checksum, and what is in them."""

from __future__ import annotations

import math
import struct
from binascii import crc_hqx
from typing import Final, NamedTuple

from aionode.interfaces.geometry_msgs.msg import Quaternion, Vector3
from aionode.interfaces.vesc_msgs.msg import VescImu, VescState

__all__ = [
    "GET_FIRMWARE",
    "GET_IMU",
    "GET_VALUES",
    "RELEASE",
    "Firmware",
    "Frames",
    "command",
    "firmware_of",
    "framed",
    "imu_of",
    "state_of",
]

GET_FIRMWARE: Final = b"\x00"
GET_VALUES: Final = b"\x04"
GET_IMU: Final = b"\x41\xff\xff"
"""Asks for all values of the IMU."""

RELEASE: Final = b"\x06\x00\x00\x00\x00"
"""Commands a current of 0: the motor is not driven."""

COMMANDS: Final = {
    "duty_cycle": (5, 1e5),
    "current": (6, 1e3),
    "brake": (7, 1e3),
    "speed": (8, 1.0),
    "position": (9, 1e6 * 180.0 / math.pi),  # radians become degrees
}
"""The number and the factor of each command for the motor."""

SET_SERVO: Final = 12
LARGEST: Final = 2**31 - 1

BEGIN, END = 2, 3
"""How a frame begins and ends.

Those of more than 255 bytes begin differently; they answer requests that are not sent here.
"""

VALUES: Final = struct.Struct(">hhiiiihihiiiiiiBiBhhhii")
VALUE_FIELDS: Final = {
    "temp_fet": 10, "temp_motor": 10, "current_motor": 100, "current_input": 100, "avg_id": 100,
    "avg_iq": 100, "duty_cycle": 1000, "speed": 1, "voltage_input": 10, "charge_drawn": 10_000,
    "charge_regen": 10_000, "energy_drawn": 10_000, "energy_regen": 10_000, "displacement": None,
    "distance_traveled": None, "fault_code": None, "pid_pos_now": 1_000_000, "controller_id": None,
    "ntc_temp_mos1": 10, "ntc_temp_mos2": 10, "ntc_temp_mos3": 10, "avg_vd": 1000, "avg_vq": 1000,
}  # fmt: skip
"""The values in their order, each with its divisor; None for integers."""

UUID_BYTES: Final = 12


class Firmware(NamedTuple):
    """What a VESC reports about itself."""

    major: int
    minor: int
    hardware: str
    is_paired: bool


def framed(payload: bytes) -> bytes:
    """Return a payload of less than 256 bytes in a frame."""
    checksum = crc_hqx(payload, 0).to_bytes(2, "big")
    return bytes((BEGIN, len(payload))) + payload + checksum + bytes((END,))


def command(name: str, value: float) -> bytes:
    """Return the payload of a command; values that it cannot hold are clamped.

    Args:
        name: A name in `COMMANDS`, or ``servo``.
        value: A finite number.
    """
    if name == "servo":
        return struct.pack(">Bh", SET_SERVO, int(value * 1e3))
    number, factor = COMMANDS[name]
    return struct.pack(">Bi", number, int(min(max(value * factor, -LARGEST), LARGEST)))


class Frames:
    """Finds the frames in what a VESC sends.

    Attributes:
        skipped: How many bytes were in no frame.
        waiting: Bytes that may be the beginning of a frame.
    """

    def __init__(self) -> None:
        self.skipped = 0
        self.waiting = b""

    def feed(self, data: bytes) -> list[bytes]:
        """Add received bytes, and return the payloads of the frames that are now complete."""
        data = self.waiting + data
        payloads: list[bytes] = []
        at = 0
        while at < len(data):
            used, payload = frame_at(data, at)
            if not used:
                break
            if payload is None:
                self.skipped += used
            else:
                payloads.append(payload)
            at += used
        self.waiting = data[at:]
        return payloads


def frame_at(data: bytes, at: int) -> tuple[int, bytes | None]:
    """Return how many bytes are used from a position on, and the payload if they are a frame.

    0 while more bytes are needed. Where no frame begins, the search goes on with the next byte.
    """
    if data[at] != BEGIN or data[at + 1 : at + 2] == b"\0":
        return 1, None
    start = at + 2
    if len(data) < start:
        return 0, None
    stop = start + data[at + 1]
    if len(data) < stop + 3:
        return 0, None
    payload = data[start:stop]
    if data[stop + 2] != END or crc_hqx(payload, 0) != int.from_bytes(data[stop : stop + 2], "big"):
        return 1, None
    return stop + 3 - at, payload


def firmware_of(payload: bytes) -> Firmware | None:
    """Return the content of the answer to `GET_FIRMWARE`; None if it is too short."""
    if len(payload) < 3:
        return None
    hardware, _, rest = payload[3:].partition(b"\0")
    return Firmware(
        payload[1], payload[2], hardware.decode("ascii", "replace"), any(rest[UUID_BYTES:][:1])
    )


def state_of(payload: bytes) -> VescState | None:
    """Return the content of the answer to `GET_VALUES`; None if it is too short."""
    if len(payload) <= VALUES.size:
        return None
    values = VALUES.unpack_from(payload, 1)
    return VescState(
        **{
            name: value if divisor is None else value / divisor
            for (name, divisor), value in zip(VALUE_FIELDS.items(), values, strict=True)
        }
    )


def imu_of(payload: bytes) -> VescImu | None:
    """Return the content of the answer to `GET_IMU`; None if it is too short or not finite.

    A mask says which values are present; the others are 0.
    """
    mask = int.from_bytes(payload[1:3], "big")
    count = mask.bit_count()
    if len(payload) < 3 + 4 * count:
        return None
    given = iter(struct.unpack_from(f">{count}f", payload, 3))
    values = [next(given) if mask >> bit & 1 else 0.0 for bit in range(16)]
    if not all(map(math.isfinite, values)):
        return None
    roll, pitch, yaw = map(math.degrees, values[:3])
    return VescImu(
        ypr=Vector3(x=roll, y=pitch, z=yaw),
        linear_acceleration=Vector3(*values[3:6]),
        angular_velocity=Vector3(*values[6:9]),
        compass=Vector3(*values[9:12]),
        orientation=Quaternion(w=values[12], x=values[13], y=values[14], z=values[15]),
    )

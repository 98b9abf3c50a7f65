"""The frames of the VESC, whole and damaged."""

from __future__ import annotations

import math
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.programs._vesc.packets import (
    GET_FIRMWARE,
    GET_VALUES,
    RELEASE,
    Firmware,
    Frames,
    command,
    firmware_of,
    framed,
    imu_of,
    state_of,
)

PAYLOADS = st.lists(st.binary(min_size=1, max_size=255), max_size=6)


@pytest.mark.parametrize(
    ("payload", "frame"),
    [(GET_VALUES, "02 01 04 40 84 03"), (GET_FIRMWARE, "02 01 00 00 00 03")],
)
def test_frames_are_those_of_the_vesc(payload: bytes, frame: str) -> None:
    """As others have recorded them."""
    assert framed(payload) == bytes.fromhex(frame)


@pytest.mark.parametrize(
    ("name", "value", "payload"),
    [
        ("duty_cycle", 0.25, "05 00 00 61 a8"),
        ("current", -1.5, "06 ff ff fa 24"),
        ("brake", 2.0, "07 00 00 07 d0"),
        ("speed", 4614.9, "08 00 00 12 06"),
        ("position", math.pi / 2, "09 05 5d 4a 80"),
        ("servo", 0.5304, "0c 02 12"),
        ("brake", 1e9, "07 7f ff ff ff"),
        ("speed", -1e300, "08 80 00 00 01"),
    ],
)
def test_commands_have_the_units_of_the_vesc(name: str, value: float, payload: str) -> None:
    """Fractions are cut off as in the original; what is beyond the numbers is the largest one."""
    assert command(name, value) == bytes.fromhex(payload)


def test_a_motor_is_released_by_a_current_of_zero() -> None:
    """So it is neither driven nor braked."""
    assert command("current", 0.0) == RELEASE


@given(PAYLOADS, st.integers(1, 300))
def test_what_is_framed_is_found_in_whatever_pieces_it_arrives(
    payloads: list[bytes], size: int
) -> None:
    """A serial port has no borders."""
    whole = b"".join(map(framed, payloads))
    frames = Frames()
    pieces = [whole[at : at + size] for at in range(0, len(whole), size)]

    assert [found for piece in pieces for found in frames.feed(piece)] == payloads
    assert (frames.skipped, frames.waiting) == (0, b"")


@given(st.binary(max_size=300), st.integers(0, 1000), st.integers(1, 255))
def test_after_damage_the_next_frames_are_found(noise: bytes, at: int, flip: int) -> None:
    """At the latest when as much has arrived as the longest frame has, 260 bytes."""
    damaged = bytearray(framed(b"\x04" + bytes(range(72))))
    damaged[at % len(damaged)] ^= flip
    frames = Frames()
    frames.feed(noise + bytes(damaged))

    found = frames.feed(framed(GET_VALUES) * 100)
    assert found[-50:] == [GET_VALUES] * 50


@given(st.lists(st.binary(max_size=5000), max_size=5))
def test_noise_is_not_kept(chunks: list[bytes]) -> None:
    """No more than one frame waits for its rest."""
    frames = Frames()
    for chunk in chunks:
        frames.feed(chunk)
        assert len(frames.waiting) < 260


def test_a_wrong_checksum_is_counted() -> None:
    """Nothing of the frame is used."""
    frames = Frames()
    frame = bytearray(framed(GET_VALUES))
    frame[-2] ^= 1

    assert frames.feed(bytes(frame) + framed(RELEASE)) == [RELEASE]
    assert frames.skipped == len(frame)


@given(st.binary(max_size=120))
def test_whatever_a_frame_has_is_no_error(payload: bytes) -> None:
    """Other firmware sends other answers."""
    firmware_of(payload)
    state_of(payload)
    imu_of(payload)


def test_values_are_in_their_units() -> None:
    """Amperes, volts, electrical RPM, hours."""
    numbers = (312, 254, 1234, 567, -12, 345, -250, -9228, 116, 12_345, 678, 9012, 34, -77, 99, 2)
    payload = struct.pack(">BhhiiiihihiiiiiiB", 4, *numbers)
    payload += struct.pack(">iBhhhii", 1_500_000, 7, 301, 302, 303, -1500, 2500)
    state = state_of(payload)

    assert state is not None
    assert (state.temp_fet, state.temp_motor) == (31.2, 25.4)
    assert (state.current_motor, state.current_input) == (12.34, 5.67)
    assert (state.avg_id, state.avg_iq, state.duty_cycle) == (-0.12, 3.45, -0.25)
    assert (state.speed, state.voltage_input) == (-9228.0, 11.6)
    assert (state.charge_drawn, state.charge_regen) == (1.2345, 0.0678)
    assert (state.energy_drawn, state.energy_regen) == (0.9012, 0.0034)
    assert (state.displacement, state.distance_traveled, state.fault_code) == (-77, 99, 2)
    assert (state.pid_pos_now, state.controller_id) == (1.5, 7)
    assert (state.ntc_temp_mos1, state.ntc_temp_mos3) == (30.1, 30.3)
    assert (state.avg_vd, state.avg_vq) == (-1.5, 2.5)


def test_an_imu_says_what_its_mask_names() -> None:
    """The others are 0; angles are in degrees, as the original gives them."""
    payload = struct.pack(">BH4f", 65, 0b0001_0000_0010_0101, math.pi, -math.pi / 2, 1.0, 0.5)
    imu = imu_of(payload)

    assert imu is not None
    assert (imu.ypr.x, imu.ypr.y, imu.ypr.z) == pytest.approx((180.0, 0.0, -90.0))
    assert (imu.linear_acceleration.x, imu.linear_acceleration.z) == (0.0, 1.0)
    assert imu.orientation.w == 0.5


def test_an_imu_that_measures_no_numbers_is_ignored() -> None:
    """Filters would never recover."""
    assert imu_of(struct.pack(">BHf", 65, 1, math.nan)) is None


def test_firmware_says_its_version_and_hardware() -> None:
    """That of old versions has only a version."""
    whole = b"\x00\x05\x02HW60\x00" + bytes(12) + b"\x01"

    assert firmware_of(whole) == Firmware(5, 2, "HW60", is_paired=True)
    assert firmware_of(b"\x00\x03\x28") == Firmware(3, 40, "", is_paired=False)

"""Rows belong together, whenever their messages were captured and whenever they arrived."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, event, given, settings
from hypothesis import strategies as st

from aionode import image
from aionode.errors import DatasetError
from aionode.interfaces.sensor_msgs.msg import JointState
from aionode.interfaces.std_msgs.msg import Float64MultiArray
from aionode.learn import Contract, export
from aionode.learn._alignment import aligned
from aionode.learn._report import lag_of, topic_of
from aionode.learn._series import Series, in_order
from tests.support.demonstrations import (
    HEIGHT,
    SPEED,
    START_NS,
    Messages,
    angle,
    contract,
    stamp,
    write_bag,
)
from tests.support.lerobot_reader import Reader

ROUNDING_SEC = 2e-6
"""A message that is later by less counts as of the same time."""

LENGTH_SEC = 1.6


@dataclass(frozen=True)
class Course:
    """How the messages of a topic are captured, and how they arrive.

    Attributes:
        rate_hz: How many a second.
        phase_sec: The time of the first one.
        jitter: How far each is from its time at most, in periods.
        late_sec: How long each takes at least.
        wait_sec: How much longer it may take: they overtake each other.
        burst_sec: The steps in which they arrive, many at a time; 0 for none.
        lost: The share that never arrives.
        outage: When none is captured, from and until.
        seed: The seed of all that is random.
    """

    rate_hz: float
    phase_sec: float
    jitter: float
    late_sec: float
    wait_sec: float
    burst_sec: float
    lost: float
    outage: tuple[float, float]
    seed: int

    def moments(self, length_sec: float) -> tuple[Any, Any]:
        """Return when messages are captured and when they arrive, in the order of arrival."""
        random = np.random.default_rng(self.seed)
        count = max(int((length_sec - self.phase_sec) * self.rate_hz), 1)
        captured = self.phase_sec + np.arange(count) / self.rate_hz
        captured += random.uniform(-1, 1, count) * self.jitter / self.rate_hz
        first, last = self.outage
        is_out = (first <= captured) & (captured < last)
        captured = captured[(random.uniform(size=count) >= self.lost) & ~is_out & (captured >= 0)]
        arrived = captured + self.late_sec + random.uniform(size=len(captured)) * self.wait_sec
        if self.burst_sec:
            arrived = np.ceil(arrived / self.burst_sec) * self.burst_sec
            arrived += np.arange(len(arrived)) * 1e-6
        order = np.argsort(arrived, kind="stable")
        return captured[order], arrived[order]


spans = st.tuples(st.floats(0, 2), st.floats(0, 0.7)).map(lambda each: (each[0], sum(each)))

courses = st.builds(
    Course,
    rate_hz=st.floats(1, 120),
    phase_sec=st.floats(0, 0.1),
    jitter=st.sampled_from([0.0, 0.1, 0.5, 1.0, 2.5]),
    late_sec=st.floats(0, 0.1),
    wait_sec=st.sampled_from([0.0, 0.002, 0.05]),
    burst_sec=st.sampled_from([0.0, 0.0, 0.03, 0.4]),
    lost=st.sampled_from([0.0, 0.1, 0.6]),
    outage=spans,
    seed=st.integers(0, 1000),
)


def series(course: Course, *, is_captured: bool) -> Series:
    """Return the messages of a topic that shows the angle of a joint when they were captured."""
    captured, arrived = course.moments(3)
    angles = np.vectorize(angle, otypes=[float])(captured)[:, None]
    times = captured if is_captured else arrived
    arrivals, stamps = (
        np.round(each * 1e9).astype(np.int64) + START_NS for each in (arrived, times)
    )
    return in_order(Series(stamps, arrivals, angles, np.arange(len(times)), is_captured))


def made_for(
    *, fps: int = 30, hold: bool = False, receive: bool = False, width: int = 128
) -> Contract:
    """Return a contract of two cameras that looks back for 0.2 s."""
    given = contract(2, fps=fps).to_dict()["observations"]
    for each in given:
        each |= {"max_age": 0.2, "stamp": "receive" if receive else "capture"}
    for each in given[:2]:
        each["width"] = width
    given[2] |= {"resample": "hold" if hold else "interpolate", "fields": ["position.joint"]}
    given[2]["names"] = ["joint"]
    return contract(2, fps=fps, observations=given)


def latest_sec(*given: Course) -> float:
    """Return how late a message arrives at most."""
    return max(
        float((arrived - captured).max(initial=0))
        for captured, arrived in (each.moments(3) for each in given)
    )


@pytest.mark.slow
@settings(max_examples=300, suppress_health_check=[HealthCheck.too_slow])
@given(
    camera=courses,
    other=courses,
    joint=courses,
    fps=st.sampled_from([1, 10, 30, 60, 120]),
    hold=st.booleans(),
    receive=st.booleans(),
)
def test_what_a_picture_and_a_joint_show_agrees_within_the_age_that_is_told(
    camera: Course, other: Course, joint: Course, fps: int, hold: bool, receive: bool
) -> None:
    """For any phase, rate, jitter, loss, burst and way; by arrival, as far as that is late."""
    made = made_for(fps=fps, hold=hold, receive=receive)
    given = [series(each, is_captured=not receive) for each in (camera, other, joint)]
    late = latest_sec(camera, other, joint) if receive else 0.0
    times = np.arange(0, 4, 1 / 60)
    command_times = np.round(times * 1e9).astype(np.int64) + START_NS
    commands = Series(command_times, command_times, times[:, None], np.arange(len(times)))
    rows = aligned(made, [*given, commands])
    event(f"{min(len(rows.times), 10)} rows")
    shown = given[0].values[rows.chosen[0], 0]
    bounds = [SPEED * (ages + late + ROUNDING_SEC) for ages in rows.ages]
    if receive and not hold:  # a motion that jumps, as arrivals make it, is smoothed
        bounds[2] += SPEED * rows.ages[2]
    assert (np.abs(given[1].values[rows.chosen[1], 0] - shown) <= bounds[1]).all()
    assert (np.abs(rows.values[2][:, 0] - shown) <= bounds[2]).all()
    told = [
        topic_of(made, entry, each, rows, position)["age_sec"]
        for position, (entry, each) in enumerate(zip(made.entries, [*given, commands], strict=True))
    ]
    for ages, spread in zip(rows.ages, told, strict=True):
        assert (ages >= 0).all()
        assert ages.max(initial=0) == (spread["max"] if spread else 0)
        assert ages.max(initial=0) <= 0.2 + 1e-6
    steps = np.diff(rows.times) / 1e9
    inside = np.delete(steps, [start - 1 for start in rows.starts if start])
    assert inside.max(initial=0) <= 1.5 / fps + 1e-9
    assert (steps > 0).all()


@pytest.mark.parametrize("rows", [0, 1, 4, 12])
@pytest.mark.parametrize("is_speed", [False, True])
def test_the_delay_of_an_observation_after_its_command_is_reported(
    rows: int, is_speed: bool
) -> None:
    """A robot that answers late: of the position that was commanded, or of the speed."""
    noise = np.random.default_rng(0).normal(size=400)
    commanded = np.convolve(noise, np.ones(8) / 8, "same")
    followed = np.roll(commanded, rows + 1)  # a row has the command of one period later
    if is_speed:
        followed = np.cumsum(followed) - followed[0]
        followed = np.roll(followed, 1)
    found = lag_of(commanded[50:350], followed[50:350], 30)
    assert found == pytest.approx(rows / 30, abs=0.5 / 30)


def test_no_lag_is_reported_for_what_does_not_follow() -> None:
    """A guess would be taken for a measurement."""
    first, second = np.random.default_rng(0).normal(size=(2, 300))
    assert lag_of(first, second, 30) is None
    assert lag_of(first, np.zeros(300), 30) is None


# With pictures


PIXELS_PER_SEC = 320
"""A column is 3 ms, and the step from one picture to the next at 30 Hz 10 columns."""


def clock_face(sec: float) -> Any:
    """Return a picture that is white on the left, as far as the time has come."""
    pixels = np.zeros((HEIGHT, round(LENGTH_SEC * PIXELS_PER_SEC), 3), np.uint8)
    pixels[:, : max(round(sec * PIXELS_PER_SEC), 0)] = 255
    return pixels


def recorded(camera: Course, other: Course, joint: Course) -> Messages:
    """Return the messages of a robot whose pictures and joint show the time."""
    found: Messages = [
        (START_NS + tick * 10**9 // 60, "/command", Float64MultiArray(data=[tick / 60]))
        for tick in range(120)
    ]
    for topic, course in (("/camera0", camera), ("/camera1", other), ("/joint_states", joint)):
        for captured, arrived in zip(*course.moments(LENGTH_SEC), strict=True):
            message: Any = JointState(name=["joint"], position=[float(captured)])
            if topic != "/joint_states":
                message = image.from_numpy(clock_face(float(captured)), "rgb8")
            message.header.stamp = stamp(START_NS + round(captured * 1e9))
            found.append((START_NS + round(arrived * 1e9), topic, message))
    return sorted(found, key=lambda each: each[0])


@pytest.mark.slow
@settings(
    max_examples=15,
    suppress_health_check=[HealthCheck.too_slow],
    deadline=None,
    phases=[Phase.explicit, Phase.reuse, Phase.generate],  # shrinking takes minutes
)
@given(camera=courses, other=courses, joint=courses, hold=st.booleans(), receive=st.booleans())
def test_a_marker_in_a_decoded_picture_and_the_joint_agree_within_the_age_that_is_told(
    camera: Course, other: Course, joint: Course, hold: bool, receive: bool
) -> None:
    """All the way: drawn, recorded, encoded, written, and read as a reader does."""
    made = made_for(hold=hold, receive=receive, width=round(LENGTH_SEC * PIXELS_PER_SEC))
    late = latest_sec(camera, other, joint) if receive else 0.0
    with TemporaryDirectory() as folder:
        write_bag(Path(folder, "run"), recorded(camera, other, joint))
        try:
            export(Path(folder, "out"), [Path(folder, "run")], contract=made, jobs=1)
        except DatasetError as error:
            assert "no bag has a row" in str(error)  # noqa: PT017  # not always
            return
        read = Reader(Path(folder, "out"))
        event(f"{min(len(read), 10)} rows")
        for index in range(len(read)):
            row = read[index]
            markers = [
                (row[f"observation.images.camera{number}"][HEIGHT // 2, :, 1] > 128).sum()
                / PIXELS_PER_SEC
                for number in range(2)
            ]
            smoothed = row["age"][2] if receive and not hold else 0.0
            for shown, age in (
                (markers[1], row["age"][1]),
                (float(row["observation.state"]), row["age"][2] + smoothed),
            ):
                allowed = age + late + ROUNDING_SEC + 2 / PIXELS_PER_SEC
                assert abs(shown - markers[0]) <= allowed

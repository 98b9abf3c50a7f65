"""Recordings that are not what they claim to be: each is told, and none makes a false row."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from aionode import image
from aionode.errors import DatasetError
from aionode.interfaces.sensor_msgs.msg import JointState
from aionode.interfaces.std_msgs.msg import String
from aionode.learn import Exported, check_dataset, export
from tests.support.demonstrations import (
    HEIGHT,
    START_NS,
    WIDTH,
    Messages,
    angle,
    column,
    contract,
    demonstration,
    stamp,
)
from tests.support.lerobot_reader import Reader

CAMERA = "observation.images.camera0"


def shifted(message: Any, sec: float) -> None:
    """Move the time in the header of a message."""
    now = message.header.stamp
    message.header.stamp = stamp(now.sec * 10**9 + now.nanosec + round(sec * 1e9))


def false(topic: str, change: Callable[[Any], Any], every: slice) -> Callable[[Messages], Messages]:
    """Return what changes some of the messages of a topic, in place or by another one."""

    def edit(messages: Messages) -> Messages:
        places = [place for place, each in enumerate(messages) if each[1] == topic][every]
        for place in places:
            arrival, _, message = messages[place]
            messages[place] = (arrival, topic, change(message) or message)
        return messages

    return edit


def exported(folder: Path, edit: Callable[[Messages], Messages], **options: Any) -> Exported:
    """Export a demonstration with false messages, and check that no row is false."""
    made = options.pop("contract", contract())
    options.setdefault("length_sec", 1.0)
    run = demonstration(folder / "run", edit=edit, **options)
    found = export(folder / "out", [run], contract=made, jobs=1)
    assert check_dataset(folder / "out") == []
    read = Reader(folder / "out")
    for index in range(len(read)):
        row = read[index]
        assert row["observation.state"][0] == pytest.approx(angle(seen_at(row)), abs=1e-3)
        if CAMERA in row:
            white = int((row[CAMERA][HEIGHT // 2, :, 1] > 128).sum())
            assert abs(white - column(angle(seen_at(row)))) <= 1
    return found


def seen_at(row: dict[str, Any]) -> float:
    """Return the time of a row since the start of the demonstration."""
    return float(row["stamp"] - START_NS / 1e9)


def at(**changes: Any) -> Callable[[Any], None]:
    """Return what sets fields of a message."""

    def change(message: Any) -> None:
        for name, value in changes.items():
            setattr(message, name, value)

    return change


def joints(**changes: Any) -> Callable[[Any], Any]:
    """Return what makes another message of the joints, at the same time."""
    return lambda message: JointState(header=message.header, **changes)


@dataclass(frozen=True)
class Case:
    """Messages that are false, and what the report says of them.

    Attributes:
        topic: Their topic.
        change: What is false about them.
        every: Which messages of the topic.
        told: What the report says.
    """

    topic: str
    change: Callable[[Any], Any]
    every: slice
    told: str


ONE, SOME, ALL = slice(15, 16), slice(10, 30, 8), slice(None)

CASES = {
    "a stamp of the future": Case(
        "/camera0", lambda each: shifted(each, 3600), ONE, "1 message with a time out of order"
    ),
    "a stamp of a joint from the future": Case(
        "/joint_states", lambda each: shifted(each, 1e8), SOME, "3 messages with a time out"
    ),
    "a stamp of the past": Case(
        "/camera0", lambda each: shifted(each, -1e9), SOME, "3 messages with a time out"
    ),
    "stamps that go back": Case(
        "/camera0",
        lambda each: shifted(each, -0.05),
        SOME,
        "3 messages with a time out of order, left out",
    ),
    "a stamp of zero": Case(
        "/camera0",
        lambda each: at(header=type(each.header)())(each),
        SOME,
        "3 messages without a time in the header; they are left out",
    ),
    "the first stamp is of zero": Case(
        "/joint_states",
        lambda each: at(header=type(each.header)())(each),
        slice(0, 1),
        "1 message without a time in the header; they are left out",
    ),
    "a height that is too large": Case(
        "/camera0", at(height=HEIGHT * 2), SOME, "3 messages not as in the contract: "
    ),
    "a width that is too small": Case(
        "/camera0", at(width=WIDTH // 2), SOME, "64 by 32 pixels; the contract has 128 by 32"
    ),
    "a step that is too small": Case("/camera0", at(step=3), SOME, "Image.step: 3, but 128"),
    "an encoding of more bytes": Case("/camera0", at(encoding="rgb16"), SOME, "Image.step: "),
    "an encoding that is none": Case(
        "/camera0", at(encoding="\x1b[2J"), SOME, r"Image.encoding: '\x1b[2J' is unknown"
    ),
    "an encoding with any number of channels": Case(
        "/camera0", at(encoding="8UC" + "9" * 5000), SOME, "3 messages not as in the contract"
    ),
    "data that are cut": Case("/camera0", at(data=b"123"), SOME, "3 bytes, but 32 rows"),
    "no data": Case("/camera0", at(height=0, width=0, data=b""), SOME, "0 by 0 pixels"),
    "the first picture is cut": Case("/camera0", at(data=b""), slice(0, 3), "3 messages not as"),
    "fewer joints": Case(
        "/joint_states",
        joints(name=["joint"], position=[]),
        SOME,
        "position.joint: not there: 0 elements for 1 names",
    ),
    "other joints": Case(
        "/joint_states",
        joints(name=["elbow"], position=[1.0], velocity=[1.0]),
        SOME,
        "position.joint: not there: the names are elbow",
    ),
    "a joint that is there twice": Case(
        "/joint_states",
        joints(name=["joint", "joint"], position=[1.0, 2.0], velocity=[1.0, 2.0]),
        SOME,
        "position.joint: not there: joint occurs 2 times among the names",
    ),
    "a joint that is not a number": Case(
        "/joint_states",
        joints(name=["joint"], position=[float("nan")], velocity=[0.0]),
        SOME,
        "position.joint: nan, not finite",
    ),
    "a joint beyond 32 bits": Case(
        "/joint_states",
        joints(name=["joint"], position=[1e300], velocity=[0.0]),
        SOME,
        "position.joint: inf, not finite",
    ),
    "messages of another type in between": Case(
        "/joint_states",
        lambda each: String(data="on"),
        SOME,
        "sensor_msgs/msg/JointState: it is std_msgs/msg/String in the bag",
    ),
    "another type first": Case(
        "/camera0",
        lambda each: String(data="on"),
        slice(0, 2),
        "2 messages not as in the contract: sensor_msgs/msg/Image: it is std_msgs/msg/String",
    ),
    "pictures of another type in between": Case(
        "/camera0", lambda each: image.compress(each, "png"), SOME, "CompressedImage in the bag"
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_false_messages_are_left_out_and_told(tmp_path: Path, name: str) -> None:
    """The rest is true, and the exit status is not 0."""
    case = CASES[name]
    found = exported(tmp_path, false(case.topic, case.change, case.every))
    assert case.told in found.text
    assert found.problems
    assert 20 <= found.rows < 30


@pytest.mark.slow
def test_compressed_pictures_that_are_false_are_left_out(tmp_path: Path) -> None:
    """They are decoded when rows are there already: these are made again."""
    observations = contract().to_dict()["observations"]
    observations[0]["type"] = "sensor_msgs/msg/CompressedImage"
    bomb = image.compress(image.from_numpy(np.zeros((4000, 5000), np.uint8), "mono8"), "png").data

    def edit(messages: Messages) -> Messages:
        pictures = [message for _, topic, message in messages if topic == "/camera0"]
        for picture, data in zip(
            pictures[10::5], (b"", bomb, b"\xff\xd8\xff", b"%!PS"), strict=True
        ):
            picture.data = data
        return messages

    found = exported(
        tmp_path,
        edit,
        contract=contract(observations=observations),
        wrap=lambda shown: image.compress(shown, "png"),
    )
    assert "/camera0: 4 messages not as in the contract: sensor_msgs/msg/Compr" in found.text
    assert found.rows == 24


def test_infinite_numbers_make_rows_if_the_contract_says_what_they_mean(tmp_path: Path) -> None:
    """As for a beam of a scan that does not return."""
    observations = contract().to_dict()["observations"]
    observations[1] |= {"infinity": 0.25, "stamp": "receive"}
    edit = false("/joint_states", at(position=[float("inf")]), ALL)
    run = demonstration(tmp_path / "run", edit=edit, length_sec=1)
    made = contract(observations=observations)
    found = export(tmp_path / "out", [run], contract=made, jobs=1)
    assert "not finite" not in found.text
    read = Reader(tmp_path / "out")
    assert {float(read[index]["observation.state"][0]) for index in range(len(read))} == {0.25}


def test_a_bag_that_was_recorded_in_a_loop_is_read_once(tmp_path: Path) -> None:
    """The times of each turn are those of the first one: a mixture would be of no demonstration."""

    def edit(messages: Messages) -> Messages:
        turns = range(3)
        return [
            (arrival + turn * 2 * 10**9, *rest) for turn in turns for arrival, *rest in messages
        ]

    by_stamps = contract().to_dict()
    by_stamps["actions"][0] |= {
        "topic": "/joint_states",
        "type": by_stamps["observations"][1]["type"],
        "fields": ["position.joint"],
    }
    found = exported(tmp_path, edit, contract=contract(actions=by_stamps["actions"]))
    assert (found.episodes, found.rows) == (1, 29)
    assert "/camera0: 60 messages with a time out of order, left out" in found.text


def test_a_topic_without_times_is_of_its_arrivals_and_told(tmp_path: Path) -> None:
    """A driver that fills no header; the contract can say so."""
    edit = false("/joint_states", lambda each: at(header=type(each.header)())(each), ALL)
    found = exported(tmp_path, edit)
    told = (
        "/joint_states: 99 messages without a time in the header; their times of arrival are used"
    )
    assert told in found.text
    assert "stamped" not in found.reports[0]["topics"][1]
    observations = contract().to_dict()["observations"]
    observations[1]["stamp"] = "receive"
    made = contract(observations=observations)
    assert exported(tmp_path / "told", edit, contract=made).problems == {}


def test_a_clock_that_is_ahead_is_reported(tmp_path: Path) -> None:
    """Its pictures would show what the joints do later."""
    edit = false("/joint_states", lambda each: shifted(each, 0.3), ALL)
    run = demonstration(tmp_path / "run", edit=edit, length_sec=1)
    found = export(tmp_path / "out", [run], contract=contract(), jobs=1)
    told = "/joint_states: 99 messages stamped up to 300.0 ms after arrival, by a clock that is"
    assert told in found.problems[str(run)][-1]


def test_stamps_of_a_clock_that_began_with_the_computer_make_no_rows(tmp_path: Path) -> None:
    """Nothing belongs together."""
    edit = false("/camera0", lambda each: shifted(each, -1.7e9), ALL)
    with pytest.raises(DatasetError, match=r"1700000000\.0 s before arrival, by another clock"):
        exported(tmp_path, edit)

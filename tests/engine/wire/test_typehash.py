"""Hashes and descriptions of types, against those that ROS 2 computed."""

from __future__ import annotations

import json
from typing import Any

import pytest

from aionode.engine.wire._type_description import describe, description_message
from aionode.engine.wire.typehash import type_hash
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import String
from aionode.interfaces.test_msgs.msg import Defaults
from aionode.message import Array, Bounded, Message, Sequence, byte, char, int32, wstring
from tests.support.samples import rosidl_hashes, type_of, vectors


def test_a_hash_is_the_one_that_rosidl_computed() -> None:
    """Messages, services, actions and all that they consist of."""
    expected = rosidl_hashes()

    assert {name: type_hash(type_of(name)) for name in expected} == expected


def test_a_hash_is_the_one_of_another_implementation() -> None:
    """For more types: this one agrees with rosbags and hiroz."""
    expected = vectors("vectors")["more_rihs01_jazzy"]

    assert {name: type_hash(type_of(name)) for name in expected} == expected


def test_the_parts_of_an_action_have_the_hashes_that_their_keys_need() -> None:
    """The parts are the send_goal and get_result services and the feedback topic."""
    expected = vectors("vectors")["actions"]["example_interfaces/action/Fibonacci"]
    ends = expected["endpoints"]

    assert type_hash(Fibonacci) == expected["rihs01_action"]
    assert type_hash(Fibonacci.Impl.SendGoalService) == ends["send_goal"]["rihs01"]
    assert type_hash(Fibonacci.Impl.GetResultService) == ends["get_result"]["rihs01"]
    assert type_hash(Fibonacci.Impl.CancelGoalService) == ends["cancel_goal"]["rihs01"]
    assert type_hash(Fibonacci.Impl.FeedbackMessage) == ends["feedback"]["rihs01"]
    assert type_hash(Fibonacci.Impl.GoalStatusMessage) == ends["status"]["rihs01"]


@pytest.mark.parametrize("name", vectors("vectors")["rihs01_canonical_json"])
def test_what_is_hashed_is_the_same_text(name: str) -> None:
    """A difference can be found when a hash is wrong."""
    assert json.dumps(describe(type_of(name))) == vectors("vectors")["rihs01_canonical_json"][name]


def test_a_class_written_by_hand_has_the_hash_of_its_definition() -> None:
    """It does not matter which way a type was made."""

    class Same(Message, typename="std_msgs/msg/String"):
        data: str

    assert type_hash(Same) == type_hash(String)


class Kinds(Message, typename="test/msg/Kinds"):
    """A field of each rule for ids."""

    letter: char
    letters: Array[char, 3]
    octets: Sequence[byte]
    numbers: Sequence[int32, 5]
    wide: wstring
    short: Bounded[str, 7]
    some_short: Sequence[Bounded[wstring, 8], 9]


@pytest.mark.parametrize(
    ("field", "type_id", "capacity", "string_capacity"),
    [
        ("letter", 3, 0, 0),
        ("letters", 51, 3, 0),
        ("octets", 160, 0, 0),
        ("numbers", 102, 5, 0),
        ("wide", 18, 0, 0),
        ("short", 21, 0, 7),
        ("some_short", 118, 9, 8),
    ],
)
def test_a_type_id_is_made_of_kind_and_container(
    field: str, type_id: int, capacity: int, string_capacity: int
) -> None:
    """As type_description_interfaces/msg/FieldType numbers them."""
    members = {form["name"]: form["type"] for form in describe(Kinds)["type_description"]["fields"]}

    assert members[field] == {
        "type_id": type_id,
        "capacity": capacity,
        "string_capacity": string_capacity,
        "nested_type_name": "",
    }


def test_a_description_as_a_message_says_the_same() -> None:
    """It is what a node answers on its get_type_description service."""
    message: Any = description_message(AddTwoInts)
    form = describe(AddTwoInts)

    assert message.type_description.type_name == "example_interfaces/srv/AddTwoInts"
    assert [field.name for field in message.type_description.fields] == [
        "request_message",
        "response_message",
        "event_message",
    ]
    assert [part.type_name for part in message.referenced_type_descriptions] == [
        part["type_name"] for part in form["referenced_type_descriptions"]
    ]
    (sum_field,) = message.referenced_type_descriptions[3].fields
    assert (sum_field.name, sum_field.type.type_id) == ("sum", 8)


def test_a_description_as_a_message_has_the_default_values() -> None:
    """They are no part of the hash, but of the answer."""
    message: Any = description_message(Defaults)
    texts = {field.name: field.default_value for field in message.type_description.fields}

    assert texts["bool_value"] == "True"
    assert texts["byte_value"] == "50"
    assert texts["float64_value"] == "1.125"
    assert texts["int64_value"] == "-40000000"


def test_a_class_without_a_name_has_no_hash() -> None:
    """The name is part of what is hashed."""

    class Nameless(Message):
        data: str

    with pytest.raises(TypeError, match="Nameless"):
        type_hash(Nameless)


@pytest.mark.parametrize("wrong", [int, "std_msgs/msg/String", None])
def test_what_is_no_type_of_ros_has_no_hash(wrong: Any) -> None:
    """The error says what was given."""
    with pytest.raises(TypeError):
        type_hash(wrong)

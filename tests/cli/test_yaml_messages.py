"""Messages from the YAML that a user types."""

from __future__ import annotations

import pytest

from aionode.cli._support.formatting import yaml_text
from aionode.cli._support.yaml_messages import Filler, message_from_yaml
from aionode.clock import Time
from aionode.errors import CommandError
from aionode.interfaces.geometry_msgs.msg import PoseStamped
from aionode.interfaces.std_msgs.msg import String
from aionode.message import to_builtins


@pytest.mark.parametrize(
    ("text", "data"),
    [("{data: hi}", "hi"), ("data: hi", "hi"), ('{"data": "hi"}', "hi"), ("", ""), ("{}", "")],
)
def test_braces_are_optional(text: str, data: str) -> None:
    """JSON is YAML, and nothing at all is a message of defaults."""
    assert message_from_yaml(String, text) == String(data=data)


def test_what_echo_prints_pub_reads() -> None:
    """``aionode topic echo /a --once | aionode topic pub /b … --stdin``."""
    printed = f"{yaml_text(to_builtins(String(data='hi')))}---\n"

    assert message_from_yaml(String, printed) == String(data="hi")


def test_two_messages_are_one_too_many() -> None:
    """The second would be lost silently."""
    with pytest.raises(CommandError, match="has 2 YAML documents"):
        message_from_yaml(String, "data: a\n---\ndata: b\n")


@pytest.mark.parametrize(
    ("text", "key", "meant"),
    [
        ("{data:hi}", "data:hi", "data: hi"),
        ("data:hi", "data:hi", "data: hi"),
        ("{header: {frame_id:map}}", "frame_id:map", "frame_id: map"),
        ("{pose: {position: {x:1, y: 2}}}", "x:1", "x: 1"),
    ],
)
def test_a_missing_blank_is_named(text: str, key: str, meant: str) -> None:
    """YAML parses such a pair as one word, so the error mentioned a field ``order:3``."""
    with pytest.raises(CommandError) as raised:
        message_from_yaml(PoseStamped, text)

    says = str(raised.value)
    assert f"field '{key}'; YAML requires a space after the colon: '{meant}'" in says


@pytest.mark.parametrize("text", ["{data: 'a:b'}", "{data: a:b}"])
def test_a_colon_within_a_value_is_one(text: str) -> None:
    """Only a key without a value is misspelled."""
    assert message_from_yaml(String, text) == String(data="a:b")


def test_a_stamp_is_set_deep_inside() -> None:
    """It is set anew for the next message."""
    filler = Filler(PoseStamped, "{header: {stamp: now, frame_id: map}}")

    seconds = [
        filler.message(Time(seconds=at)).header.stamp.sec  # type: ignore[attr-defined]  # a PoseStamped
        for at in (5, 7)
    ]

    assert seconds == [5, 7]
    assert filler.message(Time()).header.frame_id == "map"  # type: ignore[attr-defined]  # the same


def test_a_word_where_no_time_belongs_is_refused() -> None:
    """``now`` is a string everywhere else."""
    with pytest.raises(CommandError, match="Failed to populate field"):
        Filler(PoseStamped, "{pose: now}")

"""Frames of rosbridge clients are checked before anything is done."""

from __future__ import annotations

import json
import math
from contextlib import suppress
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.clock import Duration
from aionode.errors import MessageError
from aionode.gateway.rosbridge.request import FragmentStore, number, op_of, profile
from aionode.gateway.session.encoding.client_json import type_text
from aionode.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy


@pytest.mark.parametrize(
    "frame",
    ["", "[]", "7", "{", "{}", '{"op": 3}', b"\xff\xfe", "[" * 100_000, '{"op":"a"}{"op":"b"}'],
)
def test_a_frame_that_is_no_op_is_an_error(frame: str | bytes) -> None:
    """One frame is one op; rosbridge searches for brackets instead, at quadratic cost."""
    with pytest.raises(MessageError, match="frame"):
        op_of(frame, 5000)


@given(st.one_of(st.text(), st.binary()))
def test_garbage_raises_nothing_but_a_message_error(frame: str | bytes) -> None:
    """Whatever arrives, the client gets an error, and nothing else happens."""
    with suppress(MessageError):
        op_of(frame, 5000)


def test_infinities_are_read_as_python_writes_them() -> None:
    """A client that uses Python's json module sends them this way."""
    op = op_of(json.dumps({"op": "publish", "msg": [math.inf, math.nan]}), 5000)

    assert op["msg"][0] == math.inf
    assert math.isnan(op["msg"][1])


@pytest.mark.parametrize("value", ["5", True, [1], {}])
def test_a_number_is_a_number(value: object) -> None:
    """A text is not; rosbridge checks this, too."""
    with pytest.raises(MessageError, match=r"subscribe\.throttle_rate"):
        number({"op": "subscribe", "throttle_rate": value}, "throttle_rate")


def test_a_number_that_makes_no_sense_is_the_default() -> None:
    """As in rosbridge, which accepts no negative rates."""
    for value in (-1, math.nan, None):
        assert number({"op": "subscribe", "throttle_rate": value}, "throttle_rate") == 0


def test_types_are_understood_without_their_kind() -> None:
    """Clients of ROS 1 and ROS 2 write both forms."""
    assert type_text("std_msgs/String", "msg") == "std_msgs/msg/String"
    assert type_text("std_msgs/msg/String", "msg") == "std_msgs/msg/String"
    assert type_text("", "msg") == ""


def asked(**policies: object) -> QoSProfile | None:
    """Return the profile requested by an op."""
    return profile({"op": "subscribe", "qos": policies}, QoSProfile(depth=10))


def test_a_profile_may_be_asked_for() -> None:
    """As in rosbridge 4.2: words in any case, seconds, secs and nsecs, or 'infinite'."""
    found = asked(
        reliability="BEST_EFFORT",
        durability="transient_local",
        depth=3,
        deadline={"secs": 1, "nsecs": 5},
        lifespan="infinite",
    )

    assert found is not None
    assert found.reliability is ReliabilityPolicy.BEST_EFFORT
    assert found.durability is DurabilityPolicy.TRANSIENT_LOCAL
    assert (found.depth, found.deadline) == (3, Duration(nanoseconds=1_000_000_005))
    assert found.lifespan == Duration()
    assert profile({"op": "subscribe"}, QoSProfile(depth=10)) is None


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("reliability", "sometimes"),
        ("reliability", 1),
        ("depth", -1),
        ("depth", 2.5),
        ("deadline", "soon"),
        ("deadline", math.nan),
        ("lifespan", {"secs": "x"}),
        ("colour", "red"),
    ],
)
def test_an_unknown_policy_or_value_is_an_error_that_names_it(name: str, value: object) -> None:
    """The client learns what is allowed."""
    with pytest.raises(MessageError, match=f"subscribe.qos.{name}"):
        asked(**{name: value})


# Fragments


def part(data: str, num: object, total: object, message_id: object = "1") -> dict[str, Any]:
    """Return an op with one fragment."""
    return {"op": "fragment", "id": message_id, "data": data, "num": num, "total": total}


def test_fragments_make_a_message_in_any_order() -> None:
    """The last one completes it."""
    store = FragmentStore(1000)

    assert store.add(part("b", 1, 2)) is None
    assert store.add(part("a", 0, 2)) == "ab"


def test_incomplete_fragments_do_not_grow_without_limit() -> None:
    """In rosbridge, they are an attack on the robot's memory."""
    store = FragmentStore(1000)

    for num in range(45):
        store.add(part("", num, 10_000, str(num)))
    with pytest.raises(MessageError, match="exceed 1000"):
        store.add(part("x" * 100, 0, 2))
    assert store.add(part("a", 0, 1)) == "a"


@pytest.mark.parametrize(
    ("num", "total"), [(0, 0), (2, 2), (-1, 2), (0, 10**9), ("0", 1), (0, None), (True, 2)]
)
def test_a_fragment_of_nothing_is_an_error(num: object, total: object) -> None:
    """Numbers start at 0 and end before the total."""
    with pytest.raises(MessageError, match="fragment"):
        FragmentStore(1000).add(part("a", num, total))

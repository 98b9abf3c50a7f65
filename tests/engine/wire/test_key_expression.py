"""Keys of topics and services."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode._distribution import NO_TYPE_HASH
from aionode.engine.wire import _key_expression as key_expression

VECTORS: dict[str, Any] = json.loads(
    Path(__file__).parents[2].joinpath("vectors", "vectors.json").read_text()
)

STRING_HASH = VECTORS["messages"]["std_msgs/msg/String"]["rihs01"]
WORDS = st.from_regex(r"[a-z][a-z0-9_]{0,8}", fullmatch=True)
NAMES = st.lists(WORDS, min_size=1, max_size=4).map(lambda words: "/" + "/".join(words))
TYPES = st.builds("{}/{}/{}".format, WORDS, st.sampled_from(["msg", "srv", "action"]), WORDS)


@pytest.mark.parametrize(
    ("golden", "domain_id", "name", "type_name", "type_hash"),
    [
        ("/chatter domain 0", 0, "/chatter", "std_msgs/msg/String", STRING_HASH),
        ("/robot1/chatter domain 7", 7, "/robot1/chatter", "std_msgs/msg/String", STRING_HASH),
        (
            "/add_two_ints domain 2",
            2,
            "/add_two_ints",
            "example_interfaces/srv/AddTwoInts",
            VECTORS["services"]["example_interfaces/srv/AddTwoInts"]["rihs01"],
        ),
        ("humble /chatter", 0, "/chatter", "std_msgs/msg/String", NO_TYPE_HASH),
        (
            "/fibonacci/_action/send_goal",
            0,
            "/fibonacci/_action/send_goal",
            "example_interfaces/action/Fibonacci_SendGoal",
            VECTORS["actions"]["example_interfaces/action/Fibonacci"]["endpoints"]["send_goal"][
                "rihs01"
            ],
        ),
    ],
)
def test_keys_are_those_of_rmw_zenoh(
    golden: str, domain_id: int, name: str, type_name: str, type_hash: str
) -> None:
    """One other byte in a key, and a ROS node hears nothing."""
    key = VECTORS["topic_keys"][golden]

    assert key_expression.data_key(domain_id, name, type_name, type_hash) == key
    assert key_expression.parse_data_key(key) == key_expression.DataKey(
        domain_id, name, type_name, type_hash
    )


@pytest.mark.parametrize("kind", ["messages", "services"])
def test_dds_types_are_those_of_rmw_zenoh(kind: str) -> None:
    """Every type of the recorded ones."""
    for type_name, entry in VECTORS[kind].items():
        assert key_expression.dds_type(type_name) == entry["dds_type"]
        assert key_expression.ros_type(entry["dds_type"]) == type_name


@given(st.integers(0, 2**32 - 1), NAMES, TYPES, WORDS)
def test_parsing_undoes_writing(domain: int, name: str, type_name: str, type_hash: str) -> None:
    """The key of a sample says what its sender wrote."""
    key = key_expression.data_key(domain, name, type_name, type_hash)

    assert key_expression.parse_data_key(key) == key_expression.DataKey(
        domain, name, type_name, type_hash
    )
    assert key_expression.parse_data_key(key_expression.buffer_key(key)) == key_expression.DataKey(
        domain,
        name,
        type_name,
        type_hash,
    )


@given(st.text(alphabet="0aé²_/:*%#-d ", max_size=40))
def test_any_text_parses_or_is_none(key: str) -> None:
    """Any program may publish on any key: parsing one never raises."""
    parsed = key_expression.parse_data_key(key)

    assert parsed is None or parsed.name.startswith("/")


@given(NAMES)
def test_demangling_undoes_mangling(name: str) -> None:
    """A name is one chunk of a token, and comes out whole."""
    chunk = key_expression.mangle(name)

    assert "/" not in chunk
    assert key_expression.demangle(chunk) == name


def test_what_is_unknown_is_a_wildcard() -> None:
    """The command line listens to types whose definition it does not have."""
    assert key_expression.data_key(0, "/chatter", "std_msgs/msg/String").endswith("String_/*")
    assert key_expression.data_key(0, "/chatter") == "0/chatter/*/*"


@pytest.mark.parametrize(
    "dds_name", ["", "String", "dds_::String_", "a::dds_::_", "a::dds_::B", "..::msg::dds_::B_"]
)
def test_another_name_is_no_dds_type(dds_name: str) -> None:
    """Half a name is none."""
    assert key_expression.ros_type(dds_name) is None

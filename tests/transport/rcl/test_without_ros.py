"""What is said where rcl cannot be used, and where it would help."""

from __future__ import annotations

import sys

import pytest

from aionode.context import Context
from aionode.errors import ConfigurationError, TransportError
from aionode.transport._zenoh_config import unheard_middleware
from aionode.transport.rcl import RclTransport
from aionode.transport.rcl._bindings import load
from aionode.transport.rcl._types import find, hash_text


def test_without_rclpy_the_error_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """The error is one line."""
    for name in ("rclpy", "rclpy.impl", "rclpy.impl.implementation_singleton"):
        monkeypatch.setitem(sys.modules, name, None)
    load.cache_clear()
    with pytest.raises(TransportError, match=r"rclpy is not installed .* pip install"):
        load()


def test_a_type_that_is_not_installed_is_named() -> None:
    """With what to do."""
    with pytest.raises(TransportError, match=r"my_msgs/msg/Mine: the installed ROS has no such"):
        find("my_msgs/msg/Mine")


def test_the_environment_chooses_the_transport(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the argument does not."""
    monkeypatch.setenv("AIONODE_TRANSPORT", "rcl")
    assert isinstance(Context().transports[1], RclTransport)
    assert len(Context(transport="local").transports) == 1
    monkeypatch.setenv("AIONODE_TRANSPORT", "dds")
    with pytest.raises(ConfigurationError, match="AIONODE_TRANSPORT: 'dds' given"):
        Context()


def test_the_hint_names_the_middleware_that_is_not_heard() -> None:
    """And none for rmw_zenoh."""
    assert unheard_middleware({"RMW_IMPLEMENTATION": "rmw_fastrtps_cpp"}) == (
        "RMW_IMPLEMENTATION=rmw_fastrtps_cpp: nodes over DDS are not heard; "
        "AIONODE_TRANSPORT=rcl reaches them"
    )
    assert unheard_middleware({"RMW_IMPLEMENTATION": "rmw_zenoh_cpp"}) is None
    assert unheard_middleware({}) is None


def test_a_hash_that_is_not_set_is_unknown() -> None:
    """Version 0 means so."""
    assert hash_text(0, bytes(32)) == ""
    assert hash_text(1, bytes(32)) == "RIHS01_" + "00" * 32

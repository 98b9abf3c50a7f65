"""The error texts when rcl cannot be used, and the hints when it would help."""

from __future__ import annotations

import importlib.metadata
import importlib.util
import re
import sys
from types import ModuleType
from typing import TYPE_CHECKING

import pytest

from aionode.engine.context import Context
from aionode.engine.transport.network import unheard_middleware
from aionode.engine.transport.rcl import RclTransport, _types
from aionode.engine.transport.rcl._bindings import load
from aionode.engine.transport.rcl._types import find, hash_text, rosidl_class
from aionode.errors import ConfigurationError, TransportError

if TYPE_CHECKING:
    from collections.abc import Iterator


@pytest.fixture(autouse=True)
def unloaded() -> Iterator[None]:
    """Discard whatever a test loaded."""
    load.cache_clear()
    yield
    load.cache_clear()


def absent(name: str) -> str:
    """Stand in for `importlib.metadata.version` where nothing is installed."""
    raise importlib.metadata.PackageNotFoundError(name)


def problem() -> str:
    """Return the reason why rcl cannot be loaded, which must be one line."""
    with pytest.raises(TransportError) as caught:
        load()
    (line,) = str(caught.value).splitlines()
    return line


def test_without_rclpy_the_error_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """The error is one line."""
    monkeypatch.setattr(importlib.metadata, "version", absent)
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    assert re.search(r"rclpy is not installed in this Python; .* pip install", problem())


def test_an_old_ros_is_named_with_what_is_needed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Before it is imported, because Humble's rclpy is built for another Python."""
    monkeypatch.setattr(importlib.metadata, "version", lambda name: "3.3.16")
    assert re.search(r"rclpy 3\.3\.16 is too old; it needs ROS 2 Jazzy or later", problem())


def test_an_rclpy_of_another_python_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    """The import error itself has several lines."""
    monkeypatch.setattr(importlib.metadata, "version", lambda name: "7.1.6")
    for name in ("rclpy", "rclpy.impl", "rclpy.impl.implementation_singleton"):
        monkeypatch.setitem(sys.modules, name, None)
    assert re.search(r"Python 3\.\d+ cannot import rclpy 7\.1\.6 \(.*\); use the Python", problem())


def test_an_unknown_middleware_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    """Before rcl is loaded, as rcl would end the process."""
    monkeypatch.setattr(importlib.metadata, "version", lambda name: "9.1.2")
    monkeypatch.setenv("RMW_IMPLEMENTATION", "rmw_nonsense")
    assert re.search(
        r"RMW_IMPLEMENTATION='rmw_nonsense' cannot be used \(.*\); unset it",
        problem(),
    )


def test_a_type_that_is_not_installed_is_named() -> None:
    """The error says what to do."""
    with pytest.raises(TransportError, match=r"my_msgs/msg/Mine: the installed ROS has no such"):
        find("my_msgs/msg/Mine")


def test_the_environment_chooses_the_transport(monkeypatch: pytest.MonkeyPatch) -> None:
    """If the argument does not."""
    monkeypatch.setenv("AIONODE_TRANSPORT", "rcl")
    assert isinstance(Context().transports[1], RclTransport)
    assert len(Context(transport="local").transports) == 1
    monkeypatch.setenv("AIONODE_TRANSPORT", "dds")
    with pytest.raises(ConfigurationError, match="AIONODE_TRANSPORT: 'dds' given"):
        Context()


def test_the_hint_names_the_middleware_that_is_not_heard() -> None:
    """There is no hint with rmw_zenoh."""
    assert unheard_middleware({"RMW_IMPLEMENTATION": "rmw_fastrtps_cpp"}) == (
        "RMW_IMPLEMENTATION=rmw_fastrtps_cpp: nodes on DDS are not reachable; "
        "use AIONODE_TRANSPORT=rcl to reach them"
    )
    assert unheard_middleware({"RMW_IMPLEMENTATION": "rmw_zenoh_cpp"}) is None
    assert unheard_middleware({}) is None


def test_a_hash_that_is_not_set_is_unknown() -> None:
    """Version 0 means that it is not set."""
    assert hash_text(0, bytes(32)) == ""
    assert hash_text(1, bytes(32)) == "RIHS01_" + "00" * 32


def install_mine(monkeypatch: pytest.MonkeyPatch, support: object) -> None:
    """Install ``my_msgs/msg/Mine``, a message class like rosidl's, with a type support."""

    class Support(type):
        _TYPE_SUPPORT = support

        @classmethod
        def __import_type_support__(cls) -> None:  # # its name in rosidl
            """Find nothing, as in a package built for another Python."""

    module = ModuleType("my_msgs.msg")
    module.Mine = Support("Mine", (), {})  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "my_msgs", ModuleType("my_msgs"))
    monkeypatch.setitem(sys.modules, "my_msgs.msg", module)


def test_a_type_without_type_support_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    """The error says what to do."""
    install_mine(monkeypatch, None)
    with pytest.raises(TransportError, match="my_msgs/msg/Mine: its type support cannot be loaded"):
        rosidl_class("my_msgs/msg/Mine", "RIHS01_00")


def test_a_type_of_another_definition_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """DDS matches types only by name, and would decode garbage."""
    install_mine(monkeypatch, object())
    monkeypatch.setattr(_types, "type_hash_of", lambda cls: "RIHS01_11")
    with pytest.raises(TransportError, match=r"another definition \(RIHS01_11, here RIHS01_00\)"):
        rosidl_class("my_msgs/msg/Mine", "RIHS01_00")
    assert rosidl_class("my_msgs/msg/Mine", "RIHS01_11").__name__ == "Mine"

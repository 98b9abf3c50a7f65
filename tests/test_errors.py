"""The texts of errors, for any values."""

from __future__ import annotations

import ast
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from aionode import errors
from aionode.arguments import parse_arguments
from aionode.engine.context import Context
from aionode.errors import MessageError, NameValidationException, ServiceError, brief, shortened
from aionode.interfaces.std_msgs.msg import Int32, String
from aionode.interfaces.std_srvs.srv import Trigger
from aionode.node import Node
from aionode.qos import QoSProfile

LONG: Any = "x" * 400_000


@pytest.fixture
def plain_node() -> Node:
    """A node that does not run."""
    return Node("node", context=Context(transport="local"))


@pytest.mark.parametrize(
    "mistake",
    [
        lambda node: Node(LONG + "-", context=node.context),
        lambda node: node.create_publisher(String, LONG + "-", 10),
        lambda node: node.create_publisher(LONG, LONG, 10),
        lambda node: node.create_publisher(String, "topic", LONG),
        lambda node: node.create_service(Trigger, LONG + "-", lambda _, response: response),
        lambda node: node.create_subscription(String, "topic", LONG, 10),
        lambda node: node.create_action_client(LONG, LONG),
        lambda node: node.create_timer(LONG, lambda: None),
        lambda node: node.get_parameter(LONG),
        lambda node: node.create_publisher(Int32, "n", 10).publish(Int32(data=LONG)),
        lambda _: QoSProfile(depth=LONG),
        lambda _: Context(transport=LONG),
        lambda _: parse_arguments(["--ros-args", "-r", LONG]),
        lambda _: parse_arguments(["--ros-args", "-p", "name:=[" + LONG]),
    ],
)
def test_a_long_value_makes_no_long_error(
    mistake: Callable[[Node], object], plain_node: Node
) -> None:
    """It would fill logs and terminals, and travel as the error of a service."""
    with pytest.raises(Exception) as caught:  # noqa: PT011  # all kinds
        mistake(plain_node)
    assert len(str(caught.value)) < 2_500


def test_a_variable_of_the_environment_is_not_repeated_at_length(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Values that are read from elsewhere are not either."""
    monkeypatch.setenv("ROS_DOMAIN_ID", "9" * 100_000)
    with pytest.raises(ValueError, match="ROS_DOMAIN_ID") as caught:
        Context(transport="local")
    assert len(str(caught.value)) < 2_500


def test_the_mark_stands_under_the_mistake_in_a_long_name() -> None:
    """Only its neighbourhood is shown."""
    error = NameValidationException("topic name", "a" * 300 + "-" + "b" * 300, "a reason", 300)
    _, name, mark = str(error).splitlines()
    assert name[mark.index("^")] == "-"
    assert len(name) < 200
    short = NameValidationException("topic name", "ab-c", "a reason", 2)
    assert str(short).splitlines()[1:] == ["  'ab-c'", "     ^"]


def test_begin_and_end_of_a_long_text_are_kept_and_the_attributes_are_whole() -> None:
    """The beginning names the subject, the end says what to do."""
    error = MessageError("type.field", LONG + "; use another")
    assert str(error).startswith("type.field: xxx")
    assert str(error).endswith("; use another")
    assert error.problem == LONG + "; use another"
    assert shortened("short") == "short"


def test_a_number_that_python_does_not_write_is_shown_all_the_same() -> None:
    """With more than 4300 digits `repr` raises."""
    assert "cannot be written" in brief(10**5000)


def test_an_error_that_quotes_another_process_shows_its_control_characters() -> None:
    """The text of a server's exception could otherwise rewrite the caller's terminal."""
    error = ServiceError("ValueError", "\x1b[2Jall is well\r\x9b31m\u202e\n\tat line 3")

    assert "\\x1b[2Jall is well\\r\\x9b31m\\u202e\n\tat line 3" in str(error)
    assert error.error_text.startswith("\x1b")


@pytest.mark.parametrize("module", ["_calls", "_nodes"])
def test_errors_that_commands_print_advise_no_code(module: str) -> None:
    """Whoever calls a service or sends a goal from a terminal cannot await anything."""
    tree = ast.parse((Path(errors.__file__).parent / f"{module}.py").read_text())
    documented = ast.Module | ast.ClassDef | ast.FunctionDef
    docs = {
        ast.get_docstring(node, clean=False)
        for node in ast.walk(tree)
        if isinstance(node, documented)
    }
    texts = [
        node.value
        for node in ast.walk(tree)
        if isinstance(node, ast.Constant) and isinstance(node.value, str)
    ]
    assert [text for text in texts if text not in docs and "await " in text] == []

"""Tests of tracebacks that show the program's lines, not aionode's."""

from __future__ import annotations

import pytest

from aionode._process.tracebacks import traceback_text
from aionode.errors import MessageError
from aionode.interfaces.std_msgs.msg import Int32
from aionode.message import check
from aionode.runner import failure_text


def failing_check() -> None:
    """Raise an error from inside aionode."""
    check(Int32(data="five"))  # type: ignore[arg-type]  # the mistake


def error_of_a_program() -> Exception:
    """Return an error with a cause; both have lines of aionode."""
    try:
        try:
            failing_check()
        except MessageError as error:
            raise ValueError("no map") from error
    except ValueError as error:
        return error
    raise AssertionError


def test_the_lines_of_aionode_are_left_out() -> None:
    """The last line is the program's own, in the error, its cause and the members of a group."""
    error = error_of_a_program()
    for text in (traceback_text(error), traceback_text(ExceptionGroup("several", [error]))):
        assert "in failing_check" in text
        assert "in error_of_a_program" in text
        assert "aionode/message" not in text
        assert "<snapshot" not in text  # generated for the type


def test_a_variable_shows_all_lines(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is for people who look for a mistake in aionode."""
    monkeypatch.setenv("AIONODE_TRACEBACK", "1")

    assert "aionode/message" in traceback_text(error_of_a_program())
    assert "shows aionode's lines" not in failure_text(error_of_a_program())


def test_an_error_that_is_all_in_aionode_keeps_its_lines() -> None:
    """Without them, nothing would show where it is."""
    with pytest.raises(MessageError) as raised:
        check(Int32(data="five"))  # type: ignore[arg-type]  # the mistake
    error = raised.value
    assert error.__traceback__ is not None
    assert error.__traceback__.tb_next is not None

    text = traceback_text(error.with_traceback(error.__traceback__.tb_next))

    assert "<snapshot of std_msgs/msg/Int32>" in text


def test_the_examples_of_aionode_are_programs() -> None:
    """Users copy them, so their lines are shown."""
    from aionode._process.tracebacks import is_of_library

    assert not is_of_library(failure_text.__code__.co_filename.replace("runner", "examples/pubsub"))
    assert is_of_library(failure_text.__code__.co_filename)

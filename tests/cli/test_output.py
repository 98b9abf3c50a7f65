"""What a command prints, for people and for programs."""

from __future__ import annotations

import io
import math
from typing import Any

import pytest

from aionode.cli._support.formatting import csv_line
from aionode.cli._support.output import Output


def test_text_is_for_people_only(screen: Any) -> None:
    """Programs get records and nothing else on stdout."""
    screen.json_output.text("hello")
    screen.json_output.raw("hello")
    screen.json_output.item("hello", {"a": 1})

    assert screen.records == [{"a": 1}]


def test_progress_leaves_stdout_to_the_records(screen: Any) -> None:
    """On stdout, where ros2 prints it."""
    screen.output.progress("waiting")
    screen.json_output.progress("waiting")

    assert (screen.text, screen.errors) == ("waiting\n", "waiting\n")


@pytest.mark.parametrize(
    ("number", "word"), [(math.nan, "NaN"), (math.inf, "Infinity"), (-math.inf, "-Infinity")]
)
def test_what_json_has_no_number_for_is_a_word(number: float, word: str, screen: Any) -> None:
    """A range finder reports infinity when nothing is in range; that is a value, not null."""
    screen.json_output.item(
        "", {"range": number, "ranges": [1.0, number], "nested": [{"a": number}]}
    )

    assert screen.records == [{"range": word, "ranges": [1.0, word], "nested": [{"a": word}]}]


def test_a_pipe_gets_no_spinner(screen: Any) -> None:
    """A spinner is for terminals."""
    with screen.output.waiting("for something"):
        pass

    assert (screen.text, screen.errors) == ("", "")


class Terminal(io.StringIO):
    """A stream that says that it is a terminal."""

    def isatty(self) -> bool:
        """Return True."""
        return True


def test_a_terminal_shows_the_control_characters_of_others_as_escapes() -> None:
    """A value could retitle the terminal, or hide what is above it."""
    stdout, stderr = Terminal(), io.StringIO()
    output = Output(stdout, stderr)

    output.text("data: \x1b[2Jnothing\x07 here")
    output.warn("\x1b[31mnothing")

    assert stdout.getvalue() == "data: \\x1b[2Jnothing\\x07 here\n"
    assert stderr.getvalue() == "\\x1b[31mnothing\n"


def test_a_pipe_gets_values_as_they_are(screen: Any) -> None:
    """A program that reads them wants what was sent."""
    screen.output.text("\x1b[2J")

    assert screen.text == "\x1b[2J\n"


def test_a_row_of_csv_is_one_line() -> None:
    """A line break in a value would start another message."""
    assert csv_line({"a": "one\ntwo\r", "b": [1, 2]}) == "one\\ntwo\\r,1,2"

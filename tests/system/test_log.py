"""The merged log of a system: lines, files, and what is kept for reports."""

from __future__ import annotations

import io
import json
import os
from typing import TYPE_CHECKING

from aionode.system import SystemLog

if TYPE_CHECKING:
    from pathlib import Path


def test_each_line_has_its_time_and_the_name_of_its_member() -> None:
    """A line that comes in parts is one line."""
    stream = io.StringIO()
    log = SystemLog(stream)
    log.add_member("driver")
    log.write("driver", b"one\ntw")
    log.write("driver", b"o\nrest")
    log.close()
    lines = stream.getvalue().splitlines()

    assert [line.partition("driver | ")[2] for line in lines] == ["one", "two", "rest"]
    assert len(lines[0].split()[0]) == len("12:00:00.000")


def test_as_json_each_line_is_a_record() -> None:
    """For programs that read the log."""
    stream = io.StringIO()
    log = SystemLog(stream, json=True)
    log.write("driver", b"one\n\xff\n")
    log.close()
    records = [json.loads(line) for line in stream.getvalue().splitlines()]

    assert [(one["name"], one["text"]) for one in records] == [("driver", "one"), ("driver", "�")]


def test_names_have_colours_on_request() -> None:
    """Two members have two."""
    stream = io.StringIO()
    log = SystemLog(stream, color=True)
    for name in ("a", "b"):
        log.add_member(name)
        log.write(name, b"line\n")
    log.close()

    assert "\x1b[36m     a |\x1b[0m line" in stream.getvalue()
    assert "\x1b[33m     b |\x1b[0m line" in stream.getvalue()


def test_files_are_rotated_and_the_oldest_is_removed(tmp_path: Path) -> None:
    """A robot that runs for a year does not fill its disk."""
    log = SystemLog(io.StringIO(), folder=tmp_path, max_bytes=100, backups=2)
    for number in range(10):
        log.write("driver", b"%040d\n" % number)
    log.close()
    kept = {file.name: file.read_text() for file in tmp_path.iterdir()}

    assert set(kept) == {"driver.log", "driver.log.1", "driver.log.2"}
    assert kept["driver.log"].endswith("9\n")
    assert all(len(text) <= 140 for text in kept.values())


def test_the_last_twenty_lines_of_a_member_are_kept() -> None:
    """They are in the report when it has failed."""
    log = SystemLog(io.StringIO())
    log.write("driver", b"".join(b"%d\n" % number for number in range(100)))

    assert log.last_lines("driver") == [str(number) for number in range(80, 100)]


def test_what_a_pipe_does_not_take_waits_and_blocks_nothing() -> None:
    """Nobody has to read the log for the system to go on."""
    reading, writing = os.pipe()
    with os.fdopen(writing, "w") as stream:
        log = SystemLog(stream)
        log.write("driver", b"x" * 60_000 + b"\n" + b"y" * 60_000 + b"\n")
        assert not log.flush()
        got = b""
        while not log.flush():
            got += os.read(reading, 1 << 16)
        got += os.read(reading, 1 << 16)
        log.close()
    os.close(reading)

    assert (got.count(b"x"), got.count(b"y")) == (60_000, 60_000)

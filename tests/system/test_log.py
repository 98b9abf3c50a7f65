"""The merged log of a system: lines, files, and what is kept for reports."""

from __future__ import annotations

import io
import json
import os
from pathlib import Path

from aionode.system import SystemLog


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

    assert [(record["name"], record["text"]) for record in records] == [
        ("driver", "one"),
        ("driver", "�"),
    ]


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


def test_a_full_disk_is_named_once_and_the_log_goes_on(tmp_path: Path) -> None:
    """The robot runs without its files: its programs would wait for a log that nobody reads."""
    stream = io.StringIO()
    log = SystemLog(stream, folder=tmp_path)
    (tmp_path / "driver.log").symlink_to("/dev/full")
    for _ in range(2):
        log.write("driver", b"line\n")
    log.close()

    assert stream.getvalue().count("driver | line") == 2
    assert stream.getvalue().count("files of the log are incomplete from here on: ") == 1


def test_lines_that_are_read_in_any_pieces_are_the_same_in_stream_and_files(tmp_path: Path) -> None:
    """Large output is read in pieces that end anywhere."""
    lines = [b"", b"a", b"b" * 70_000, b"\r", b"", b"c"]
    text = b"\n".join(lines)
    for size in (1, 2, 3, 1000):
        folder = tmp_path / str(size)
        with (folder.parent / f"{size}.txt").open("w+") as stream:
            log = SystemLog(stream, folder=folder)
            for begin in range(0, len(text), size):
                log.write("x", text[begin : begin + size])
            log.close()
            stream.seek(0)
            shown = Path(stream.name).read_bytes()
        time = len("2026-11-23 12:00:00.000 ")
        kept = (folder / "x.log").read_bytes().split(b"\n")

        assert b"".join(line.partition(b"| ")[2] for line in shown.split(b"\n")) == b"".join(lines)
        assert [len(line) - time for line in kept[:2]] == [0, 1]
        assert b"".join(line[time:] for line in kept) == b"".join(lines)


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

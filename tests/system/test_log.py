"""The merged log of a system: lines, files, and the lines kept for reports."""

from __future__ import annotations

import io
import json
import os
import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.system import SystemLog
from aionode.system._control_codes import has_codes, without_codes


def test_each_line_has_its_time_and_the_name_of_its_member() -> None:
    """A line that arrives in parts is one line."""
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
    """Two members have two colours."""
    stream = io.StringIO()
    log = SystemLog(stream, color=True)
    for name in ("a", "b"):
        log.add_member(name)
        log.write(name, b"line\n")
    log.close()

    assert "\x1b[36m     a |\x1b[0m line" in stream.getvalue()
    assert "\x1b[33m     b |\x1b[0m line" in stream.getvalue()


def test_files_are_rotated_and_the_oldest_is_removed(tmp_path: Path) -> None:
    """A robot that runs for a year must not fill its disk."""
    log = SystemLog(io.StringIO(), folder=tmp_path, max_bytes=100, backups=2)
    for number in range(10):
        log.write("driver", b"%040d\n" % number)
    log.close()
    kept = {file.name: file.read_text() for file in tmp_path.iterdir()}

    assert set(kept) == {"driver.log", "driver.log.1", "driver.log.2"}
    assert kept["driver.log"].endswith("9\n")
    assert all(len(text) <= 140 for text in kept.values())


def test_a_full_disk_is_named_once_and_the_log_goes_on(tmp_path: Path) -> None:
    """Otherwise the robot's programs would block on a log that nobody reads."""
    stream = io.StringIO()
    log = SystemLog(stream, folder=tmp_path)
    (tmp_path / "driver.log").symlink_to("/dev/full")
    for _ in range(2):
        log.write("driver", b"line\n")
    log.close()

    assert stream.getvalue().count("driver | line") == 2
    assert stream.getvalue().count("files of the log are incomplete from here on: ") == 1


def test_lines_that_are_read_in_any_pieces_are_the_same_in_stream_and_files(tmp_path: Path) -> None:
    """Large output is read in chunks that end anywhere."""
    lines = [b"", b"a", b"b" * 70_000, b"\r", b"", b"c"]
    text = b"\n".join(lines)
    all_text = b"".join(lines).replace(b"\r", b"")  # a line that ended as in DOS
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

        assert b"".join(line.partition(b"| ")[2] for line in shown.split(b"\n")) == all_text
        assert [len(line) - time for line in kept[:2]] == [0, 1]
        assert b"".join(line[time:] for line in kept) == all_text


def test_the_last_twenty_lines_of_a_member_are_kept() -> None:
    """They are in the report if it fails."""
    log = SystemLog(io.StringIO())
    log.write("driver", b"".join(b"%d\n" % number for number in range(100)))

    assert log.last_lines("driver") == [str(number) for number in range(80, 100)]


def test_what_a_pipe_does_not_take_waits_and_blocks_nothing() -> None:
    """The system goes on even if nobody reads the log."""
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


@pytest.mark.parametrize(
    ("output", "shown"),
    [
        (b"\x1b[31mred\x1b[0m\n", [b"\x1b[31mred\x1b[0m"]),
        (b"\x1b[1;38:5:9mred\n", [b"\x1b[1;38:5:9mred\x1b[0m"]),
        (b"plain \xc3\xa4\xc2\xa0\ttext\n", [b"plain \xc3\xa4\xc2\xa0\ttext"]),
        (b"ended as in DOS\r\n", [b"ended as in DOS"]),
        (
            b"10 %\r20 %\rforged 12:00 other | line\n",
            [b"10 %", b"20 %", b"forged 12:00 other | line"],
        ),
        (b"\x1b[2K\x1b[1A\x1b[?25l\x1b[2Jup\n", [b"up"]),
        (b"\x1b]0;title\x07\x1b]52;c;Y2xpcA==\x1b\\\x1bPq\x1b\\\x1b(0\x1bcrest\n", [b"rest"]),
        (b"\x1b]0;without an end\n", [b"0;without an end"]),
        (b"bell \x07 \x00 \xc2\x9b2J\n", [b"bell \\x07 \\x00 \\x9b2J"]),
    ],
)
@pytest.mark.parametrize("size", [1, 1000])
def test_of_the_codes_for_terminals_only_colours_pass(
    output: bytes, shown: list[bytes], size: int, tmp_path: Path
) -> None:
    """Others could overwrite other members' lines, retitle the terminal or fill the clipboard."""
    file = tmp_path / "out"
    with file.open("w") as stream:
        log = SystemLog(stream, folder=tmp_path)
        for at in range(0, len(output), size):
            log.write("one", output[at : at + size])
        log.close()

    for path, label in ((file, b" one | "), (tmp_path / "one.log", None)):
        lines = path.read_bytes().splitlines()
        begin = len("12:00:00.000 ") if label else len("2026-11-28 12:00:00.000 ")
        assert [line[begin:].removeprefix(b"   one | ") for line in lines] == shown


@given(st.binary())
def test_no_output_contains_more_than_text_and_colours(output: bytes) -> None:
    """Whatever a program prints."""
    lines = without_codes(output + b"\n")

    text = re.sub(rb"\x1b\[[0-9;:]*m", b"", lines)
    assert not has_codes(text.replace(b"\xc2", b""))
    assert re.search(rb"\xc2[\x80-\x9f]", lines) is None


def test_a_name_of_a_member_stays_on_its_line() -> None:
    """Someone else's launch file may contain any name."""
    stream = io.StringIO()
    log = SystemLog(stream)
    log.write("a\n\x1b[2J", b"text\n")
    log.flush()

    assert stream.getvalue()[13:] == "a\\n\\x1b[2J | text\n"

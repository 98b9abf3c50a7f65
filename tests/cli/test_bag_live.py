"""``aionode bag record``, ``play`` and ``burst``: options, keys and YAML files of rosbag2."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import click
import pexpect
import pytest
from click.testing import CliRunner

from aionode import bag
from aionode.bag._writer import topic_info
from aionode.bag.yaml_files import chunk_compression, outputs_in, static_topics_in
from aionode.cli._main import main, root
from aionode.cli._nouns.bag.live import record_command, recorder_options
from aionode.engine.wire import cdr
from aionode.interfaces.std_msgs.msg import String

Captured = pytest.CaptureFixture[str]


@pytest.fixture
def run(tmp_path: Path) -> str:
    """A bag of two topics with three messages each, 50 ms apart."""
    with bag.BagWriter(tmp_path / "run") as out:
        for name in ("/a", "/b"):
            number = out.add_topic(topic_info(name, String))
            for at in range(3):
                out.write(number, at * 50_000_000 + 1, cdr.encode(String(data=str(at))))
    return str(tmp_path / "run")


def settings(*line: str) -> dict[str, Any]:
    """Return the settings of the recorder that a command line makes."""
    context = record_command.make_context("record", list(line), help_option_names=["-h", "--help"])
    return recorder_options(context.params)


def test_playing_and_bursting_tell_what_was_played(run: str, capsys: Captured) -> None:
    """As a record for programs."""
    assert main(["bag", "play", run, "--rate", "10", "--topics", "/a", "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == {"paths": [run], "played": 3}
    line = ["bag", "burst", "-i", run, "mcap", "-n", "4", "--json"]
    assert main(line) == 0
    assert json.loads(capsys.readouterr().out)["played"] == 4


def test_topics_may_be_named_without_their_option() -> None:
    """As in the tutorials, and in ROS 2 until Jazzy."""
    named = settings("-o", "subset", "/turtle1/cmd_vel", "/turtle1/pose")

    assert named == settings("-o", "subset", "--topics", "/turtle1/cmd_vel", "/turtle1/pose")


def test_the_options_of_rosbag2_are_taken(tmp_path: Path) -> None:
    """A command line that works with ros2 works here."""
    static = tmp_path / "static.yaml"
    static.write_text("static_topics_and_types_list:\n- [/late, std_msgs/msg/String]\n")
    options = settings(
        "--topics", "/a", "/map", "-s", "mcap", "-b", "5000", "--max-bag-files", "3",
        "--storage-preset-profile", "zstd_small", "--repeat-transient-local", "/map=2", "tf_static",
        "--static-topics-path", str(static), "--max-cache-duration", "2.5", "--polling-interval",
        "100", "--compression-threads", "0", "--stats_max_publishing_rate", "2", "--custom-data",
        "robot=r2",
    )  # fmt: skip
    assert options["compression"] == "zstd_small"
    assert options["repeat_latched"] == {"/map": 2, "/tf_static": 0}
    assert options["static_topics"] == {"/late": "std_msgs/msg/String"}
    assert (options["cache_duration_sec"], options["loss_report_hz"]) == (2.5, 2)
    assert options["custom_data"] == {"robot": "r2"}
    both = settings("-a", "--repeat-all-transient-local", "4", "--repeat-transient-local", "/map=1")
    assert both["repeat_latched"] == {"*": 4, "/map": 1}


@pytest.mark.parametrize(
    ("option", "value", "text"),
    [("--storage", "sqlite3", "writes mcap"), ("--compression-mode", "file", "chunks are")],
)
def test_what_is_not_written_is_refused(option: str, value: str, text: str) -> None:
    """Before a robot is recorded in a format other than the requested one."""
    with pytest.raises(click.UsageError, match=text):
        settings("-a", option, value)


def test_new_bags_are_made_as_a_yaml_file_of_rosbag2_says(run: str, tmp_path: Path) -> None:
    """Several from one, each with its topics, its times and its compression."""
    options = tmp_path / "out.yaml"
    options.write_text(
        f"output_bags:\n"
        f"- uri: {tmp_path / 'one'}\n"
        f"  topics: [/a]\n"
        f"  start_time_ns: 50000001\n"
        f"  storage_preset_profile: fastwrite\n"
        f"- uri: {tmp_path / 'two'}\n"
        f"  all: true\n"
        f"  end_time_ns: 50000001\n"
    )
    assert main(["bag", "convert", "-i", run, "-o", str(options)]) == 0
    for name, counts in (("one", {"/a": 2}), ("two", {"/a": 2, "/b": 2})):
        with bag.open(tmp_path / name) as written:
            assert written.counts == counts


def test_a_yaml_file_without_what_it_needs_is_refused(tmp_path: Path) -> None:
    """The error names the file and the key."""
    file = tmp_path / "x.yaml"
    file.write_text("output_bags:\n- storage_id: sqlite3\n  uri: x\n")
    with pytest.raises(ValueError, match="writes mcap"):
        outputs_in(str(file))
    file.write_text("a: [")
    with pytest.raises(ValueError, match="not YAML"):
        static_topics_in(str(file))
    file.write_text("static_topics_and_types_list: [x]")
    with pytest.raises(ValueError, match="static_topics_and_types_list"):
        static_topics_in(str(file))
    file.write_text("compression: Zip")
    with pytest.raises(ValueError, match="Lz4"):
        chunk_compression(None, str(file), "zstd")


@pytest.mark.slow
@pytest.mark.processes
def test_keys_pause_and_step_and_change_the_rate(run: str) -> None:
    """On a terminal, with a line of progress; the terminal is as before afterwards."""
    line = [*f"-m aionode bag play {run} --start-paused".split()]
    environ = {**os.environ, "AIONODE_TRANSPORT": "zenoh"}
    with pexpect.spawn(sys.executable, line, env=environ, timeout=40, encoding="utf-8") as shell:
        shell.expect("Paused  0.0 of 0.1 s, 1 times as fast")
        shell.send("\x1b[A\x1b[A\x1b[B")
        shell.expect("1.1 times as fast")
        shell.send("\x1b[C")
        shell.send(" ")
        shell.expect(pexpect.EOF)
    shell.close()
    assert shell.exitstatus == 0


@pytest.mark.processes
def test_a_recording_ends_with_a_record_of_what_was_lost(tmp_path: Path) -> None:
    """This includes Ctrl-C, which is the usual end."""
    out = tmp_path / "run"
    line = [*f"-m aionode bag record -a --json -o {out}".split()]
    with subprocess.Popen(
        [sys.executable, *line], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        assert process.stderr is not None
        while "Recording to" not in process.stderr.readline():
            assert process.poll() is None
        process.send_signal(2)
        text, _ = process.communicate(timeout=40)
    assert process.returncode == 0
    assert json.loads(text)["path"] == str(out)
    with bag.open(out) as run:
        assert run.losses == {}


def test_help_names_every_option() -> None:
    """It is how users find them."""
    text = CliRunner().invoke(root, ["bag", "record", "--help"]).output
    for option in ("--repeat-transient-local", "--storage-preset-profile", "--static-topics-path"):
        assert option in text

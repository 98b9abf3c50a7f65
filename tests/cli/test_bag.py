"""``aionode bag``: the options of rosbag2, and plain ones where rosbag2 wants a YAML file."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import click
import pytest

from aionode import bag
from aionode.bag._writer import topic_info
from aionode.cli._main import main
from aionode.cli._nouns.bag.options import checked_selection, length_of, overrides
from aionode.clock import Duration
from aionode.engine.wire import cdr
from aionode.interfaces.std_msgs.msg import String
from aionode.qos import ReliabilityPolicy

Captured = pytest.CaptureFixture[str]


@pytest.fixture
def run(tmp_path: Path) -> str:
    """A bag of two topics with three messages each, a second apart."""
    with bag.BagWriter(tmp_path / "run") as out:
        for name in ("/a", "/b"):
            number = out.add_topic(topic_info(name, String))
            for at in range(3):
                out.write(number, (at + 1) * 10**9, cdr.encode(String(data=str(at))))
    return str(tmp_path / "run")


def test_info_prints_topics_and_counts(run: str, capsys: Captured) -> None:
    """For people, and as a record for programs."""
    assert main(["bag", "info", run]) == 0
    assert "Topic: /a | Type: std_msgs/msg/String | Count: 3" in capsys.readouterr().out
    assert main(["bag", "info", run, "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    assert record["message_count"] == 6
    assert record["duration_ns"] == 2 * 10**9


def test_a_piece_is_cut_by_plain_options(run: str, tmp_path: Path) -> None:
    """Several topics follow one option, as in ros2."""
    out = str(tmp_path / "piece")
    line = ["bag", "cut", run, out, "--start", "1s", "--duration", "1s", "--topics", "/a", "/b"]
    assert main(line) == 0
    with bag.open(out) as piece:
        assert piece.counts == {"/a": 1, "/b": 1}


def test_bags_are_merged_and_converted(run: str, tmp_path: Path) -> None:
    """The last name is that of the new bag."""
    both, small = str(tmp_path / "both"), str(tmp_path / "small")
    assert main(["bag", "merge", run, run, both]) == 0
    assert main(["bag", "convert", both, small, "--topics", "a"]) == 0
    with bag.open(small) as smaller:
        assert smaller.counts == {"/a": 6}


def test_check_says_what_it_has_repaired(run: str, capsys: Captured) -> None:
    """One line for each file."""
    file = Path(run) / "run_0.mcap"
    file.write_bytes(file.read_bytes()[:-50])
    assert main(["bag", "info", run]) == 1
    assert "aionode bag check" in capsys.readouterr().err
    assert main(["bag", "check", run]) == 0
    assert "run_0.mcap: repaired" in capsys.readouterr().out
    assert main(["bag", "info", run]) == 0


def test_a_check_that_misses_messages_fails(run: str, capsys: Captured) -> None:
    """It cannot bring them back, and a script that goes on has to know that they are gone."""
    file = Path(run) / "metadata.yaml"
    file.write_text(file.read_text().replace("message_count: 3", "message_count: 5"))
    for _ in range(2):
        assert main(["bag", "check", run]) == 1
        assert "missing, as metadata.yaml counted: /a: 2; /b: 2" in capsys.readouterr().out
        assert main(["bag", "reindex", run]) == 0


def test_metadata_are_written_anew_by_reindex(run: str) -> None:
    """As in rosbag2."""
    (Path(run) / "metadata.yaml").unlink()
    assert main(["bag", "reindex", run]) == 0
    assert main(["bag", "info", run]) == 0


def test_a_bag_that_is_not_there_is_one_clear_line(capsys: Captured) -> None:
    """Without a traceback."""
    assert main(["bag", "info", "/none"]) == 1
    assert capsys.readouterr().err.count("\n") == 1


def test_recording_nothing_in_particular_is_refused(capsys: Captured) -> None:
    """In rosbag2's words."""
    assert main(["bag", "record"]) == 2
    assert "Need to specify at least one option out of --all" in capsys.readouterr().err


def test_lengths_of_time_have_units() -> None:
    """Seconds if there is none."""
    assert length_of("500ms") == Duration(seconds=0.5)
    assert length_of("2min") == Duration(seconds=120)
    assert length_of("1.5") == Duration(seconds=1.5)
    with pytest.raises(click.BadParameter, match="10s"):
        length_of("soon")


def test_qos_overrides_are_read_from_rosbag2s_yaml(tmp_path: Path) -> None:
    """Users have such files."""
    file = tmp_path / "qos.yaml"
    file.write_text("/scan:\n  history: keep_last\n  depth: 7\n  reliability: best_effort\n")
    (profile,) = overrides(str(file)).values()
    assert (profile.depth, profile.reliability) == (7, ReliabilityPolicy.BEST_EFFORT)


def test_all_excludes_what_is_named() -> None:
    """``--all --exclude-topics /a`` is what users type most."""
    values = {
        "everything": True, "topics": (), "services": (), "actions": (), "regex": "",
        "exclude_regex": "", "exclude_topics": ("a",), "exclude_services": (),
        "exclude_actions": (),
    }  # fmt: skip
    selection = checked_selection(values)
    assert selection.wants("/b", "x/msg/X")
    assert selection.wants("/add/_service_event", "x/srv/X_Event")
    assert not selection.wants("/a", "x/msg/X")
    assert not selection.wants("/_hidden", "x/msg/X")


def test_a_missing_extra_is_one_line_that_says_how_to_install_it(
    run: str, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without the extra, the first command of a newcomer would end in a traceback."""
    monkeypatch.delitem(vars(bag), "open")
    monkeypatch.delitem(sys.modules, "aionode.bag._bag")
    monkeypatch.setitem(sys.modules, "mcap", None)
    monkeypatch.delitem(sys.modules, "aionode.bag.files.source")
    monkeypatch.delitem(sys.modules, "mcap.exceptions")
    assert main(["bag", "info", run]) == 1
    text = capsys.readouterr().err
    assert text == "aionode.bag: mcap is not installed; pip install 'aionode[bag]'\n"


def test_a_folder_that_cannot_be_written_is_one_clear_line(
    tmp_path: Path, capsys: Captured
) -> None:
    """Before anything is recorded. Below a file, not even root can create a folder."""
    (tmp_path / "file").touch()
    assert main(["bag", "record", "--all", "-o", str(tmp_path / "file" / "run")]) == 1
    text = capsys.readouterr().err
    assert text.count("\n") == 1
    assert f"{tmp_path / 'file' / 'run'}: cannot be written" in text

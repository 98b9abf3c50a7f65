"""Data sets from demonstrations: read by a reader that is written from LeRobot's source."""

from __future__ import annotations

import json
import multiprocessing
import re
import shutil
import signal
import subprocess
import sys
import textwrap
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pyarrow import parquet

from aionode import image
from aionode.bag import Record, TopicInfo
from aionode.engine.wire import cdr
from aionode.errors import BagError, DatasetError
from aionode.interfaces.std_msgs.msg import Float64MultiArray
from aionode.learn import Limits, check_dataset, export
from aionode.learn._alignment import aligned
from aionode.learn._scan import Collected
from aionode.learn._series import Series
from tests.support.demonstrations import (
    HEIGHT,
    START_NS,
    WIDTH,
    Timing,
    angle,
    column,
    contract,
    demonstration,
)
from tests.support.lerobot_reader import Reader

CAMERA = "observation.images.camera0"


def dataset(tmp_path: Path, *bags: Path, cameras: int = 1, **options: Any) -> Reader:
    """Export bags, and return their data set."""
    options.setdefault("contract", contract(cameras))
    export(tmp_path / "out", bags, jobs=1, **options)
    return Reader(tmp_path / "out")


def shown(pixels: Any) -> int:
    """Return the column up to which a picture is white."""
    return int((pixels[HEIGHT // 2, :, 1] > 128).sum())


@pytest.mark.parametrize("cameras", [1, 2])
def test_a_reader_like_lerobots_reads_all_rows(tmp_path: Path, cameras: int) -> None:
    """With pictures, tasks and numbers of the right types, in several episodes."""
    timings = [Timing(30, late_sec=0.008), Timing(15, phase_sec=0.01)][:cameras]
    wide = contract(cameras, observations=[
        each | {"max_age": 0.1} for each in contract(cameras).to_dict()["observations"]
    ])  # fmt: skip
    bags = [
        demonstration(tmp_path / f"run{number}", cameras=timings, seed=number, length_sec=1)
        for number in range(3)
    ]
    read = dataset(tmp_path, *bags, cameras=cameras, contract=wide)
    assert len(read) == len(read.rows) > 80
    assert len(read.episodes) == 3
    for index in range(0, len(read), 7):
        row = read[index]
        assert row["task"] == "turn the joint"
        assert all(row[key].shape == (HEIGHT, WIDTH, 3) for key in read.cameras)
        assert abs(shown(row[CAMERA]) - column(row["observation.state"][0])) <= 1


def test_times_are_exact_and_true_stamps_are_kept(tmp_path: Path) -> None:
    """Readers compute times from indexes; when it really was is a feature of its own."""
    bag = demonstration(tmp_path / "run", cameras=[Timing(30, jitter_sec=0.004)])
    read = dataset(tmp_path, bag)
    for row in read.rows:
        assert row["timestamp"] == np.float32(row["frame_index"] / 30)
    assert 0 <= read.rows[0]["stamp"] - START_NS / 1e9 < 0.1
    assert read.info["features"]["age"]["names"] == ["/camera0", "/joint_states", "/command"]
    assert all(0 <= age <= 0.05 for row in read.rows for age in row["age"])


def test_a_time_that_no_clock_has_is_the_latest_one() -> None:
    """Bags hold times of 64 bits without a sign; a second message of that time is not after it."""
    found = Collected(contract().actions[0])
    command = Float64MultiArray(data=[0.5])
    info = TopicInfo(name="/command", type="std_msgs/msg/Float64MultiArray")
    for _ in range(2):
        found.take(Record(info, 2**64 - 1, 0, 0, cdr.encode(command)))
    read = found.series()
    assert (read.times.tolist(), read.values.tolist()) == ([2**63 - 1], [[0.5]])
    assert read.backwards == 1


def test_an_action_answers_the_picture_of_its_row(tmp_path: Path) -> None:
    """It is the command as of one period later: that of the row itself was before the picture."""
    read = dataset(tmp_path, demonstration(tmp_path / "run"))
    for row in read.rows:
        commanded_sec = row["stamp"] - START_NS / 1e9 + 1 / 30 - row["age"][2]
        assert row["action"] == pytest.approx(angle(commanded_sec), abs=1e-3)


def test_a_gap_ends_the_episode(tmp_path: Path) -> None:
    """The rows before and after it are not 1/30 s apart."""
    bag = demonstration(tmp_path / "run", cameras=[Timing(30, gaps=[(0.5, 0.8)])])
    read = dataset(tmp_path, bag)
    assert [each["length"] for each in read.episodes] == [
        14,
        35,
    ]  # the first picture is before any joint
    assert check_dataset(tmp_path / "out") == []


def test_a_gap_refuses_the_episode_if_the_contract_says_so(tmp_path: Path) -> None:
    """Then the demonstration is to be repeated."""
    bag = demonstration(tmp_path / "run", cameras=[Timing(30, gaps=[(0.5, 0.8)])])
    with pytest.raises(DatasetError, match=r"refused: 1 gap between rows, the longest of 0\.3"):
        dataset(tmp_path, bag, contract=contract(gap="refuse"))


def test_rows_without_fresh_joints_are_dropped_and_told(tmp_path: Path) -> None:
    """A driver that hung for half a second."""
    bag = demonstration(tmp_path / "run", joints=Timing(100, gaps=[(1.0, 1.5)]))
    result = export(tmp_path / "out", [bag], contract=contract(), jobs=1)
    assert re.search(r"too old for 1\d rows", result.text)
    assert "of the rows between the first and the last are missing" in result.text
    assert result.problems
    assert not export(
        tmp_path / "lax", [bag], contract=contract(), jobs=1, limits=Limits(dropped=0.5)
    ).problems


def test_a_topic_that_is_missing_is_named(tmp_path: Path) -> None:
    """Nothing can be made of such a recording."""
    bag = demonstration(tmp_path / "run", commands=None)
    with pytest.raises(DatasetError, match=r"no bag has a row; .*/command: no messages in the bag"):
        dataset(tmp_path, bag)


def test_a_topic_that_one_bag_of_several_lacks_is_named(tmp_path: Path) -> None:
    """Its task would be missing in the data set; the others make one."""
    bags = [
        demonstration(tmp_path / "whole"),
        demonstration(tmp_path / "deaf", joints=None),
    ]
    result = export(tmp_path / "out", bags, contract=contract(), jobs=1)
    assert result.problems[str(bags[1])][0].startswith("/joint_states: no messages in the bag")


def test_a_topic_of_a_similar_name_is_suggested(tmp_path: Path) -> None:
    """A typing error in the contract is the usual reason."""
    observations = contract().to_dict()["observations"]
    observations[1]["topic"] = "/joint_state"
    bag = demonstration(tmp_path / "run")
    with pytest.raises(DatasetError, match=re.escape("did you mean /joint_states?")):
        dataset(tmp_path, bag, contract=contract(observations=observations))


def test_a_topic_that_is_too_old_for_all_rows_is_named(tmp_path: Path) -> None:
    """The bag has its messages, and still nothing can be made of it."""
    bag = demonstration(tmp_path / "run", joints=Timing(100, gaps=[(0.1, 2.0)]), cameras=[
        Timing(30, gaps=[(0.0, 0.5)])
    ])  # fmt: skip
    with pytest.raises(DatasetError, match=r"no rows; /joint_states: too old for \d+ rows"):
        dataset(tmp_path, bag)


def test_what_a_repair_could_not_save_is_reported(tmp_path: Path) -> None:
    """Without metadata nothing else says that messages are missing."""
    path = demonstration(tmp_path / "run", length_sec=6)
    (file,) = path.glob("*.mcap")
    file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])
    (path / "metadata.yaml").unlink()
    found = export(tmp_path / "out", [path], contract=contract(), jobs=1)
    assert re.search(r"repaired: \d+ bytes could not be saved", found.text)


@pytest.mark.slow
@pytest.mark.parametrize("times", [1, 2])
def test_a_bag_that_was_cut_after_its_recording_says_what_is_missing(
    tmp_path: Path, times: int
) -> None:
    """The first export repairs it, and no later one may take what is left for the whole."""
    path = demonstration(tmp_path / "run", length_sec=6, outcome="success")
    (file,) = path.glob("*.mcap")
    file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])
    for attempt in range(times):
        found = export(tmp_path / f"out{attempt}", [path], contract=contract(), jobs=1)
        assert 30 < found.rows < 150
        assert re.search(r"! /camera0: \d+ messages recorded, but no longer in the bag", found.text)
        assert found.problems


def test_no_bag_of_a_folder_is_left_out(tmp_path: Path) -> None:
    """A bag of SQLite counts, and so does one whose files are missing, which is an error."""
    runs = tmp_path / "runs"
    demonstration(runs / "a", length_sec=0.5)
    (runs / "contract.yaml").touch()
    (runs / "b").mkdir()
    (runs / "b" / "metadata.yaml").touch()
    with pytest.raises(BagError, match="runs/b"):
        export(tmp_path / "out", [runs], contract=contract(), jobs=1)
    shutil.rmtree(runs / "b")
    assert export(tmp_path / "out", [runs], contract=contract(), jobs=1).episodes == 1


@pytest.mark.parametrize("stray", ["old.mcap", "old.db3", "old.mcap.zstd"])
def test_a_file_beside_episodes_does_not_make_their_folder_a_bag(
    tmp_path: Path, stray: str
) -> None:
    """A recording that somebody copied there; it can be named itself."""
    runs = tmp_path / "runs"
    demonstration(runs / "a", length_sec=0.5)
    (runs / stray).touch()
    assert export(tmp_path / "out", [runs], contract=contract(), jobs=1).episodes == 1


def test_topics_that_arrive_late_are_aligned_by_their_stamps(tmp_path: Path) -> None:
    """The camera's driver takes 40 ms, the joints' 2 ms."""
    bag = demonstration(
        tmp_path / "run",
        cameras=[Timing(30, late_sec=0.040)],
        joints=Timing(100, phase_sec=0.003, late_sec=0.002),
    )
    read = dataset(tmp_path, bag)
    for index in range(len(read)):
        row = read[index]
        at = angle(row["stamp"] - START_NS / 1e9)
        assert row["observation.state"][0] == pytest.approx(at, abs=1e-4)
        assert abs(shown(row[CAMERA]) - column(at)) <= 1


def test_a_slow_camera_is_reported(tmp_path: Path) -> None:
    """Its pictures would be played too fast."""
    bag = demonstration(tmp_path / "run", cameras=[Timing(24)])
    result = export(tmp_path / "out", [bag], contract=contract(), jobs=1)
    assert "rows at 24.00 Hz, and fps is 30: they would be played too fast" in result.text


def test_a_fast_camera_makes_a_row_of_every_second_picture(tmp_path: Path) -> None:
    """A contract may ask for fewer frames than the camera has."""
    bag = demonstration(tmp_path / "run", cameras=[Timing(60, jitter_sec=0.002)])
    result = export(tmp_path / "out", [bag], contract=contract(), jobs=1)
    assert result.problems == {}
    assert 55 <= result.rows <= 60


def test_compressed_pictures_are_read(tmp_path: Path) -> None:
    """As most cameras publish them."""
    observations = contract().to_dict()["observations"]
    observations[0]["type"] = "sensor_msgs/msg/CompressedImage"
    bag = demonstration(tmp_path / "run", wrap=lambda each: image.compress(each, "png"))
    read = dataset(tmp_path, bag, contract=contract(observations=observations))
    row = read[30]
    assert abs(shown(row[CAMERA]) - column(row["observation.state"][0])) <= 1


def test_depths_survive_to_a_hundredth(tmp_path: Path) -> None:
    """In LeRobot's scale of 12 bits, without losses by the codec."""
    observations = contract().to_dict()["observations"]
    observations[0] |= {"image": "depth", "feature": "observation.images.depth"}

    def depths(sec: float) -> Any:
        return np.full((HEIGHT, WIDTH, 3), 0, np.uint8) + np.uint8(sec * 10)

    def as_depth(shown: Any) -> Any:
        metres = image.to_numpy(shown)[..., 0].astype(np.float32) / 10 + 0.5
        return image.from_numpy(metres, "32FC1", header=shown.header)

    bag = demonstration(tmp_path / "run", draw=depths, wrap=as_depth)
    read = dataset(tmp_path, bag, contract=contract(observations=observations))
    info = read.info["features"]["observation.images.depth"]
    assert info["shape"] == [HEIGHT, WIDTH, 1]
    assert info["info"]["is_depth_map"]
    low, high = np.log(3.51), np.log(13.5)
    for index in range(len(read)):
        row = read[index]
        metres = np.exp(row["observation.images.depth"][0, 0] / 4095 * (high - low) + low) - 3.5
        sec = row["stamp"] - START_NS / 1e9
        assert metres == pytest.approx(int(sec * 10 + 1e-6) / 10 + 0.5, abs=0.11)
    assert read.stats["observation.images.depth"]["min"] == [[[pytest.approx(0.5, abs=0.01)]]]


def test_a_topic_may_be_named_without_its_slash(tmp_path: Path) -> None:
    """As nodes name them."""
    observations = contract().to_dict()["observations"]
    for each in observations:
        each["topic"] = each["topic"].removeprefix("/")
    bag = demonstration(tmp_path / "run", length_sec=0.5)
    assert len(dataset(tmp_path, bag, contract=contract(observations=observations))) == 13


def test_av1_is_an_option(tmp_path: Path) -> None:
    """LeRobot's own default: smaller files for more work."""
    read = dataset(tmp_path, demonstration(tmp_path / "run", length_sec=1), codec="av1")
    assert read.info["features"][CAMERA]["info"]["video.codec"] == "av1"
    assert abs(shown(read[20][CAMERA]) - column(read[20]["observation.state"][0])) <= 1


def test_an_export_resumes_where_it_was_interrupted(tmp_path: Path) -> None:
    """Hours of encoding are not done again."""
    bags = [demonstration(tmp_path / f"run{number}", length_sec=0.5) for number in range(2)]

    def interrupt(done: int, whole: int) -> None:
        if done > 0.6 * whole:
            raise InterruptedError

    with pytest.raises(InterruptedError):
        export(tmp_path / "out", bags, contract=contract(), jobs=1, progress=interrupt)
    (part,) = (tmp_path / "out").rglob("part.json")
    before = next(part.parent.glob("*.mp4")).stat().st_ino
    read = dataset(tmp_path, *bags)
    assert len(read.episodes) == 2
    first = tmp_path / "out/videos" / CAMERA / "chunk-000/file-000.mp4"
    assert first.stat().st_ino == before


def test_a_data_set_is_not_overwritten(tmp_path: Path) -> None:
    """It may be the only one."""
    bag = demonstration(tmp_path / "run", length_sec=0.5)
    dataset(tmp_path, bag)
    with pytest.raises(DatasetError, match="it exists already; give another name"):
        dataset(tmp_path, bag)


def test_a_folder_with_other_files_is_left_alone(tmp_path: Path) -> None:
    """A data set among them could not be removed as a whole, and might replace some."""
    bag = demonstration(tmp_path / "run", length_sec=0.5)
    kept = tmp_path / "out/data/precious"
    kept.parent.mkdir(parents=True)
    kept.touch()
    with pytest.raises(DatasetError, match="the folder has other files; give the name of a new"):
        dataset(tmp_path, bag)
    assert [each for each in (tmp_path / "out").rglob("*") if each.is_file()] == [kept]
    with pytest.raises(DatasetError, match="a file has this name"):
        export(kept, [bag], contract=contract())


def test_a_bag_that_is_given_twice_is_exported_once(tmp_path: Path) -> None:
    """As one of its folder, and by its name: its episodes would count double."""
    bag = demonstration(tmp_path / "runs/a", length_sec=0.5)
    assert len(dataset(tmp_path, tmp_path / "runs", bag).episodes) == 1


@pytest.mark.slow
def test_two_exports_do_not_write_one_folder(tmp_path: Path) -> None:
    """The second one would replace files that the first one writes."""
    bag = demonstration(tmp_path / "run", length_sec=0.5)

    def again(done: int, whole: int) -> None:
        del done, whole
        with pytest.raises(DatasetError, match="another export is writing it; wait until it has"):
            export(tmp_path / "out", [bag], contract=contract(), jobs=1)

    found = export(tmp_path / "out", [bag], contract=contract(), jobs=1, progress=again)
    assert found.rows == 13


KILLED = textwrap.dedent("""
    import os, signal, sys
    from aionode.learn import _export, export
    from tests.support.demonstrations import contract

    place, out, codec, *bags = sys.argv[1:]
    count = 0

    def die(*_):
        os.kill(os.getpid(), signal.SIGKILL)

    def progress(done, whole):
        if place.isdigit() and done >= int(place) / 100 * whole:
            die()

    if not place.isdigit():
        setattr(_export, place, die)
    export(out, bags, contract=contract(), codec=codec, jobs=1, progress=progress)
""")


@pytest.mark.processes
@pytest.mark.parametrize(
    ("index", "fits"), [("task", True), ("task_index", False), (None, False)], ids=str
)
def test_the_tasks_are_an_index_of_any_name(tmp_path: Path, index: str | None, fits: bool) -> None:
    """LeRobot 0.6 calls it ``task`` itself; its loader gives it that name."""
    bags = [demonstration(tmp_path / "run", length_sec=1)]
    export(tmp_path / "out", bags, contract=contract(), task="turn it", jobs=1)
    path = tmp_path / "out/meta/tasks.parquet"
    tasks = parquet.read_table(path).rename_columns(["task_index", "task"])
    pandas = json.dumps({"index_columns": [] if index is None else [index]})
    parquet.write_table(tasks.replace_schema_metadata({"pandas": pandas}), path)
    found = check_dataset(str(tmp_path / "out"))
    assert found == ([] if fits else [
        "meta/tasks.parquet: the text of the tasks is not the index of pandas"
    ])  # fmt: skip


@pytest.mark.slow
@pytest.mark.processes
@pytest.mark.parametrize("place", ["10", "45", "70", "write_dataset", "check_dataset"])
def test_a_killed_export_resumes(tmp_path: Path, place: str) -> None:
    """Wherever it was, also with another codec and other bags than before: they leave nothing."""
    bags = [
        demonstration(tmp_path / f"run{number}", length_sec=0.5, seed=number) for number in range(3)
    ]
    out = tmp_path / "out"
    for codec in ("av1", "h264"):
        killed = subprocess.run(
            [sys.executable, "-c", KILLED, place, out, codec, *bags], check=False
        )
        assert killed.returncode == -signal.SIGKILL
    assert export(out, bags[:2], contract=contract(), jobs=1).rows == 26
    assert check_dataset(out) == []
    assert len(list(out.rglob("*.mp4"))) == 2
    assert sorted(each.name for each in out.iterdir()) == ["data", "meta", "videos"]
    assert Reader(out).info["features"][CAMERA]["info"]["video.codec"] == "h264"


@pytest.mark.slow
@pytest.mark.processes
def test_several_bags_are_converted_at_the_same_time(tmp_path: Path) -> None:
    """With progress that ends at the whole."""
    bags = [
        demonstration(tmp_path / f"run{number}", length_sec=0.5, recorded_with=contract())
        for number in range(2)
    ]
    told: list[tuple[int, int]] = []
    result = export(tmp_path / "out", bags, jobs=2, progress=lambda *each: told.append(each))
    assert result.episodes == 2
    assert told[-1][0] <= told[-1][1]


@pytest.mark.slow
@pytest.mark.processes
def test_a_process_of_an_export_that_was_killed_is_one_sentence(tmp_path: Path) -> None:
    """As for lack of memory: the others' work stays, and one job at a time needs less."""
    bags = [demonstration(tmp_path / f"run{sec}", length_sec=sec) for sec in (0.2, 4.0)]

    def kill(done: int, whole: int) -> None:
        del done, whole
        for child in multiprocessing.active_children():
            child.kill()

    with pytest.raises(DatasetError, match="a process of the export ended early: it was killed"):
        export(tmp_path / "out", bags, contract=contract(), jobs=2, progress=kill)
    assert export(tmp_path / "out", bags, contract=contract(), jobs=1).episodes == 2


def test_a_check_finds_a_video_with_a_frame_too_few(tmp_path: Path) -> None:
    """LeRobot does not: it would show each later picture one row early."""
    bags = [
        demonstration(tmp_path / f"run{number}", length_sec=0.5 + number / 30)
        for number in range(2)
    ]
    dataset(tmp_path, *bags)
    folder = tmp_path / "out/videos" / CAMERA / "chunk-000"
    shutil.copy(folder / "file-000.mp4", folder / "file-001.mp4")
    assert "13 frames for 14 rows" in check_dataset(tmp_path / "out")[0]


def test_a_bag_of_another_contract_is_refused(tmp_path: Path) -> None:
    """Their columns differ."""
    bags = [
        demonstration(tmp_path / "a", length_sec=0.5, recorded_with=contract()),
        demonstration(tmp_path / "b", length_sec=0.5, recorded_with=contract(fps=15)),
    ]
    with pytest.raises(DatasetError, match="recorded with a different contract"):
        export(tmp_path / "out", bags)


def test_an_export_is_checked(tmp_path: Path) -> None:
    """The report says what became of the messages, as numbers and in plain words."""
    bags = [demonstration(tmp_path / "run", length_sec=1)]
    exported = export(tmp_path / "out", bags, contract=contract(), task="turn it", jobs=1)
    assert exported.problems == {}, exported.text
    assert check_dataset(tmp_path / "out") == []


# Alignment


def series(times_sec: Any, values: Any = None) -> Series:
    """Return messages at times."""
    times = np.unique(np.round(np.asarray(times_sec) * 1e9).astype(np.int64))
    columns = np.zeros((len(times), 0)) if values is None else values(times / 1e9)
    return Series(times, times, columns, np.arange(len(times)))


def test_a_command_of_every_period_is_taken_once() -> None:
    """A simulation commands exactly once a picture, at times rounded to nanoseconds."""
    times = np.arange(100) / 30
    rows = aligned(
        contract(),
        [
            series(times),
            series(times, lambda each: np.stack([each, each], axis=1)),
            series(times, lambda each: np.round(each * 30)[:, None]),
        ],
    )
    assert np.diff(rows.values[2][:98, 0]).tolist() == [1.0] * 97

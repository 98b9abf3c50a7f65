"""Data sets in LeRobot's format v3.0: put together from episodes, and checked.

LeRobot's own reader demands columns of exactly the types in ``meta/info.json``,
episodes numbered without gaps, times of exactly index / fps, and a video frame at each of
those times.
"""

from __future__ import annotations

import json
import os
import shutil
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import av
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from aionode.learn._video import (
    CODECS,
    DEPTH_MAX,
    DEPTH_MIN,
    DEPTH_SHIFT,
    KEY_FRAMES,
    frame_times,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from aionode.learn.contract import Contract, Feature

__all__ = ["INFO", "Episode", "check_dataset", "write_dataset"]

INFO: Final = "meta/info.json"
"""The file that is written last: a data set that has it is complete."""

CHUNK: Final = 1000
"""Maximum files in a folder."""

DATA_MB: Final = 100
"""The size of a file of rows after which another one begins."""

DATA_PATH: Final = "data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet"
VIDEO_PATH: Final = "videos/{video_key}/chunk-{chunk_index:03d}/file-{file_index:03d}.mp4"
EPISODES_PATH: Final = "meta/episodes/chunk-000/file-000.parquet"

TOLERANCE: Final = 1e-4
"""Maximum seconds between a frame and the time of its row."""

INDEXES: Final = ("frame_index", "episode_index", "index", "task_index")


@dataclass(frozen=True, slots=True)
class Episode:
    """An episode of a part of a data set.

    Attributes:
        folder: The folder of the part.
        task: What the robot did.
        rows: How many rows it has.
        file: The file of its rows.
        videos: The file of each of its videos.
        stats: Its statistics by feature.
    """

    folder: Path
    task: str
    rows: int
    file: str
    videos: dict[str, str]
    stats: dict[str, dict[str, Any]]


def write_dataset(out: Path, contract: Contract, episodes: list[Episode], codec: str) -> None:
    """Put a data set together from episodes, in the given order.

    Files left by an interrupted export are removed: they may be of other episodes.
    """
    (out / INFO).unlink(missing_ok=True)
    for name in ("data", "meta", "videos"):
        shutil.rmtree(out / name, ignore_errors=True)
    tasks = list(dict.fromkeys(each.task for each in episodes))
    (out / INFO).parent.mkdir(parents=True, exist_ok=True)
    rows = Rows(out, tasks)
    listed = []
    for number, episode in enumerate(episodes):
        listed.append(rows.add(number, episode) | link_videos(out, number, episode, contract.fps))
    rows.close()
    write_tasks(out, tasks)
    write_episodes(out, episodes, listed)
    stats = {name: merged([each.stats[name] for each in episodes]) for name in episodes[0].stats}
    write_json(out / "meta/stats.json", stats | merged_indexes(listed, tasks, episodes))
    write_json(out / INFO, info_of(contract, episodes, tasks, codec))


def write_json(path: Path, content: object) -> None:
    """Write a file atomically: it has all of its content or does not exist."""
    new = path.with_name(f"{path.name}.new")
    new.write_text(json.dumps(content, indent=4))
    new.replace(path)


def info_of(
    contract: Contract, episodes: list[Episode], tasks: list[str], codec: str
) -> dict[str, Any]:
    """Return the content of ``meta/info.json``."""
    return {
        "codebase_version": "v3.0",
        "fps": contract.fps,
        "features": features_of(contract, codec),
        "total_episodes": len(episodes),
        "total_frames": sum(each.rows for each in episodes),
        "total_tasks": len(tasks),
        "chunks_size": CHUNK,
        "data_files_size_in_mb": DATA_MB,
        "video_files_size_in_mb": 200,
        "data_path": DATA_PATH,
        "video_path": VIDEO_PATH if any(each.videos for each in episodes) else None,
        "robot_type": contract.robot or None,
        "splits": {"train": f"0:{len(episodes)}"},
    }


def features_of(contract: Contract, codec: str) -> dict[str, Any]:
    """Return the features of ``meta/info.json``, with those that every data set has."""
    found = {
        name: video_feature(each, contract.fps, codec)
        if each.kind != "numbers"
        else {"dtype": "float32", "shape": list(each.shape), "names": list(each.labels)}
        for name, each in contract.features.items()
    }
    topics = [each.topic for each in contract.entries]
    ages = [
        topic if topics.count(topic) == 1 else f"{each.feature}:{topic}"
        for topic, each in zip(topics, contract.entries, strict=True)
    ]
    found["stamp"] = {"dtype": "float64", "shape": [1], "names": ["seconds"]}
    found["age"] = {"dtype": "float32", "shape": [len(ages)], "names": ages}
    found["timestamp"] = {"dtype": "float32", "shape": [1], "names": None}
    return found | {name: {"dtype": "int64", "shape": [1], "names": None} for name in INDEXES}


def video_feature(feature: Feature, fps: int, codec: str) -> dict[str, Any]:
    """Return the entry of an image feature."""
    is_depth = feature.kind == "depth"
    chosen = "depth" if is_depth else codec
    channels = 1 if is_depth else 3  # grey images are decoded to three equal channels
    info: dict[str, Any] = {
        "video.height": feature.shape[0],
        "video.width": feature.shape[1],
        "video.codec": {"h264": "h264", "av1": "av1", "depth": "hevc"}[chosen],
        "video.pix_fmt": CODECS[chosen][1],
        "video.fps": fps,
        "video.channels": channels,
        "video.g": KEY_FRAMES,
        "is_depth_map": is_depth,
        "has_audio": False,
    }
    if is_depth:
        info |= {
            "depth_unit": "m",
            "video.depth_min": DEPTH_MIN,
            "video.depth_max": DEPTH_MAX,
            "video.shift": DEPTH_SHIFT,
            "video.use_log": True,
        }
    return {
        "dtype": "video",
        "shape": [*feature.shape[:2], channels],
        "names": ["height", "width", "channels"],
        "info": info,
    }


class Rows:
    """The files of rows: a row group for each episode, so that one can be read by itself."""

    def __init__(self, out: Path, tasks: list[str]) -> None:
        self.out = out
        self.tasks = tasks
        self.first = 0
        self.file = -1
        self.path = out
        self.writer: pq.ParquetWriter | None = None

    def add(self, number: int, episode: Episode) -> dict[str, Any]:
        """Add the rows of an episode, and return their location."""
        table = pq.read_table(episode.folder / episode.file)
        count = len(table)
        ends = self.first + count
        for name, values in (
            ("episode_index", np.full(count, number)),
            ("index", np.arange(self.first, ends)),
            ("task_index", np.full(count, self.tasks.index(episode.task))),
        ):
            table = table.append_column(name, pa.array(values.astype(np.int64)))
        if self.writer is None or self.path.stat().st_size > DATA_MB << 20:
            self.open(table.schema)
        assert self.writer is not None  # noqa: S101  # opened above
        self.writer.write_table(table)
        chunk, file = divmod(self.file, CHUNK)
        found = {
            "data/chunk_index": chunk,
            "data/file_index": file,
            "dataset_from_index": self.first,
            "dataset_to_index": ends,
        }
        self.first = ends
        return found

    def open(self, schema: pa.Schema) -> None:
        """Begin another file."""
        self.close()
        self.file += 1
        chunk, file = divmod(self.file, CHUNK)
        self.path = self.out / DATA_PATH.format(chunk_index=chunk, file_index=file)
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self.writer = pq.ParquetWriter(self.path, schema, compression="snappy")

    def close(self) -> None:
        """End the file."""
        if self.writer is not None:
            self.writer.close()


def link_videos(out: Path, number: int, episode: Episode, fps: int) -> dict[str, Any]:
    """Put the videos of an episode in place, and return their metadata."""
    chunk, file = divmod(number, CHUNK)
    found: dict[str, Any] = {}
    for name, source in episode.videos.items():
        place = out / VIDEO_PATH.format(video_key=name, chunk_index=chunk, file_index=file)
        place.parent.mkdir(parents=True, exist_ok=True)
        place.unlink(missing_ok=True)
        try:
            os.link(episode.folder / source, place)
        except OSError:  # the file system has no links
            shutil.copyfile(episode.folder / source, place)
        found |= {
            f"videos/{name}/chunk_index": chunk,
            f"videos/{name}/file_index": file,
            f"videos/{name}/from_timestamp": 0.0,
            f"videos/{name}/to_timestamp": episode.rows / fps,
        }
    return found


def write_tasks(out: Path, tasks: list[str]) -> None:
    """Write the tasks; readers expect their text as the pandas index."""
    table = pa.table({"task_index": pa.array(range(len(tasks)), pa.int64()), INDEX: tasks})
    columns = [
        {"name": "task_index", "field_name": "task_index", "pandas_type": "int64",
         "numpy_type": "int64", "metadata": None},
        {"name": None, "field_name": INDEX, "pandas_type": "unicode",
         "numpy_type": "object", "metadata": None},
    ]  # fmt: skip
    pandas = {
        "index_columns": [INDEX],
        "column_indexes": [],
        "columns": columns,
        "creator": {"library": "pyarrow", "version": pa.__version__},
        "pandas_version": "2.0.0",
    }
    pq.write_table(
        table.replace_schema_metadata({"pandas": json.dumps(pandas)}), out / "meta/tasks.parquet"
    )


INDEX: Final = "__index_level_0__"
"""The name that pandas gives the column of an unnamed index."""


def write_episodes(out: Path, episodes: list[Episode], listed: list[dict[str, Any]]) -> None:
    """Write a row for each episode: where it is, and its statistics."""
    columns: dict[str, Any] = {
        "episode_index": pa.array(range(len(episodes)), pa.int64()),
        "tasks": [[each.task] for each in episodes],
        "length": pa.array([each.rows for each in episodes], pa.int64()),
    }
    columns |= {name: [each[name] for each in listed] for name in listed[0]}
    for feature, stats in episodes[0].stats.items():
        for name in stats:
            columns[f"stats/{feature}/{name}"] = [each.stats[feature][name] for each in episodes]
    for name in ("chunk_index", "file_index"):
        columns[f"meta/episodes/{name}"] = pa.array([0] * len(episodes), pa.int64())
    path = out / EPISODES_PATH
    path.parent.mkdir(parents=True, exist_ok=True)
    pq.write_table(pa.table(columns), path)


def merged(stats: list[dict[str, Any]]) -> dict[str, Any]:
    """Return the statistics of all episodes; for quantiles, bounds as in LeRobot."""
    stacked = {name: np.array([each[name] for each in stats], np.float64) for name in stats[0]}
    counts = stacked["count"].reshape(len(stats), *[1] * (stacked["mean"].ndim - 1))
    total = counts.sum()
    mean = (stacked["mean"] * counts).sum(0) / total
    spread = ((stacked["std"] ** 2 + (stacked["mean"] - mean) ** 2) * counts).sum(0) / total
    found = {
        "min": stacked["min"].min(0),
        "max": stacked["max"].max(0),
        "mean": mean,
        "std": np.sqrt(spread),
        **{name: stacked[name].min(0) for name in ("q01", "q10", "q50")},
        **{name: stacked[name].max(0) for name in ("q90", "q99")},
    }
    return {name: each.tolist() for name, each in found.items()} | {"count": [int(total)]}


def merged_indexes(
    listed: list[dict[str, Any]], tasks: list[str], episodes: list[Episode]
) -> dict[str, Any]:
    """Return the statistics of the columns that only the whole data set has."""
    counts = np.array([each.rows for each in episodes])
    values = {
        "episode_index": np.repeat(np.arange(len(episodes)), counts),
        "index": np.arange(listed[-1]["dataset_to_index"]),
        "task_index": np.repeat([tasks.index(each.task) for each in episodes], counts),
    }
    return {
        name: {
            "min": [int(each.min())],
            "max": [int(each.max())],
            "mean": [float(each.mean())],
            "std": [float(each.std())],
            "count": [len(each)],
            **{f"q{q:02d}": [float(np.percentile(each, q))] for q in (1, 10, 50, 90, 99)},
        }
        for name, each in values.items()
    }


# Checking


def check_dataset(out: str | os.PathLike[str]) -> list[str]:
    """Read a data set back, and return what would break LeRobot's reader; empty if nothing does.

    Unlike that reader, it checks that a video has exactly as many frames as its episode has rows;
    otherwise all later images would belong to other rows.
    """
    out = Path(out)
    try:
        info = json.loads((out / INFO).read_text())
        rows = pq.read_table(out / "data")
        episodes = pq.read_table(out / EPISODES_PATH).to_pylist()
        tasks = pq.read_table(out / "meta/tasks.parquet")
        stats = json.loads((out / "meta/stats.json").read_text())
    except (OSError, ValueError, pa.ArrowException) as error:
        return [f"cannot be read: {error}"]
    return [
        *check_info(info, episodes, tasks, rows, stats),
        *check_columns(info, rows),
        *check_rows(info, episodes, rows),
        *check_videos(out, info, episodes),
    ]


def check_info(
    info: dict[str, Any],
    episodes: list[dict[str, Any]],
    tasks: pa.Table,
    rows: pa.Table,
    stats: dict[str, Any],
) -> Iterator[str]:
    """Yield what disagrees with the totals and names in ``info.json``."""
    if info["codebase_version"] != "v3.0":
        yield f"{INFO}: codebase_version {info['codebase_version']}"
    for name, count in (("episodes", len(episodes)), ("frames", len(rows)), ("tasks", len(tasks))):
        if info[f"total_{name}"] != count:
            yield f"{INFO}: total_{name} {info[f'total_{name}']}, but {count} are there"
    pandas = json.loads((tasks.schema.metadata or {}).get(b"pandas", b"{}"))
    index = pandas.get("index_columns", [])  # LeRobot 0.4 has no name for it, and 0.6 ``task``
    if len(index) != 1 or index[0] not in set(tasks.column_names) - {"task_index"}:
        yield "meta/tasks.parquet: the text of the tasks is not the index of pandas"
    for name, feature in info["features"].items():
        if "/" in name:
            yield f"{INFO}: {name}: a name with a slash"
        if name not in stats:
            yield f"meta/stats.json: nothing about {name}"
        elif feature["dtype"] == "video":
            shape = np.shape(stats[name]["mean"])
            if shape != (feature["shape"][2], 1, 1):
                yield f"meta/stats.json: {name}: the mean has the shape {shape}"


def check_columns(info: dict[str, Any], rows: pa.Table) -> Iterator[str]:
    """Yield the columns that do not match ``info.json``."""
    wanted = {
        name: pa.list_(pa.type_for_alias(DTYPES[each["dtype"]]), each["shape"][0])
        if each["shape"] != [1]
        else pa.type_for_alias(DTYPES[each["dtype"]])
        for name, each in info["features"].items()
        if each["dtype"] != "video"
    }
    for name in wanted.keys() - set(rows.column_names):
        yield f"data: no column {name}"
    for field in rows.schema:
        if field.type != wanted.get(field.name):
            yield f"data: the column {field.name} is {field.type}, not {wanted.get(field.name)}"
        elif rows[field.name].null_count:
            yield f"data: the column {field.name} has missing values"


DTYPES: Final = {"float32": "float", "float64": "double", "int64": "int64"}
"""The names of types as Arrow spells them."""


def check_rows(
    info: dict[str, Any], episodes: list[dict[str, Any]], rows: pa.Table
) -> Iterator[str]:
    """Yield where numbers or times differ from those that readers compute."""
    numbers = {name: rows[name].to_numpy() for name in (*INDEXES, "timestamp")}
    if not np.array_equal(numbers["index"], np.arange(len(rows))):
        yield "data: index does not count the rows"
    first = 0
    for number, episode in enumerate(episodes):
        name = f"episode {number}"
        span = slice(episode["dataset_from_index"], episode["dataset_to_index"])
        length = span.stop - span.start
        if episode["episode_index"] != number or span.start != first:
            yield f"{name}: it is numbered {episode['episode_index']}, from row {span.start}"
        if length != episode["length"] or not length:
            yield f"{name}: length {episode['length']}, with {length} rows"
        if not (numbers["episode_index"][span] == number).all():
            yield f"{name}: its rows belong to another episode"
        frames = np.arange(length)
        if not np.array_equal(numbers["frame_index"][span], frames):
            yield f"{name}: frame_index does not count its rows"
        elif np.abs(numbers["timestamp"][span] - frames / info["fps"]).max(initial=0) > TOLERANCE:
            yield f"{name}: timestamp is not frame_index / fps"
        first = span.stop


def check_videos(out: Path, info: dict[str, Any], episodes: list[dict[str, Any]]) -> Iterator[str]:
    """Yield the videos that do not have exactly one frame for each row, at its time."""
    keys = [name for name, each in info["features"].items() if each["dtype"] == "video"]
    for number, episode in enumerate(episodes):
        for key in keys:
            path = info["video_path"].format(
                video_key=key,
                chunk_index=episode[f"videos/{key}/chunk_index"],
                file_index=episode[f"videos/{key}/file_index"],
            )
            try:
                yield from check_video(out / path, info, key, episode)
            except (OSError, av.FFmpegError) as error:
                yield f"episode {number}: {path}: {error}"


def check_video(
    path: Path, info: dict[str, Any], key: str, episode: dict[str, Any]
) -> Iterator[str]:
    """Yield what is wrong with one video of an episode."""
    first = Fraction(episode[f"videos/{key}/from_timestamp"])
    end = Fraction(episode[f"videos/{key}/to_timestamp"])
    tolerance = Fraction(TOLERANCE)
    times = [
        each - first for each in frame_times(path) if first - tolerance <= each < end - tolerance
    ]
    if len(times) != episode["length"]:
        yield f"{path}: {len(times)} frames for {episode['length']} rows"
        return
    if any(abs(time * info["fps"] - row) > tolerance for row, time in enumerate(times)):
        yield f"{path}: its frames are not 1/{info['fps']} s apart"
    with av.open(str(path)) as container:
        frame = next(container.decode(video=0), None)
        shape = list(info["features"][key]["shape"][:2])
        if frame is None or [frame.height, frame.width] != shape:
            yield f"{path}: its pictures are not {shape[1]} by {shape[0]}"

"""Reads data sets like LeRobot 0.6, as its source does, without torch and its 8 GB.

It has the same requirements: the types of columns are those in ``info.json``, the row of an episode
is found by its position, and each frame of a video by its time within 0.1 ms.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import av
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

TOLERANCE_SEC = 1e-4


class Reader:
    """A data set, by index: each item has the values of a row and its pictures."""

    def __init__(self, root: Path) -> None:
        self.root = root
        self.info: dict[str, Any] = json.loads((root / "meta/info.json").read_text())
        assert self.info["codebase_version"] == "v3.0"
        self.stats = json.loads((root / "meta/stats.json").read_text())
        tasks = pq.read_table(root / "meta/tasks.parquet")
        described = json.loads(tasks.schema.metadata[b"pandas"])
        self.tasks = tasks[described["index_columns"][0]].to_pylist()
        self.episodes = pa.concat_tables(
            [pq.read_table(file) for file in sorted((root / "meta/episodes").glob("*/*.parquet"))]
        ).to_pylist()
        schema = pa.schema({name: arrow(each) for name, each in self.columns.items()})
        files = sorted((root / "data").glob("*/*.parquet"))
        self.rows = pa.concat_tables(
            [pq.read_table(file).select(schema.names).cast(schema) for file in files]
        ).to_pylist()
        self.videos: dict[Path, tuple[Any, Any]] = {}

    @property
    def columns(self) -> dict[str, Any]:
        """The features that are columns."""
        found = self.info["features"].items()
        return {name: each for name, each in found if each["dtype"] != "video"}

    @property
    def cameras(self) -> list[str]:
        """The features that are videos."""
        return [name for name in self.info["features"] if name not in self.columns]

    def __len__(self) -> int:
        return int(self.info["total_frames"])

    def __getitem__(self, index: int) -> dict[str, Any]:
        row = dict(self.rows[index])
        episode = self.episodes[row["episode_index"]]
        row["task"] = self.tasks[row["task_index"]]
        for key in self.cameras:
            path = self.info["video_path"].format(
                video_key=key,
                chunk_index=episode[f"videos/{key}/chunk_index"],
                file_index=episode[f"videos/{key}/file_index"],
            )
            wanted = episode[f"videos/{key}/from_timestamp"] + row["timestamp"]
            times, pictures = self.video(self.root / path)
            nearest = int(np.abs(times - wanted).argmin())
            assert abs(times[nearest] - wanted) < TOLERANCE_SEC, (path, wanted, times[nearest])
            row[key] = pictures[nearest]
        return row

    def video(self, path: Path) -> tuple[Any, Any]:
        """Return the times and pictures of a video."""
        if path not in self.videos:
            with av.open(str(path)) as container:
                frames: list[Any] = list(container.decode(video=0))
            is_depth = frames[0].format.name == "gray12le"
            self.videos[path] = (
                np.array([float(frame.pts * frame.time_base) for frame in frames]),
                [frame.to_ndarray(format="gray12le" if is_depth else "rgb24") for frame in frames],
            )
        return self.videos[path]


def arrow(feature: dict[str, Any]) -> pa.DataType:
    """Return the type of a column, as the reader derives it from a feature."""
    types = {"float32": pa.float32(), "float64": pa.float64(), "int64": pa.int64()}
    value = types[feature["dtype"]]
    return value if feature["shape"] == [1] else pa.list_(value, feature["shape"][0])

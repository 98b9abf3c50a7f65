"""Converts one bag to a part of a data set: its episodes, in a folder of their own."""

from __future__ import annotations

import json
import queue
from collections import deque
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from aionode import bag
from aionode.errors import DatasetError
from aionode.learn._alignment import Aligned, aligned
from aionode.learn._metadata import CONTRACT_KEY, TASK_KEY
from aionode.learn._report import counted, report_of
from aionode.learn._scan import UNREADABLE, full_name, records_of, scanned
from aionode.learn._series import Series
from aionode.learn._video import PixelStats, VideoWriter
from aionode.learn.contract import Contract, Observation

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.bag import Bag, Record
    from aionode.learn._entries import Array

__all__ = ["PART", "Job", "contract_in", "run"]

PART: Final = "part.json"
"""The file that marks a part as complete."""

WAITING: Final = 4
"""Maximum images that wait for their encoder."""


@dataclass(frozen=True, slots=True)
class Job:
    """One bag to export.

    Attributes:
        path: The bag.
        contract: The contract, as plain values.
        folder: The folder of the part.
        task: The task; empty to use that of the bag or of the contract.
        codec: ``h264`` or ``av1``.
        threads: Threads of each encoder.
    """

    path: str
    contract: dict[str, Any]
    folder: str
    task: str
    codec: str
    threads: int


def contract_in(opened: Bag) -> Contract | None:
    """Return the contract with which an episode was recorded, if its bag has one.

    Raises:
        ContractError: it is not valid (a ValueError).
    """
    text = opened.custom_data.get(CONTRACT_KEY)
    if text is None:
        return None
    try:
        given = json.loads(text)
    except ValueError:
        given = text
    return Contract.from_dict(given, f"in {opened.path}")


def run(job: Job, tell: Callable[[int], None]) -> dict[str, Any]:
    """Export a bag, and return the content of its part: episodes, and a report.

    Args:
        job: What to do.
        tell: Called with the number of messages read so far, to show progress.

    Raises:
        BagError: it is not a bag (a ValueError).
        DatasetError: it has no task (a ValueError).
    """
    contract = Contract.from_dict(job.contract, job.path)
    folder = Path(job.folder)
    folder.mkdir(parents=True, exist_ok=True)
    with bag.open(job.path) as opened:
        task = job.task or opened.custom_data.get(TASK_KEY) or contract.task
        if not task:
            raise DatasetError(job.path, "it has no task", "give one with --task")
        series, problems = scanned(opened, contract, tell)
        rows, cameras = encoded(opened, job, contract, series, tell)
        if rows.gaps and contract.gap == "refuse":
            problems.append(
                f"refused: {counted(len(rows.gaps), 'gap')} between rows, the longest of "
                f"{max(rows.gaps):.3f} s"
            )
        episodes = [
            episode_of(contract, rows, cameras, number, folder) | {"task": task}
            for number in range(len(rows.starts))
        ]
        report = report_of(opened, contract, series, rows, problems)
    part = {"episodes": episodes, "report": report}
    written = folder / f"{PART}.new"
    written.write_text(json.dumps(part))
    written.replace(folder / PART)
    return part


# Pictures


def encoded(
    opened: Bag,
    job: Job,
    contract: Contract,
    series: list[Series],
    tell: Callable[[int], None],
) -> tuple[Aligned, list[Camera]]:
    """Write the images of a bag, and return its rows.

    Only encoding shows whether an image can be read. If one cannot, the rows are made
    again without it: another image in its place would have another age.
    """
    while True:
        rows = aligned(contract, series)
        if rows.gaps and contract.gap == "refuse":
            rows.starts = []
        cameras = cameras_of(contract, rows, series, job)
        fill(opened, cameras, tell)
        if not any(each.unreadable for each in cameras):
            return rows, cameras
        for each in cameras:
            position = contract.entries.index(each.entry)
            series[position] = series[position].without(each.unreadable, each.problem)


class Camera:
    """The images of one feature, on their way into the videos of the episodes.

    Attributes:
        entry: The observation.
        wanted: The ordinal of the message for each row of an episode, with that episode.
        files: The video of each episode.
        stats: The statistics of each video.
        unreadable: The ordinals of images that could not be read.
        problem: What was wrong with the first of these.
    """

    def __init__(self, entry: Observation, wanted: list[tuple[int, int]], job: Job) -> None:
        self.entry = entry
        self.wanted = deque(wanted)
        self.files: list[Path] = []
        self.stats: list[PixelStats] = []
        self.unreadable: list[int] = []
        self.problem = ""
        self.job = job
        self.queue: queue.Queue[tuple[int, Record] | None] = queue.Queue(WAITING)
        self.count = 0
        """The number of messages of the topic that the reader has seen."""
        self.next = deque(ordinal for ordinal, _ in wanted)
        """The ordinals that the reader still has to pass on."""

    def passes(self, record: Record, encoding: Future[None]) -> None:
        """Pass a message on to the encoder if it is in a row."""
        ordinal, self.count = self.count, self.count + 1
        if not self.next or self.next[0] != ordinal:
            return
        while self.next and self.next[0] == ordinal:
            self.next.popleft()
        self.put((ordinal, record), encoding)

    def put(self, item: tuple[int, Record] | None, encoding: Future[None]) -> None:
        """Put an item into the queue, unless its encoder has failed."""
        while not encoding.done():
            try:
                self.queue.put(item, timeout=0.2)
            except queue.Full:
                continue
            return

    def encode(self) -> None:
        """Write the videos, in a thread: encoders and decoders release the GIL."""
        with ExitStack() as stack:
            writer: VideoWriter | None = None
            while (item := self.queue.get()) is not None:
                ordinal, record = item
                try:
                    pixels = self.entry.value(record.message)
                except UNREADABLE as error:
                    self.unreadable.append(ordinal)
                    self.problem = self.problem or str(error)
                if self.unreadable:
                    continue  # the rows will be made again
                frame = None
                while self.wanted and self.wanted[0][0] == ordinal:
                    _, episode = self.wanted.popleft()
                    if writer is None or episode == len(self.files):
                        stack.close()
                        writer = stack.enter_context(self.writer())
                        frame = None
                    frame = frame or writer.converted(pixels)
                    writer.add(frame)
                    self.stats[-1].add(pixels)

    def writer(self) -> VideoWriter:
        """Return the writer of the next episode."""
        job = self.job
        self.files.append(Path(job.folder, f"{self.entry.feature}-{len(self.files):03d}.mp4"))
        self.stats.append(PixelStats(self.entry.image or ""))
        codec = "depth" if self.is_depth else job.codec
        fps = int(job.contract["fps"])
        return VideoWriter(self.files[-1], self.entry.shape, fps, codec, job.threads)

    @property
    def is_depth(self) -> bool:
        """Whether its images are depths."""
        return self.entry.image == "depth"


def cameras_of(contract: Contract, rows: Aligned, series: list[Series], job: Job) -> list[Camera]:
    """Return the cameras of a contract, with the messages that are in rows."""
    found = []
    for position, entry in enumerate(contract.observations):
        if entry.image is None:
            continue
        ordinals = series[position].ordinals
        wanted = [
            (int(ordinals[place]), episode)
            for episode, (start, end) in enumerate(zip(rows.starts, rows.ends, strict=True))
            for place in rows.chosen[position][start:end].tolist()
        ]
        found.append(Camera(entry, wanted, job))
    return found


def fill(opened: Bag, cameras: list[Camera], tell: Callable[[int], None]) -> None:
    """Read the images once, and encode those of each camera in a thread of its own."""
    wanted = [each for each in cameras if each.next]
    if not wanted:
        return
    with ThreadPoolExecutor(len(wanted)) as threads:
        encoding = [(each, threads.submit(each.encode)) for each in wanted]
        by_topic: dict[str, list[tuple[Camera, Future[None]]]] = {}
        for each, future in encoding:
            by_topic.setdefault(full_name(each.entry.topic), []).append((each, future))
        try:
            for record in records_of(opened, set(by_topic), []):
                tell(1)
                for each, future in by_topic[record.topic]:
                    each.passes(record, future)
        finally:
            for each, future in encoding:
                each.put(None, future)
        for _, future in encoding:
            future.result()


# Numbers


def episode_of(
    contract: Contract, rows: Aligned, cameras: list[Camera], number: int, folder: Path
) -> dict[str, Any]:
    """Write the numbers of one episode, and return its metadata."""
    span = slice(rows.starts[number], rows.ends[number])
    columns = columns_of(contract, rows, span)
    file = folder / f"rows-{number:03d}.parquet"
    pq.write_table(pa.table({name: arrow_of(each) for name, each in columns.items()}), file)
    stats = {name: statistics(each) for name, each in columns.items()}
    stats |= {each.entry.feature: each.stats[number].statistics() for each in cameras}
    return {
        "rows": span.stop - span.start,
        "file": file.name,
        "videos": {each.entry.feature: each.files[number].name for each in cameras},
        "stats": stats,
    }


def columns_of(contract: Contract, rows: Aligned, span: slice) -> dict[str, Array]:
    """Return the numbers of an episode by name, one row for each image."""
    entries = contract.entries
    columns: dict[str, Array] = {}
    for name, feature in contract.features.items():
        if feature.kind == "numbers":
            parts = [rows.values[entries.index(each)][span] for each in feature.entries]
            columns[name] = np.concatenate(parts, axis=1).astype(np.float32)
    count = span.stop - span.start
    columns["stamp"] = (rows.times[span] / 1e9).reshape(count, 1)
    columns["age"] = np.stack([ages[span] for ages in rows.ages], axis=1).astype(np.float32)
    columns["timestamp"] = (np.arange(count) / contract.fps).astype(np.float32).reshape(count, 1)
    columns["frame_index"] = np.arange(count, dtype=np.int64).reshape(count, 1)
    return columns


def arrow_of(values: Array) -> pa.Array:
    """Return a column: numbers, or lists of a fixed length."""
    flat = pa.array(values.ravel())
    return (
        flat if values.shape[1] == 1 else pa.FixedSizeListArray.from_arrays(flat, values.shape[1])
    )


def statistics(values: Array) -> dict[str, list[float]]:
    """Return the statistics of the numeric columns, which readers normalize with."""
    given = values.astype(np.float64)
    found = {
        "min": given.min(0),
        "max": given.max(0),
        "mean": given.mean(0),
        "std": given.std(0),
        **{f"q{each:02d}": np.percentile(given, each, axis=0) for each in (1, 10, 50, 90, 99)},
    }
    return {name: each.tolist() for name, each in found.items()} | {"count": [len(given)]}

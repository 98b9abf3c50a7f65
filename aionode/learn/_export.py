"""Converts recorded episodes to a data set of LeRobot: `export`."""

from __future__ import annotations

import hashlib
import json
import multiprocessing
import os
import shutil
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from aionode import __version__, bag
from aionode.bag.files.lock import FolderLock
from aionode.bag.files.metadata import FILE_NAME
from aionode.errors import BagError, DatasetError
from aionode.learn._dataset import INFO, Episode, check_dataset, write_dataset
from aionode.learn._episode import PART, Job, contract_in, run
from aionode.learn._metadata import FAILURE, OUTCOME_KEY
from aionode.learn._report import Limits, counted, over, text_of
from aionode.learn._scan import full_name
from aionode.learn.contract import Contract

if TYPE_CHECKING:
    from os import PathLike

__all__ = ["Exported", "Limits", "export"]

PARTS: Final = ".parts"
"""The folder of what has been exported so far, from which an export resumes."""

REPORT: Final = "meta/report.json"

TOLD_SEC: Final = 0.2
"""The interval at which the progress of processes is read."""

TOLD_MESSAGES: Final = 100
"""The number of messages after which a process reports its progress."""


@dataclass(frozen=True, slots=True)
class Exported:
    """A data set that was exported.

    Attributes:
        path: Its folder.
        episodes: The number of its episodes.
        rows: The number of its rows.
        reports: The report of each bag, as numbers.
        problems: What exceeds the limits, by bag.
        fps: The frames per second.
        limits: The limits.
    """

    path: str
    episodes: int
    rows: int
    reports: list[dict[str, Any]]
    problems: dict[str, list[str]]
    fps: int
    limits: Limits

    @property
    def text(self) -> str:
        """The report as text."""
        lines = [text_of(report, self.limits, self.fps) for report in self.reports]
        bad = f"; over the limits: {counted(len(self.problems), 'bag')}" if self.problems else ""
        whole = f"{self.path}: {counted(self.episodes, 'episode')}, {self.rows} rows"
        whole += f" at {self.fps} fps{bad}"
        return "\n".join([*lines, whole])


def export(
    out: str | PathLike[str],
    bags: Sequence[str | PathLike[str]],
    *,
    contract: Contract | None = None,
    task: str = "",
    codec: str = "h264",
    jobs: int = 0,
    failures: bool = False,
    limits: Limits | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Exported:
    """Convert episodes to a data set of LeRobot, format v3.0.

    Each message of the contract's reference topic makes a row, as `aionode.learn.contract`
    describes. An export that was interrupted resumes with the missing episodes if it is called
    again with the same arguments.

    Args:
        out: The folder of the data set.
        bags: The bags of the episodes, in order; a folder stands for all bags in it.
        contract: The contract; by default, that of the recording.
        task: The task of all episodes; by default, that of each recording.
        codec: ``h264``, or ``av1``, which is smaller and takes three times as much work.
        jobs: Maximum bags to convert at the same time; 0 to choose by the number of processors.
        failures: Whether to also convert episodes that ended as failures.
        limits: What may be wrong before it counts as a problem.
        progress: Called with the messages read so far, and the total.

    Raises:
        BagError: one of them is not a bag, or is being recorded (a ValueError).
        ContractError: a contract is not valid (a ValueError).
        DatasetError: the folder has a data set or other files, the bags do not share a contract, no
            bag has a row, or the data set cannot be read back (a ValueError).
    """
    place = Path(out)
    check_place(place)
    paths = list(
        {os.path.realpath(path): path for each in bags for path in bags_in(Path(each))}.values()
    )
    removed = {str(path): repair(path) for path in paths}
    wanted = [path for path in paths if failures or not failed(path)]
    if not wanted:
        left_out = f"{counted(len(paths), 'episode')}, and only failures"
        problem = left_out if paths else "no bag is given"
        raise DatasetError(str(out), problem, "--failures includes them" if paths else "")
    paths = wanted
    found = contract or common_contract(paths)
    check_sizes(found)
    cameras = max(sum(1 for each in found.observations if each.image), 1)
    processors = len(os.sched_getaffinity(0))
    jobs = jobs or max(processors // cameras, 1)
    threads = max(processors // (cameras * min(jobs, len(paths) or 1)), 1)
    planned = [job_of(place, str(path), found, task, codec, threads) for path in paths]
    with lock_of(place):
        parts = list(done(planned, jobs, progress))
        episodes = [
            Episode(Path(job.folder), **each)
            for job, part in zip(planned, parts, strict=True)
            for each in part["episodes"]
        ]
        reports = [
            part["report"] | {"removed_bytes": removed[job.path]}
            for job, part in zip(planned, parts, strict=True)
        ]
        bounds = limits or Limits()
        wrong = {each["path"]: over(each, bounds, found.fps) for each in reports}
        problems = {path: lines for path, lines in wrong.items() if lines}
        if not episodes:
            name, first = next(iter(problems.items()))
            raise DatasetError(str(out), f"no bag has a row; {name}: {'; '.join(first)[:1000]}")
        complete(place, found, episodes, codec, reports)
    rows = sum(each.rows for each in episodes)
    return Exported(str(out), len(episodes), rows, reports, problems, found.fps, bounds)


def complete(
    place: Path,
    contract: Contract,
    episodes: list[Episode],
    codec: str,
    reports: list[dict[str, Any]],
) -> None:
    """Put a data set together and read it back; then remove its parts.

    Raises:
        DatasetError: it cannot be read back (a ValueError).
    """
    write_dataset(place, contract, episodes, codec)
    wrong = check_dataset(place)
    if wrong:
        (place / INFO).unlink(missing_ok=True)
        raise DatasetError(str(place), f"it cannot be read back: {'; '.join(wrong[:5])}")
    (place / REPORT).write_text(json.dumps(reports, indent=1))
    shutil.rmtree(place / PARTS)


def check_place(place: Path) -> None:
    """Raise an error for a folder that cannot take this data set.

    Raises:
        DatasetError: it has a data set, or files that no export has left there (a ValueError).
    """
    if place.exists() and not place.is_dir():
        raise DatasetError(str(place), "a file has this name", "give another one")
    if (place / PARTS).is_dir() or not place.is_dir():
        return
    if (place / INFO).exists():
        raise DatasetError(str(place), "it exists already", "give another name, or remove it")
    if any(place.iterdir()):
        raise DatasetError(str(place), "the folder has other files", "give the name of a new one")


def lock_of(place: Path) -> FolderLock:
    """Return a lock that keeps other exports out of a folder.

    Raises:
        DatasetError: another one is running (a ValueError).
    """
    (place / PARTS).mkdir(parents=True, exist_ok=True)
    try:
        return FolderLock(place / PARTS)
    except BagError as error:
        problem = "another export is writing it"
        raise DatasetError(str(place), problem, "wait until it has ended") from error


def bags_in(path: Path) -> list[Path]:
    """Return a bag, or the bags in a folder, in the order of their names.

    A bag has no bags in it: a recording beside them does not make their folder one.
    """
    if not path.is_dir() or (path / FILE_NAME).exists():
        return [path]
    return [each for each in sorted(path.iterdir()) if each.is_dir() and is_bag(each)] or [path]


def is_bag(folder: Path) -> bool:
    """Return whether a folder is a bag, which may lack its metadata or its files."""
    return any(
        each.name == FILE_NAME or {".mcap", ".db3"} & set(each.suffixes)
        for each in folder.iterdir()
    )


def repair(path: Path) -> int:
    """Close the bag of a recorder that was killed, which lacks at most the last second.

    Returns:
        The bytes that could not be saved.

    Raises:
        BagError: it is damaged in another way, or is being recorded (a ValueError).
    """
    try:
        bag.open(path).close()
    except BagError:
        return sum(each.removed_bytes for each in bag.check(path))
    return 0


def failed(path: Path) -> bool:
    """Return whether the episode in a bag ended as a failure."""
    with bag.open(path) as opened:
        return opened.custom_data.get(OUTCOME_KEY) in {FAILURE, "discarded"}


def common_contract(bags: Sequence[Path]) -> Contract:
    """Return the contract with which all bags were recorded.

    Raises:
        DatasetError: one has none, or a different one (a ValueError).
    """
    found: Contract | None = None
    for path in bags:
        with bag.open(path) as opened:
            each = contract_in(opened)
        if each is None:
            raise DatasetError(str(path), "it was recorded without a contract", "give --contract")
        if found is not None and each != found:
            raise DatasetError(
                str(path),
                f"it was recorded with a different contract from {bags[0]}",
                "give the one to use with --contract",
            )
        found = each
    if found is None:
        raise DatasetError("", "no bag is given")
    return found


def check_sizes(contract: Contract) -> None:
    """Raise an error for images of a size that no video can have.

    Raises:
        DatasetError: a height or width is odd (a ValueError).
    """
    for each in contract.observations:
        if each.image and each.image != "depth" and (each.height % 2 or each.width % 2):
            raise DatasetError(
                each.topic,
                f"images of {each.width} by {each.height} pixels",
                "videos have an even number of rows and columns: crop them",
            )


def job_of(place: Path, path: str, contract: Contract, task: str, codec: str, threads: int) -> Job:
    """Return the job for a bag, whose folder is named after everything that affects its content."""
    given = contract.to_dict()
    files = sorted(Path(path).rglob("*")) if Path(path).is_dir() else [Path(path)]
    marks = [
        (each.name, each.stat().st_size, each.stat().st_mtime_ns)
        for each in files
        if each.is_file()
    ]
    words = json.dumps(
        [__version__, os.path.realpath(path), given, task, codec, marks], sort_keys=True
    )
    name = hashlib.sha256(words.encode()).hexdigest()[:16]
    return Job(path, given, str(place / PARTS / name), task, codec, threads)


def done(
    planned: list[Job], jobs: int, progress: Callable[[int, int], None] | None
) -> Iterator[dict[str, Any]]:
    """Do the jobs that are not done yet, and yield the parts of all, in order."""
    missing = [job for job in planned if read_part(job) is None]
    whole = sum(map(messages_of, missing)) if progress else 0
    count = 0

    def tell(read: int) -> None:
        nonlocal count
        count += read
        if progress:
            progress(min(count, whole), whole)

    if len(missing) > 1 and jobs > 1:
        run_in_processes(missing, jobs, tell)
    else:
        for job in missing:
            run(job, tell)
    for job in planned:
        part = read_part(job)
        if part is None:
            raise DatasetError(job.folder, "it was removed while it was being written")
        yield part


def read_part(job: Job) -> dict[str, Any] | None:
    """Return a part, or None if it is not complete."""
    try:
        part: dict[str, Any] = json.loads(Path(job.folder, PART).read_text())
    except (OSError, ValueError):
        return None
    return part


def messages_of(job: Job) -> int:
    """Return how many messages of a bag will be read, images twice."""
    contract = Contract.from_dict(job.contract)
    pictures = {full_name(each.topic) for each in contract.observations if each.image}
    topics = {full_name(name) for name in contract.topics}
    with bag.open(job.path) as opened:
        return sum(
            count * (2 if name in pictures else 1)
            for name, count in opened.counts.items()
            if name in topics
        )


def run_in_processes(missing: list[Job], jobs: int, tell: Callable[[int], None]) -> None:
    """Run several jobs at the same time, each in a process of its own.

    Raises:
        BagError, ContractError, DatasetError: as `run`, or a process was killed; what is done by
            then is kept.
    """
    context = multiprocessing.get_context("spawn")
    told = context.SimpleQueue()
    with ProcessPoolExecutor(
        min(jobs, len(missing)), mp_context=context, initializer=tell_by, initargs=(told,)
    ) as pool:
        waiting = {pool.submit(run_and_tell, job) for job in missing}
        try:
            while waiting:
                finished, waiting = wait(waiting, TOLD_SEC, FIRST_COMPLETED)
                while not told.empty():
                    tell(told.get())
                for each in finished:
                    each.result()
            while not told.empty():
                tell(told.get())
        except BrokenProcessPool as error:
            raise DatasetError(
                missing[0].folder,
                "a process of the export ended early: it was killed, perhaps for lack of memory, "
                "or the program that calls export() does so without `if __name__ == '__main__':`",
                "start it again with one job at a time; what is done is kept",
            ) from error
        finally:
            pool.shutdown(cancel_futures=True)


class Told:
    """Where a process of the pool reports its progress.

    Attributes:
        queue: Its queue to the main process.
        count: What it has not reported yet.
    """

    queue: Any = None
    count = 0


def tell_by(queue: Any) -> None:
    """Set the queue of this process."""
    Told.queue = queue


def run_and_tell(job: Job) -> None:
    """Run a job in a process of the pool."""

    def tell(read: int) -> None:
        Told.count += read
        if Told.count >= TOLD_MESSAGES:
            flush()

    def flush() -> None:
        Told.queue.put(Told.count)
        Told.count = 0

    run(job, tell)
    flush()

"""``metadata.yaml``, which rosbag2 writes next to the files of a bag."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Final

import yaml

from aionode._process.bounded_files import LFS_POINTER, read_file
from aionode._process.bounded_yaml import loaded_yaml
from aionode.bag.files.qos import readable_profiles, to_builtins, yaml_text
from aionode.bag.files.record import TopicInfo
from aionode.errors import BagError

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from pathlib import Path

__all__ = [
    "FILE_NAME",
    "FilePart",
    "counts_in",
    "metadata_of",
    "metadata_text",
    "read_metadata",
    "start_in",
    "sync_folder",
    "topics_in",
    "write_metadata",
]

FILE_NAME: Final = "metadata.yaml"
ROOT: Final = "rosbag2_bagfile_information"
VERSION: Final = 9
NEVER_NS: Final = 2**63 - 1
"""The start of a bag without messages, as rosbag2 writes it."""

FilePart = tuple[str, int, int, int]
"""A file of a bag: its name, the times of its first and last message in nanoseconds, and its
number of messages."""


def metadata_of(
    topics: Iterable[TopicInfo],
    files: Sequence[FilePart],
    *,
    custom_data: Mapping[str, str],
    ros_distro: str,
    storage: str = "mcap",
) -> dict[str, Any]:
    """Return the metadata of a bag, version 9."""
    filled = [part for part in files if part[3]]
    start = min((part[1] for part in filled), default=NEVER_NS)
    end = max((part[2] for part in filled), default=NEVER_NS)
    return {
        "version": VERSION,
        "storage_identifier": storage,
        "duration": {"nanoseconds": end - start},
        "starting_time": {"nanoseconds_since_epoch": start},
        "message_count": sum(part[3] for part in files),
        "topics_with_message_count": [
            {"topic_metadata": topic_metadata(topic), "message_count": topic.message_count}
            for topic in topics
        ],
        "compression_format": "",
        "compression_mode": "",
        "relative_file_paths": [part[0] for part in files],
        "files": [
            {
                "path": name,
                "starting_time": {"nanoseconds_since_epoch": first if count else NEVER_NS},
                "duration": {"nanoseconds": last - first if count else 0},
                "message_count": count,
            }
            for name, first, last, count in files
        ],
        "custom_data": dict(custom_data),
        "ros_distro": ros_distro,
    }


def topic_metadata(topic: TopicInfo) -> dict[str, Any]:
    """Return the metadata of one topic."""
    return {
        "name": topic.name,
        "type": topic.type,
        "serialization_format": topic.serialization_format,
        "offered_qos_profiles": [to_builtins(qos) for qos in topic.qos],
        "type_description_hash": topic.type_hash,
    }


def metadata_text(metadata: Mapping[str, Any]) -> str:
    """Return metadata as the text of ``metadata.yaml``."""
    return yaml_text({ROOT: dict(metadata)})


def write_metadata(folder: Path, metadata: Mapping[str, Any]) -> None:
    """Write ``metadata.yaml``, replacing the old file only once the new one is complete.

    Raises:
        OSError: it cannot be written.
    """
    waiting = folder / f".{FILE_NAME}"
    with waiting.open("w", encoding="utf-8") as file:
        file.write(metadata_text(metadata))
        file.flush()
        os.fsync(file.fileno())
    waiting.replace(folder / FILE_NAME)
    sync_folder(folder)


def sync_folder(folder: Path) -> None:
    """Sync a folder to disk, so that the names of its files survive a power cut.

    A folder that cannot be opened for reading is left to the system.

    Raises:
        OSError: the disk fails.
    """
    try:
        fd = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    except PermissionError:
        return
    try:
        os.fsync(fd)
    finally:
        os.close(fd)


def read_metadata(folder: Path) -> dict[str, Any]:
    """Return the metadata of a bag, whatever its version.

    Raises:
        BagError: the file is missing, or invalid.
    """
    path = folder / FILE_NAME
    try:
        content = loaded_yaml(read_file(path))
        metadata: dict[str, Any] = dict(content[ROOT])
        metadata["relative_file_paths"] = [str(name) for name in metadata["relative_file_paths"]]
        metadata["storage_identifier"] = str(metadata["storage_identifier"])
        if any("\0" in name for name in metadata["relative_file_paths"]):
            raise ValueError("NUL in the name of a file")  # noqa: TRY301  # as the others
    except FileNotFoundError as error:
        raise BagError(
            str(folder), f"there is no {FILE_NAME}", "`aionode bag reindex` creates one"
        ) from error
    except (OSError, yaml.YAMLError, LookupError, TypeError, ValueError) as error:
        if isinstance(error, OSError) and error.strerror == LFS_POINTER:
            raise BagError(str(path), f"it is {LFS_POINTER}") from None
        what = " ".join(str(error).split())
        problem = f"{FILE_NAME} cannot be used ({type(error).__name__}: {what})"
        raise BagError(str(folder), problem, "`aionode bag reindex` rebuilds it") from error
    return metadata


def start_in(metadata: Mapping[str, Any]) -> int:
    """Return the start time in a bag's metadata, in nanoseconds; `NEVER_NS` if there is none."""
    told = metadata.get("starting_time")
    start = told.get("nanoseconds_since_epoch") if isinstance(told, dict) else None
    return start if isinstance(start, int) else NEVER_NS


def counts_in(metadata: Mapping[str, Any]) -> dict[str, int]:
    """Return the numbers of messages in a bag's metadata, for the topics that have one."""
    listed = metadata.get("topics_with_message_count")
    counts: dict[str, int] = {}
    for entry in listed if isinstance(listed, list) else ():
        told = entry.get("topic_metadata") if isinstance(entry, dict) else None
        name = told.get("name") if isinstance(told, dict) else None
        if isinstance(name, str) and isinstance(entry.get("message_count"), int):
            counts[name] = counts.get(name, 0) + entry["message_count"]
    return counts


def topics_in(metadata: Mapping[str, Any]) -> list[TopicInfo]:
    """Return the topics listed in a bag's metadata, ignoring what rosbag2 would not write.

    Their numbers of messages are known only from the files.
    """
    listed = metadata.get("topics_with_message_count")
    topics = []
    for entry in listed if isinstance(listed, list) else ():
        told = entry.get("topic_metadata") if isinstance(entry, dict) else None
        if not isinstance(told, dict) or not isinstance(told.get("name"), str):
            continue
        qos, problem = readable_profiles(told.get("offered_qos_profiles") or [])
        topics.append(
            TopicInfo(
                name=told["name"],
                type=str(told.get("type", "")),
                type_hash=str(told.get("type_description_hash") or ""),
                qos=qos,
                serialization_format=str(told.get("serialization_format", "cdr")),
                problem=problem,
            )
        )
    return topics

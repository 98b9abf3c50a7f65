"""rosbag2's YAML files, used on the command line and by programs of `rosbag2_py`."""

from __future__ import annotations

from typing import Any, Final

import yaml

from aionode._process.bounded_files import read_file
from aionode._process.bounded_yaml import loaded_yaml
from aionode.bag._selection import Selection
from aionode.clock import Time

__all__ = ["PRESETS", "chunk_compression", "inputs_in", "outputs_in", "static_topics_in"]

PRESETS: Final = {
    "none": "none",
    "fastwrite": "none",
    "zstd_fast": "zstd",
    "zstd_small": "zstd_small",
}
"""The compression of chunks for each of rosbag2's MCAP presets."""

COMPRESSIONS: Final = {"None": "none", "Lz4": "lz4", "Zstd": "zstd"}
"""The compression for each name in the configuration files of its MCAP plugin."""


def content_of(path: str) -> dict[str, Any]:
    """Return the content of a YAML file.

    Raises:
        ValueError: it is not a mapping.
    """
    try:
        content = loaded_yaml(read_file(path))
    except yaml.YAMLError as error:
        raise ValueError(f"{path}: not YAML: {' '.join(str(error).split())}") from error
    if not isinstance(content, dict):
        raise ValueError(f"{path}: not a mapping of names to values")  # noqa: TRY004  # of a file, and not of an argument
    return content


def static_topics_in(path: str | None) -> dict[str, str]:
    """Return types by topic from a file for ``--static-topics-path``; empty without a file.

    Raises:
        ValueError: it is not such a file.
    """
    if not path:
        return {}
    listed = content_of(path).get("static_topics_and_types_list")
    try:
        return {f"/{name.removeprefix('/')}": str(kind) for name, kind in listed or ()}
    except (TypeError, ValueError, AttributeError) as error:
        raise ValueError(
            f"{path}: it needs static_topics_and_types_list, with [topic, type] for each"
        ) from error


def chunk_compression(preset: str | None, config: str | None, compression: str) -> str:
    """Return how to compress chunks, by the most specific of three options.

    Raises:
        ValueError: the file does not name a compression of MCAP.
    """
    if config is not None:
        named = content_of(config).get("compression")
        if named is not None and named not in COMPRESSIONS:
            raise ValueError(f"{config}: compression is one of {', '.join(COMPRESSIONS)}")
        if named is not None:
            return COMPRESSIONS[named]
    return compression if preset is None else PRESETS[preset]


def bags_in(path: str, key: str) -> list[dict[str, Any]]:
    """Return the entries of a list of bags in a file.

    Raises:
        ValueError: there is none, or an entry has no ``uri``.
    """
    listed = content_of(path).get(key)
    if not isinstance(listed, list) or not all(
        isinstance(bag, dict) and bag.get("uri") for bag in listed
    ):
        raise ValueError(f"{path}: it needs {key}: a list of entries with a uri")
    return listed


def inputs_in(path: str | None) -> list[str]:
    """Return the bags of a file for ``--input-options``."""
    return [] if path is None else [str(bag["uri"]) for bag in bags_in(path, "input_bags")]


def outputs_in(path: str) -> list[tuple[str, dict[str, Any]]]:
    """Return the new bags in a file for ``--output-options``: folder, and options of `convert`.

    Raises:
        ValueError: it is not such a file, or asks for a format that cannot be written.
    """
    try:
        return [output_in(path, entry) for entry in bags_in(path, "output_bags")]
    except (
        TypeError,
        AttributeError,
        OverflowError,
    ) as error:  # such as a list instead of a number
        raise ValueError(f"{path}: a value in output_bags has the wrong type: {error}") from error


def output_in(path: str, entry: dict[str, Any]) -> tuple[str, dict[str, Any]]:
    """Return one entry of `outputs_in`."""
    if entry.get("storage_id") not in {None, "", "mcap"}:
        raise ValueError(f"{path}: {entry['uri']}: aionode writes mcap, not {entry['storage_id']}")
    every = [
        kind
        for kind in ("topic", "service", "action")
        if entry.get("all") or entry.get(f"all_{kind}s")
    ]
    names = ("topics", "services", "actions", "topic_types", "regex")
    if not (every or any(entry.get(name) for name in names)):
        every = ["topic", "service", "action"]
    preset = entry.get("storage_preset_profile") or None
    if preset is not None and preset not in PRESETS:
        raise ValueError(f"{path}: unknown storage_preset_profile {preset}")
    start_ns, end_ns = entry.get("start_time_ns", -1), entry.get("end_time_ns", -1)
    return (
        str(entry["uri"]),
        {
            "selection": Selection(
                topics=entry.get("topics") or (),
                services=entry.get("services") or (),
                actions=entry.get("actions") or (),
                types=entry.get("topic_types") or (),
                regex=entry.get("regex") or "",
                every=every,
                exclude_regex=entry.get("exclude_regex") or entry.get("exclude") or "",
                exclude=[
                    name
                    for kind in ("topics", "services", "actions")
                    for name in entry.get(f"exclude_{kind}") or ()
                ],
                exclude_types=entry.get("exclude_topic_types") or (),
                hidden=True,
            ),
            "start": Time(nanoseconds=start_ns) if start_ns >= 0 else None,
            "end": Time(nanoseconds=end_ns + 1) if end_ns >= 0 else None,
            "compression": chunk_compression(preset, None, "zstd"),
            "max_bytes": entry.get("max_bagfile_size") or 0,
            "max_duration_ns": (entry.get("max_bagfile_duration") or 0) * 10**9,
            "custom_data": entry.get("custom_data") or None,
        },
    )

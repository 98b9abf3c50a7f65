"""Zenoh key expressions of topics and services, as `rmw_zenoh_cpp` forms them.

A key is ``<domain>/<name>/<DDS type>/<type hash>``. The name keeps its inner slashes and loses its
outer ones; the DDS type of ``std_msgs/msg/String`` is ``std_msgs::msg::dds_::String_``.

Zenoh's wildcards stand for what is not known: ``*`` for one chunk, ``**`` for any number of them.
"""

from __future__ import annotations

from typing import NamedTuple

__all__ = [
    "BUFFER_SUFFIX",
    "HUMBLE_HASH",
    "DataKey",
    "buffer_key",
    "data_key",
    "dds_type",
    "demangle",
    "mangle",
    "parse_data_key",
    "ros_type",
]

HUMBLE_HASH = "TypeHashNotSupported"
"""What a ROS 2 Humble node writes where newer ones write a type hash."""

BUFFER_SUFFIX = "_buf_cpu"
"""Last chunk of the second key of a topic with byte sequences, from ROS 2 Lyrical on."""

DDS_MARK = "dds_::"


class DataKey(NamedTuple):
    """What the key of a sample or query says."""

    domain_id: int
    name: str
    """Fully qualified name, with its leading slash."""
    type_name: str
    """ROS name of the type, such as ``std_msgs/msg/String``."""
    type_hash: str


def dds_type(type_name: str) -> str:
    """Return the DDS name of a ROS type, such as ``std_msgs::msg::dds_::String_``."""
    package, _, name = type_name.rpartition("/")
    return f"{package.replace('/', '::')}::{DDS_MARK}{name}_"


def ros_type(dds_name: str) -> str | None:
    """Return the ROS name of a DDS type, or None when `dds_name` is not one."""
    package, mark, name = dds_name.rpartition(DDS_MARK)
    if not (mark and package.endswith("::") and len(name) > 1 and name.endswith("_")):
        return None
    return f"{package[:-2].replace('::', '/')}/{name[:-1]}"


def data_key(
    domain_id: int, name: str, type_name: str | None = None, type_hash: str | None = None
) -> str:
    """Return the key of a topic or service.

    Without `type_hash` it matches every definition of the type, without `type_name` every type:
    such a key is for receiving only, as Zenoh sends nothing on a wildcard to a ROS node.
    """
    dds_name = "*" if type_name is None else dds_type(type_name)
    return f"{domain_id}/{name.strip('/')}/{dds_name}/{type_hash or '*'}"


def buffer_key(key: str) -> str:
    """Return the second key on which a ROS 2 Lyrical publisher sends plain bytes."""
    return f"{key}/{BUFFER_SUFFIX}"


def parse_data_key(key: str) -> DataKey | None:
    """Return what `key` says, or None when it is not the key of a topic or service."""
    chunks = key.removesuffix(f"/{BUFFER_SUFFIX}").split("/")
    if len(chunks) < 4 or "" in chunks:
        return None
    domain, *name, dds_name, type_hash = chunks
    type_name = ros_type(dds_name)
    # int() would take signs, blanks, underscores and other scripts' digits as well.
    if type_name is None or not (domain.isascii() and domain.isdigit() and len(domain) <= 10):
        return None
    return DataKey(int(domain), "/" + "/".join(name), type_name, type_hash)


def mangle(name: str) -> str:
    """Return `name` as one chunk of a liveliness token: each slash becomes ``%``."""
    return name.replace("/", "%")


def demangle(chunk: str) -> str:
    """Return the name that `mangle` made `chunk` of."""
    return chunk.replace("%", "/")

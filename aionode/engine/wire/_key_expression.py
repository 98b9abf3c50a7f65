"""Zenoh key expressions of topics and services, as in `rmw_zenoh_cpp`.

A key is ``<domain>/<name>/<DDS type>/<type hash>``, without the name's leading slash. The DDS type
of ``std_msgs/msg/String`` is ``std_msgs::msg::dds_::String_``.

Unknown parts are Zenoh wildcards: ``*`` for one chunk, ``**`` for any number of chunks.

What aionode contexts tell each other about a topic is sent below its key, so that an access rule
for the topic can cover it: ``<key>/@aionode/pub/…`` is used by publishers, ``<key>/@aionode/sub/…``
by subscriptions. No wildcard matches a chunk with an ``@``, so subscribers of the topic do not
receive it.
"""

from __future__ import annotations

import enum

from msgspec import Struct

from aionode.names import is_full_name, is_type_name

__all__ = [
    "BUFFER_SUFFIX",
    "DataKey",
    "Side",
    "buffer_key",
    "data_key",
    "dds_type",
    "demangle",
    "mangle",
    "parse_data_key",
    "ros_type",
    "side_key",
]

BUFFER_SUFFIX = "_buf_cpu"
"""Last chunk of the second key of topics with byte sequences, since ROS 2 Lyrical."""

DDS_MARK = "dds_::"


class DataKey(Struct, frozen=True):
    """The parsed key of a sample or query."""

    domain_id: int
    name: str
    """Fully qualified name, with its leading slash."""
    type_name: str
    """ROS name of the type, such as ``std_msgs/msg/String``."""
    type_hash: str


class Side(enum.Enum):
    """The endpoints that a key concerns: publishers or subscriptions."""

    PUBLISHERS = "pub"
    SUBSCRIPTIONS = "sub"


def dds_type(type_name: str) -> str:
    """Return the DDS name of a ROS type, such as ``std_msgs::msg::dds_::String_``."""
    package, _, name = type_name.rpartition("/")
    return f"{package.replace('/', '::')}::{DDS_MARK}{name}_"


def ros_type(dds_name: str) -> str | None:
    """Return the ROS name of a DDS type, or None if `dds_name` is not a DDS type."""
    package, mark, name = dds_name.rpartition(DDS_MARK)
    if not (mark and package.endswith("::") and name.endswith("_")):
        return None
    type_name = f"{package[:-2].replace('::', '/')}/{name[:-1]}"
    return type_name if is_type_name(type_name) else None


def data_key(
    domain_id: int, name: str, type_name: str | None = None, type_hash: str | None = None
) -> str:
    """Return the key of a topic or service.

    Without `type_hash` it matches every definition of the type, without `type_name` every type.
    Such keys are for receiving only: ROS nodes receive nothing that is sent to a wildcard.
    """
    dds_name = "*" if type_name is None else dds_type(type_name)
    return f"{domain_id}/{name.strip('/')}/{dds_name}/{type_hash or '*'}"


def buffer_key(key: str) -> str:
    """Return the second key, on which ROS 2 Lyrical publishers send plain bytes."""
    return f"{key}/{BUFFER_SUFFIX}"


def side_key(key: str, side: Side, what: str) -> str:
    """Return the key below a topic's key on which one side of it sends `what`."""
    return f"{key}/@aionode/{side.value}/{what}"


def parse_data_key(key: str) -> DataKey | None:
    """Parse a key; return None if it is not the key of a topic or service."""
    chunks = key.removesuffix(f"/{BUFFER_SUFFIX}").split("/")
    if len(chunks) < 4 or "" in chunks:
        return None
    domain, *name, dds_name, type_hash = chunks
    type_name = ros_type(dds_name)
    # int() would also accept signs, blanks, underscores and digits of other scripts.
    if type_name is None or not (domain.isascii() and domain.isdigit() and len(domain) <= 10):
        return None
    full_name = "/" + "/".join(name)
    return (
        DataKey(int(domain), full_name, type_name, type_hash) if is_full_name(full_name) else None
    )


def mangle(name: str) -> str:
    """Return `name` as one chunk of a liveliness token, with each slash replaced by ``%``."""
    return name.replace("/", "%")


def demangle(chunk: str) -> str:
    """Undo `mangle`."""
    return chunk.replace("%", "/")

"""`launch_ros.utilities`."""

from __future__ import annotations

from launch_ros.namespaces import is_absolute as is_namespace_absolute
from launch_ros.namespaces import joined as prefix_namespace

__all__ = ["is_namespace_absolute", "make_namespace_absolute", "prefix_namespace"]


def make_namespace_absolute(ns: str | None) -> str | None:
    """Return a namespace with a leading slash."""
    return ns if ns is None or ns.startswith("/") else f"/{ns}"

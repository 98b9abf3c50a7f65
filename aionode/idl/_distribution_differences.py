"""The interfaces with other fields in other distributions of ROS 2, known without a sourced ROS 2.

`_installed.py` uses them for the distribution that ROS_DISTRO names.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path

__all__ = ["differences"]

FOLDER = Path(__file__).with_name("distributions")
SAME = {"rolling": "lyrical"}
"""Distributions whose interfaces are those of another one."""

HEAD = "== "
"""Begins the line before each definition, which ends with the name of the type."""


@cache
def differences(distribution: str) -> Mapping[str, str]:
    """Return what differs from the shipped types in a distribution: definitions by type name.

    They are those of types with other fields, of types that contain one of those, and of types that
    only this distribution has. There are none for the distribution of the shipped types, and for
    one that is not known.
    """
    file = FOLDER / f"{SAME.get(distribution, distribution)}.txt"
    if not distribution.isidentifier() or not file.is_file():
        return {}
    parts = f"\n{file.read_text(encoding='utf-8')}".split(f"\n{HEAD}")[1:]
    pairs = (part.partition("\n") for part in parts)
    return {typename: text for typename, _, text in pairs}

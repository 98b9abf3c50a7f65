"""The interfaces that differ between ROS 2 distributions, known without a sourced ROS 2.

`_installed.py` uses them for the distribution that ROS_DISTRO names.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path

__all__ = ["differences"]

FOLDER = Path(__file__).with_name("distributions")
SAME = {"rolling": "lyrical"}
"""Distributions that have the same interfaces as another one."""

HEAD = "== "
"""The start of the line before each definition, which ends with the name of the type."""


@cache
def differences(distribution: str) -> Mapping[str, str]:
    """Return a distribution's definitions that differ from the shipped types, by type name.

    They are of types with other fields, types that contain one of those, and types that only this
    distribution has. There are none for the distribution of the shipped types, nor for an unknown
    one.
    """
    file = FOLDER / f"{SAME.get(distribution, distribution)}.txt"
    if not distribution.isidentifier() or not file.is_file():
        return {}
    parts = f"\n{file.read_text(encoding='utf-8')}".split(f"\n{HEAD}")[1:]
    pairs = (part.partition("\n") for part in parts)
    return {typename: text for typename, _, text in pairs}

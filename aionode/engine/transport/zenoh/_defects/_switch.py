"""Disables workarounds."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Final

from aionode.errors import ConfigurationError

__all__ = ["is_mended"]

VARIABLE: Final = "AIONODE_ZENOH_UNMENDED"
"""The environment variable that lists the defects whose workarounds are disabled."""


def is_mended(defect: str) -> bool:
    """Return whether the workaround for a defect is enabled.

    Raises:
        ConfigurationError: the environment names something that is not a defect.
    """
    unmended = set(os.environ.get(VARIABLE, "").replace(",", " ").split())
    for name in unmended and unmended - defects():
        raise ConfigurationError(VARIABLE, name, f"use {', '.join(sorted(defects()))}")
    return defect not in unmended


def defects() -> set[str]:
    """Return the names of all defects; each has a module here."""
    names = {path.stem for path in Path(__file__).parent.glob("*.py")}
    return {name for name in names if not name.startswith("_")}

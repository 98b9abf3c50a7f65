"""The folders in which packages are searched."""

from __future__ import annotations

import os
from pathlib import Path

from ament_index_python.constants import AMENT_PREFIX_PATH_ENV_VAR

__all__ = ["get_search_paths"]


def get_search_paths() -> list[str]:
    """Return the existing folders of AMENT_PREFIX_PATH.

    Raises:
        OSError: The variable is not set, or empty.
    """
    prefixes = os.environ.get(AMENT_PREFIX_PATH_ENV_VAR, "")
    if not prefixes:
        raise OSError(f"Environment variable '{AMENT_PREFIX_PATH_ENV_VAR}' is not set or empty")
    return [prefix for prefix in prefixes.split(os.pathsep) if prefix and Path(prefix).exists()]

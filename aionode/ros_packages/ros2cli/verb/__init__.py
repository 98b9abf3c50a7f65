"""The base class of verbs."""

from __future__ import annotations

from typing import Any

__all__ = ["VerbExtension"]


class VerbExtension:
    """A verb of a command, with ``main(args=…)`` and ``add_arguments(parser, cli_name)``."""

    NAME: Any = None
    EXTENSION_POINT_VERSION = "0.1"

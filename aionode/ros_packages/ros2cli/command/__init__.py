"""The base of commands."""

from __future__ import annotations

from typing import Any

__all__ = ["CommandExtension"]


class CommandExtension:
    """A command: ``main(parser=…, args=…)`` does it."""

    NAME: Any = None
    EXTENSION_POINT_VERSION = "0.1"

    def add_arguments(self, parser: Any, cli_name: str, *, argv: Any = None) -> None:
        """Add the arguments of the command, of which a base has none."""

    def main(self, *, parser: Any, args: Any) -> Any:
        """Do it, and return the exit status."""
        raise NotImplementedError

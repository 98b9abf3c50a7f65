"""The base class of commands."""

from __future__ import annotations

from typing import Any

__all__ = ["CommandExtension"]


class CommandExtension:
    """A command, which ``main(parser=…, args=…)`` runs."""

    NAME: Any = None
    EXTENSION_POINT_VERSION = "0.1"

    def add_arguments(self, parser: Any, cli_name: str, *, argv: Any = None) -> None:
        """Add the arguments of the command; the base class has none."""

    def main(self, *, parser: Any, args: Any) -> Any:
        """Run the command, and return the exit status."""
        raise NotImplementedError

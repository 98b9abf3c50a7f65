"""Commands that read and write files that the user names."""

from __future__ import annotations

from typing import Any

import click

from aionode.errors import CommandError

__all__ = ["FilesGroup"]


class FilesGroup(click.Group):
    """A group that reports a missing or unreadable file in one line, with its name."""

    def invoke(self, ctx: click.Context) -> Any:
        """Run a command.

        Raises:
            CommandError: a file cannot be read or written.
        """
        try:
            return super().invoke(ctx)
        except BrokenPipeError:
            raise
        except OSError as error:
            raise CommandError(str(error)) from error

"""What a command prints: text for people, or with ``--json`` one record per line for programs.

Data goes to stdout, and what is said about it to stderr. Each item is flushed, so that a pipe
shows it at once.
"""

from __future__ import annotations

import contextlib
import math
import sys
from typing import TYPE_CHECKING, Any, TextIO

import msgspec

from aionode._streams import discard
from aionode.errors import CommandError

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = ["Output", "unwritable"]


class Output:
    """Where a verb prints to.

    Args:
        stdout: Where data goes.
        stderr: Where warnings go.
        json: Whether to print records instead of text.

    Attributes:
        json: Whether records are printed instead of text.
    """

    def __init__(
        self,
        stdout: TextIO | None = None,
        stderr: TextIO | None = None,
        *,
        json: bool = False,
    ) -> None:
        self.json = json
        self._stdout = sys.stdout if stdout is None else stdout
        self._stderr = sys.stderr if stderr is None else stderr

    @property
    def is_terminal(self) -> bool:
        """Whether a person reads the data as it comes."""
        return not self.json and self._stdout.isatty()

    def item(self, text: str, record: object) -> None:
        """Print one item of data: `text`, or `record` in one line of JSON.

        A float that JSON does not have is a word there: ``NaN``, ``Infinity``, ``-Infinity``.
        """
        if self.json:
            self._write(msgspec.json.encode(json_safe(record)).decode())
        else:
            self._write(text)

    def json_line(self, text: str) -> None:
        """Print a record that is JSON already."""
        self._write(text)

    def text(self, text: str = "") -> None:
        """Print a line for people; nothing with ``--json``."""
        if not self.json:
            self._write(text)

    def raw(self, text: str) -> None:
        """Print a text for people as it is, without a new line; nothing with ``--json``."""
        if not self.json:
            self._print(text)

    def progress(self, text: str) -> None:
        """Say what is being waited for: on stdout as ros2 does, on stderr with ``--json``."""
        if self.json:
            self.warn(text)
        else:
            self._write(text)

    def warn(self, text: str) -> None:
        """Print a line on stderr, if that can be written to: there is no other place for it."""
        try:
            self._stderr.write(f"{text}\n")
            self._stderr.flush()
        except OSError:
            discard(self._stderr)

    def _write(self, text: str) -> None:
        self._print(f"{text}\n")

    def _print(self, text: str) -> None:
        try:
            self._stdout.write(text)
            self._stdout.flush()
        except BrokenPipeError:  # its reader has enough, and knows it
            raise
        except OSError as error:
            discard(self._stdout)
            raise CommandError(unwritable(error)) from error

    @contextlib.contextmanager
    def waiting(self, text: str) -> Iterator[None]:
        """Show on a terminal, for as long as it takes, what is being waited for; else nothing."""
        if self.json or not (self._stdout.isatty() and self._stderr.isatty()):
            yield
            return
        from rich.console import Console

        with Console(file=self._stderr).status(text):
            yield

    @contextlib.contextmanager
    def live(self) -> Iterator[Any]:
        """Give a function that shows a rich table in place of the one before."""
        from rich.console import Console
        from rich.live import Live

        with Live(console=Console(file=self._stdout), auto_refresh=False) as live:
            yield lambda table: live.update(table, refresh=True)


def unwritable(error: OSError) -> str:
    """Return what to say when the answer could not be printed."""
    return f"stdout cannot be written to: {error.strerror}; the answer is incomplete"


def json_safe(plain: Any) -> Any:
    """Return plain values in which words stand for the floats that JSON does not have."""
    if isinstance(plain, float):
        return plain if math.isfinite(plain) else NOT_FINITE[str(plain)]
    if isinstance(plain, dict):
        return {key: json_safe(value) for key, value in plain.items()}
    if isinstance(plain, list):
        # All of a list are of one kind, and those of numbers can be long.
        simple = not plain or isinstance(plain[0], int | str)
        return plain if simple else [json_safe(value) for value in plain]
    return plain


NOT_FINITE = {"nan": "NaN", "inf": "Infinity", "-inf": "-Infinity"}

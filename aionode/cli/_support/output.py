"""Output of a command: text for people, or with ``--json`` one record per line for programs.

Data goes to stdout; warnings and progress go to stderr. Each item is flushed, so that a pipe gets
it immediately. On a terminal, control characters in received text are shown as escapes; a pipe or
file gets the characters themselves.
"""

from __future__ import annotations

import contextlib
import math
import sys
from typing import TYPE_CHECKING, Any, TextIO, TypeAlias

from aionode._process.streams import discard
from aionode.errors import CommandError, escaped

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

__all__ = ["Output", "unwritable"]

Shown: TypeAlias = str | list[tuple[str, str]]
"""A text for a terminal: whole, or in pieces with their colours."""

CLEAR = "\x1b[H\x1b[2J"


class Output:
    """The output streams of a verb.

    Args:
        stdout: The stream for data; defaults to sys.stdout.
        stderr: The stream for warnings; defaults to sys.stderr.
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
        """Whether data is printed as text on a terminal."""
        return not self.json and self._stdout.isatty()

    def item(self, text: str, record: object) -> None:
        """Print one item of data: `text`, or `record` in one line of JSON.

        Floats that JSON cannot represent become strings: ``NaN``, ``Infinity``, ``-Infinity``.
        """
        if self.json:
            import msgspec  # `aionode run` and others write no records

            self._write(msgspec.json.encode(json_safe(record)).decode())
        else:
            self._write(text)

    def items(self, items: Iterable[tuple[str, object]], *, count: str = "") -> None:
        """Print each item (text and record); with `count`, print their number under that key."""
        if count:
            number = len(list(items))
            self.item(str(number), {count: number})
            return
        for text, record in items:
            self.item(text, record)

    def json_line(self, text: str) -> None:
        """Print a record that is already encoded as JSON."""
        self._write(text)

    def text(self, text: str = "") -> None:
        """Print a line for people; nothing with ``--json``."""
        if not self.json:
            self._write(text)

    def raw(self, text: str) -> None:
        """Print text for people without a newline; nothing with ``--json``."""
        if not self.json:
            self._print(text)

    def clear(self) -> None:
        """Clear the screen; nothing with ``--json``."""
        if not self.json:
            self._stdout.write(CLEAR)

    def progress(self, text: str) -> None:
        """Print what is being waited for: on stdout, as ros2 does; with ``--json`` on stderr."""
        if self.json:
            self.warn(text)
        else:
            self._write(text)

    def warn(self, text: str) -> None:
        """Print a line on stderr; it is dropped if stderr cannot be written to."""
        try:
            self._stderr.write(f"{escaped(text)}\n")
            self._stderr.flush()
        except OSError:
            discard(self._stderr)

    def _write(self, text: str) -> None:
        self._print(f"{text}\n")

    def _print(self, text: str) -> None:
        try:
            self._stdout.write(escaped(text) if self.is_terminal else text)
            self._stdout.flush()
        except BrokenPipeError:  # the reader closed the pipe on purpose
            raise
        except OSError as error:
            discard(self._stdout)
            raise CommandError(unwritable(error)) from error

    @contextlib.contextmanager
    def waiting(self, text: str) -> Iterator[None]:
        """Show a spinner with `text` while waiting, if the output is a terminal."""
        if self.json or not (self._stdout.isatty() and self._stderr.isatty()):
            yield
            return
        from rich.console import Console

        with Console(file=self._stderr).status(text):
            yield

    @contextlib.contextmanager
    def live(self) -> Iterator[Callable[[Callable[[int], Shown]], None]]:
        """Yield a function that shows a text in place of the previous one.

        Its argument is a function that returns the text for a terminal width in characters, whole
        or in pieces, each with the name of its colour.
        """
        from rich.console import Console
        from rich.live import Live
        from rich.text import Text

        console = Console(file=self._stdout)
        with Live(console=console, auto_refresh=False) as live:

            def update(text_for: Callable[[int], Shown]) -> None:
                shown = text_for(console.width)
                pieces = [(shown, "")] if isinstance(shown, str) else shown
                text = Text.assemble(*pieces, no_wrap=True, overflow="ellipsis")
                live.update(text, refresh=True)

            yield update


def unwritable(error: OSError) -> str:
    """Return the error text for output that could not be written."""
    return f"cannot write to stdout: {error.strerror}; the output is incomplete"


def json_safe(plain: Any) -> Any:
    """Return plain values in which floats that JSON cannot represent are strings."""
    if isinstance(plain, float):
        return plain if math.isfinite(plain) else NOT_FINITE[str(plain)]
    if isinstance(plain, dict):
        return {key: json_safe(value) for key, value in plain.items()}
    if isinstance(plain, list):
        # List elements share one type, and lists of numbers can be long: checking one is enough.
        simple = not plain or isinstance(plain[0], int | str)
        return plain if simple else [json_safe(value) for value in plain]
    return plain


NOT_FINITE = {"nan": "NaN", "inf": "Infinity", "-inf": "-Infinity"}

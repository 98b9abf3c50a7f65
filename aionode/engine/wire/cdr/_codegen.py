"""Builds the source of functions that are generated once per message type.

The source consists only of numbers, names chosen by this package, and field names that
`aionode.message` has validated as identifiers. All other values are passed in by name.
"""

from __future__ import annotations

import re
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

__all__ = ["CodeBuilder", "NeedsFallback"]

POSITION = re.compile(r"\bpos\b")


class NeedsFallback(ValueError):  # noqa: N818 - internal control flow, never seen by a caller
    """The generated code does not handle a value; the fallback handles it or raises the error."""


class CodeBuilder:
    """The source of one function, and the values that it refers to by name."""

    def __init__(self) -> None:
        self.namespace: dict[str, Any] = {"NeedsFallback": NeedsFallback}
        self._lines: list[str] = []
        self._indent = 1
        self._count = 0
        self._kept: list[str] = []
        """Names of the variables that keep their value between calls."""
        self._loops = 0
        """Number of loops around the next line."""
        self._positions: set[int] = set()
        """Indices of the lines that only set `pos`."""

    def constant(self, hint: str, value: object) -> str:
        """Return the name by which the function refers to `value`."""
        for name, known in self.namespace.items():
            if known is value and name not in self._kept:
                return name
        name = f"{hint}{len(self.namespace)}"
        self.namespace[name] = value
        return name

    def variable(self, hint: str, value: object) -> str:
        """Return the name of a variable that keeps its value between calls."""
        name = f"{hint}{len(self.namespace)}"
        self.namespace[name] = value
        self._kept.append(name)
        return name

    def local(self, hint: str) -> str:
        """Return a new name for a local variable."""
        self._count += 1
        return f"{hint}_{self._count}"

    def line(self, text: str) -> None:
        """Add a statement."""
        self._lines.append("    " * self._indent + text)

    def position(self, text: str) -> None:
        """Add a statement that sets `pos`; it is dropped if `pos` is not read afterwards."""
        if not self._loops:
            self._positions.add(len(self._lines))
        self.line(text)

    def require(self, condition: str) -> None:
        """Raise NeedsFallback unless `condition` holds."""
        self.line(f"if not ({condition}): raise NeedsFallback")

    @contextmanager
    def block(self, head: str) -> Iterator[None]:
        """Indent the lines added inside the `with` block under `head`."""
        self.line(head)
        self._indent += 1
        yield
        self._indent -= 1

    @contextmanager
    def loop(self, head: str) -> Iterator[None]:
        """Like `block`, for loops: a later iteration may read what an earlier one sets."""
        self._loops += 1
        with self.block(head):
            yield
        self._loops -= 1

    def text(self, head: str) -> str:
        """Return the source of the whole function."""
        kept: list[str] = []
        is_read = False
        for number, line in reversed(list(enumerate(self._lines))):
            if number in self._positions and not is_read:
                continue
            is_read = is_read or POSITION.search(line) is not None
            kept.insert(0, line)
        kept[:0] = [f"    global {name}" for name in self._kept]
        return "\n".join((head, *kept, ""))

    def function(self, head: str, subject: str) -> Callable[..., Any]:
        """Return the compiled function; `subject` is shown in tracebacks."""
        name = head.removeprefix("def ").partition("(")[0]
        code = compile(self.text(head), f"<{name} {subject}>", "exec")
        # The source contains only validated field names and numbers: see the module's docstring.
        exec(code, self.namespace)  # noqa: S102
        function: Callable[..., Any] = self.namespace.pop(name)
        return function

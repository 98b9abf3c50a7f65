"""Functions written at run time, one for each message type, and compiled once.

Their text holds only numbers, names that this package made up, and names of fields that
`aionode.message` has validated as identifiers. Values of any other kind go in by name.
"""

from __future__ import annotations

import re
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

__all__ = ["CodeBuilder", "NeedsFallback"]

POSITION = re.compile(r"\bpos\b")


class NeedsFallback(ValueError):  # noqa: N818 - a signal inside this package, never seen by a caller
    """A value is not of the usual form: the plain codec takes it, or says what is wrong."""


class CodeBuilder:
    """The text of one function, and the values that it uses by name."""

    def __init__(self) -> None:
        self.namespace: dict[str, Any] = {"NeedsFallback": NeedsFallback}
        self._lines: list[str] = []
        self._indent = 1
        self._count = 0
        self._kept: list[str] = []
        self._loops = 0
        self._positions: set[int] = set()

    def constant(self, hint: str, value: object) -> str:
        """Return the name under which the function finds `value`."""
        for name, known in self.namespace.items():
            if known is value and name not in self._kept:
                return name
        name = f"{hint}{len(self.namespace)}"
        self.namespace[name] = value
        return name

    def variable(self, hint: str, value: object) -> str:
        """Return the name of a variable that the function keeps from call to call."""
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
        """Add a statement that sets `pos`; it is left out if nothing reads `pos` after it."""
        if not self._loops:
            self._positions.add(len(self._lines))
        self.line(text)

    def require(self, condition: str) -> None:
        """Leave the function where `condition` does not hold."""
        self.line(f"if not ({condition}): raise NeedsFallback")

    @contextmanager
    def block(self, head: str) -> Iterator[None]:
        """Indent what follows under `head`."""
        self.line(head)
        self._indent += 1
        yield
        self._indent -= 1

    @contextmanager
    def loop(self, head: str) -> Iterator[None]:
        """Indent what follows under `head`; what it sets may be read when it comes round."""
        self._loops += 1
        with self.block(head):
            yield
        self._loops -= 1

    def text(self, head: str) -> str:
        """Return the whole function."""
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
        """Compile the function; `subject` shows in tracebacks."""
        name = head.removeprefix("def ").partition("(")[0]
        code = compile(self.text(head), f"<{name} {subject}>", "exec")
        # The text comes from validated field names and numbers only: see the module's docstring.
        exec(code, self.namespace)  # noqa: S102
        function: Callable[..., Any] = self.namespace.pop(name)
        return function

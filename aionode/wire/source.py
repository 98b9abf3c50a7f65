"""Functions written at run time, one for each message type, and compiled once.

Their text holds only numbers, names that this package made up, and names of fields that
`aionode.message` has validated as identifiers. Values of any other kind go in by name.
"""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

__all__ = ["Misfit", "Source"]


class Misfit(ValueError):  # noqa: N818 - a signal inside this package, never seen by a caller
    """A value is not of the usual form: the plain codec takes it, or says what is wrong."""


class Source:
    """The text of one function, and the values that it uses by name."""

    def __init__(self) -> None:
        self.namespace: dict[str, Any] = {"Misfit": Misfit}
        self._lines: list[str] = []
        self._indent = 1
        self._count = 0
        self._unread: list[int] = []  # lines that set `pos`, and nothing read it since

    def constant(self, hint: str, value: object) -> str:
        """Return the name under which the function finds `value`."""
        for name, known in self.namespace.items():
            if known is value:
                return name
        name = f"{hint}{len(self.namespace)}"
        self.namespace[name] = value
        return name

    def local(self, hint: str) -> str:
        """Return a new name for a local variable."""
        self._count += 1
        return f"{hint}_{self._count}"

    def line(self, text: str) -> None:
        """Add a statement."""
        self._lines.append("    " * self._indent + text)

    def position(self, text: str) -> None:
        """Add a statement that sets `pos`; it is left out if nothing reads `pos` any more."""
        self._unread.append(len(self._lines))
        self.line(text)

    def reads_position(self) -> None:
        """Note that the next statement reads `pos`."""
        self._unread.clear()

    def require(self, condition: str) -> None:
        """Leave the function where `condition` does not hold."""
        self.line(f"if not ({condition}): raise Misfit")

    @contextmanager
    def block(self, head: str) -> Iterator[None]:
        """Indent what follows under `head`."""
        self.line(head)
        self._indent += 1
        yield
        self._indent -= 1

    @contextmanager
    def loop(self, head: str) -> Iterator[None]:
        """Indent what follows under `head`; what is set at its end may be read at its start."""
        self.reads_position()
        with self.block(head):
            yield
        self.reads_position()

    def text(self, head: str) -> str:
        """Return the whole function."""
        unread = set(self._unread)
        kept = [text for number, text in enumerate(self._lines) if number not in unread]
        return "\n".join((head, *kept, ""))

    def function(self, head: str, subject: str) -> Callable[..., Any]:
        """Compile the function; `subject` shows in tracebacks."""
        name = head.removeprefix("def ").partition("(")[0]
        code = compile(self.text(head), f"<{name} {subject}>", "exec")
        # The text comes from validated field names and numbers only: see the module's docstring.
        exec(code, self.namespace)  # noqa: S102
        function: Callable[..., Any] = self.namespace.pop(name)
        return function
